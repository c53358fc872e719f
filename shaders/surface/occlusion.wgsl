// How much of the environment's light arrives, in [0, 1] (glTF 2.0, 3.9.3).
fn read_occlusion(v: VertexOut, metallic_roughness: vec4f) -> f32 {
    return saturate(1.0 + material.occlusion_strength * (occlusion_texel(v, metallic_roughness).x - 1.0));
}
