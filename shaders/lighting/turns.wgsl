// How often a loop over lights turns, hidden from the driver: no position is so far away. Where uniforms alone decide, llvmpipe
// of Mesa 22.3 compiled the deferred path anew for each draw, and kept what it had compiled: 2.6 MB a draw and frame.
fn turns(count: u32, position: vec3f) -> u32 {
    return count + u32(position.x > 3e38);
}
