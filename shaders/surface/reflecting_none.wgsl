// No light is evaluated here.
fn read_metallic(metallic_roughness: vec4f) -> f32 {
    return 0.0;
}

fn read_perceptual_roughness(metallic_roughness: vec4f) -> f32 {
    return 1.0;
}

fn read_dielectric_F0() -> f32 {
    return 0.0;
}
