#import "math/constants.wgsl"

// Anisotropic GGX, 1/sr. Burley 2012, eq. 13.
//   D = 1 / (pi alpha_t alpha_b ((t.h / alpha_t)^2 + (b.h / alpha_b)^2 + (n.h)^2)^2)
// `alpha_t`, `alpha_b` in [1e-4, 1]; t, b, n an orthonormal frame, n.h > 0.
// t and b are at right angles to n, so they see the chord h - n, whose small components are exact near the peak.
fn D_GGX_anisotropic(alpha_t: f32, alpha_b: f32, t: vec3f, b: vec3f, n: vec3f, h: vec3f) -> f32 {
    let chord = h - n;
    let x = dot(t, chord) / alpha_t;
    let y = dot(b, chord) / alpha_b;
    let NoH = 1.0 - 0.5 * dot(chord, chord);
    let q = x * x + y * y + NoH * NoH;
    return INV_PI / (alpha_t * alpha_b * q * q);
}
