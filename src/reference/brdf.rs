//! The equations of the surface, in the algebra of the papers they come from.
//!
//! These are the truth that the shaders are tested against. The shaders use other, numerically stable algebra, so that
//! a test compares two derivations and not two copies. Cosines are of unit vectors: `NoV` = n.v and so on.

#![expect(non_snake_case, reason = "equations keep the symbols of their papers")]

use glam::DVec3;
use std::f64::consts::PI;

/// Alpha of the NDF from what artists set, in [1e-3, 1]: the square (Burley 2012, section 5.4), floored because D and V
/// of a perfectly smooth surface are a delta function and a pole (docs/model.md).
pub fn alpha_from_perceptual_roughness(perceptual_roughness: f64) -> f64 {
    (perceptual_roughness * perceptual_roughness).max(1e-3)
}

/// Normal distribution of GGX, 1/sr (Trowbridge and Reitz 1975; Walter et al. 2007, equation 33).
/// `alpha` in (0, 1], `NoH` in [-1, 1]; even in `NoH`.
pub fn D_GGX(alpha: f64, NoH: f64) -> f64 {
    let a2 = alpha * alpha;
    a2 / (PI * (NoH * NoH * (a2 - 1.0) + 1.0).powi(2))
}

/// Smith's Lambda for GGX (Heitz 2014, equation 72); `NoX` in (0, 1] is the cosine of the direction.
pub fn Lambda_GGX(alpha: f64, NoX: f64) -> f64 {
    let tan2 = (1.0 - NoX * NoX).max(0.0) / (NoX * NoX);
    ((1.0 + alpha * alpha * tan2).sqrt() - 1.0) / 2.0
}

/// Masking of one direction (Heitz 2014, equation 43), in [0, 1].
pub fn G1_GGX(alpha: f64, NoX: f64) -> f64 {
    1.0 / (1.0 + Lambda_GGX(alpha, NoX))
}

/// Height-correlated masking and shadowing (Heitz 2014, equation 99), in [0, 1].
pub fn G2_SmithGGXCorrelated(alpha: f64, NoV: f64, NoL: f64) -> f64 {
    1.0 / (1.0 + Lambda_GGX(alpha, NoV) + Lambda_GGX(alpha, NoL))
}

/// Visibility, G2 / (4 NoV NoL): all of the Cook-Torrance lobe that is neither D nor F (Heitz 2014, equation 99).
/// Both cosines in (0, 1].
pub fn V_SmithGGXCorrelated(alpha: f64, NoV: f64, NoL: f64) -> f64 {
    G2_SmithGGXCorrelated(alpha, NoV, NoL) / (4.0 * NoV * NoL)
}

/// Fresnel reflectance (Schlick 1994, equation 15), with `f90` at grazing incidence instead of 1. `VoH` in [0, 1].
pub fn F_Schlick(f0: DVec3, f90: f64, VoH: f64) -> DVec3 {
    f0 + (DVec3::splat(f90) - f0) * (1.0 - VoH).powi(5)
}

/// Cosine-weighted average of [`F_Schlick`] over the hemisphere: int 2 mu (1 - mu)^5 dmu = 1/21.
pub fn F_Schlick_average(f0: DVec3, f90: f64) -> DVec3 {
    f0 + (DVec3::splat(f90) - f0) / 21.0
}

/// Share of the energy lost by single scattering that comes back out as Kulla and Conty published it (2017, "Revisiting
/// Physically Based Shading at Imageworks", F_avg E_avg / (1 - F_avg (1 - E_avg)), times F_avg for the first bounce).
/// `f_avg` from [`F_Schlick_average`]; `E_avg` in (0, 1] is the cosine average of the lobe's albedo with F = 1.
pub fn F_KullaConty(f_avg: DVec3, E_avg: f64) -> DVec3 {
    f_avg * f_avg * E_avg / (DVec3::ONE - f_avg * (1.0 - E_avg))
}

/// Share of the light at the second and later facets that leaves from there: `E_avg (1 + 0.7 (1 - E_avg))`.
///
/// Kulla and Conty have `E_avg`, the share at the first, at every facet. But light that comes back up starts higher, and
/// the share grows from facet to facet. One number for all of them was fitted to random walks of isotropic facets
/// (docs/multiscatter.md). In [`E_avg`, 1], and growing with `E_avg`.
pub fn later_escape(E_avg: f64) -> f64 {
    E_avg * (1.0 + 0.7 * (1.0 - E_avg))
}

/// Share of the energy lost by single scattering that comes back out: [`F_KullaConty`] with the [`later_escape`].
pub fn F_multiscatter(f_avg: DVec3, E_avg: f64) -> DVec3 {
    F_KullaConty(f_avg, later_escape(E_avg))
}

/// Kulla and Conty's multiple-scattering lobe without its Fresnel factor, 1/sr (2017, slide 13):
/// (1 - E(NoV)) (1 - E(NoL)) / (pi (1 - E_avg)). 0 where nothing is lost, as for a mirror.
pub fn f_KullaConty(E_v: f64, E_l: f64, E_avg: f64) -> f64 {
    coupled_cosine_lobe(E_v, E_l, E_avg)
}

/// Lambert's diffuse lobe of unit albedo, 1/sr.
pub fn Fd_Lambert() -> f64 {
    1.0 / PI
}

