// Naive: shown beside the form in use by `specula stability`, and part of no frame.

// I / (d d): the square under- and overflows long before the distance does.
fn point_illuminance_naive(intensity: f32, toward: vec3f) -> f32 {
    let d = length(toward);
    return intensity / (d * d);
}
