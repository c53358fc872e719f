// Lobes that depend on the light's cosine alone see the sky as irradiance does, but for its parts of degree 1 and 2: how
// much more of them than the cosine they see. Fitted to the harmonics of the lobes.

// (1 - E(NoL)) NoL, the multiple scattering of Kulla and Conty 2017, E being GGX's albedo: the fit is off by 0.4 % of the
// loss at most.
fn multiscatter_parts(perceptual_roughness: f32) -> vec2f {
    let s = 1.0 - perceptual_roughness;
    return vec2f(0.0578, 0.2615) - (vec2f(0.0296, 0.6833) + vec2f(0.9131, 3.1658) * s) * (s * s);
}

// (1 - E_s(NoL)) NoL, Lambert's lobe below an interface of F0 = 0.04: within 0.003 and 0.012.
fn coated_parts(perceptual_roughness: f32) -> vec2f {
    let s = 1.0 - perceptual_roughness;
    return (vec2f(0.0476, 0.2026) - vec2f(0.0133, 0.0667) * (s * s)) * (s * s);
}
