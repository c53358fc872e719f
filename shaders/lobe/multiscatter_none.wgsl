// Single scattering only: the rest of the energy is lost.
fn F_multiscatter(F_avg: vec3f, E_avg: f32) -> vec3f {
    return vec3f(0.0);
}
