// Naive: shown beside the form in use by `specula stability`, and part of no frame.
#import "naive/d_ggx.wgsl"
#import "naive/v_smith_ggx.wgsl"

// D G / (4 n.v n.l) n.l as a lecture prints it, F = 1.
fn specular_lobe_naive(perceptual_roughness: f32, n: vec3f, v: vec3f, l: vec3f) -> f32 {
    let alpha = perceptual_roughness * perceptual_roughness;
    let h = normalize(l + v);
    let NoL = dot(n, l);
    return D_GGX_textbook(alpha, n, h) * V_from_G(alpha, dot(n, v), NoL) * NoL;
}
