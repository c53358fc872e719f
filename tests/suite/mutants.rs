//! Planted faults: a test of the tests. Each is a plausible slip of the pen, and some comparison has to reject it.

use crate::grazing::grazing_tiers;
use crate::lit_plane::{Plane, disney_planes, planes};
use crate::lobe_tiers::lobe_tiers;
use crate::support::gpu;
use crate::tiers::Tiers;
use crate::twins::files;
use specula::gpu::Gpu;
use specula::gpu::formats::Precision;
use specula::proof::{TWINS, Twin};
use specula::shader::ShaderSources;
use std::collections::BTreeSet;

/// One edit of one file; `from` stands there exactly once.
struct Mutant {
    file: &'static str,
    from: &'static str,
    to: &'static str,
}

const fn fault(file: &'static str, from: &'static str, to: &'static str) -> Mutant {
    Mutant { file, from, to }
}

/// Faults in functions that have a twin.
const IN_FUNCTIONS: &[Mutant] = &[
    fault("brdf/d_ggx.wgsl", "1.0 - 0.25 * chord2", "1.0 - 0.5 * chord2"),
    fault("brdf/d_ggx.wgsl", "sin2 + alpha * alpha * (1.0", "sin2 + alpha * (1.0"),
    fault("brdf/d_ggx.wgsl", "return t * t * INV_PI", "return t * INV_PI"),
    fault("brdf/d_ggx.wgsl", "t * t * INV_PI", "t * t"),
    fault("brdf/d_ggx.wgsl", "let sin2 = chord2 * (1.0 - 0.25 * chord2)", "let sin2 = 1.0 - dot(n, h) * dot(n, h)"),
    fault("brdf/v_smith_ggx_correlated.wgsl", "NoL * sqrt((NoV", "NoV * sqrt((NoV"),
    fault("brdf/v_smith_ggx_correlated.wgsl", "(NoL - a2 * NoL) * NoL", "(NoL - a2 * NoL) * NoV"),
    fault("brdf/v_smith_ggx_correlated.wgsl", "0.5 /", "1.0 /"),
    fault("brdf/v_smith_ggx_correlated.wgsl", "a2 = alpha * alpha", "a2 = alpha"),
    fault("brdf/f_schlick.wgsl", "x2 * x2 * x", "x2 * x2"),
    fault("brdf/f_schlick.wgsl", "saturate(1.0 - VoH)", "1.0 - VoH"),
    fault("brdf/f_schlick.wgsl", "(F90 - F0) * F_Schlick_weight", "(1.0 - F0) * F_Schlick_weight"),
    fault("brdf/fd_lambert.wgsl", "return INV_PI", "return 1.0"),
    fault("brdf/d_gtr1.wgsl", "0.5 * INV_PI", "INV_PI"),
    fault("brdf/d_gtr1.wgsl", "sin2 + a2", "sin2 + alpha"),
    fault("brdf/d_gtr1.wgsl", "a2 - 1.0", "1.0"),
    fault("brdf/d_gtr1.wgsl", "let sin2 = chord2 * (1.0 - 0.25 * chord2)", "let sin2 = 1.0 - dot(n, h) * dot(n, h)"),
    fault("brdf/g1_smith_ggx.wgsl", "2.0 * NoX /", "NoX /"),
    fault("brdf/g1_smith_ggx.wgsl", "a2 = alpha * alpha", "a2 = alpha"),
    fault("brdf/fd_burley.wgsl", "- 0.5", "+ 0.5"),
    fault("brdf/fd_burley.wgsl", "2.0 * LoH * LoH", "2.0 * LoH"),
    fault("brdf/fd_burley.wgsl", "F_Schlick_weight(NoL)", "F_Schlick_weight(NoV)"),
    fault("brdf/fd_subsurface.wgsl", "1.25 *", "1.2 *"),
    fault("brdf/fd_subsurface.wgsl", "- 1.0;", "- 0.5;"),
    fault("brdf/fd_subsurface.wgsl", "- 0.5) + 0.5", "+ 0.5) - 0.5"),
    fault("math/orthonormal.wgsl", "-sign * n.x)", "sign * n.x)"),
    fault("math/orthonormal.wgsl", "n.z >= 0.0", "n.z <= 0.0"),
    fault("math/constants.wgsl", "0.318309886183791", "0.31831"),
    fault("math/vectors.wgsl", "inverseSqrt(", "sqrt("),
    fault("math/vectors.wgsl", "LENGTH_MIN: f32 = 1e-30", "LENGTH_MIN: f32 = 1e-15"),
    fault("math/vectors.wgsl", "v * (1.0 / max(largest, LENGTH_MIN))", "v"),
    fault("math/vectors.wgsl", "LENGTH_MAX: f32 = 1e37", "LENGTH_MAX: f32 = 1e19"),
    fault("math/half_range.wgsl", "65504.0", "65520.0"),
    fault("math/octahedral.wgsl", "abs(d.zx)", "abs(d.xz)"),
    fault("math/octahedral.wgsl", "d.xz >= vec2f(0.0)", "d.xz > vec2f(0.0)"),
    fault("math/octahedral.wgsl", "d.xz, d.y >= 0.0", "d.zx, d.y >= 0.0"),
    fault("lobe/albedo.wgsl", "F_ms * (1.0 - scale - bias)", "F_ms * (1.0 - scale)"),
    fault("lobe/albedo.wgsl", "F90 * bias", "bias"),
    fault("lobe/albedo.wgsl", "saturate(", "("),
    fault("brdf/f_schlick.wgsl", "F90 - F0) * (1.0 / 21.0)", "F90 - F0) * (1.0 / 20.0)"),
    fault("lobe/multiscatter_kulla_conty.wgsl", "return F_avg * (out", "return (out"),
    fault("lobe/multiscatter_kulla_conty.wgsl", "1.0 - F_avg + out", "1.0 - escape + out"),
    fault("lobe/multiscatter_kulla_conty.wgsl", "f32 = 0.7", "f32 = 0.71"),
    fault("lobe/multiscatter_kulla_conty.wgsl", "(1.0 - E_avg) * E_avg", "(1.0 - E_avg)"),
    fault("lobe/multiscatter_none.wgsl", "vec3f(0.0)", "F_avg"),
    fault("brdf/d_ggx_anisotropic.wgsl", "dot(b, chord) / alpha_b", "dot(b, chord) / alpha_t"),
    fault("brdf/d_ggx_anisotropic.wgsl", "(alpha_t * alpha_b * q * q)", "(alpha_t * alpha_b * q)"),
    fault("brdf/d_ggx_anisotropic.wgsl", "1.0 - 0.5 * dot", "1.0 - dot"),
    fault("brdf/v_smith_ggx_correlated_anisotropic.wgsl", "alpha_b * BoL", "alpha_t * BoL"),
    fault("brdf/v_smith_ggx_correlated_anisotropic.wgsl", "NoL * length(", "NoV * length("),
    fault("brdf/v_smith_ggx_separable.wgsl", "NoV + sqrt", "sqrt"),
    fault("brdf/v_smith_ggx_separable.wgsl", "(NoL - a2 * NoL) * NoL", "(NoL - a2) * NoL"),
    fault("brdf/v_schlick.wgsl", "(1.0 - k) + k) * (NoL", "(1.0 - k)) * (NoL"),
    fault("brdf/v_schlick.wgsl", "0.25", "0.5"),
    fault("brdf/f_lazanyi.wgsl", "x2 * x2 * x2", "x2 * x2 * x"),
    fault("brdf/f_lazanyi.wgsl", "- a * F_Lazanyi_weight", "+ a * F_Lazanyi_weight"),
    fault("brdf/f_conductor.wgsl", "(n2 - 1.0 - k2) + cos2", "n2 - k2"),
    fault("brdf/f_conductor.wgsl", "4.0 * n2 * k2", "2.0 * n2 * k2"),
    fault("brdf/f_conductor.wgsl", "sin2 * sin2", "sin2"),
    fault("lobe/visibility_smith_correlated.wgsl", "(alpha, NoV, NoL);", "(alpha * alpha, NoV, NoL);"),
    fault("lobe/visibility_smith_separable.wgsl", "(alpha, NoV, NoL);", "(alpha, NoV, NoV);"),
    fault("lobe/visibility_schlick_half_alpha.wgsl", "0.5 * alpha", "alpha"),
    fault("lobe/visibility_schlick_karis.wgsl", "0.125", "0.25"),
    fault("lobe/visibility_schlick_lecture.wgsl", "x * x", "x"),
    fault("lobe/visibility_anisotropic_smith_correlated.wgsl", "ToL, BoL, NoV", "BoL, ToL, NoV"),
    fault("lobe/visibility_anisotropic_smith_separable.wgsl", "NoL + length", "length"),
    fault("light/attenuation.wgsl", "1.0 - x * x", "1.0 - x"),
    fault("light/attenuation.wgsl", "saturate(1.0 - x * x)", "(1.0 - x * x)"),
    fault(
        "light/attenuation.wgsl",
        "clamp(distance_squared, DISTANCE_SQUARED_MIN, DISTANCE_SQUARED_MAX)",
        "distance_squared",
    ),
    fault("light/attenuation.wgsl", "f32 = 1e-4", "f32 = 1e-2"),
    fault("light/attenuation.wgsl", "return x * x", "return x"),
    fault("light/attenuation.wgsl", "scale + offset)", "scale - offset)"),
    fault("light/irradiance_sh.wgsl", "n.x * n.x - n.y * n.y", "n.x * n.x + n.y * n.y"),
    fault("light/irradiance_sh.wgsl", "3.0 * n.z * n.z", "2.0 * n.z * n.z"),
    fault("light/irradiance_sh.wgsl", "coefficients[1] * n.y", "coefficients[1] * n.x"),
    fault("light/irradiance_sh.wgsl", "coefficients[5] * (n.y", "coefficients[5] * (-n.y"),
    fault("light/irradiance_sh.wgsl", "+ uneven, vec3f(0.0))", "+ uneven, vec3f(-1e9))"),
    fault("color/srgb.wgsl", "1.055 *", "1.05 *"),
    fault("color/srgb.wgsl", "1.0 / 2.4", "1.0 / 2.2"),
    fault("color/srgb.wgsl", "0.0031308", "0.04045"),
    fault("color/srgb.wgsl", "12.92", "12.9"),
    fault("color/encode_srgb.wgsl", "srgb_from_linear(linear)", "linear"),
    fault("color/encode_linear.wgsl", "saturate(linear)", "linear"),
    fault("color/tone_map_linear.wgsl", "saturate(exposed)", "exposed"),
    fault("color/tone_map_reinhard.wgsl", "(1.0 + exposed)", "(1.0 + exposed * exposed)"),
    fault("color/tone_map_aces.wgsl", "0.13383", "0.13338"),
    fault("color/tone_map_aces.wgsl", "-0.07276", "0.07276"),
    fault("color/tone_map_aces.wgsl", " / 0.6)", ")"),
    fault("color/tone_map_aces.wgsl", "0.4329510", "0.4239510"),
    fault("color/tone_map_aces.wgsl", "saturate(OUTPUT * fitted)", "OUTPUT * fitted"),
    fault("color/tone_map_agx.wgsl", "0.0423282422610123", "0.0423756549057051"),
    fault("color/tone_map_agx.wgsl", "-0.0980434501171241", "0.0980434501171241"),
    fault("color/tone_map_agx.wgsl", "15.5", "15.4"),
    fault("color/tone_map_agx.wgsl", "vec3f(2.2)", "vec3f(2.4)"),
    fault("color/tone_map_agx.wgsl", "4.026069", "4.06069"),
    fault("color/tone_map_neutral.wgsl", "6.25", "6.5"),
    fault("color/tone_map_neutral.wgsl", "F90: f32 = 0.04", "F90: f32 = 0.05"),
    fault("color/tone_map_neutral.wgsl", "DESATURATION: f32 = 0.15", "DESATURATION: f32 = 0.1"),
    fault("color/tone_map_neutral.wgsl", "headroom * headroom", "headroom"),
    fault("color/tone_map_neutral.wgsl", "min(exposed.x,", "max(exposed.x,"),
];

