// The channel of the frame's uniform, its index and its components.
//
// llvmpipe compiles a shader once more for the values of uniforms that it branches on, and keeps what it has compiled. Of these
// shaders, which branch much, that was done in every frame, and 23 channels of a scene with 22 materials and a lamp took 2 GB.
// So they branch on this, which is no uniform as far as a compiler can tell.
var<private> asked: vec3u;

// A fragment's w is the inverse of its distance. It may be below 0, where the middle of a pixel lies beside a triangle near the eye that
// covers another of its samples, but is never so large.
fn ask(w: f32) {
    asked = vec3u(frame.channel, frame.channel_index, frame.channel_components) + u32(w > 3e38);
}
