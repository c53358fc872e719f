#import "lighting/turns.wgsl"

// Radiance from the lights that reach everything: directional ones, and those without a range. They come first.
fn unbounded_radiance(lobes: Lobes, position: vec3f) -> vec3f {
    var radiance = vec3f(0.0);
    for (var i = 0u; i < turns(clusters.unbounded, position); i++) {
        radiance += radiance_of_light(lobes, position, i);
    }
    return radiance;
}
