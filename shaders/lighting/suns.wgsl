#import "lighting/sun.wgsl"

// Radiance toward the viewer from the suns that the prefiltered maps do not hold.
fn sun_radiance(lobes: Lobes) -> vec3f {
    var radiance = vec3f(0.0);
    for (var i = 0u; i < environment.sun_count; i++) {
        radiance += radiance_of_sun(lobes, i);
    }
    return radiance;
}
