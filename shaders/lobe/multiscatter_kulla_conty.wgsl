// Share of the light at the second and later facets that leaves from there, to 1 - E_avg, what the first one keeps.
// Fitted to random walks on the microsurface (docs/multiscatter.md).
const LATER_ESCAPE: f32 = 0.7;

// Fresnel factor of the light that meets more than one microfacet. Kulla and Conty 2017, "Revisiting Physically Based
// Shading at Imageworks": F_ms = F_avg^2 e / (1 - F_avg (1 - e)), with F_avg squared so that one bounce is not
// counted twice. They have e = E_avg. `F_avg` is the cosine average of the Fresnel curve.
fn F_multiscatter(F_avg: vec3f, E_avg: f32) -> vec3f {
    let escape = E_avg + LATER_ESCAPE * (1.0 - E_avg) * E_avg;
    let out = F_avg * escape;
    // As a sum without cancellation: 1 for F_avg = 1, to the last bit.
    return F_avg * (out / (1.0 - F_avg + out));
}
