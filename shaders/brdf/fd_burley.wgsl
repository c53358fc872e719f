#import "math/constants.wgsl"
#import "brdf/f_schlick.wgsl"

// Diffuse lobe with retro-reflection at grazing angles, of base colour 1, 1/sr. Burley 2012, section 5.3.
// All arguments in [0, 1].
fn Fd_Burley(perceptual_roughness: f32, NoV: f32, NoL: f32, LoH: f32) -> f32 {
    let rise = 2.0 * LoH * LoH * perceptual_roughness - 0.5;
    return (1.0 + rise * F_Schlick_weight(NoV)) * (1.0 + rise * F_Schlick_weight(NoL)) * INV_PI;
}
