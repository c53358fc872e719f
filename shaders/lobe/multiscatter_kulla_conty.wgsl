// Fresnel factor of the light that meets more than one microfacet. Kulla and Conty 2017, "Revisiting Physically Based
// Shading at Imageworks", slide 26: F_ms = F_avg^2 E_avg / (1 - F_avg (1 - E_avg)); with F_avg squared so that one
// bounce is not counted twice. F_avg is the cosine average of Schlick's curve, F0 + (F90 - F0) / 21.
fn F_multiscatter(F0: vec3f, F90: f32, E_avg: f32) -> vec3f {
    let F_avg = F0 + (F90 - F0) * (1.0 / 21.0);
    return F_avg * F_avg * E_avg / (1.0 - F_avg * (1.0 - E_avg));
}
