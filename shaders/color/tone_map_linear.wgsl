// No curve: light beyond 1 is clipped.
fn tone_map(exposed: vec3f) -> vec3f {
    return saturate(exposed);
}