/// Faults in lighting and surfaces, which need a frame to show.
const IN_FRAMES: &[Mutant] = &[
    fault("lighting/lobes.wgsl", "max(r * r, ALPHA_MIN)", "max(r, ALPHA_MIN)"),
    fault("lighting/lift_view.wgsl", "max(NOV_MIN - dot(n, v), 0.0)", "0.0"),
    fault("lighting/lobes.wgsl", "(1.0 - surface.metallic) * (1.0 - E_s)", "(1.0 - surface.metallic)"),
    fault("lighting/lobes.wgsl", "(lobes.diffuse_norm * passed)", "lobes.diffuse_norm"),
    fault("lighting/lobes.wgsl", "(lobes.multiscatter_norm * loss)", "lobes.multiscatter_norm"),
    fault("lighting/lobes.wgsl", "smooth_part) * NoL", "smooth_part)"),
    fault("lighting/lobes.wgsl", "dot(lobes.v, h)", "dot(lobes.n, h)"),
    fault("lighting/lobes.wgsl", "surface.metallic) * max(1.0 - E, 0.0)", "surface.metallic)"),
    fault("lighting/lobes.wgsl", "vec3f(1.0)) * surface.specular;", "vec3f(1.0));"),
    fault("lighting/fresnel_schlick.wgsl", "mix(surface.specular, 1.0, surface.metallic)", "1.0"),
    fault("lighting/fresnel_schlick.wgsl", "F_Schlick_average(surface.base_color, 1.0)", "vec3f(1.0)"),
    fault("lighting/shape_isotropic.wgsl", "visibility(shape.alpha, NoV, NoL)", "0.25"),
    fault("lighting/fresnel_lazanyi.wgsl", "- fresnel.a * F_Lazanyi_weight", "+ fresnel.a * F_Lazanyi_weight"),
    fault("lighting/fresnel_lazanyi.wgsl", "- fresnel.a * tail", ""),
    fault("lighting/fresnel_lazanyi.wgsl", "(1.0 / 126.0)", "0.0"),
    fault("lighting/fresnel_lazanyi.wgsl", "material.lazanyi_a * surface.metallic", "material.lazanyi_a"),
    fault(
        "lighting/fresnel_conductor.wgsl",
        "F_conductor(material.conductor_n, material.conductor_k",
        "F_conductor(material.conductor_k, material.conductor_n",
    ),
    fault("lighting/fresnel_conductor.wgsl", "VoH), metal, fresnel.metallic", "VoH), metal, 1.0"),
    fault("lighting/fresnel_tail.wgsl", "(1.0 / 16.0)", "(1.0 / 8.0)"),
    fault("lighting/shape_anisotropic.wgsl", "strength * strength", "strength"),
    fault("lighting/shape_anisotropic.wgsl", "dot(shape.b, l), NoV", "dot(shape.t, l), NoV"),
    fault("lighting/visibility_anisotropic_mean.wgsl", "sqrt(alpha_t * alpha_b)", "alpha_t"),
    fault("surface/tangents_anisotropic.wgsl", "-material.anisotropy.z", "material.anisotropy.z"),
    fault("surface/tangents_anisotropic.wgsl", "cross(n, along) * v.tangent.w", "cross(n, along)"),
    fault("surface/tangents_anisotropic.wgsl", "material.anisotropy.x * texel.z", "material.anisotropy.x"),
    fault("surface/tangents_anisotropic.wgsl", "texel.xy * 2.0 - 1.0", "texel.xy"),
    fault("lighting/dfg.wgsl", "sqrt(cos_theta)", "cos_theta"),
    fault("lighting/dfg.wgsl", "+ 0.5) / DFG_SIZE", ") / DFG_SIZE"),
    fault("lighting/punctual_light.wgsl", "position * light.w;", "position;"),
    fault("lighting/punctual_light.wgsl", "-dot(light.direction, l)", "dot(light.direction, l)"),
    fault("lighting/punctual_light.wgsl", "(falloff * cone)", "falloff"),
    fault("lighting/punctual_light.wgsl", "light.w > 0.0", "light.w < 0.0"),
    fault("lighting/punctual_light.wgsl", "dot(toward, toward)", "length(toward)"),
    fault("lighting/punctual_light.wgsl", "light.intensity * ", ""),
    fault("lighting/environment.wgsl", "* lobes.single_scatter", "* lobes.fresnel.F0"),
    fault("lighting/environment.wgsl", "(lobes.diffuse + lobes.multiscatter)", "lobes.diffuse"),
    fault("lighting/shape_isotropic.wgsl", "reflect(-v, n)", "n"),
    fault("lighting/reflection_mirror.wgsl", "to_environment * mirror", "mirror"),
    fault("lighting/environment.wgsl", "to_environment * lobes.n", "lobes.n"),
    fault("lighting/prefiltered.wgsl", "level - lower)", "0.0)"),
    fault("lighting/prefiltered.wgsl", " * environment.radiance_scale", ""),
    fault("lighting/lit.wgsl", " * surface.occlusion", ""),
    fault("lighting/lit.wgsl", " + surface.emissive", ""),
    fault("surface/reflecting.wgsl", "metallic_roughness.z", "metallic_roughness.x"),
    fault("surface/reflecting.wgsl", "metallic_roughness.y", "metallic_roughness.x"),
    fault("surface/dielectric.wgsl", "specular_texel(v).w", "specular_texel(v).x"),
    fault("surface/dielectric.wgsl", " * specular_color_texel(v).xyz", ""),
    fault("surface/occlusion.wgsl", "occlusion_texel(v, metallic_roughness).x", "metallic_roughness.y"),
    fault("surface/occlusion.wgsl", "material.occlusion_strength * ", ""),
    fault("surface/emission.wgsl", " * emissive_texel(v).xyz", ""),
    fault("surface/surface.wgsl", " * vertex_color(v)", ""),
    fault("surface/normal_map.wgsl", "xyz * (254.0 / 255.0) + 1.0 / 255.0", "xyz * 0.5 + 0.5"),
    fault("surface/normal_map.wgsl", " * v.tangent.w", ""),
    fault("surface/normal_map.wgsl", " * material.normal_scale", ""),
    fault("surface/normal_map.wgsl", "cross(v.normal, v.tangent.xyz)", "cross(v.tangent.xyz, v.normal)"),
    fault("surface/facing_double.wgsl", "select(-n, n, front_facing)", "n"),
];

