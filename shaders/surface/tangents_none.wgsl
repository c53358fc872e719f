// Nothing here has a direction along the surface.
struct Tangents {
    strength: f32,
}

fn read_tangents(v: VertexOut, n: vec3f) -> Tangents {
    return Tangents(0.0);
}
