#import "math/constants.wgsl"
#import "brdf/f_schlick.wgsl"

// Approximation of subsurface scattering for base colour 1, 1/sr, after Hanrahan and Krueger 1993. Burley 2012, section
// 5.3, as in the BRDF published with it. All arguments in [0, 1], NoV above 0. Times NoL it is finite at the horizon.
fn Fd_Subsurface(perceptual_roughness: f32, NoV: f32, NoL: f32, LoH: f32) -> f32 {
    let rise = LoH * LoH * perceptual_roughness - 1.0;
    let F_ss = (1.0 + rise * F_Schlick_weight(NoV)) * (1.0 + rise * F_Schlick_weight(NoL));
    return (1.25 * INV_PI) * (F_ss * (1.0 / (NoV + NoL) - 0.5) + 0.5);
}
