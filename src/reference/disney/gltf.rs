//! Disney materials as glTF ones and back, and how far apart the two then are.
//!
//! The glTF side is metallic-roughness with KHR_materials_specular, _clearcoat, _sheen and _anisotropy, by the formulas
//! that these extensions give for an implementation. docs/disney.md says what survives.

#![expect(non_snake_case, reason = "equations keep the symbols of their papers")]

use super::bsdf::{DisneyBsdf, DisneyMaterial, TangentFrame};
use super::{CLEARCOAT_WEIGHT, D_GTR2_anisotropic, Schlick_weight, alpha_of_clearcoat, alphas, tint};
use crate::reference::brdf::{D_GGX, F_Schlick, Fd_Lambert, V_SmithGGXCorrelated, alpha_from_perceptual_roughness};
use crate::reference::quadrature::GaussLegendre;
use crate::scene::Disney;
use glam::DVec3;
use std::f64::consts::PI;

/// A glTF material as far as a Disney one can say it; no textures, index of refraction 1.5.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GltfMaterial {
    /// Linear Rec.709 in [0, 1].
    pub base_color: DVec3,
    /// In [0, 1].
    pub metallic: f64,
    /// In [0, 1].
    pub perceptual_roughness: f64,
    /// KHR_materials_specular: weight in [0, 1], and tint of F0 = 0.04, 0 or above.
    pub specular: f64,
    pub specular_color: DVec3,
    /// KHR_materials_anisotropy: strength in [0, 1], along the tangent.
    pub anisotropy_strength: f64,
    /// KHR_materials_sheen.
    pub sheen_color: DVec3,
    pub sheen_perceptual_roughness: f64,
    /// KHR_materials_clearcoat, both in [0, 1].
    pub clearcoat: f64,
    pub clearcoat_perceptual_roughness: f64,
}

/// Charlie's lobe is nothing like Disney's sheen: the residual of the best multiple is 0.98 or more at any perceptual
/// roughness. This multiple of the lobe of perceptual roughness 1 returns as much of an even environment's light,
/// averaged over views; a test integrates both.
const SHEEN_SCALE: f64 = 0.0475;

/// The closest glTF material. Subsurface has no counterpart and is left out.
pub fn gltf_from_disney(material: &DisneyMaterial) -> GltfMaterial {
    let Disney { specular, specular_tint, anisotropic, sheen, sheen_tint, clearcoat, clearcoat_gloss, .. } =
        material.parameters;
    let hue = tint(material.base_color);
    let (alpha_x, alpha_y) = alphas(material.perceptual_roughness, f64::from(anisotropic));
    // alpha_t = mix(alpha, 1, strength^2) along the tangent and alpha_b = alpha across it.
    let isotropic = anisotropic == 0.0;
    let strength =
        if isotropic { 0.0 } else { ((alpha_x - alpha_y) / (1.0 - alpha_y).max(1e-9)).clamp(0.0, 1.0).sqrt() };
    GltfMaterial {
        base_color: material.base_color,
        metallic: material.metallic,
        perceptual_roughness: if isotropic { material.perceptual_roughness } else { alpha_y.sqrt() },
        specular: 1.0,
        // F0 = 0.04 color here and 0.08 specular color there.
        specular_color: DVec3::ONE.lerp(hue, f64::from(specular_tint)) * (2.0 * f64::from(specular)),
        anisotropy_strength: strength,
        sheen_color: DVec3::ONE.lerp(hue, f64::from(sheen_tint))
            * (SHEEN_SCALE * f64::from(sheen) * (1.0 - material.metallic)),
        sheen_perceptual_roughness: 1.0,
        clearcoat: CLEARCOAT_WEIGHT * f64::from(clearcoat),
        // Half of the facets within the same angle: alpha_GGX = sqrt(alpha_GTR1).
        clearcoat_perceptual_roughness: alpha_of_clearcoat(f64::from(clearcoat_gloss)).powf(0.25),
    }
}

