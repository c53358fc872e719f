#import "brdf/v_smith_ggx_correlated_anisotropic.wgsl"

// The default: exact under Smith's assumptions.
fn visibility_anisotropic(alpha_t: f32, alpha_b: f32, ToV: f32, BoV: f32, ToL: f32, BoL: f32, NoV: f32, NoL: f32) -> f32 {
    return V_SmithGGXCorrelated_anisotropic(alpha_t, alpha_b, ToV, BoV, ToL, BoL, NoV, NoL);
}
