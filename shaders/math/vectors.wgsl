// Lengths between which a direction is told from rounding: beyond, squares and reciprocals leave f32.
const LENGTH_MIN: f32 = 1e-30;
const LENGTH_MAX: f32 = 1e37;

// `v / |v|`, or `fallback` where the length is zero or outside of what can be told. Scaled by the largest component
// first: the square of a length leaves f32 below 1e-19 and above 1e19.
fn normalize_or(v: vec3f, fallback: vec3f) -> vec3f {
    let largest = max(abs(v.x), max(abs(v.y), abs(v.z)));
    let scaled = v * (1.0 / max(largest, LENGTH_MIN));
    let unit = scaled * inverseSqrt(max(dot(scaled, scaled), LENGTH_MIN));
    return select(fallback, unit, largest > LENGTH_MIN && largest < LENGTH_MAX);
}