/// The closest Disney material; the inverse of [`gltf_from_disney`] where that loses nothing, its numbers clamped to
/// what Disney's parameters reach.
pub fn disney_from_gltf(material: &GltfMaterial) -> DisneyMaterial {
    let across = material.perceptual_roughness.powi(2);
    let along = across + (1.0 - across) * material.anisotropy_strength.powi(2);
    let hue = tint(material.base_color);
    let (specular, specular_tint) = amount_and_tint(material.specular_color * (0.5 * material.specular), hue);
    let below_metal = SHEEN_SCALE * (1.0 - material.metallic).max(1e-6);
    let (sheen, sheen_tint) = amount_and_tint(material.sheen_color / below_metal, hue);
    let gloss = (0.1 - material.clearcoat_perceptual_roughness.powi(4)) / (0.1 - 1e-3);
    let unit = |x: f64| x.clamp(0.0, 1.0) as f32;
    DisneyMaterial {
        base_color: material.base_color,
        metallic: material.metallic,
        perceptual_roughness: (along * across).powf(0.25),
        parameters: Disney {
            subsurface: 0.0,
            specular: unit(specular),
            specular_tint: unit(specular_tint),
            anisotropic: unit(if along > 0.0 { (1.0 - across / along) / 0.9 } else { 0.0 }),
            sheen: unit(sheen),
            sheen_tint: unit(sheen_tint),
            clearcoat: unit(material.clearcoat / CLEARCOAT_WEIGHT),
            clearcoat_gloss: unit(gloss),
        },
    }
}

/// Splits `amount mix(white, hue, tint)`; both whites and hues have the luminance 1.
fn amount_and_tint(color: DVec3, hue: DVec3) -> (f64, f64) {
    let amount = color.dot(DVec3::new(0.3, 0.6, 0.1));
    let toward = hue - DVec3::ONE;
    let tinted = amount > 0.0 && toward.length_squared() > 1e-12;
    (amount, if tinted { (color / amount - DVec3::ONE).dot(toward) / toward.length_squared() } else { 0.0 })
}

/// Distribution of Charlie's cloth, 1/sr (Estevez and Kulla 2017, "Production Friendly Microfacet Sheen BRDF").
pub fn D_Charlie(alpha: f64, NoH: f64) -> f64 {
    let inverse = 1.0 / alpha;
    (2.0 + inverse) * (1.0 - NoH * NoH).max(0.0).powf(0.5 * inverse) / (2.0 * PI)
}

/// Visibility of cloth (Neubelt and Pettineo 2013, "Crafting a Next-Gen Material Pipeline for The Order: 1886").
pub fn V_Neubelt(NoV: f64, NoL: f64) -> f64 {
    1.0 / (4.0 * (NoL + NoV - NoL * NoV))
}

/// Anisotropic height-correlated visibility (Heitz 2014, equation 99, of the stretched directions).
fn V_SmithGGXCorrelatedAnisotropic(alpha: (f64, f64), v: DVec3, l: DVec3) -> f64 {
    let length = |d: DVec3| DVec3::new(alpha.0 * d.x, alpha.1 * d.y, d.z).length();
    0.5 / (l.z * length(v) + v.z * length(l))
}

/// The BRDF of a glTF material in the frame whose normal is +Z and whose tangent is +X.
#[derive(Debug)]
pub struct GltfBrdf {
    material: GltfMaterial,
    alphas: (f64, f64),
    /// Directional albedo of the sheen for colour 1, over NoV.
    sheen_albedo: Vec<f64>,
}

impl GltfBrdf {
    pub fn new(material: GltfMaterial) -> Self {
        let across = alpha_from_perceptual_roughness(material.perceptual_roughness);
        let along = across + (1.0 - across) * material.anisotropy_strength.powi(2);
        let alpha = alpha_from_perceptual_roughness(material.sheen_perceptual_roughness);
        let rule = GaussLegendre::new(48);
        let sheen_albedo = (0..=64).map(|i| sheen_albedo(&rule, alpha, f64::from(i) / 64.0)).collect();
        Self { material, alphas: (along, across), sheen_albedo }
    }

