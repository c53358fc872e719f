// Nothing shines on this scene: surfaces are seen by what they emit.
fn shade(surface: Surface, position: vec3f) -> vec3f {
    return surface.emissive;
}
