#import "brdf/f_lazanyi.wgsl"
#import "lighting/fresnel_tail.wgsl"

// Reflectance of dielectric and metal, mixed; the metal's curve dips before grazing incidence.
struct Fresnel {
    F0: vec3f,
    F90: f32,
    a: vec3f,
}

fn make_fresnel(surface: Surface, dielectric_F0: vec3f) -> Fresnel {
    let F0 = mix(dielectric_F0, surface.base_color, surface.metallic);
    return Fresnel(F0, mix(surface.specular, 1.0, surface.metallic), material.lazanyi_a * surface.metallic);
}

fn reflectance(fresnel: Fresnel, VoH: f32) -> vec3f {
    return max(F_Schlick(fresnel.F0, fresnel.F90, VoH) - fresnel.a * F_Lazanyi_weight(VoH), vec3f(0.0));
}

// What the lobe returns of uniform light in one bounce; `table` is the split-sum pair at `cos_theta`.
fn single_scatter(fresnel: Fresnel, table: vec4f, perceptual_roughness: f32, cos_theta: f32) -> vec3f {
    let tail = fresnel_tail(perceptual_roughness, cos_theta);
    return max(fresnel.F0 * table.x + fresnel.F90 * table.y - fresnel.a * tail, vec3f(0.0));
}

// Cosine average of the metal's curve: 2 int x^2 (1 - x)^6 dx = 1/126.
fn metal_average(surface: Surface) -> vec3f {
    return saturate(F_Schlick_average(surface.base_color, 1.0) - material.lazanyi_a * (1.0 / 126.0));
}
