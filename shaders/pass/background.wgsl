#import <types>
#import "math/half_range.wgsl"
#import "math/vectors.wgsl"
#import "pass/fullscreen.wgsl"
#import <backdrop>
#import <target>

@group(0) @binding(0) var<uniform> background: BackgroundUniform;

struct BackgroundOut {
    @builtin(position) position_in_clip: vec4f,
    @location(0) direction: vec3f,
}

// Depth 0 is infinitely far away: only what no surface covers is drawn. The second instance is for pixels that are shared,
// which `pass/covered.wgsl` has at depth 1, and for hosts whose depth is not reversed.
@vertex
fn vertex(@builtin(vertex_index) index: u32, @builtin(instance_index) shared_pixels: u32) -> BackgroundOut {
    let ndc = fullscreen_position(index);
    return BackgroundOut(vec4f(ndc, f32(shared_pixels), 1.0), background.direction_from_ndc * vec3f(ndc, 1.0));
}

@fragment
fn fragment(in: BackgroundOut) -> @location(0) vec4f {
    let radiance = backdrop(normalize_or(in.direction, vec3f(1.0, 0.0, 0.0)));
    return target_value(vec4f(clamp_to_half(radiance), 1.0));
}
