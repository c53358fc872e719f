// sRGB opto-electronic transfer of linear light in [0, 1] (IEC 61966-2-1, 5.3).
fn srgb_from_linear(linear: vec3f) -> vec3f {
    let x = saturate(linear);
    return select(1.055 * pow(x, vec3f(1.0 / 2.4)) - 0.055, 12.92 * x, x <= vec3f(0.0031308));
}
