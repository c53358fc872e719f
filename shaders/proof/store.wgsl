#import "math/half_range.wgsl"
#import "naive/half_range.wgsl"

// The same resolve of radiances that were brought into the range of the target first.
fn resolve_halves(a: f32, b: f32, coverage: f32) -> f32 {
    return resolve_halves_naive(clamp_to_half(vec3f(a)).x, clamp_to_half(vec3f(b)).x, coverage);
}
