#import "brdf/f_schlick.wgsl"

// Reflectance of dielectric and metal, mixed. Schlick's curve is linear in F0 and F90, so mixing those is exact.
struct Fresnel {
    F0: vec3f,
    F90: f32,
}

fn make_fresnel(surface: Surface, dielectric_F0: vec3f) -> Fresnel {
    let F0 = mix(dielectric_F0, surface.base_color, surface.metallic);
    return Fresnel(F0, mix(surface.specular, 1.0, surface.metallic));
}

fn reflectance(fresnel: Fresnel, VoH: f32) -> vec3f {
    return F_Schlick(fresnel.F0, fresnel.F90, VoH);
}

// What the lobe returns of uniform light in one bounce; `table` is the split-sum pair at `cos_theta`.
fn single_scatter(fresnel: Fresnel, table: vec4f, perceptual_roughness: f32, cos_theta: f32) -> vec3f {
    return fresnel.F0 * table.x + fresnel.F90 * table.y;
}

// Cosine average of the metal's curve.
fn metal_average(surface: Surface) -> vec3f {
    return F_Schlick_average(surface.base_color, 1.0);
}
