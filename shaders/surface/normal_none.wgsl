// Unlit geometry has no normal and needs none.
fn shading_normal(v: VertexOut, toward_viewer: vec3f) -> vec3f {
    return toward_viewer;
}
