#import "math/constants.wgsl"

// GGX (Trowbridge-Reitz) distribution of microfacet normals, 1/sr. Walter et al. 2007, eq. 33.
//   D = alpha^2 / (pi ((n.h)^2 (alpha^2 - 1) + 1)^2)
// `alpha` in [1e-4, 1]; `n` and `h` unit vectors with n.h > 0.
// The denominator wants 1 - (n.h)^2, which cancels near the peak: at alpha = 1e-3 the printed form is wrong by up to
// 40 times in f32. The chord n - h is exact there (Sterbenz), and sin^2 = c^2 (1 - c^2 / 4) for a chord of length c.
fn D_GGX(alpha: f32, n: vec3f, h: vec3f) -> f32 {
    let chord = n - h;
    let chord2 = dot(chord, chord);
    let sin2 = chord2 * (1.0 - 0.25 * chord2);
    let t = alpha / (sin2 + alpha * alpha * (1.0 - sin2));
    return t * t * INV_PI;
}
