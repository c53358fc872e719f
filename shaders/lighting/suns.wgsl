#import "lighting/sun.wgsl"
#import <each_sun>

// Radiance toward the viewer from the suns that the prefiltered maps do not hold.
fn sun_radiance(lobes: Lobes) -> vec3f {
    return radiance_of_suns(lobes);
}
