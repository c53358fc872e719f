// The target encodes by itself.
fn encode(linear: vec3f) -> vec3f {
    return saturate(linear);
}
