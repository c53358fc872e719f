// Which part of a pixel's light a group of its samples has that is seen through what lies over them.
fn share(pixel: vec2i, group: u32) -> f32 {
    var sum = 0.0;
    for (var i = 0u; i < SAMPLES; i++) {
        sum += select(0.0, transmitted(pixel, i), (group & (1u << i)) != 0u);
    }
    return sum / f32(SAMPLES);
}
