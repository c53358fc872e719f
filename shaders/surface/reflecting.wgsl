// What the lobes are made of beside colours: glTF 2.0, 3.9.2.
fn read_metallic(metallic_roughness: vec4f) -> f32 {
    return saturate(material.metallic * metallic_roughness.z);
}

fn read_perceptual_roughness(metallic_roughness: vec4f) -> f32 {
    return saturate(material.perceptual_roughness * metallic_roughness.y);
}

fn read_dielectric_F0() -> f32 {
    return material.dielectric_F0;
}