/// Files that need a frame to be tested and have faults in [`IN_FRAMES`].
const SEEN_IN_FRAMES: [&str; 23] = [
    "lighting/dfg.wgsl",
    "lighting/environment.wgsl",
    "lighting/reflection_mirror.wgsl",
    "lighting/lit.wgsl",
    "lighting/fresnel_conductor.wgsl",
    "lighting/fresnel_lazanyi.wgsl",
    "lighting/fresnel_schlick.wgsl",
    "lighting/fresnel_tail.wgsl",
    "lighting/lift_view.wgsl",
    "lighting/lobes.wgsl",
    "lighting/prefiltered.wgsl",
    "lighting/punctual_light.wgsl",
    "lighting/shape_anisotropic.wgsl",
    "lighting/shape_isotropic.wgsl",
    "lighting/visibility_anisotropic_mean.wgsl",
    "surface/dielectric.wgsl",
    "surface/emission.wgsl",
    "surface/facing_double.wgsl",
    "surface/occlusion.wgsl",
    "surface/normal_map.wgsl",
    "surface/reflecting.wgsl",
    "surface/surface.wgsl",
    "surface/tangents_anisotropic.wgsl",
];

/// Faults in the lighting of Disney materials.
const IN_DISNEY_FRAMES: &[Mutant] = &[
    fault("lighting/disney.wgsl", "vec3f(0.3, 0.6, 0.1)", "vec3f(0.2126, 0.7152, 0.0722)"),
    fault("lighting/disney.wgsl", "0.08 * disney.specular", "0.04 * disney.specular"),
    fault("lighting/disney.wgsl", "mix(vec3f(1.0), hue, disney.specular_tint)", "hue"),
    fault("lighting/disney.wgsl", "0.9 * disney.anisotropic", "disney.anisotropic"),
    fault("lighting/disney.wgsl", "max(r * r / aspect,", "max(r * r * aspect,"),
    fault("lighting/disney.wgsl", "(0.5 + 0.5 * r) * (0.5 + 0.5 * r)", "(0.5 + 0.5 * r)"),
    fault("lighting/disney.wgsl", "mix(dielectric_F0, surface.base_color, surface.metallic)", "dielectric_F0"),
    fault("lighting/disney.wgsl", "surface.base_color * (1.0 - surface.metallic)", "surface.base_color"),
    fault("lighting/disney.wgsl", "hue, disney.sheen_tint)", "hue, disney.specular_tint)"),
    fault("lighting/disney.wgsl", "disney.sheen * (1.0 - surface.metallic)", "disney.sheen"),
    fault("lighting/disney.wgsl", "CLEARCOAT_WEIGHT * disney.clearcoat", "disney.clearcoat"),
    fault("lighting/disney.wgsl", "DISNEY_ALPHA_MIN, disney.clearcoat_gloss", "DISNEY_ALPHA_MIN, 1.0"),
    fault("lighting/disney.wgsl", "F0: f32 = 0.04", "F0: f32 = 0.05"),
    fault("lighting/disney.wgsl", "(lobes.masking, lobes.NoV) / (4.0", "(lobes.masking, lobes.NoV) / (2.0"),
    fault("lighting/disney.wgsl", "(CLEARCOAT_MASKING, lobes.NoV) / (4.0", "(lobes.masking, lobes.NoV) / (4.0"),
    fault("lighting/disney.wgsl", "G1_SmithGGX(lobes.masking, NoL)", "NoL"),
    fault("lighting/disney.wgsl", "mix(Fd, Fss, lobes.subsurface)", "Fd"),
    fault("lighting/disney.wgsl", "lobes.sheen * F_Schlick_weight(LoH)", "lobes.sheen"),
    fault("lighting/disney.wgsl", "smooth_part * NoL +", "smooth_part +"),
    fault("lighting/disney.wgsl", "cross(surface.n, surface.t)", "surface.t"),
    fault("lighting/disney_albedo.wgsl", "vec2f(sqrt(cos_theta)", "vec2f(cos_theta"),
    fault("lighting/disney_albedo.wgsl", "vec3f(c, T2, T3) * 3.0", "vec3f(c, T2, T3) * 2.0"),
    fault("lighting/disney_albedo.wgsl", "disney_layered(2.0,", "disney_layered(0.0,"),
    fault("lighting/disney_albedo.wgsl", "texel.xy * 2.0", "texel.xy"),
    fault("lighting/disney_albedo.wgsl", "return root * root", "return root"),
    fault("lighting/disney_albedo.wgsl", "DISNEY_TILES - 1.0, clearcoat_gloss", "DISNEY_TILES - 1.0, 1.0"),
    fault("lighting/environment_disney.wgsl", "along.x * along.x - along.y * along.y", "along.x * along.x"),
    fault("lighting/environment_disney.wgsl", "albedo.x * (1.0 - lobes.subsurface)", "albedo.x"),
    fault("lighting/environment_disney.wgsl", "* lobes.sheen * albedo.z", "* lobes.sheen"),
    fault("lighting/disney_lookups_plain.wgsl", "sqrt(sqrt(lobes.clearcoat_alpha))", "sqrt(lobes.clearcoat_alpha)"),
    fault("lighting/reflection_mirror_disney.wgsl", "(t2 - b2) / (t2 + b2)", "(t2 - b2)"),
    fault("lighting/bent_mirror.wgsl", "b * dot(b, v)", "b"),
    fault("lighting/bent_mirror.wgsl", "0.5 * contrast", "contrast"),
    fault("surface/tangent_vertex.wgsl", "tangent - n * dot(n, tangent)", "tangent.yzx"),
];

