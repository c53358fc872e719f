#import "math/orthonormal.wgsl"
#import "math/vectors.wgsl"

// The frame in which microfacets are spread: t along the wide direction, b across it, both at right angles to n.
struct Tangents {
    t: vec3f,
    strength: f32,
    b: vec3f,
}

// KHR_materials_anisotropy: the texture holds a direction in tangent space (RG) and a strength (B); all are turned by the
// material's rotation. `n` is the shading normal before it faces the viewer.
fn read_tangents(v: VertexOut, n: vec3f) -> Tangents {
    let texel = anisotropy_texel(v).xyz;
    let turn = mat2x2f(material.anisotropy.y, material.anisotropy.z, -material.anisotropy.z, material.anisotropy.y);
    let direction = turn * (texel.xy * 2.0 - 1.0);
    let tangent = v.tangent.xyz;
    let along = normalize_or(tangent - n * dot(n, tangent), any_orthonormal(n));
    let across = cross(n, along) * v.tangent.w;
    let t = normalize_or(along * direction.x + across * direction.y, along);
    return Tangents(t, saturate(material.anisotropy.x * texel.z), cross(n, t));
}
