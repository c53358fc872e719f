#import "lighting/taps.wgsl"

// One tap. `metal` is the share of the lobe that is one of F0 = 1.
fn reflection(plane: Plane, metal: vec3f) -> Reflection {
    let one = taps_texel(0.0, plane);
    let others = taps_texel(1.0, plane);
    let share = mix(vec3f(others.z), vec3f(one.w), metal);
    return Reflection(tap(plane, one.xyz) * share, 1.0 - share, parts(others.xy));
}
