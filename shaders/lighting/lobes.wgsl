#import "math/constants.wgsl"
#import "brdf/fd_lambert.wgsl"
#import "lobe/albedo.wgsl"
#import <multiscatter>
#import "lighting/dfg.wgsl"
#import <fresnel>
#import <shape>
#import "lighting/half_vector.wgsl"
#import "lighting/lift_view.wgsl"

// Below this a punctual light's highlight is a few pixels of f32 noise, and D overflows half floats.
const ALPHA_MIN: f32 = 1e-3;
// Smallest loss that the 16-bit table can tell from zero.
const LOSS_MIN: f32 = 1.5e-5;

// Everything about a surface that does not depend on the light.
struct Lobes {
    n: vec3f,
    NoV: f32,
    v: vec3f,
    perceptual_roughness: f32,
    shape: Shape,
    fresnel: Fresnel,
    // Of the specular lobe, for light that is seen elsewhere too.
    specular_share: f32,
    // Scale and bias of the specular lobe's albedo.
    split_sum: vec2f,
    // What the specular lobe returns of uniform light in one bounce.
    single_scatter: vec3f,
    // F_ms (1 - E(NoV)), dielectric and metal computed apart and then mixed: F_ms is not linear in F0.
    multiscatter: vec3f,
    multiscatter_norm: f32,
    // base_color (1 - metallic) (1 - E_s(NoV)).
    diffuse: vec3f,
    diffuse_norm: f32,
    // The dielectric lobe that the diffuse light has to pass once more on the light's side.
    coat_F0: f32,
    coat_F90: f32,
    coat_F_ms: f32,
}

fn make_lobes(surface: Surface) -> Lobes {
    let r = surface.perceptual_roughness;
    let v = lift_view(surface.n, surface.v);
    let NoV = clamp(dot(surface.n, v), NOV_MIN, 1.0);
    let shape = make_shape(surface, max(r * r, ALPHA_MIN));
    let table_r = albedo_perceptual_roughness(shape, r, v);
    let table = dfg(table_r, NoV);
    let average = albedo_average(shape, table);
    let E = table.x + table.y;
    let E_avg = average.x + average.y;

    let dielectric_F0 = min(surface.dielectric_F0 * surface.specular_color, vec3f(1.0)) * surface.specular;
    let share = compensated_share(shape);
    let dielectric_F_ms = F_multiscatter(F_Schlick_average(dielectric_F0, surface.specular), E_avg) * share;
    let metal_F_ms = F_multiscatter(metal_average(surface), E_avg) * share;

    var lobes: Lobes;
    lobes.n = surface.n;
    lobes.v = v;
    lobes.NoV = NoV;
    lobes.perceptual_roughness = r;
    lobes.shape = shape;
    lobes.fresnel = make_fresnel(surface, dielectric_F0);
    lobes.specular_share = 1.0;
    lobes.split_sum = table.xy;
    lobes.single_scatter = single_scatter(lobes.fresnel, table, table_r, NoV);
    lobes.multiscatter = mix(dielectric_F_ms, metal_F_ms, surface.metallic) * max(1.0 - E, 0.0);
    lobes.multiscatter_norm = INV_PI / max(1.0 - E_avg, LOSS_MIN);

    lobes.coat_F0 = max(dielectric_F0.x, max(dielectric_F0.y, dielectric_F0.z));
    lobes.coat_F90 = surface.specular;
    lobes.coat_F_ms = max(dielectric_F_ms.x, max(dielectric_F_ms.y, dielectric_F_ms.z));
    let E_s = E_specular(lobes.coat_F0, lobes.coat_F90, lobes.coat_F_ms, table.x, table.y);
    let E_s_avg = E_specular(lobes.coat_F0, lobes.coat_F90, lobes.coat_F_ms, average.x, average.y);
    lobes.diffuse = surface.base_color * ((1.0 - surface.metallic) * (1.0 - E_s));
    lobes.diffuse_norm = Fd_Lambert() / max(1.0 - E_s_avg, LOSS_MIN);
    return lobes;
}

// The lobes for a light that is a disc around `l`, with a share of the specular one. `spread` is the squared radius of
// its half vectors, seen along the normal.
fn lobes_of_disc(lobes: Lobes, l: vec3f, spread: f32, specular_share: f32) -> Lobes {
    var disc = lobes;
    disc.shape = widened(lobes.shape, spread);
    let h = unit_half_vector(l, lobes.v);
    let VoH = max(dot(h, l), 1e-3);
    let of_disc = disc_share(lobes.shape, lobes.n, h, VoH, spread);
    disc.specular_share = lobes.specular_share * specular_share * of_disc;
    return disc;
}

// BRDF times the cosine of the light, 1/sr. `l` is a unit vector toward the light; zero when it is below the horizon.
fn evaluate_lobes(lobes: Lobes, l: vec3f) -> vec3f {
    let NoL = saturate(dot(lobes.n, l));
    let h = unit_half_vector(l, lobes.v);
    let VoH = saturate(dot(lobes.v, h));
    let F = reflectance(lobes.fresnel, VoH);
    let DV = D_V(lobes.shape, lobes.n, lobes.v, l, h, lobes.NoV, NoL) * lobes.specular_share;

    let table = dfg(albedo_perceptual_roughness(lobes.shape, lobes.perceptual_roughness, l), NoL);
    let loss = max(1.0 - table.x - table.y, 0.0);
    let passed = 1.0 - E_specular(lobes.coat_F0, lobes.coat_F90, lobes.coat_F_ms, table.x, table.y);
    let smooth_part = lobes.multiscatter * (lobes.multiscatter_norm * loss) + lobes.diffuse * (lobes.diffuse_norm * passed);
    return (F * DV + smooth_part) * NoL;
}
