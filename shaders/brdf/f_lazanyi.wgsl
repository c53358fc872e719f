#import "brdf/f_schlick.wgsl"

// The weight of a in Lazanyi's correction of Schlick's curve: cos (1 - cos)^6.
fn F_Lazanyi_weight(VoH: f32) -> f32 {
    let x = saturate(1.0 - VoH);
    let x2 = x * x;
    return saturate(VoH) * x2 * x2 * x2;
}

// Fresnel reflectance of a metal. Lazanyi and Szirmay-Kalos 2005: Schlick's curve with F90 = 1, less a cos (1 - cos)^6.
// `a` a channel, fitted to the metal; the F82 tint of Kutz et al. 2021 is the same curve with another name for a.
fn F_Lazanyi(F0: vec3f, a: vec3f, VoH: f32) -> vec3f {
    return F0 + (1.0 - F0) * F_Schlick_weight(VoH) - a * F_Lazanyi_weight(VoH);
}
