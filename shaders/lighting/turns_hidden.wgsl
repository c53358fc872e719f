// How often a loop over lights turns, which no compiler can tell from uniforms alone. Where uniforms decide, Mesa 22.3
// compiles the shader anew for each draw of a pass and keeps it: 2.6 MB a draw and frame. No position is so far away.
fn turns(count: u32, position: vec3f) -> u32 {
    return count + u32(position.x > 3e38);
}
