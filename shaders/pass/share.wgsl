// Which part of a pixel's light a group of its samples has.
fn share(pixel: vec2i, group: u32) -> f32 {
    return f32(countOneBits(group)) / f32(SAMPLES);
}
