#import <types>
#import <seen>
#import "pass/fullscreen.wgsl"
#import "pass/draw_depth.wgsl"

@vertex
fn vertex(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    return vec4f(fullscreen_position(index), 0.0, 1.0);
}

// Whose a pixel is, as depth. The passes that follow test it before they shade.
@fragment
fn fragment(@builtin(position) position: vec4f) -> @builtin(frag_depth) f32 {
    let pixel = vec2i(position.xy);
    let first = seen(pixel, 0u).x;
    var is_shared = false;
    for (var i = 1u; i < SAMPLES; i++) {
        is_shared = is_shared || seen(pixel, i).x != first;
    }
    return select(depth_of_draw(first), SHARED_DEPTH, is_shared);
}
