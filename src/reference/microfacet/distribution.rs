//! Distributions of facet normals (NDF).

#![expect(non_snake_case, reason = "equations keep the symbols of their papers")]

use super::ellipsoid::{Ellipsoid, check_alpha};
use crate::math::parameter::ParameterError;
use crate::reference::brdf::{D_GGX, Lambda_GGX};
use glam::DVec3;
use std::f64::consts::PI;

/// Anisotropic GGX, 1/sr (Burley 2012, "Physically-Based Shading at Disney", equation 13). `alpha_x` along the tangent,
/// `alpha_y` along the bitangent, both above 0; `ToH` and `BoH` are the half vector's cosines with these.
pub fn D_GGX_anisotropic(alpha_x: f64, alpha_y: f64, ToH: f64, BoH: f64, NoH: f64) -> f64 {
    let squared = (ToH / alpha_x).powi(2) + (BoH / alpha_y).powi(2) + NoH * NoH;
    1.0 / (PI * alpha_x * alpha_y * squared * squared)
}

/// Smith's Lambda for anisotropic GGX (Heitz 2014, equations 72 and 80), of a direction with `NoX` in (0, 1].
pub fn Lambda_GGX_anisotropic(alpha_x: f64, alpha_y: f64, ToX: f64, BoX: f64, NoX: f64) -> f64 {
    let alpha_tan = (alpha_x * ToX).hypot(alpha_y * BoX) / NoX;
    ((1.0 + alpha_tan * alpha_tan).sqrt() - 1.0) / 2.0
}

/// How the normals of the facets are distributed. The constructors check the parameters.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Distribution {
    #[non_exhaustive]
    Ggx {
        alpha: f64,
    },
    /// The axis of `alpha_x` is turned by `rotation_rad` from the tangent toward the bitangent.
    #[non_exhaustive]
    GgxAnisotropic {
        alpha_x: f64,
        alpha_y: f64,
        rotation_rad: f64,
    },
    Ellipsoid(Ellipsoid),
}

impl Distribution {
    /// # Errors
    /// When `alpha` is not in [1e-4, 1].
    pub fn ggx(alpha: f64) -> Result<Self, ParameterError> {
        let alpha = ParameterError::check("alpha", alpha, 1e-4..=1.0, "from 1e-4 to 1")?;
        Ok(Self::Ggx { alpha })
    }

    /// # Errors
    /// When an alpha is not in [1e-4, 4], or the rotation not finite.
    pub fn ggx_anisotropic(alpha_x: f64, alpha_y: f64, rotation_rad: f64) -> Result<Self, ParameterError> {
        let finite = f64::MIN..=f64::MAX;
        let rotation_rad = ParameterError::check("rotation_rad", rotation_rad, finite, "a finite angle in radians")?;
        Ok(Self::GgxAnisotropic {
            alpha_x: check_alpha("alpha_x", alpha_x)?,
            alpha_y: check_alpha("alpha_y", alpha_y)?,
            rotation_rad,
        })
    }

    /// Density of facet normals per unit of macroscopic area, 1/sr; `m.z` above 0.
    pub fn D(&self, m: DVec3) -> f64 {
        match *self {
            Self::Ggx { alpha } => D_GGX(alpha, m.z),
            Self::GgxAnisotropic { alpha_x, alpha_y, rotation_rad } => {
                let turned = turned(m, rotation_rad);
                D_GGX_anisotropic(alpha_x, alpha_y, turned.x, turned.y, turned.z)
            }
            Self::Ellipsoid(ellipsoid) => ellipsoid.D(m),
        }
    }

    /// Smith's Lambda of a direction with `x.z` in (0, 1]: area of facets that face away from it per unit of area seen.
    pub fn Lambda(&self, x: DVec3) -> f64 {
        match *self {
            Self::Ggx { alpha } => Lambda_GGX(alpha, x.z),
            Self::GgxAnisotropic { alpha_x, alpha_y, rotation_rad } => {
                let turned = turned(x, rotation_rad);
                Lambda_GGX_anisotropic(alpha_x, alpha_y, turned.x, turned.y, turned.z)
            }
            Self::Ellipsoid(ellipsoid) => ellipsoid.Lambda(x),
        }
    }

    /// What int D(m) (v.m) dm over the upper hemisphere is the cosine with: the macroscopic normal, except for a leaning
    /// ellipsoid ([`Ellipsoid::mean_normal`]).
    pub fn mean_normal(&self) -> DVec3 {
        match self {
            Self::Ggx { .. } | Self::GgxAnisotropic { .. } => DVec3::Z,
            Self::Ellipsoid(ellipsoid) => ellipsoid.mean_normal(),
        }
    }

