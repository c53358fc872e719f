#import "math/orthonormal.wgsl"
#import "math/vectors.wgsl"

// The part of the interpolated tangent that lies across the shading normal, normal map included.
fn shading_tangent(v: VertexOut, n: vec3f) -> vec3f {
    let tangent = v.tangent.xyz;
    return normalize_or(tangent - n * dot(n, tangent), any_orthonormal(n));
}
