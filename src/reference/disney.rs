//! The Disney BRDF of 2012 in the algebra of its paper.
//!
//! Burley 2012, "Physically-Based Shading at Disney" (SIGGRAPH course notes), sections 5.3 to 5.6 and appendix B. What
//! the text leaves open (colours at normal incidence, the weight and the limits of the lobes, the approximation of
//! subsurface scattering) follows the BRDF that Disney published with it, `disney.brdf` of its BRDF Explorer.
//! docs/disney.md lists the formulas and what is measured about them.

#![expect(non_snake_case, reason = "equations keep the symbols of their papers")]

pub mod albedo;
pub mod bsdf;
pub mod gltf;

/// Generalized Trowbridge-Reitz with exponent 2 is GGX (Burley 2012, appendix B).
pub use super::microfacet::distribution::D_GGX_anisotropic as D_GTR2_anisotropic;
use glam::DVec3;
use std::f64::consts::PI;

/// Generalized Trowbridge-Reitz distribution with exponent 1, 1/sr (Burley 2012, appendix B). `alpha` in (0, 1).
pub fn D_GTR1(alpha: f64, NoH: f64) -> f64 {
    let a2 = alpha * alpha;
    (a2 - 1.0) / (PI * a2.ln() * (1.0 + (a2 - 1.0) * NoH * NoH))
}

/// Smith masking of one direction for GGX, in [0, 1] (Walter et al. 2007, equation 34). `NoX` in [0, 1].
pub fn G1_SmithGGX(alpha: f64, NoX: f64) -> f64 {
    let tan2 = (1.0 - NoX * NoX).max(0.0) / (NoX * NoX);
    2.0 / (1.0 + (1.0 + alpha * alpha * tan2).sqrt())
}

/// Diffuse lobe with retro-reflection at grazing angles, of base colour 1, 1/sr (Burley 2012,
/// section 5.3). Two Schlick curves whose value at grazing incidence is 0.5 + 2 LoH^2 `perceptual_roughness`.
pub fn Fd_Burley(perceptual_roughness: f64, NoV: f64, NoL: f64, LoH: f64) -> f64 {
    let F_D90 = 0.5 + 2.0 * LoH * LoH * perceptual_roughness;
    both_ways(F_D90, NoV, NoL) / PI
}

/// Approximation of subsurface scattering for base colour 1, 1/sr (Burley 2012, section 5.3 and `disney.brdf`), after
/// the shape of Hanrahan and Krueger 1993. Reciprocal; 1 / (NoL + NoV) grows at grazing angles, times NoL it stays
/// finite.
pub fn Fd_Subsurface(perceptual_roughness: f64, NoV: f64, NoL: f64, LoH: f64) -> f64 {
    let F_ss = both_ways(LoH * LoH * perceptual_roughness, NoV, NoL);
    1.25 / PI * (F_ss * (1.0 / (NoL + NoV) - 0.5) + 0.5)
}

/// Light that a surface lets through on the way in and out: 1 at normal incidence, `F90` at grazing.
fn both_ways(F90: f64, NoV: f64, NoL: f64) -> f64 {
    (1.0 + (F90 - 1.0) * Schlick_weight(NoL)) * (1.0 + (F90 - 1.0) * Schlick_weight(NoV))
}

/// The weight of the reflectance at grazing incidence (Schlick 1994, equation 15).
pub fn Schlick_weight(cosine: f64) -> f64 {
    (1.0 - cosine).powi(5)
}

/// Smallest alpha of a lobe.
const ALPHA_MIN: f64 = 1e-3;

/// Alphas along tangent and bitangent (Burley 2012, section 5.4): the square of the perceptual roughness, apart by
/// `aspect = sqrt(1 - 0.9 anisotropic)`.
pub fn alphas(perceptual_roughness: f64, anisotropic: f64) -> (f64, f64) {
    let aspect = (1.0 - 0.9 * anisotropic).sqrt();
    let alpha = perceptual_roughness * perceptual_roughness;
    ((alpha / aspect).max(ALPHA_MIN), (alpha * aspect).max(ALPHA_MIN))
}

/// Alpha of the masking of the specular lobe, from 0.25 up (Burley 2012, section 5.6): as if the perceptual roughness
/// were in [0.5, 1], to keep smooth highlights from becoming too hot.
pub fn alpha_of_masking(perceptual_roughness: f64) -> f64 {
    (0.5 + 0.5 * perceptual_roughness).powi(2)
}

/// Alpha of the clearcoat's distribution.
pub fn alpha_of_clearcoat(clearcoat_gloss: f64) -> f64 {
    0.1 + (ALPHA_MIN - 0.1) * clearcoat_gloss
}

/// Alpha of the clearcoat's masking, its reflectance at normal incidence, and its weight in the sum.
pub const CLEARCOAT_MASKING: f64 = 0.25;
pub const CLEARCOAT_F0: f64 = 0.04;
pub const CLEARCOAT_WEIGHT: f64 = 0.25;

