// Smith masking of one direction for GGX, in [0, 1]. Walter et al. 2007, equation 34, without its tangent.
// `alpha` in (0, 1], `NoX` in [0, 1]; it falls linearly to 0 at the horizon.
fn G1_SmithGGX(alpha: f32, NoX: f32) -> f32 {
    let a2 = alpha * alpha;
    return 2.0 * NoX / (NoX + sqrt((NoX - a2 * NoX) * NoX + a2));
}
