#import "math/vectors.wgsl"

fn shading_normal(v: VertexOut, toward_viewer: vec3f) -> vec3f {
    return normalize_or(v.normal, toward_viewer);
}
