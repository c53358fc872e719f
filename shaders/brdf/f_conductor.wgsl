// Fresnel reflectance of a conductor in air, exact for unpolarised light. Born and Wolf 1999, section 14.4.
// `n` + i `k` is the complex index of refraction a channel; `n` > 0, `k` >= 0; `VoH` in [0, 1].
fn F_conductor(n: vec3f, k: vec3f, VoH: f32) -> vec3f {
    let cos2 = VoH * VoH;
    let sin2 = 1.0 - cos2;
    let n2 = n * n;
    let k2 = k * k;
    // n^2 - k^2 - sin^2 in an order that keeps cos^2 where n is near 1.
    let t = (n2 - 1.0 - k2) + cos2;
    let ab = sqrt(t * t + 4.0 * n2 * k2);
    // 2 a cos, where a^2 = (ab + t) / 2; a difference of nearly equal numbers where k is large, so it takes the other root.
    let a2 = select(2.0 * n2 * k2 / max(ab - t, vec3f(1e-20)), 0.5 * (ab + t), t > vec3f(0.0));
    let a_cos = 2.0 * sqrt(a2) * VoH;
    // Nothing is left of either side where the metal is a vacuum, seen edge on.
    let Rs = (ab + cos2 - a_cos) / max(ab + cos2 + a_cos, vec3f(1e-20));
    let p = cos2 * ab + sin2 * sin2;
    let q = a_cos * sin2;
    return 0.5 * Rs * (1.0 + (p - q) / (p + q));
}
