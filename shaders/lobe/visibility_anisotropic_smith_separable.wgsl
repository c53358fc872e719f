// Masking and shadowing as if independent.
fn visibility_anisotropic(alpha_t: f32, alpha_b: f32, ToV: f32, BoV: f32, ToL: f32, BoL: f32, NoV: f32, NoL: f32) -> f32 {
    let from_view = NoV + length(vec3f(alpha_t * ToV, alpha_b * BoV, NoV));
    let from_light = NoL + length(vec3f(alpha_t * ToL, alpha_b * BoL, NoL));
    // Zero for a light straight below, which the cosine has yet to cancel.
    return 1.0 / max(from_view * from_light, 1e-12);
}
