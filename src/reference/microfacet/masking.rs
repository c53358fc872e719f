//! How facets hide each other from light and view: the geometry factor, as visibility V = G / (4 NoV NoL).

#![expect(non_snake_case, reason = "equations keep the symbols of their papers")]

use super::Distribution;
use super::distribution::Lambda_GGX_anisotropic;
use crate::reference::brdf::G1_GGX;
use glam::DVec3;

/// Smith's masking and shadowing, taken as independent (Walter et al. 2007, equation 23; Heitz 2014, equation 98),
/// as visibility. Both cosines in (0, 1].
pub fn V_SmithGGX_separable(alpha: f64, NoV: f64, NoL: f64) -> f64 {
    G1_GGX(alpha, NoV) * G1_GGX(alpha, NoL) / (4.0 * NoV * NoL)
}

/// Height-correlated Smith for anisotropic GGX (Heitz 2014, equations 80 and 99). `NoV` and `NoL` in (0, 1].
#[expect(clippy::too_many_arguments, reason = "the six cosines of the equation")]
pub fn V_SmithGGXCorrelated_anisotropic(
    alpha_x: f64,
    alpha_y: f64,
    ToV: f64,
    BoV: f64,
    ToL: f64,
    BoL: f64,
    NoV: f64,
    NoL: f64,
) -> f64 {
    let Lambda_v = Lambda_GGX_anisotropic(alpha_x, alpha_y, ToV, BoV, NoV);
    let Lambda_l = Lambda_GGX_anisotropic(alpha_x, alpha_y, ToL, BoL, NoL);
    1.0 / ((1.0 + Lambda_v + Lambda_l) * 4.0 * NoV * NoL)
}

/// Schlick's rational G1(x) = x / (x (1 - k) + k), once for each direction (Schlick 1994, equation 19), as visibility.
/// `k` in [0, 1], the cosines in (0, 1].
pub fn V_Schlick(k: f64, NoV: f64, NoL: f64) -> f64 {
    let G1 = |NoX: f64| NoX / (NoX * (1.0 - k) + k);
    G1(NoV) * G1(NoL) / (4.0 * NoV * NoL)
}

/// A geometry factor. The Schlick forms know no direction, and take the mean alpha of an anisotropic distribution.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Geometry {
    /// Exact under Smith's assumptions: facets that are high are neither masked nor shadowed.
    SmithCorrelated,
    /// Masking and shadowing as if independent: too dark where light and view are both grazing.
    SmithSeparable,
    /// Schlick's form with k = alpha / 2, which meets Smith's at alpha = 1.
    SchlickHalfAlpha,
    /// Schlick's form with k = (r + 1)^2 / 8 of the perceptual roughness r (Karis 2013, equation 4): made to look good
    /// under punctual lights, and so dark at low perceptual roughness.
    SchlickKaris,
    /// Schlick's form with k = ((r + 1) / 2)^2, as the lecture prints it. That is Karis' remapped alpha, which he halves
    /// again to get k: the lecture's k is twice as large, and hides most of the light.
    SchlickLecture,
}

impl Geometry {
    pub const ALL: [Self; 5] =
        [Self::SmithCorrelated, Self::SmithSeparable, Self::SchlickHalfAlpha, Self::SchlickKaris, Self::SchlickLecture];

    /// The name in reports and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::SmithCorrelated => "smith-correlated",
            Self::SmithSeparable => "smith-separable",
            Self::SchlickHalfAlpha => "schlick-half-alpha",
            Self::SchlickKaris => "schlick-karis",
            Self::SchlickLecture => "schlick-lecture",
        }
    }

    /// The model of a name.
    pub fn by_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|geometry| geometry.name() == name)
    }

    /// V, all of the lobe that is neither D nor F; `v.z` and `l.z` in (0, 1].
    pub fn visibility(self, distribution: &Distribution, v: DVec3, l: DVec3) -> f64 {
        if let Some(k) = self.k(distribution.mean_alpha()) {
            return V_Schlick(k, v.z, l.z);
        }
        let (Lambda_v, Lambda_l) = (distribution.Lambda(v), distribution.Lambda(l));
        let G2 = match self {
            Self::SmithSeparable => 1.0 / ((1.0 + Lambda_v) * (1.0 + Lambda_l)),
            _ => 1.0 / (1.0 + Lambda_v + Lambda_l),
        };
        G2 / (4.0 * v.z * l.z)
    }

    /// k of Schlick's form at an alpha; `None` for the Smith models.
    fn k(self, alpha: f64) -> Option<f64> {
        let perceptual_roughness = alpha.sqrt();
        match self {
            Self::SmithCorrelated | Self::SmithSeparable => None,
            Self::SchlickHalfAlpha => Some(alpha / 2.0),
            Self::SchlickKaris => Some((perceptual_roughness + 1.0).powi(2) / 8.0),
            Self::SchlickLecture => Some(((perceptual_roughness + 1.0) / 2.0).powi(2)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reference::brdf::V_SmithGGXCorrelated;

    const V: DVec3 = DVec3::new(0.6, 0.0, 0.8);
    const L: DVec3 = DVec3::new(-0.48, 0.64, 0.6);

    #[test]
    fn the_functions_are_the_models() {
        let round = Distribution::ggx(0.36).unwrap();
        let anisotropic = Distribution::ggx_anisotropic(0.1, 0.5, 0.0).unwrap();
        let expected = [
            (Geometry::SmithCorrelated, V_SmithGGXCorrelated(0.36, 0.8, 0.6)),
            (Geometry::SmithSeparable, V_SmithGGX_separable(0.36, 0.8, 0.6)),
            (Geometry::SchlickHalfAlpha, V_Schlick(0.18, 0.8, 0.6)),
            (Geometry::SchlickKaris, V_Schlick(0.32, 0.8, 0.6)),
            (Geometry::SchlickLecture, V_Schlick(0.64, 0.8, 0.6)),
        ];
        for (geometry, V_expected) in expected {
            let found = geometry.visibility(&round, V, L);
            assert!((found / V_expected - 1.0).abs() < 1e-14, "{}: {found}", geometry.name());
        }
        let found = Geometry::SmithCorrelated.visibility(&anisotropic, V, L);
        let expected = V_SmithGGXCorrelated_anisotropic(0.1, 0.5, 0.6, 0.0, -0.48, 0.64, 0.8, 0.6);
        assert!((found / expected - 1.0).abs() < 1e-14);
    }

    #[test]
    fn schlick_with_half_of_alpha_meets_separable_smith_at_alpha_1() {
        for (NoV, NoL) in [(0.01, 1.0), (0.5, 0.3)] {
            assert!((V_Schlick(0.5, NoV, NoL) / V_SmithGGX_separable(1.0, NoV, NoL) - 1.0).abs() < 1e-13);
        }
    }
}
