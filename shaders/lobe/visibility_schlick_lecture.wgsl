#import "brdf/v_schlick.wgsl"

// Schlick's form with k = ((r + 1) / 2)^2, as the lecture prints it: twice Karis' k, which hides most of the light.
fn visibility(alpha: f32, NoV: f32, NoL: f32) -> f32 {
    let x = 0.5 * (sqrt(alpha) + 1.0);
    return V_Schlick(x * x, NoV, NoL);
}
