// Nothing depends on the direction along the surface.
fn shading_tangent(v: VertexOut, n: vec3f) -> vec3f {
    return vec3f(0.0);
}
