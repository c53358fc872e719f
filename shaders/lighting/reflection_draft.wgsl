#import "lighting/taps.wgsl"

// Two taps. `metal` is the share of the lobe that is one of F0 = 1.
fn reflection(plane: Plane, metal: vec3f) -> Reflection {
    let one = taps_texel(0.0, plane);
    let two = taps_texel(1.0, plane);
    let others = taps_texel(2.0, plane);
    let share_1 = mix(vec3f(others.z), vec3f(one.w), metal);
    let share_2 = mix(vec3f(others.w), vec3f(two.w), metal);
    let seen = tap(plane, one.xyz) * share_1 + tap(plane, two.xyz) * share_2;
    return Reflection(seen, 1.0 - share_1 - share_2, parts(others.xy));
}
