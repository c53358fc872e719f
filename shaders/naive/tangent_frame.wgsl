// Naive: shown beside the form in use by `specula stability`, and part of no frame.

// A normal map in a frame each of whose vectors is normalised first.
fn shading_normal_naive(normal: vec3f, tangent: vec4f, texel: vec3f) -> vec3f {
    let n = normalize(normal);
    let t = normalize(tangent.xyz);
    let b = normalize(cross(n, t)) * tangent.w;
    let local = texel * 2.0 - 1.0;
    return normalize(t * local.x + b * local.y + n * local.z);
}

// A tangent from the edges of a triangle and of its texture coordinates, by the inverse of their matrix.
fn tangent_from_edges(edge_1: vec3f, edge_2: vec3f, uv_1: vec2f, uv_2: vec2f) -> vec3f {
    let inverse_determinant = 1.0 / (uv_1.x * uv_2.y - uv_1.y * uv_2.x);
    return normalize((edge_1 * uv_2.y - edge_2 * uv_1.y) * inverse_determinant);
}
