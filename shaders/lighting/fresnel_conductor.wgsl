#import "brdf/f_conductor.wgsl"
#import "brdf/f_lazanyi.wgsl"
#import "lighting/fresnel_tail.wgsl"

// Reflectance of dielectric and metal, mixed; the metal's is exact for each light, and for the environment and for
// multiple scattering it is Lazanyi's curve fitted to it, whose largest error is 0.01 on average over metals.
struct Fresnel {
    F0: vec3f,
    F90: f32,
    metallic: f32,
    metal_F0: vec3f,
}

fn make_fresnel(surface: Surface, dielectric_F0: vec3f) -> Fresnel {
    return Fresnel(dielectric_F0, surface.specular, surface.metallic, surface.base_color);
}

fn reflectance(fresnel: Fresnel, VoH: f32) -> vec3f {
    let metal = F_conductor(material.conductor_n, material.conductor_k, VoH);
    return mix(F_Schlick(fresnel.F0, fresnel.F90, VoH), metal, fresnel.metallic);
}

// What the lobe returns of uniform light in one bounce; `table` is the split-sum pair at `cos_theta`.
fn single_scatter(fresnel: Fresnel, table: vec4f, perceptual_roughness: f32, cos_theta: f32) -> vec3f {
    let tail = fresnel_tail(perceptual_roughness, cos_theta);
    let metal = max(fresnel.metal_F0 * table.x + table.y - material.lazanyi_a * tail, vec3f(0.0));
    return mix(fresnel.F0 * table.x + fresnel.F90 * table.y, metal, fresnel.metallic);
}

// Cosine average of the metal's curve.
fn metal_average(surface: Surface) -> vec3f {
    return saturate(F_Schlick_average(surface.base_color, 1.0) - material.lazanyi_a * (1.0 / 126.0));
}