/// Hue and saturation of the base colour: the colour over its luminance, white for black (`disney.brdf`, whose
/// luminance weights are rounder than those of Rec.709).
pub fn tint(base_color: DVec3) -> DVec3 {
    let luminance = base_color.dot(DVec3::new(0.3, 0.6, 0.1));
    if luminance > 0.0 { base_color / luminance } else { DVec3::ONE }
}

/// Reflectance at normal incidence, dielectric and metal mixed (`disney.brdf`).
pub fn specular_f0(base_color: DVec3, metallic: f64, specular: f64, specular_tint: f64) -> DVec3 {
    let dielectric = 0.08 * specular * DVec3::ONE.lerp(tint(base_color), specular_tint);
    dielectric.lerp(base_color, metallic)
}

#[cfg(test)]
mod tests {
    use super::super::quadrature::GaussLegendre;
    use super::*;
    use crate::reference::brdf::{D_GGX, G1_GGX};
    use glam::DVec2;

    /// int D(h) NoH dh over facets of the slopes tan(psi) (x, y) stretched by `scale`.
    fn projected_area(scale: DVec2, D: impl Fn(DVec3) -> f64) -> f64 {
        let rule = GaussLegendre::new(96);
        let ring = |psi: f64, phi: f64| {
            let h = (scale * DVec2::from_angle(phi) * psi.tan()).extend(1.0).normalize();
            // dh = NoH^3 d(slopes).
            D(h) * h.z.powi(4) * scale.x * scale.y * psi.tan() / psi.cos().powi(2)
        };
        let polar = rule.nodes_with_flat_ends(0.0, PI / 2.0);
        polar.map(|(psi, weight)| weight * rule.integrate(0.0, 2.0 * PI, |phi| ring(psi, phi))).sum()
    }

    #[test]
    fn facets_project_onto_the_surface_they_make_up() {
        for alpha in [0.001, 0.02, 0.1] {
            let area = projected_area(DVec2::splat(alpha), |h| D_GTR1(alpha, h.z));
            assert!((area - 1.0).abs() < 1e-6, "alpha {alpha}: {area}");
        }
        for (perceptual_roughness, anisotropic) in [(0.3, 0.0), (0.3, 0.8), (0.7, 1.0), (1.0, 0.5)] {
            let (x, y) = alphas(perceptual_roughness, anisotropic);
            let area = projected_area(DVec2::new(x, y), |h| D_GTR2_anisotropic(x, y, h.x, h.y, h.z));
            assert!((area - 1.0).abs() < 1e-6, "{perceptual_roughness}, {anisotropic}: {area}");
        }
    }

    #[test]
    fn without_anisotropy_the_lobe_is_ggx() {
        for (alpha, NoH) in [(0.01_f64, 0.9999_f64), (0.3, 0.7), (1.0, 0.1)] {
            let x = (1.0 - NoH * NoH).sqrt();
            let both = (D_GTR2_anisotropic(alpha, alpha, 0.6 * x, 0.8 * x, NoH), D_GGX(alpha, NoH));
            assert!((both.0 / both.1 - 1.0).abs() < 1e-9, "{both:?}");
            assert!((G1_SmithGGX(alpha, NoH) - G1_GGX(alpha, NoH)).abs() < 1e-12);
        }
    }

    #[test]
    fn the_diffuse_lobe_is_darker_than_lamberts_at_grazing_angles_when_smooth_and_brighter_when_rough() {
        // Burley 2012, section 5.3: 0.5 at the edge of a smooth surface, 2.5 in retro-reflection from a rough one.
        assert!((Fd_Burley(0.0, 1e-9, 1.0, 0.5) * PI - 0.5).abs() < 1e-6);
        assert!((Fd_Burley(1.0, 1e-9, 1e-9, 1.0) * PI - 6.25).abs() < 1e-6);
        assert!((Fd_Burley(0.7, 1.0, 1.0, 1.0) * PI - 1.0).abs() < 1e-12);
        assert!((Fd_Subsurface(0.7, 1.0, 1.0, 1.0) * PI - 0.625).abs() < 1e-12);
    }

    #[test]
    fn tints_have_the_luminance_of_white_and_black_has_none() {
        let color = tint(DVec3::new(0.2, 0.5, 0.9));
        assert!((color.dot(DVec3::new(0.3, 0.6, 0.1)) - 1.0).abs() < 1e-12);
        assert_eq!(tint(DVec3::ZERO), DVec3::ONE);
        assert_eq!(specular_f0(DVec3::new(0.9, 0.5, 0.1), 1.0, 0.5, 1.0), DVec3::new(0.9, 0.5, 0.1));
        assert!((specular_f0(DVec3::ONE, 0.0, 0.5, 1.0) - 0.04).abs().max_element() < 1e-12);
    }
}
