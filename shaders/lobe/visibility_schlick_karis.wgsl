#import "brdf/v_schlick.wgsl"

// Schlick's form with k = (r + 1)^2 / 8 of the perceptual roughness r (Karis 2013, eq. 4).
fn visibility(alpha: f32, NoV: f32, NoL: f32) -> f32 {
    let x = sqrt(alpha) + 1.0;
    return V_Schlick(0.125 * x * x, NoV, NoL);
}