    /// f(l, v), 1/sr; both unit vectors above the horizon.
    pub fn evaluate(&self, v: DVec3, l: DVec3) -> DVec3 {
        let material = &self.material;
        let h = (l + v).normalize_or(DVec3::Z);
        let VoH = v.dot(h).clamp(0.0, 1.0);
        let (x, y) = self.alphas;
        let specular = D_GTR2_anisotropic(x, y, h.x, h.y, h.z) * V_SmithGGXCorrelatedAnisotropic((x, y), v, l);

        let f0 = (0.04 * material.specular_color).min(DVec3::ONE) * material.specular;
        let fresnel = F_Schlick(f0, material.specular, VoH);
        let dielectric = material.base_color * (Fd_Lambert() * (1.0 - fresnel.max_element())) + fresnel * specular;
        let metal = F_Schlick(material.base_color, 1.0, VoH) * specular;
        let base = dielectric.lerp(metal, material.metallic);

        let alpha = alpha_from_perceptual_roughness(material.sheen_perceptual_roughness);
        let sheen = material.sheen_color * (D_Charlie(alpha, h.z) * V_Neubelt(v.z, l.z));
        let taken = material.sheen_color.max_element();
        let left = (1.0 - taken * self.sheen_albedo(v.z)).min(1.0 - taken * self.sheen_albedo(l.z));

        let alpha = alpha_from_perceptual_roughness(material.clearcoat_perceptual_roughness);
        let coat = D_GGX(alpha, h.z) * V_SmithGGXCorrelated(alpha, v.z, l.z);
        let weight = material.clearcoat * (0.04 + 0.96 * Schlick_weight(v.z));
        (sheen + base * left).lerp(DVec3::splat(coat), weight)
    }

    fn sheen_albedo(&self, NoV: f64) -> f64 {
        let position = NoV.clamp(0.0, 1.0) * (self.sheen_albedo.len() - 1) as f64;
        let index = (position as usize).min(self.sheen_albedo.len() - 2);
        let [below, above] = [self.sheen_albedo[index], self.sheen_albedo[index + 1]];
        below + (above - below) * (position - index as f64)
    }
}

fn sheen_albedo(rule: &GaussLegendre, alpha: f64, NoV: f64) -> f64 {
    let v = DVec3::new((1.0 - NoV * NoV).sqrt(), 0.0, NoV);
    let at = |NoL: f64, phi: f64| {
        let sin = (1.0 - NoL * NoL).sqrt();
        let l = DVec3::new(sin * phi.cos(), sin * phi.sin(), NoL);
        D_Charlie(alpha, (l + v).normalize().z) * V_Neubelt(NoV, NoL) * NoL
    };
    2.0 * rule.integrate(0.0, 1.0, |NoL| rule.integrate(0.0, PI, |phi| at(NoL, phi)))
}

/// Relative difference of the two BRDFs, `|f_gltf - f_disney| / |f_disney|` in L2 over the sphere of directions of
/// light and view, both weighted with their cosine: 48 views by 4096 lights on spirals, the same in every call.
///
/// A clearcoat whose peak is narrower than the spiral's step of about 2 degrees is judged by what lies around the peak.
pub fn residual(disney: &DisneyMaterial, gltf: &GltfMaterial) -> f64 {
    let gltf = GltfBrdf::new(*gltf);
    let (mut difference, mut power) = (0.0, 0.0);
    for v in spiral(48, 1.0) {
        let bsdf = DisneyBsdf::new(disney, TangentFrame::LOCAL, v);
        for l in spiral(4096, 0.0) {
            let f = bsdf.evaluate(l);
            difference += (gltf.evaluate(v, l) - f).length_squared();
            power += f.length_squared();
        }
    }
    if power > 0.0 { (difference / power).sqrt() } else { difference.sqrt() }
}

