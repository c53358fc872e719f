// Visibility of Smith's masking and shadowing taken as independent. Walter et al. 2007, eqs. 23 and 34, simplified.
// `alpha` in (0, 1], `NoV` in (0, 1], `NoL` in [0, 1].
fn V_SmithGGX_separable(alpha: f32, NoV: f32, NoL: f32) -> f32 {
    let a2 = alpha * alpha;
    let from_view = NoV + sqrt((NoV - a2 * NoV) * NoV + a2);
    let from_light = NoL + sqrt((NoL - a2 * NoL) * NoL + a2);
    return 1.0 / (from_view * from_light);
}
