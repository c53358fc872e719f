// Visibility of height-correlated Smith for anisotropic GGX. Heitz 2014, eqs. 80 and 99, simplified.
// `NoV` in (0, 1], `NoL` in [0, 1].
fn V_SmithGGXCorrelated_anisotropic(alpha_t: f32, alpha_b: f32, ToV: f32, BoV: f32, ToL: f32, BoL: f32, NoV: f32, NoL: f32) -> f32 {
    let from_view = NoL * length(vec3f(alpha_t * ToV, alpha_b * BoV, NoV));
    let from_light = NoV * length(vec3f(alpha_t * ToL, alpha_b * BoL, NoL));
    // Both are zero for a light straight below, which the cosine has yet to cancel.
    return 0.5 / max(from_view + from_light, 1e-8);
}
