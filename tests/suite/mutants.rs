//! Planted faults: a test of the tests. Each is a plausible slip of the pen, and some comparison has to reject it.

use crate::lit_plane::{Plane, planes};
use crate::support::gpu;
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
    fault("brdf/f_schlick.wgsl", "(F90 - F0)", "(1.0 - F0)"),
    fault("brdf/fd_lambert.wgsl", "return INV_PI", "return 1.0"),
    fault("math/constants.wgsl", "0.318309886183791", "0.31831"),
    fault("math/vectors.wgsl", "inverseSqrt(", "sqrt("),
    fault("math/vectors.wgsl", "LENGTH_MIN: f32 = 1e-30", "LENGTH_MIN: f32 = 1e-15"),
    fault("math/vectors.wgsl", "v / max(largest, LENGTH_MIN)", "v"),
    fault("math/vectors.wgsl", "LENGTH_MAX: f32 = 1e37", "LENGTH_MAX: f32 = 1e19"),
    fault("math/half_range.wgsl", "65504.0", "65520.0"),
    fault("math/octahedral.wgsl", "abs(d.zx)", "abs(d.xz)"),
    fault("math/octahedral.wgsl", "d.xz >= vec2f(0.0)", "d.xz > vec2f(0.0)"),
    fault("math/octahedral.wgsl", "d.xz, d.y >= 0.0", "d.zx, d.y >= 0.0"),
    fault("lobe/albedo.wgsl", "F_ms * (1.0 - scale - bias)", "F_ms * (1.0 - scale)"),
    fault("lobe/albedo.wgsl", "F90 * bias", "bias"),
    fault("lobe/albedo.wgsl", "saturate(", "("),
    fault("lobe/multiscatter_kulla_conty.wgsl", "(1.0 / 21.0)", "(1.0 / 20.0)"),
    fault("lobe/multiscatter_kulla_conty.wgsl", "F_avg * F_avg * E_avg", "F_avg * E_avg"),
    fault("lobe/multiscatter_kulla_conty.wgsl", "F_avg * (1.0 - E_avg))", "(1.0 - E_avg))"),
    fault("lobe/multiscatter_none.wgsl", "vec3f(0.0)", "F0"),
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
    fault("light/irradiance_sh.wgsl", ".xyz, vec3f(0.0))", ".xyz, vec3f(-1e9))"),
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
    fault("lighting/lobes.wgsl", "max(NOV_MIN - dot(surface.n, surface.v), 0.0)", "0.0"),
    fault("lighting/lobes.wgsl", "(1.0 - surface.metallic) * (1.0 - E_s)", "(1.0 - surface.metallic)"),
    fault("lighting/lobes.wgsl", "(lobes.diffuse_norm * passed)", "lobes.diffuse_norm"),
    fault("lighting/lobes.wgsl", "(lobes.multiscatter_norm * loss)", "lobes.multiscatter_norm"),
    fault("lighting/lobes.wgsl", "smooth_part) * NoL", "smooth_part)"),
    fault("lighting/lobes.wgsl", "dot(lobes.v, h)", "dot(lobes.n, h)"),
    fault("lighting/lobes.wgsl", "surface.metallic) * max(1.0 - E, 0.0)", "surface.metallic)"),
    fault("lighting/lobes.wgsl", "vec3f(1.0)) * surface.specular;", "vec3f(1.0));"),
    fault("lighting/lobes.wgsl", "mix(surface.specular, 1.0, surface.metallic)", "1.0"),
    fault("lighting/lobes.wgsl", "F_multiscatter(surface.base_color", "F_multiscatter(dielectric_F0"),
    fault("lighting/lobes.wgsl", "V_SmithGGXCorrelated(lobes.alpha, lobes.NoV, NoL)", "0.25"),
    fault("lighting/dfg.wgsl", "sqrt(cos_theta)", "cos_theta"),
    fault("lighting/dfg.wgsl", "+ 0.5) / DFG_SIZE", ") / DFG_SIZE"),
    fault("lighting/punctual.wgsl", "position * light.w;", "position;"),
    fault("lighting/punctual.wgsl", "-dot(light.direction, l)", "dot(light.direction, l)"),
    fault("lighting/punctual.wgsl", "(falloff * cone)", "falloff"),
    fault("lighting/punctual.wgsl", "light.w > 0.0", "light.w < 0.0"),
    fault("lighting/punctual.wgsl", "dot(toward, toward)", "length(toward)"),
    fault("lighting/punctual.wgsl", "light.intensity * ", ""),
    fault("lighting/environment.wgsl", "* lobes.single_scatter", "* lobes.F0"),
    fault("lighting/environment.wgsl", "(lobes.diffuse + lobes.multiscatter)", "lobes.diffuse"),
    fault("lighting/environment.wgsl", "reflect(-lobes.v, lobes.n)", "lobes.n"),
    fault("lighting/environment.wgsl", "to_environment * mirror", "mirror"),
    fault("lighting/environment.wgsl", "to_environment * lobes.n", "lobes.n"),
    fault("lighting/environment.wgsl", "level - f32(lower)", "0.0"),
    fault("lighting/environment.wgsl", " * environment.radiance_scale", ""),
    fault("lighting/lit.wgsl", " * surface.occlusion", ""),
    fault("lighting/lit.wgsl", " + surface.emissive", ""),
    fault("surface/surface.wgsl", "metallic_roughness.z", "metallic_roughness.x"),
    fault("surface/surface.wgsl", "metallic_roughness.y", "metallic_roughness.x"),
    fault("surface/surface.wgsl", "specular_texel(v).w", "specular_texel(v).x"),
    fault("surface/surface.wgsl", " * specular_color_texel(v).xyz", ""),
    fault("surface/surface.wgsl", "occlusion_texel(v).x", "occlusion_texel(v).y"),
    fault("surface/surface.wgsl", "material.occlusion_strength * ", ""),
    fault("surface/surface.wgsl", " * emissive_texel(v).xyz", ""),
    fault("surface/surface.wgsl", " * vertex_color(v)", ""),
    fault("surface/normal_map.wgsl", "xyz * 2.0 - 1.0", "xyz * 2.0"),
    fault("surface/normal_map.wgsl", " * v.tangent.w", ""),
    fault("surface/normal_map.wgsl", " * material.normal_scale", ""),
    fault("surface/normal_map.wgsl", "cross(v.normal, v.tangent.xyz)", "cross(v.tangent.xyz, v.normal)"),
    fault("surface/facing_double.wgsl", "select(-n, n, front_facing)", "n"),
];

/// Files that need a frame to be tested and have faults in [`IN_FRAMES`].
const SEEN_IN_FRAMES: [&str; 8] = [
    "lighting/dfg.wgsl",
    "lighting/environment.wgsl",
    "lighting/lit.wgsl",
    "lighting/lobes.wgsl",
    "lighting/punctual.wgsl",
    "surface/facing_double.wgsl",
    "surface/normal_map.wgsl",
    "surface/surface.wgsl",
];

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
