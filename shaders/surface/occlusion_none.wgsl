fn read_occlusion(v: VertexOut, metallic_roughness: vec4f) -> f32 {
    return 1.0;
}
