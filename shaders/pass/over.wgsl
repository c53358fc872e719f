#import <over>
#import "pass/fullscreen.wgsl"

// In front of all depths.
@vertex
fn vertex(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    return vec4f(fullscreen_position(index), 1.0, 1.0);
}

// What lies over a pixel: the mean of its samples.
@fragment
fn fragment(@builtin(position) position: vec4f) -> @location(0) vec4f {
    var sum = vec4f(0.0);
    for (var i = 0u; i < SAMPLES; i++) {
        sum += over(vec2i(position.xy), i);
    }
    return sum * (1.0 / f32(SAMPLES));
}
