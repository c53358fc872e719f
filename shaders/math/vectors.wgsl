// `v / |v|`, or `fallback` where the length is zero or so small that its square underflows.
fn normalize_or(v: vec3f, fallback: vec3f) -> vec3f {
    let length_squared = dot(v, v);
    return select(fallback, v * inverseSqrt(max(length_squared, 1e-30)), length_squared > 1e-30);
}
