#import <types>
#import "math/constants.wgsl"
#import "math/half_range.wgsl"
#import "math/vectors.wgsl"
#import "pass/fullscreen.wgsl"
#import <target>

@group(0) @binding(0) var<uniform> background: BackgroundUniform;
@group(0) @binding(1) var panorama: texture_2d<f32>;
@group(0) @binding(2) var panorama_sampler: sampler;

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

// The panorama at infinity: u = 0.5 + atan2(z, x) / 2 pi, v = acos(y) / pi.
@fragment
fn fragment(in: BackgroundOut) -> @location(0) vec4f {
    let d = normalize_or(in.direction, vec3f(1.0, 0.0, 0.0));
    let uv = vec2f(0.5 + atan2(d.z, d.x) * (0.5 * INV_PI), acos(clamp(d.y, -1.0, 1.0)) * INV_PI);
    let radiance = textureSampleLevel(panorama, panorama_sampler, uv, 0.0).xyz * background.radiance_scale;
    return target_value(vec4f(clamp_to_half(radiance), 1.0));
}
