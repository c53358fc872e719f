#import "math/vectors.wgsl"

// Tangent-space normal map. MikkTSpace: the interpolated frame is used as it is, the bitangent is made per pixel, and
// only the result is normalised. A frame or a texel of length zero falls back to the vertex normal.
//
// Texels are signed: code 128 of the file is 0 and 255 is 1. Half a code makes the range of the file even again.
fn shading_normal(v: VertexOut, toward_viewer: vec3f) -> vec3f {
    let vertex_normal = normalize_or(v.normal, toward_viewer);
    let bitangent = cross(v.normal, v.tangent.xyz) * v.tangent.w;
    let texel = normal_texel(v).xyz * (254.0 / 255.0) + 1.0 / 255.0;
    let xy = texel.xy * material.normal_scale;
    return normalize_or(v.tangent.xyz * xy.x + bitangent * xy.y + v.normal * texel.z, vertex_normal);
}
