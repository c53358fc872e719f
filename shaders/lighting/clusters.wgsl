@group(0) @binding(9) var<uniform> clusters: ClusterUniform;
// For each cluster where its list begins in this table, then where the last one ends, then the lists.
@group(0) @binding(10) var<storage, read> cluster_table: array<u32>;

// The cluster of a point of the scene, a number from 0. What is outside of all counts to the nearest.
fn cluster_at(position: vec3f) -> u32 {
    let at = clusters.tiles_from_world * vec4f(position, 1.0);
    let w = max(at.w, 1e-30);
    let slice = log2(w) * clusters.slice_per_octave + at.z * clusters.slice_per_clip_z + clusters.slice_bias;
    let last = vec3u(clusters.columns, clusters.rows, clusters.slices) - 1u;
    let cell = min(vec3u(max(vec3f(at.xy / w, slice), vec3f(0.0))), last);
    return (cell.z * clusters.rows + cell.y) * clusters.columns + cell.x;
}
