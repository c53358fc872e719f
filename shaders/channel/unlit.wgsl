// No light falls on this surface.
fn radiance_channel(surface: Surface, position: vec3f) -> vec3f {
    return vec3f(0.0);
}