/// Files whose faults [`IN_DISNEY_FRAMES`] must show.
const DISNEY_LIGHTING: [&str; 7] = [
    "lighting/bent_mirror.wgsl",
    "lighting/disney.wgsl",
    "lighting/disney_albedo.wgsl",
    "lighting/disney_lookups_plain.wgsl",
    "lighting/environment_disney.wgsl",
    "lighting/reflection_mirror_disney.wgsl",
    "surface/tangent_vertex.wgsl",
];

/// Faults in how suns and fitted taps are shaded.
const IN_TIERS: &[Mutant] = &[
    fault("lighting/sun.wgsl", "sun_illuminance[i]", "sun_illuminance[0]"),
    fault("lighting/sun.wgsl", "let sun = environment.suns[i]", "let sun = environment.suns[0]"),
    fault("lighting/sun.wgsl", "sun.xyz, sun.w,", "sun.xyz, 1e-9,"),
    fault("lighting/shape_isotropic.wgsl", "2.0 / (s * (s + x))", "1.0"),
    fault("lighting/shape_isotropic.wgsl", "spread / VoH", "spread"),
    fault("lighting/prefiltered.wgsl", "LAST_LEVEL + 2.0 * log2", "LAST_LEVEL + log2"),
    fault("lighting/prefiltered.wgsl", "(1.0 - share) + 2.0 * pair", "(1.0 - share)"),
    fault("lighting/prefiltered.wgsl", "max(share, 0.25)", "share"),
    fault("lighting/taps.wgsl", "stored.x * TAPS_SCALE + TAPS_BIAS", "TAPS_BIAS - stored.x * TAPS_SCALE"),
    fault("lighting/taps.wgsl", "stored.y * LAST_LEVEL", "stored.y * 7.0"),
    fault("lighting/taps.wgsl", "place + spread * share", "place - spread * share"),
    fault("lighting/taps.wgsl", "place - spread * (1.0 - share)", "place"),
    fault("lighting/taps.wgsl", "twice * lobes.NoV - 1.0", "twice * lobes.NoV"),
    fault("lighting/taps.wgsl", "let v = to_environment * lobes.v", "let v = lobes.v"),
    fault("lighting/taps.wgsl", "vec2f(sqrt(lobes.NoV), level", "vec2f(lobes.NoV, level"),
    fault("lighting/environment_taps.wgsl", "plane.normal) * linear", "plane.normal) * quadratic"),
    fault("lighting/environment_taps.wgsl", "seen.parts.x", "seen.parts.y"),
    fault("lighting/environment_taps.wgsl", "lobes.multiscatter * multiscatter.y", "lobes.multiscatter * diffuse.y"),
    fault("lighting/flat_lobes.wgsl", "vec2f(0.0578, 0.2615) - ", "vec2f(0.0578, 0.2615) + "),
    fault("lighting/taps.wgsl", "(lobes.single_scatter - dielectric)", "lobes.single_scatter"),
    fault("lighting/reflection_draft.wgsl", "vec3f(others.z)", "vec3f(one.w)"),
    fault("lighting/reflection_standard.wgsl", "vec3f(others.z), vec3f(one.w)", "vec3f(one.w), vec3f(others.z)"),
    fault("lighting/reflection_standard.wgsl", "taps_texel(4.0, plane)", "taps_texel(3.0, plane)"),
    fault("lighting/reflection_high.wgsl", "vec3f(others.w)", "vec3f(others.z)"),
    fault("lighting/reflection_high.wgsl", "tap(plane, three.xyz)", "tap(plane, two.xyz)"),
];

