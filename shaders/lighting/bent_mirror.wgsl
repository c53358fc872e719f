#import "math/vectors.wgsl"

// Where one lookup sees most of a lobe that is wider across b than along it. Facets lean along t, and those that reflect
// toward the viewer lean toward it: the normal is bent to the viewer's side within the plane of t and n (after McAuley
// 2015), the more so the wider the spread along t is than along b. `contrast` is of both alpha^2.
fn bent_mirror_direction(contrast: f32, b: vec3f, n: vec3f, v: vec3f) -> vec3f {
    let leaning = normalize_or(v - b * dot(b, v), n);
    return reflect(-v, normalize_or(mix(n, leaning, 0.5 * contrast), n));
}
