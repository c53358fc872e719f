// Khronos PBR Neutral tone mapper (Khronos 2024 specification): exact below 0.8 - offset, then a hyperbolic shoulder
// that approaches 1 and desaturates toward white.
fn tone_map(exposed: vec3f) -> vec3f {
    const F90: f32 = 0.04;
    const START: f32 = 0.8 - F90;
    const DESATURATION: f32 = 0.15;

    let smallest = min(exposed.x, min(exposed.y, exposed.z));
    let offset = select(F90, smallest - 6.25 * smallest * smallest, smallest < 2.0 * F90);
    let color = exposed - offset;
    let peak = max(color.x, max(color.y, color.z));
    let headroom = 1.0 - START;
    let new_peak = 1.0 - headroom * headroom / max(peak + headroom - START, headroom);
    let desaturated = 1.0 / (DESATURATION * max(peak - new_peak, 0.0) + 1.0);
    let compressed = mix(vec3f(new_peak), color * (new_peak / max(peak, START)), desaturated);
    return select(compressed, color, peak < START);
}
