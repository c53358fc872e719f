#import "math/constants.wgsl"

// Generalized Trowbridge-Reitz distribution with exponent 1, 1/sr. Burley 2012, appendix B.
//   D = (alpha^2 - 1) / (pi ln(alpha^2) (1 + (alpha^2 - 1) (n.h)^2))
// `alpha` in [1e-4, 0.99]; `n` and `h` unit vectors with n.h > 0. The sine comes from the chord, see D_GGX.
fn D_GTR1(alpha: f32, n: vec3f, h: vec3f) -> f32 {
    let a2 = alpha * alpha;
    let chord = n - h;
    let chord2 = dot(chord, chord);
    let sin2 = chord2 * (1.0 - 0.25 * chord2);
    return (a2 - 1.0) * (0.5 * INV_PI) / (log(alpha) * (sin2 + a2 * (1.0 - sin2)));
}
