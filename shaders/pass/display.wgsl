#import <types>
#import "pass/fullscreen.wgsl"
#import <tone_map>
#import <encode>

@group(0) @binding(0) var<uniform> display: DisplayUniform;
@group(0) @binding(1) var scene_radiance: texture_2d<f32>;

@vertex
fn vertex(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    return vec4f(fullscreen_position(index), 0.0, 1.0);
}

// Scene radiance to display light. The tone map sees the colour of the covered part, and coverage mixes display light:
// an edge is as soft as it would be on a photograph, and a background colour comes out as it was asked for.
@fragment
fn fragment(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let texel = textureLoad(scene_radiance, vec2i(position.xy), 0);
    let straight = texel.xyz * (1.0 / max(texel.w, 1e-4));
    let mapped = tone_map(straight * display.exposure);
    let coverage = saturate(texel.w);
    let light = mix(mapped, mix(display.background.xyz, mapped, coverage), display.background.w);
    return vec4f(encode(light), max(coverage, display.background.w));
}
