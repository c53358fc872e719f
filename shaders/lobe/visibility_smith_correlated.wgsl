#import "brdf/v_smith_ggx_correlated.wgsl"

// The default: exact under Smith's assumptions.
fn visibility(alpha: f32, NoV: f32, NoL: f32) -> f32 {
    return V_SmithGGXCorrelated(alpha, NoV, NoL);
}
