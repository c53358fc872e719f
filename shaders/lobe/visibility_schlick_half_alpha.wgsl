#import "brdf/v_schlick.wgsl"

// Schlick's form with k = alpha / 2, which meets Smith's at alpha = 1.
fn visibility(alpha: f32, NoV: f32, NoL: f32) -> f32 {
    return V_Schlick(0.5 * alpha, NoV, NoL);
}
