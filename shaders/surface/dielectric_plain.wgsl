fn read_specular(v: VertexOut) -> f32 {
    return 1.0;
}

fn read_specular_color(v: VertexOut) -> vec3f {
    return vec3f(1.0);
}
