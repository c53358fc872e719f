// Naive: shown beside the form in use by `specula stability`, and part of no frame.

fn normalize_naive(v: vec3f, fallback: vec3f) -> vec3f {
    return normalize(v);
}
