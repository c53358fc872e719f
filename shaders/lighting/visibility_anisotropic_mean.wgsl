#import <visibility>

// A model that knows no direction takes the geometric mean of both alphas.
fn visibility_anisotropic(alpha_t: f32, alpha_b: f32, ToV: f32, BoV: f32, ToL: f32, BoL: f32, NoV: f32, NoL: f32) -> f32 {
    return visibility(sqrt(alpha_t * alpha_b), NoV, NoL);
}
