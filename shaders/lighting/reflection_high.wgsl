#import "lighting/taps.wgsl"

// Four taps. `metal` is the share of the lobe that is one of F0 = 1.
fn reflection(plane: Plane, metal: vec3f) -> Reflection {
    let one = taps_texel(8.0, plane);
    let two = taps_texel(9.0, plane);
    let three = taps_texel(10.0, plane);
    let four = taps_texel(11.0, plane);
    let others = taps_texel(12.0, plane);
    let last = taps_texel(13.0, plane);
    let share_1 = mix(vec3f(others.z), vec3f(one.w), metal);
    let share_2 = mix(vec3f(others.w), vec3f(two.w), metal);
    let share_3 = mix(vec3f(last.x), vec3f(three.w), metal);
    let share_4 = mix(vec3f(last.y), vec3f(four.w), metal);
    let seen = tap(plane, one.xyz) * share_1 + tap(plane, two.xyz) * share_2 + tap(plane, three.xyz) * share_3
        + tap(plane, four.xyz) * share_4;
    return Reflection(seen, 1.0 - share_1 - share_2 - share_3 - share_4, parts(others.xy));
}
