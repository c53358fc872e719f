// cd/m2.
fn read_emission(v: VertexOut) -> vec3f {
    return material.emissive * emissive_texel(v).xyz;
}
