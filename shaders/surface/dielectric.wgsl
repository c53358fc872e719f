// KHR_materials_specular: weight and tint of what the dielectric part reflects.
fn read_specular(v: VertexOut) -> f32 {
    return saturate(material.specular * specular_texel(v).w);
}

fn read_specular_color(v: VertexOut) -> vec3f {
    return material.specular_color * specular_color_texel(v).xyz;
}
