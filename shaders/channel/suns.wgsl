#import "channel/asked.wgsl"
#import "lighting/sun.wgsl"
#import <each_sun>

// The suns, unless the sky is asked for without them.
fn sun_radiance(lobes: Lobes) -> vec3f {
    return select(radiance_of_suns(lobes), vec3f(0.0), asked.x == CHANNEL_SKY);
}
