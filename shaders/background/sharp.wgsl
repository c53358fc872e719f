#import "math/constants.wgsl"

@group(0) @binding(1) var panorama: texture_2d<f32>;
@group(0) @binding(2) var panorama_sampler: sampler;

// The panorama at infinity: u = 0.5 + atan2(z, x) / 2 pi, v = acos(y) / pi.
fn backdrop(d: vec3f) -> vec3f {
    let uv = vec2f(0.5 + atan2(d.z, d.x) * (0.5 * INV_PI), acos(clamp(d.y, -1.0, 1.0)) * INV_PI);
    return textureSampleLevel(panorama, panorama_sampler, uv, 0.0).xyz * background.radiance_scale;
}
