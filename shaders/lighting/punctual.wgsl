#import "lighting/punctual_light.wgsl"
#import "lighting/turns.wgsl"

// Radiance toward the viewer from all of them.
fn punctual_radiance(lobes: Lobes, position: vec3f) -> vec3f {
    var radiance = vec3f(0.0);
    for (var i = 0u; i < turns(frame.light_count, position); i++) {
        radiance += radiance_of_light(lobes, position, i);
    }
    return radiance;
}

// How many lights are looked at.
fn punctual_count(position: vec3f) -> u32 {
    return frame.light_count;
}
