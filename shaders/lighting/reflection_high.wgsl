#import "lighting/taps.wgsl"

// What the specular lobe sees of the environment on average, by three taps.
fn reflected_radiance(lobes: Lobes, to_environment: mat3x3f) -> vec3f {
    let offsets = taps_texel(2.0, lobes);
    let widths = taps_texel(3.0, lobes);
    let dielectric = taps_texel(4.0, lobes);
    let plane = plane_of_incidence(lobes, to_environment);
    let metal = share_of_metal(lobes);
    let first = mix(vec3f(dielectric.x), vec3f(offsets.w), metal);
    let second = mix(vec3f(dielectric.y), vec3f(widths.w), metal);
    return tap(plane, offsets.x, widths.x) * first
        + tap(plane, offsets.y, widths.y) * second
        + tap(plane, offsets.z, widths.z) * (1.0 - first - second);
}
