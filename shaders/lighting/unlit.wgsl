// KHR_materials_unlit: the base colour is the radiance.
fn shade(surface: Surface, position: vec3f) -> vec3f {
    return surface.base_color;
}