/// Files whose faults [`IN_TIERS`] must show.
const TIER_LIGHTING: [&str; 9] = [
    "lighting/flat_lobes.wgsl",
    "lighting/environment_taps.wgsl",
    "lighting/shape_isotropic.wgsl",
    "lighting/sun.wgsl",
    "lighting/prefiltered.wgsl",
    "lighting/taps.wgsl",
    "lighting/reflection_draft.wgsl",
    "lighting/reflection_standard.wgsl",
    "lighting/reflection_high.wgsl",
];

/// Faults in how stretched lobes and those of Disney look for the environment.
const IN_LOBE_TIERS: &[Mutant] = &[
    fault("lighting/visible_facets.wgsl", "VoH * VoH * dot(a, b)", "dot(a, b)"),
    fault("lighting/visible_facets.wgsl", "normalize(line.alpha * line.v)", "line.v"),
    fault("lighting/visible_facets.wgsl", "select(along, -along, lean < 0.0)", "along"),
    fault("lighting/visible_facets.wgsl", "vec2f(half_difference + radius, xy)", "vec2f(xy, half_difference + radius)"),
    fault("lighting/visible_facets.wgsl", "2.0 * radius / largest", "radius / largest"),
    fault("lighting/visible_facets.wgsl", "turn / (4.0 + turn)", "turn"),
    fault("lighting/visible_facets.wgsl", "line.to_environment * l, r", "l, r"),
    fault("lighting/visible_facets.wgsl", "vec2f(-line.along.y, line.along.x)", "line.along"),
    fault("lighting/visible_facets.wgsl", "0.5 * width", "width"),
    fault("lighting/visible_facets.wgsl", " * (1.0 - place * place));", ");"),
    fault("lighting/facets_standard.wgsl", "reflectance(lobes.fresnel, VoH) * ", "vec3f(1.0) * "),
    fault("lighting/facets_standard.wgsl", "v.z * length(alpha * l)", "v.z * length(l)"),
    fault("lighting/facets_standard.wgsl", "lobes.shape.t, lobes.shape.alpha_t", "lobes.shape.t, lobes.shape.alpha"),
    fault("lighting/facets_disney.wgsl", "F_Schlick(lobes.F0, 1.0, VoH) * ", "vec3f(1.0) * "),
    fault("lighting/facets_disney.wgsl", "lobes.b, lobes.alpha_y", "lobes.b, lobes.alpha_x"),
    fault("lighting/reflection_line_draft.wgsl", "0.3089 * longer", "0.0"),
    fault("lighting/reflection_line_standard.wgsl", "place - reach, end", "place + reach, end"),
    fault("lighting/reflection_line_standard.wgsl", "mix(0.8494, 2.5253, long)", "0.8494"),
    fault("lighting/reflection_line_high.wgsl", "place + near", "place - near"),
    fault("lighting/reflection_line_high.wgsl", "* end_tilt)", "/ end_tilt)"),
    fault("lighting/disney_smooth.wgsl", "lobes.n * lobes.NoV - lobes.v", "lobes.v - lobes.n * lobes.NoV"),
    fault("lighting/disney_smooth.wgsl", "to_environment * direction, 0.5", "to_environment * direction, 0.8"),
    fault("lighting/disney_smooth.wgsl", "direction) * degree_2", "direction) * degree_1"),
    fault("lighting/disney_smooth.wgsl", "0.28 * r", "0.6 * r"),
    fault("lighting/disney_smooth.wgsl", "0.79 - 0.03 * r", "1.0"),
    fault("lighting/disney_lookups_draft.wgsl", "(0.539 + lobes.NoV)", "1.539"),
    fault("lighting/disney_lookups_standard.wgsl", "cos(angle) + inward", "cos(angle) - inward"),
    fault("lighting/disney_lookups_standard.wgsl", "0.508", "0.8"),
];

