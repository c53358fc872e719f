// How often a loop over lights turns.
fn turns(count: u32, position: vec3f) -> u32 {
    return count;
}
