// Single scattering only: the rest of the energy is lost.
fn F_multiscatter(F0: vec3f, F90: f32, E_avg: f32) -> vec3f {
    return vec3f(0.0);
}
