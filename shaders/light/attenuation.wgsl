// The shortest distance that counts, squared, in m^2: closer lights would overflow the half-float target.
const DISTANCE_SQUARED_MIN: f32 = 1e-4;
// The square of a distance above 1.8e19 m is infinite, and infinity times no range is no number.
const DISTANCE_SQUARED_MAX: f32 = 3e38;

// Inverse-square law with the smooth window of KHR_lights_punctual, 1/m^2.
// `inverse_range_squared` is 1/range^2, or 0 for a light without a range.
fn distance_attenuation(inverse_range_squared: f32, distance_squared: f32) -> f32 {
    let d2 = clamp(distance_squared, DISTANCE_SQUARED_MIN, DISTANCE_SQUARED_MAX);
    let x = d2 * inverse_range_squared;
    return saturate(1.0 - x * x) / d2;
}

// Spot cone of KHR_lights_punctual: 1 inside the inner cone, 0 outside the outer one.
// scale = 1 / max(1e-3, cos_inner - cos_outer), offset = -cos_outer scale.
fn spot_attenuation(scale: f32, offset: f32, cos_angle: f32) -> f32 {
    let x = saturate(cos_angle * scale + offset);
    return x * x;
}
