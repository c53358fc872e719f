// Reinhard et al. 2002, eq. 3, per channel.
fn tone_map(exposed: vec3f) -> vec3f {
    return exposed / (1.0 + exposed);
}