    /// int D(m) <v.m> dm over the whole sphere: the shadow of the closed ellipsoid along `v`, 1 along the normal.
    pub fn projected_area(&self, v: DVec3) -> f64 {
        match self {
            Self::Ggx { .. } | Self::GgxAnisotropic { .. } => v.z * (1.0 + 2.0 * self.Lambda(v)),
            Self::Ellipsoid(ellipsoid) => ellipsoid.projected_area(v),
        }
    }

    /// The unit normal around which D is highest.
    pub fn predominant_normal(&self) -> DVec3 {
        match self {
            Self::Ggx { .. } | Self::GgxAnisotropic { .. } => DVec3::Z,
            Self::Ellipsoid(ellipsoid) => ellipsoid.predominant_normal(),
        }
    }

    /// Alpha along the two axes.
    pub fn alphas(&self) -> (f64, f64) {
        match *self {
            Self::Ggx { alpha } => (alpha, alpha),
            Self::GgxAnisotropic { alpha_x, alpha_y, .. } => (alpha_x, alpha_y),
            Self::Ellipsoid(ellipsoid) => ellipsoid.alphas(),
        }
    }

    /// One alpha for models that know no direction: the geometric mean.
    pub fn mean_alpha(&self) -> f64 {
        let (alpha_x, alpha_y) = self.alphas();
        (alpha_x * alpha_y).sqrt()
    }

    /// Whether turning light and view together about the normal changes nothing.
    pub fn is_isotropic(&self) -> bool {
        matches!(self, Self::Ggx { .. })
    }
}

/// `m` as seen from axes that are turned by `rotation_rad` about the normal.
fn turned(m: DVec3, rotation_rad: f64) -> DVec3 {
    let (sin, cos) = rotation_rad.sin_cos();
    DVec3::new(cos * m.x + sin * m.y, cos * m.y - sin * m.x, m.z)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn direction(z: f64, phi: f64) -> DVec3 {
        let sin = (1.0 - z * z).sqrt();
        DVec3::new(sin * phi.cos(), sin * phi.sin(), z)
    }

    #[test]
    fn equal_alphas_are_isotropic() {
        let (round, turned) = (Distribution::ggx(0.3).unwrap(), Distribution::ggx_anisotropic(0.3, 0.3, 0.9).unwrap());
        for (z, phi) in [(1.0, 0.0), (0.7, 1.0), (0.05, -2.0)] {
            let m = direction(z, phi);
            assert!((round.D(m) / turned.D(m) - 1.0).abs() < 1e-12);
            assert!((round.Lambda(m) - turned.Lambda(m)).abs() < 1e-12);
            assert!((round.projected_area(m) / turned.projected_area(m) - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn the_ellipsoid_turns_the_same_way() {
        let turned = Distribution::ggx_anisotropic(0.1, 0.5, 0.6).unwrap();
        let ellipsoid = Distribution::Ellipsoid(Ellipsoid::new(0.1, 0.5, 0.6, 0.0, 0.0).unwrap());
        for (z, phi) in [(0.9, 0.3), (0.7, 1.0), (0.05, -2.0)] {
            let m = direction(z, phi);
            assert!((ellipsoid.D(m) / turned.D(m) - 1.0).abs() < 1e-12);
            assert!((ellipsoid.Lambda(m) - turned.Lambda(m)).abs() < 1e-12);
            assert!((ellipsoid.projected_area(m) / turned.projected_area(m) - 1.0).abs() < 1e-12);
        }
        // Facets vary most along the axis of the larger alpha, here turned from the bitangent.
        let along = |phi: f64| turned.D(direction(0.9, phi));
        assert!(along(0.6 + 0.5 * PI) > 10.0 * along(0.6));
    }

    #[test]
    fn alpha_outside_its_range_is_named() {
        for alpha in [0.0, -0.1, 1.001, f64::NAN, f64::INFINITY] {
            assert_eq!(Distribution::ggx(alpha).unwrap_err().parameter, "alpha");
            let alpha = if alpha == 1.001 { 4.1 } else { alpha };
            assert_eq!(Distribution::ggx_anisotropic(alpha, 0.1, 0.0).unwrap_err().parameter, "alpha_x");
            assert_eq!(Distribution::ggx_anisotropic(0.1, alpha, 0.0).unwrap_err().parameter, "alpha_y");
        }
        assert_eq!(Distribution::ggx_anisotropic(0.1, 0.1, f64::NAN).unwrap_err().parameter, "rotation_rad");
    }
}
