#import "lighting/taps.wgsl"

// What the specular lobe sees of the environment on average, by one tap.
fn reflected_radiance(lobes: Lobes, to_environment: mat3x3f) -> vec3f {
    let fit = taps_texel(1.0, lobes);
    return tap(plane_of_incidence(lobes, to_environment), fit.z, fit.w);
}
