#import <types>
#import "lighting/frame.wgsl"

// Which triangle each sample shows: the number of its draw, and its own in two halves. Burns and Hunt 2013, "The
// Visibility Buffer: A Cache-Friendly Approach to Deferred Shading".
@group(1) @binding(0) var<uniform> pulled: PulledDraw;

@vertex
fn vertex(@location(0) position: vec3f) -> @builtin(position) @invariant vec4f {
    let position_in_world = vec4f(position, 1.0) * pulled.world_from_object;
    return frame.clip_from_world * vec4f(position_in_world, 1.0);
}

@fragment
fn fragment(@builtin(primitive_index) triangle: u32) -> @location(0) vec4u {
    return vec4u(pulled.number, 0u, triangle & 0xffffu, triangle >> 16u);
}
