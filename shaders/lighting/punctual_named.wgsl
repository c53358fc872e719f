#import "lighting/punctual_light.wgsl"
#import <each_light>

// Radiance toward the viewer from all of them.
fn punctual_radiance(lobes: Lobes, position: vec3f) -> vec3f {
    return radiance_of_named(lobes, position);
}

// How many lights are looked at.
fn punctual_count(position: vec3f) -> u32 {
    return NAMED_LIGHTS;
}
