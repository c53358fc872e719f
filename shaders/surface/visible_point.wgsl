#import <interface>
#import <material>
#import "math/half_range.wgsl"
#import "math/vectors.wgsl"
#import "surface/surface.wgsl"
#import <shading>
#import <alpha>

// Unit vector from a point of a surface to the eye.
fn direction_to_viewer(v: VertexOut) -> vec3f {
    return normalize_or(frame.viewer.xyz - v.position_in_world * frame.viewer.w, vec3f(0.0, 1.0, 0.0));
}

// What a point of a surface sends to the viewer: radiance and alpha.
fn visible_point(v: VertexOut, front_facing: bool) -> vec4f {
    let surface = read_surface(v, front_facing, direction_to_viewer(v));
    return vec4f(shade(surface, v.position_in_world), surface.alpha);
}

// The same as the target holds it: radiance multiplied with coverage, and coverage.
fn stored_point(point: vec4f) -> vec4f {
    return premultiply(clamp_to_half(point.xyz), point.w);
}
