#import "lighting/taps.wgsl"

// What the specular lobe sees of the environment on average, by one tap.
fn reflected_radiance(lobes: Lobes, to_environment: mat3x3f) -> vec3f {
    let plane = plane_of_incidence(lobes, to_environment);
    let metal = share_of_metal(lobes);
    let one = taps_texel(0.0, plane);
    let share = mix(vec3f(taps_texel(2.0, plane).x), vec3f(one.w), metal);
    let seen = tap(plane, one.xyz) * share;
    return max(seen + skirt(plane, taps_texel(1.0, plane), metal, 1.0 - share), vec3f(0.0));
}