/// Directions with density cos(theta) / pi.
fn spiral(count: u32, turn: f64) -> impl Iterator<Item = DVec3> {
    const GOLDEN_ANGLE: f64 = 2.399_963_229_728_653;
    (0..count).map(move |i| {
        let cos2 = (f64::from(i) + 0.5) / f64::from(count);
        let (sin_phi, cos_phi) = (f64::from(i) * GOLDEN_ANGLE + turn).sin_cos();
        let sin = (1.0 - cos2).sqrt();
        DVec3::new(sin * cos_phi, sin * sin_phi, cos2.sqrt())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn material(metallic: f64, perceptual_roughness: f64, parameters: Disney) -> DisneyMaterial {
        DisneyMaterial { base_color: DVec3::new(0.7, 0.4, 0.2), metallic, perceptual_roughness, parameters }
    }

    #[test]
    fn what_gltf_can_say_survives_the_way_there_and_back() {
        let parameters = Disney {
            specular: 0.7,
            specular_tint: 0.4,
            anisotropic: 0.6,
            sheen: 0.8,
            sheen_tint: 0.3,
            clearcoat: 0.9,
            clearcoat_gloss: 0.25,
            ..Disney::default()
        };
        let there = material(0.3, 0.5, parameters);
        let back = disney_from_gltf(&gltf_from_disney(&there));
        assert!((back.perceptual_roughness - 0.5).abs() < 1e-9 && back.metallic == 0.3);
        let (mut a, mut b) = (there.parameters, back.parameters);
        for name in Disney::NAMES {
            let [a, b] = [&mut a, &mut b].map(|disney| *disney.parameter_mut(name).unwrap());
            assert!((a - b).abs() < 1e-6, "{name}: {a} came back as {b}");
        }
        // Subsurface does not.
        let lost = material(0.0, 0.5, Disney { subsurface: 1.0, ..Disney::default() });
        assert_eq!(disney_from_gltf(&gltf_from_disney(&lost)).parameters.subsurface, 0.0);
    }

    #[test]
    fn residuals_are_those_of_the_document() {
        let neutral = Disney::default();
        // Measured, and in docs/disney.md. A twentieth more or less is allowed: the peaks are steep.
        let cases = [
            ("diffuse, specular 0, r = 0.5", 0.0, 0.5, Disney { specular: 0.0, ..neutral }, 0.444),
            ("neutral, r = 0.2", 0.0, 0.2, neutral, 2.074),
            ("neutral, r = 0.5", 0.0, 0.5, neutral, 0.446),
            ("neutral, r = 1", 0.0, 1.0, neutral, 0.157),
            ("metal, r = 0.2", 1.0, 0.2, neutral, 0.880),
            ("metal, r = 0.5", 1.0, 0.5, neutral, 0.603),
            ("metal, r = 1", 1.0, 1.0, neutral, 0.241),
            ("specular 1, specular_tint 1", 0.0, 0.5, Disney { specular: 1.0, specular_tint: 1.0, ..neutral }, 0.446),
            ("subsurface 1", 0.0, 0.5, Disney { subsurface: 1.0, ..neutral }, 0.479),
            ("metal, anisotropic 0.5", 1.0, 0.5, Disney { anisotropic: 0.5, ..neutral }, 0.577),
            ("metal, anisotropic 1", 1.0, 0.5, Disney { anisotropic: 1.0, ..neutral }, 0.299),
            ("sheen 1", 0.0, 0.5, Disney { sheen: 1.0, ..neutral }, 0.377),
            ("clearcoat 1, gloss 0", 0.0, 0.5, Disney { clearcoat: 1.0, clearcoat_gloss: 0.0, ..neutral }, 0.315),
            ("clearcoat 1, gloss 1", 0.0, 0.5, Disney { clearcoat: 1.0, ..neutral }, 1.303),
        ];
        for (name, metallic, r, parameters, expected) in cases {
            let disney = material(metallic, r, parameters);
            let residual = residual(&disney, &gltf_from_disney(&disney));
            assert!((residual / expected - 1.0).abs() < 0.05, "{name}: {residual} instead of {expected}");
        }
    }

    #[test]
    fn against_black_the_residual_is_1() {
        let disney = material(0.4, 0.5, Disney { sheen: 1.0, clearcoat: 1.0, ..Disney::default() });
        let lit = gltf_from_disney(&disney);
        let black = GltfMaterial {
            base_color: DVec3::ZERO,
            metallic: 0.0,
            specular: 0.0,
            sheen_color: DVec3::ZERO,
            clearcoat: 0.0,
            ..lit
        };
        assert!((residual(&disney, &black) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn the_sheen_returns_as_much_light_as_disneys() {
        let rule = GaussLegendre::new(48);
        let albedo = crate::reference::disney::albedo::DisneyAlbedo::default();
        let average = |E: &dyn Fn(f64) -> f64| rule.integrate(0.0, 1.0, |x| 4.0 * x.powi(3) * E(x * x));
        let disney = average(&|NoV| albedo.diffuse(0.5, NoV).sheen);
        let gltf = average(&|NoV| sheen_albedo(&rule, 1.0, NoV));
        assert!((disney / gltf / SHEEN_SCALE - 1.0).abs() < 2e-2, "{}", disney / gltf);
    }
}
