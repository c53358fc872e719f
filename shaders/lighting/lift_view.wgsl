// A direction of view behind the shading normal is lifted to this cosine: the lobes keep their albedo at silhouettes.
const NOV_MIN: f32 = 1e-4;

// `v`, or the nearest direction that is not behind the shading normal.
fn lift_view(n: vec3f, v: vec3f) -> vec3f {
    return normalize(v + n * max(NOV_MIN - dot(n, v), 0.0));
}
