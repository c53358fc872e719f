#import "brdf/v_smith_ggx_separable.wgsl"

// Masking and shadowing as if independent: too dark where both are grazing.
fn visibility(alpha: f32, NoV: f32, NoL: f32) -> f32 {
    return V_SmithGGX_separable(alpha, NoV, NoL);
}
