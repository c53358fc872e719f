#import "lighting/taps.wgsl"

// What the specular lobe sees of the environment on average, by two taps.
fn reflected_radiance(lobes: Lobes, to_environment: mat3x3f) -> vec3f {
    let plane = plane_of_incidence(lobes, to_environment);
    let metal = share_of_metal(lobes);
    let one = taps_texel(3.0, plane);
    let two = taps_texel(4.0, plane);
    let dielectric = taps_texel(6.0, plane);
    let share_1 = mix(vec3f(dielectric.x), vec3f(one.w), metal);
    let share_2 = mix(vec3f(dielectric.y), vec3f(two.w), metal);
    let seen = tap(plane, one.xyz) * share_1 + tap(plane, two.xyz) * share_2;
    return max(seen + skirt(plane, taps_texel(5.0, plane), metal, 1.0 - share_1 - share_2), vec3f(0.0));
}
