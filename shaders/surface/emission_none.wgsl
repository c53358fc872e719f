fn read_emission(v: VertexOut) -> vec3f {
    return vec3f(0.0);
}