/// Lambert's lobe below an interface that reflects `E_s` of the light on either way through (Kelemen and Szirmay-Kalos
/// 2001, equation 6), 1/sr and of unit albedo: albedo (1 - E_s(NoV)) at every angle. 0 below a perfect mirror.
pub fn Fd_Coupled(E_s_v: f64, E_s_l: f64, E_s_avg: f64) -> f64 {
    coupled_cosine_lobe(E_s_v, E_s_l, E_s_avg)
}

/// The reciprocal lobe whose albedo is 1 - E(v): both models above are this function of what passes.
fn coupled_cosine_lobe(E_v: f64, E_l: f64, E_avg: f64) -> f64 {
    let missing = 1.0 - E_avg;
    // Where less than a table's precision is missing there is nothing to hand out, and 0/0 to be avoided.
    if missing < 1e-9 { 0.0 } else { Fd_Lambert() * (1.0 - E_v).max(0.0) * (1.0 - E_l).max(0.0) / missing }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::quadrature::GaussLegendre;

    #[test]
    fn facets_give_back_no_more_light_than_met_them() {
        // Every loss that a lobe can have, GGX's largest being 0.591, and every colour, F90 included.
        let steps = |count: i32| (0..=count).map(move |i| f64::from(i) / f64::from(count));
        for E_avg in steps(120).map(|x| 0.4 + 0.6 * x) {
            let escape = later_escape(E_avg);
            assert!((E_avg..=1.0).contains(&escape), "{E_avg}: {escape}");
            let mut before = -1.0;
            for f_avg in steps(200) {
                let share = F_multiscatter(DVec3::splat(f_avg), E_avg).x;
                // Two facets at least: no more than their reflectance, and more with every reflectance.
                assert!(share >= 0.0 && share <= f_avg * f_avg + 1e-15, "{f_avg}, {E_avg}: {share}");
                let published = F_KullaConty(DVec3::splat(f_avg), E_avg).x;
                assert!(share > before && share >= published - 1e-15, "{f_avg}, {E_avg}");
                before = share;
            }
            assert!((before - 1.0).abs() < 1e-15, "white facets at {E_avg}: {before}");
        }
    }

    /// int over the hemisphere of facets, with tan(theta) = alpha tan(psi): `f(NoH, sin)` averaged over azimuth.
    fn over_facets(alpha: f64, mut f: impl FnMut(f64, f64) -> f64) -> f64 {
        GaussLegendre::new(96)
            .nodes_with_flat_ends(0.0, PI / 2.0)
            .map(|(psi, weight)| {
                let tan = alpha * psi.tan();
                let NoH = 1.0 / (1.0 + tan * tan).sqrt();
                let dtheta_dpsi = alpha / psi.cos().powi(2) * NoH * NoH;
                2.0 * PI * weight * dtheta_dpsi * tan * NoH * D_GGX(alpha, NoH) * f(NoH, tan * NoH)
            })
            .sum()
    }

    #[test]
    fn facets_project_onto_the_surface_they_make_up() {
        for alpha in [1e-3, 0.01, 0.1, 0.5, 1.0] {
            let area = over_facets(alpha, |NoH, _| NoH);
            // Walter et al. 2007, equation 4.
            assert!((area - 1.0).abs() < 1e-8, "alpha {alpha}: {area}");
        }
    }

    #[test]
    fn visible_facets_project_onto_the_surface_seen() {
        // int G1 <v.h> D dh = NoV (Heitz 2014, equation 15). The azimuth average of <v.h> is in closed form.
        let mut worst: f64 = 0.0;
        for alpha in [1e-3, 0.1, 0.5, 1.0] {
            for NoV in [0.05_f64, 0.4, 0.9] {
                let sin_v = (1.0 - NoV * NoV).sqrt();
                let projected = over_facets(alpha, |NoH, sin| {
                    let (a, b) = (NoV * NoH, sin_v * sin);
                    if a >= b {
                        return a;
                    }
                    let last = (-a / b).acos();
                    (a * last + b * last.sin()) / PI
                });
                let area = projected * G1_GGX(alpha, NoV) / NoV;
                worst = worst.max((area - 1.0).abs());
            }
        }
        // Measured 7.1e-6, from the bend at a = b. Margin 2.
        assert!(worst < 1.5e-5, "{worst:e}");
    }

    #[test]
    fn masking_and_shadowing_are_bounded_and_symmetric() {
        for alpha in [1e-3, 0.2, 1.0] {
            for (NoV, NoL) in [(0.01, 0.9), (0.3, 0.3), (1.0, 1.0)] {
                let G2 = G2_SmithGGXCorrelated(alpha, NoV, NoL);
                let (G1_v, G1_l) = (G1_GGX(alpha, NoV), G1_GGX(alpha, NoL));
                assert!(G2 <= G1_v.min(G1_l) && G2 >= G1_v * G1_l, "alpha {alpha}, NoV {NoV}, NoL {NoL}: {G2}");
                let exchanged = G2_SmithGGXCorrelated(alpha, NoL, NoV);
                assert!((G2 - exchanged).abs() < 1e-14, "alpha {alpha}, NoV {NoV}, NoL {NoL}: {G2} and {exchanged}");
            }
        }
    }

    #[test]
    fn schlicks_average_is_the_average_of_schlick() {
        let (f0, f90) = (DVec3::new(0.04, 0.5, 1.0), 0.9);
        let average = GaussLegendre::new(8)
            .nodes_on(0.0, 1.0)
            .fold(DVec3::ZERO, |sum, (mu, weight)| sum + F_Schlick(f0, f90, mu) * (2.0 * weight * mu));
        assert!((average - F_Schlick_average(f0, f90)).length() < 1e-12, "{average}");
    }
}
