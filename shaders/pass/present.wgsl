#import <types>
#import "pass/fullscreen.wgsl"

@group(0) @binding(0) var<uniform> present: PresentUniform;
@group(0) @binding(1) var left: texture_2d<f32>;
@group(0) @binding(2) var right: texture_2d<f32>;

@vertex
fn vertex(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    return vec4f(fullscreen_position(index), 0.0, 1.0);
}

// Display values as they are, pixel by pixel: two pictures on both sides of a line, over what is behind transparent ones.
@fragment
fn fragment(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let pixel = vec2i(position.xy);
    let is_left = position.x < present.split_px;
    let picture = select(textureLoad(right, pixel, 0), textureLoad(left, pixel, 0), is_left);
    let shown = mix(present.behind.xyz, picture.xyz, picture.w);
    let is_line = abs(position.x - present.split_px) < present.line_px;
    return vec4f(select(shown, vec3f(1.0), is_line), 1.0);
}
