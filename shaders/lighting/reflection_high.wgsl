#import "lighting/taps.wgsl"

// What the specular lobe sees of the environment on average, by three taps.
fn reflected_radiance(lobes: Lobes, to_environment: mat3x3f) -> vec3f {
    let plane = plane_of_incidence(lobes, to_environment);
    let metal = share_of_metal(lobes);
    let one = taps_texel(7.0, plane);
    let two = taps_texel(8.0, plane);
    let three = taps_texel(9.0, plane);
    let dielectric = taps_texel(11.0, plane);
    let share_1 = mix(vec3f(dielectric.x), vec3f(one.w), metal);
    let share_2 = mix(vec3f(dielectric.y), vec3f(two.w), metal);
    let share_3 = mix(vec3f(dielectric.z), vec3f(three.w), metal);
    let seen = tap(plane, one.xyz) * share_1 + tap(plane, two.xyz) * share_2 + tap(plane, three.xyz) * share_3;
    return max(seen + skirt(plane, taps_texel(10.0, plane), metal, 1.0 - share_1 - share_2 - share_3), vec3f(0.0));
}
