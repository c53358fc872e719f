// Pixels whose samples belong to several draws, or to one and the background.
const SHARED_DEPTH: f32 = 1.0;

// Pixels of one draw; 0 is the background.
fn depth_of_draw(number: u32) -> f32 {
    return f32(number) * (1.0 / 65536.0);
}
