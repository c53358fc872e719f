// Largest half float: what is beyond would become infinite in the target, and NaN when two of them are resolved.
const HALF_MAX: f32 = 65504.0;

fn clamp_to_half(radiance: vec3f) -> vec3f {
    return min(radiance, vec3f(HALF_MAX));
}
