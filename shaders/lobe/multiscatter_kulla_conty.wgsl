// Fresnel factor of the light that meets more than one microfacet. Kulla and Conty 2017, "Revisiting Physically Based
// Shading at Imageworks", slide 26: F_ms = F_avg^2 E_avg / (1 - F_avg (1 - E_avg)); with F_avg squared so that one
// bounce is not counted twice. `F_avg` is the cosine average of the Fresnel curve.
fn F_multiscatter(F_avg: vec3f, E_avg: f32) -> vec3f {
    return F_avg * F_avg * E_avg / (1.0 - F_avg * (1.0 - E_avg));
}