/// Files whose faults [`IN_LOBE_TIERS`] must show.
const LOBE_TIER_LIGHTING: [&str; 9] = [
    "lighting/disney_lookups_draft.wgsl",
    "lighting/disney_lookups_standard.wgsl",
    "lighting/disney_smooth.wgsl",
    "lighting/facets_disney.wgsl",
    "lighting/facets_standard.wgsl",
    "lighting/reflection_line_draft.wgsl",
    "lighting/reflection_line_high.wgsl",
    "lighting/reflection_line_standard.wgsl",
    "lighting/visible_facets.wgsl",
];

/// Faults by which narrow taps see suns in the mirror level that are shaded already.
const AT_GRAZING_SUNS: &[Mutant] =
    &[fault("lighting/visible_facets.wgsl", "clamp(sqrt(alpha), line.least_r, 1.0)", "min(sqrt(alpha), 1.0)")];

impl Mutant {
    fn sources(&self) -> ShaderSources {
        let mut sources = ShaderSources::default();
        let text = sources.get(self.file).unwrap_or_else(|| panic!("{} does not exist", self.file)).to_owned();
        assert_eq!(text.matches(self.from).count(), 1, "{}: `{}` has to stand there once", self.file, self.from);
        sources.insert(self.file, text.replacen(self.from, self.to, 1));
        sources
    }

