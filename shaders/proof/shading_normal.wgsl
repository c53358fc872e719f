#import "proof/inputs.wgsl"

// The normal of a mapped point whose vertex attributes are given, seen from +Z.
fn mapped_normal(normal: vec3f, tangent: vec4f, texel: vec3f) -> vec3f {
    material.normal_scale = 1.0;
    for (var slot = 0u; slot < TEXTURE_SLOTS; slot++) {
        texels[slot] = vec4f(texel, 1.0);
    }
    return shading_normal(VertexOut(vec3f(0.0), normal, tangent, vec4f(1.0)), vec3f(0.0, 0.0, 1.0));
}
