#import "math/constants.wgsl"

// GGX with two alphas, 1/sr. Burley 2012, appendix B.
//   D = 1 / (pi alpha_x alpha_y ((t.h)^2 / alpha_x^2 + (b.h)^2 / alpha_y^2 + (n.h)^2)^2)
// Alphas from 1e-4; `t`, `b`, `n` orthonormal, `h` a unit vector with n.h > 0. The cosines with t and b are taken of
// the chord h - n, which is exact near the peak: of h itself they carry the rounding of t.n, which alpha = 1e-3
// magnifies.
fn D_GTR2_anisotropic(alpha_x: f32, alpha_y: f32, t: vec3f, b: vec3f, n: vec3f, h: vec3f) -> f32 {
    let chord = h - n;
    let x = dot(t, chord) / alpha_x;
    let y = dot(b, chord) / alpha_y;
    let NoH = dot(n, h);
    let ellipsoid = x * x + y * y + NoH * NoH;
    return INV_PI / (alpha_x * alpha_y * ellipsoid * ellipsoid);
}