    fn name(&self) -> String {
        format!("{}: `{}` -> `{}`", self.file, self.from, self.to)
    }

    /// The first of the twins that the file is part of which rejects the fault.
    fn rejecting_twin(&self, gpu: &Gpu) -> Option<String> {
        let sources = self.sources();
        let reached = TWINS.iter().filter(|twin| twin.compose(&sources).unwrap().files().contains(self.file));
        let rejects = |twin: &&Twin| {
            let outcome = twin.measure(gpu, &sources).unwrap_or_else(|error| panic!("{}: {error}", self.name()));
            outcome.worst().error > twin.limit
        };
        reached.into_iter().find(rejects).map(Twin::name)
    }

    /// The first plane on which the fault shows.
    fn rejecting_plane(&self, gpu: &Gpu, planes: &[Plane]) -> Option<String> {
        let shows = |plane: &&Plane| plane.error(gpu, self.sources()) > plane.limit;
        planes.iter().find(shows).map(|plane| plane.name.to_owned())
    }
}

/// Prints who rejects each mutant; fails when nobody does, or when a file has no mutant.
fn all_are_rejected<'a>(
    mutants: &[Mutant],
    files: impl Iterator<Item = &'a str>,
    rejecting: impl Fn(&Mutant) -> Option<String>,
) {
    let mut survivors = Vec::new();
    for mutant in mutants {
        match rejecting(mutant) {
            Some(test) => println!("{} is rejected by {test}", mutant.name()),
            None => survivors.push(mutant.name()),
        }
    }
    assert!(survivors.is_empty(), "nothing rejects\n{}", survivors.join("\n"));
    let mutated: BTreeSet<&str> = mutants.iter().map(|mutant| mutant.file).collect();
    assert_eq!(files.collect::<BTreeSet<&str>>(), mutated, "files with functions, and files with mutants");
}

