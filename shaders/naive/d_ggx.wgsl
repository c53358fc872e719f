// Naive: shown beside the form in use by `specula stability`, and part of no frame.
#import "math/constants.wgsl"

// As printed, Walter et al. 2007, eq. 33: (n.h)^2 (alpha^2 - 1) + 1 cancels near the peak.
fn D_GGX_textbook(alpha: f32, n: vec3f, h: vec3f) -> f32 {
    let NoH = saturate(dot(n, h));
    let a2 = alpha * alpha;
    let d = NoH * NoH * (a2 - 1.0) + 1.0;
    return a2 / (PI * d * d);
}

// With the sine from the cosine: 1 - (n.h)^2 has lost its digits before it is used.
fn D_GGX_from_cosine(alpha: f32, n: vec3f, h: vec3f) -> f32 {
    let NoH = saturate(dot(n, h));
    let sin2 = 1.0 - NoH * NoH;
    let t = alpha / (sin2 + alpha * alpha * NoH * NoH);
    return t * t * INV_PI;
}

// With the sine from Lagrange's identity, |n x h|^2: each product of the cross product still rounds at the size of 1.
fn D_GGX_cross(alpha: f32, n: vec3f, h: vec3f) -> f32 {
    let NxH = cross(n, h);
    let sin2 = dot(NxH, NxH);
    let t = alpha / (sin2 + alpha * alpha * (1.0 - sin2));
    return t * t * INV_PI;
}
