#import "lighting/sun.wgsl"

// The suns, unless the sky is asked for without them.
fn sun_radiance(lobes: Lobes) -> vec3f {
    var radiance = vec3f(0.0);
    for (var i = 0u; i < environment.sun_count; i++) {
        if frame.channel != CHANNEL_SKY {
            radiance += radiance_of_sun(lobes, i);
        }
    }
    return radiance;
}
