#import "lighting/taps.wgsl"

// What the specular lobe sees of the environment on average, by two taps.
fn reflected_radiance(lobes: Lobes, to_environment: mat3x3f) -> vec3f {
    let fit = taps_texel(0.0, lobes);
    let shares = taps_texel(1.0, lobes);
    let plane = plane_of_incidence(lobes, to_environment);
    let first = mix(vec3f(shares.y), vec3f(shares.x), share_of_metal(lobes));
    return mix(tap(plane, fit.y, fit.w), tap(plane, fit.x, fit.z), first);
}
