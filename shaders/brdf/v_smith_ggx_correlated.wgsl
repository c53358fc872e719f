// Visibility V = G2 / (4 n.v n.l) of height-correlated Smith masking and shadowing for GGX, dimensionless.
// Heitz 2014, "Understanding the Masking-Shadowing Function", eqs. 72 and 99, simplified.
// `alpha` in (0, 1], `NoV` in (0, 1], `NoL` in [0, 1]: finite while one of the cosines is above zero.
fn V_SmithGGXCorrelated(alpha: f32, NoV: f32, NoL: f32) -> f32 {
    let a2 = alpha * alpha;
    let from_view = NoL * sqrt((NoV - a2 * NoV) * NoV + a2);
    let from_light = NoV * sqrt((NoL - a2 * NoL) * NoL + a2);
    return 0.5 / (from_view + from_light);
}
