// The target holds scene radiance.
fn target_value(stored: vec4f) -> vec4f {
    return stored;
}
