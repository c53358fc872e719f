#import "math/orthonormal.wgsl"

// The lobes want a frame, the geometry has no tangents: any will do.
fn shading_tangent(v: VertexOut, n: vec3f) -> vec3f {
    return any_orthonormal(n);
}
