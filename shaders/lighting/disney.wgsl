#import "brdf/d_gtr1.wgsl"
#import "brdf/d_ggx_anisotropic.wgsl"
#import "brdf/f_schlick.wgsl"
#import "brdf/fd_burley.wgsl"
#import "brdf/fd_subsurface.wgsl"
#import "brdf/g1_smith_ggx.wgsl"
#import "lighting/half_vector.wgsl"
#import "lighting/lift_view.wgsl"

// The Disney BRDF (docs/disney.md): the published limits and weights.
const DISNEY_ALPHA_MIN: f32 = 1e-3;
const CLEARCOAT_ALPHA_MAX: f32 = 0.1;
const CLEARCOAT_MASKING: f32 = 0.25;
const CLEARCOAT_F0: f32 = 0.04;
const CLEARCOAT_WEIGHT: f32 = 0.25;

// Everything about a surface that does not depend on the light.
struct Lobes {
    n: vec3f,
    NoV: f32,
    v: vec3f,
    perceptual_roughness: f32,
    // Tangent, bitangent, and the alphas along them.
    t: vec3f,
    alpha_x: f32,
    b: vec3f,
    alpha_y: f32,
    // Schlick's curve goes from F0 to 1.
    F0: vec3f,
    masking: f32,
    // Of the specular lobe, for light that is seen elsewhere too.
    specular_share: f32,
    diffuse: vec3f,
    subsurface: f32,
    sheen: vec3f,
    clearcoat: f32,
    clearcoat_alpha: f32,
    // G1(NoV) / (4 NoV) of the specular lobe and of the clearcoat.
    seen: f32,
    clearcoat_seen: f32,
}

// Hue and saturation of a colour: the colour over its luminance, white for black.
fn tint(color: vec3f) -> vec3f {
    let luminance = dot(color, vec3f(0.3, 0.6, 0.1));
    return select(vec3f(1.0), color / max(luminance, 1e-30), luminance > 0.0);
}

fn make_lobes(surface: Surface) -> Lobes {
    let r = surface.perceptual_roughness;
    let hue = tint(surface.base_color);
    let dielectric_F0 = mix(vec3f(1.0), hue, disney.specular_tint) * (0.08 * disney.specular);
    let aspect = sqrt(1.0 - 0.9 * disney.anisotropic);

    var lobes: Lobes;
    lobes.n = surface.n;
    lobes.v = lift_view(surface.n, surface.v);
    lobes.NoV = clamp(dot(surface.n, lobes.v), NOV_MIN, 1.0);
    lobes.perceptual_roughness = r;
    lobes.t = surface.t;
    lobes.b = cross(surface.n, surface.t);
    lobes.alpha_x = max(r * r / aspect, DISNEY_ALPHA_MIN);
    lobes.alpha_y = max(r * r * aspect, DISNEY_ALPHA_MIN);
    lobes.masking = (0.5 + 0.5 * r) * (0.5 + 0.5 * r);
    lobes.specular_share = 1.0;
    lobes.F0 = mix(dielectric_F0, surface.base_color, surface.metallic);
    lobes.diffuse = surface.base_color * (1.0 - surface.metallic);
    lobes.subsurface = disney.subsurface;
    lobes.sheen = mix(vec3f(1.0), hue, disney.sheen_tint) * (disney.sheen * (1.0 - surface.metallic));
    lobes.clearcoat = CLEARCOAT_WEIGHT * disney.clearcoat;
    lobes.clearcoat_alpha = mix(CLEARCOAT_ALPHA_MAX, DISNEY_ALPHA_MIN, disney.clearcoat_gloss);
    lobes.seen = G1_SmithGGX(lobes.masking, lobes.NoV) / (4.0 * lobes.NoV);
    lobes.clearcoat_seen = G1_SmithGGX(CLEARCOAT_MASKING, lobes.NoV) / (4.0 * lobes.NoV);
    return lobes;
}

// The lobes for a light that is a disc: wider by the variance that it adds to alpha^2, with a share of the specular one.
// GTR1 takes the same, though its tail is longer.
fn lobes_of_disc(lobes: Lobes, l: vec3f, variance: f32, specular_share: f32) -> Lobes {
    var disc = lobes;
    disc.alpha_x = sqrt(lobes.alpha_x * lobes.alpha_x + variance);
    disc.alpha_y = sqrt(lobes.alpha_y * lobes.alpha_y + variance);
    disc.clearcoat_alpha = sqrt(lobes.clearcoat_alpha * lobes.clearcoat_alpha + variance);
    disc.specular_share = lobes.specular_share * specular_share;
    return disc;
}

// BRDF times the cosine of the light, 1/sr. `l` is a unit vector toward the light; zero when it is below the horizon.
fn evaluate_lobes(lobes: Lobes, l: vec3f) -> vec3f {
    let NoL = saturate(dot(lobes.n, l));
    let h = unit_half_vector(l, lobes.v);
    let LoH = saturate(dot(l, h));

    // Masking of the light is G1(NoL) / NoL, and the cosine of the light cancels against it.
    let D = D_GGX_anisotropic(lobes.alpha_x, lobes.alpha_y, lobes.t, lobes.b, lobes.n, h);
    let specular = F_Schlick(lobes.F0, 1.0, LoH) * (D * lobes.specular_share * lobes.seen * G1_SmithGGX(lobes.masking, NoL));

    let coat_F = mix(CLEARCOAT_F0, 1.0, F_Schlick_weight(LoH));
    let coat_D = D_GTR1(lobes.clearcoat_alpha, lobes.n, h);
    let coat = lobes.clearcoat * coat_F * coat_D * lobes.clearcoat_seen * G1_SmithGGX(CLEARCOAT_MASKING, NoL);

    let Fd = Fd_Burley(lobes.perceptual_roughness, lobes.NoV, NoL, LoH);
    let Fss = Fd_Subsurface(lobes.perceptual_roughness, lobes.NoV, NoL, LoH);
    let smooth_part = lobes.diffuse * mix(Fd, Fss, lobes.subsurface) + lobes.sheen * F_Schlick_weight(LoH);
    return smooth_part * NoL + specular + coat;
}
