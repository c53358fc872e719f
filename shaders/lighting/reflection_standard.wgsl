#import "lighting/taps.wgsl"

// Three taps. `metal` is the share of the lobe that is one of F0 = 1.
fn reflection(plane: Plane, metal: vec3f) -> Reflection {
    let one = taps_texel(3.0, plane);
    let two = taps_texel(4.0, plane);
    let three = taps_texel(5.0, plane);
    let others = taps_texel(6.0, plane);
    let share_1 = mix(vec3f(others.z), vec3f(one.w), metal);
    let share_2 = mix(vec3f(others.w), vec3f(two.w), metal);
    let share_3 = mix(vec3f(taps_texel(7.0, plane).x), vec3f(three.w), metal);
    let seen = tap(plane, one.xyz) * share_1 + tap(plane, two.xyz) * share_2 + tap(plane, three.xyz) * share_3;
    return Reflection(seen, 1.0 - share_1 - share_2 - share_3, parts(others.xy));
}