#[test]
fn twins_reject_every_planted_fault() {
    let gpu = gpu(Precision::Half);
    all_are_rejected(IN_FUNCTIONS, files(), |mutant| mutant.rejecting_twin(&gpu));
}

#[test]
fn frames_reject_every_planted_fault() {
    let gpu = gpu(Precision::Float);
    let planes = planes();
    all_are_rejected(IN_FRAMES, SEEN_IN_FRAMES.into_iter(), |mutant| mutant.rejecting_plane(&gpu, &planes));
}

#[test]
fn disney_frames_reject_every_planted_fault() {
    let gpu = gpu(Precision::Float);
    let planes = disney_planes();
    all_are_rejected(IN_DISNEY_FRAMES, DISNEY_LIGHTING.into_iter(), |mutant| mutant.rejecting_plane(&gpu, &planes));
}

#[test]
fn tiers_reject_every_planted_fault() {
    let gpu = gpu(Precision::Float);
    let tiers = Tiers::round();
    all_are_rejected(IN_TIERS, TIER_LIGHTING.into_iter(), |mutant| tiers.rejecting(&gpu, &mutant.sources()));
}

#[test]
fn lobe_tiers_reject_every_planted_fault() {
    let gpu = gpu(Precision::Float);
    let tiers = lobe_tiers();
    all_are_rejected(IN_LOBE_TIERS, LOBE_TIER_LIGHTING.into_iter(), |mutant| tiers.rejecting(&gpu, &mutant.sources()));
}

#[test]
fn grazing_suns_reject_taps_that_read_the_mirror_level() {
    let gpu = gpu(Precision::Float);
    let tiers = grazing_tiers();
    let files = ["lighting/visible_facets.wgsl"];
    all_are_rejected(AT_GRAZING_SUNS, files.into_iter(), |mutant| tiers.rejecting(&gpu, &mutant.sources()));
}
