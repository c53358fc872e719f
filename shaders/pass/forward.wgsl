#import <types>
#import "lighting/frame.wgsl"
#import <interface>
#import <material>
#import "math/vectors.wgsl"
#import "surface/surface.wgsl"
#import <shading>
#import <alpha>

// Largest half float: radiance beyond it would become infinite in the target, and NaN when two of them are resolved.
const RADIANCE_MAX: f32 = 65504.0;

@vertex
fn vertex(in: VertexIn) -> VertexOut {
    return vertex_out(in);
}

@fragment
fn fragment(v: VertexOut, @builtin(front_facing) front_facing: bool) -> @location(0) vec4f {
    let toward_viewer = normalize_or(frame.viewer.xyz - v.position_in_world * frame.viewer.w, vec3f(0.0, 1.0, 0.0));
    let surface = read_surface(v, front_facing, toward_viewer);
    let radiance = min(shade(surface, v.position_in_world), vec3f(RADIANCE_MAX));
    return premultiply(radiance, surface.alpha);
}
