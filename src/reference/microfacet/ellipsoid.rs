//! Facets whose normals are distributed as on an ellipsoid that may lean.
//!
//! # Derivation
//! Let the ellipsoid be the image A u of the unit sphere, A = R S. Its normal at A u is along A^-T u, so the normal m is
//! found at u = A^T m / |A^T m|. A solid angle dm of normals comes from du = |det A| / |A^T m|^3 dm of the sphere, and
//! du becomes an area of |det A| |A^-T u| du, with |A^-T u| = 1 / |A^T m|. The area of the normals dm is therefore
//! det(A)^2 / |A^T m|^4 dm. The half of the ellipsoid that faces the macroscopic normal n is a height field over its
//! shadow, an ellipse of area pi |det A| |A^-1 n|. Per unit of shadow:
//!
//! D(m) = |det A| / (pi |A^-1 n| |A^T m|^4) for m.n > 0, and int D(m) (n.m) dm = 1.
//!
//! The constant |det A| / (pi |A^-1 n|) is what the lecture leaves out. With S = diag(1/alpha_x, 1/alpha_y, 1) and no
//! lean, R = 1, this is anisotropic GGX (Burley 2012), and 1 / (pi alpha_x alpha_y) its constant.
//!
//! # Laws
//! - Seen along any v, the facets of the whole ellipsoid cover what its shadow does:
//!   int over the sphere of D(m) <v.m> dm = |A^-1 v| / |A^-1 n| (as in Heitz et al. 2015, "The SGGX Microflake
//!   Distribution", section 4).
//! - The facets of the upper half alone have the vector area int D(m) m dm = A^-T A^-1 n / |A^-1 n|^2 =: N, the normal of
//!   the plane through the half's rim. N.n = 1, but N = n only where the ellipsoid does not lean. For the surface to be
//!   level on the whole, as int D(m) (v.m) dm = v.n demands, upright facets of the vector area n - N belong to it: the
//!   risers of a saw tooth. They are seen only by masking, and are black in the lobe: half vectors are never level.

#![expect(non_snake_case, reason = "equations keep the symbols of their papers")]

use crate::math::parameter::ParameterError;
use glam::{DMat3, DVec3};
use std::f64::consts::PI;

/// The ellipsoid A = R S with S = diag(1/alpha_x, 1/alpha_y, 1).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ellipsoid {
    /// R: its columns are the axes of the ellipsoid, the last one the predominant normal.
    tangent_from_axes: DMat3,
    alpha_x: f64,
    alpha_y: f64,
}

impl Ellipsoid {
    /// `rotation_rad` turns the axes of `alpha_x` and `alpha_y` about the normal, from the tangent toward the bitangent;
    /// then the predominant normal leans by `tilt_rad` toward `tilt_azimuth_rad`.
    ///
    /// # Errors
    /// When an alpha is not in [1e-4, 4], the tilt not in [0, 1.5], or an angle not finite.
    pub fn new(
        alpha_x: f64,
        alpha_y: f64,
        rotation_rad: f64,
        tilt_rad: f64,
        tilt_azimuth_rad: f64,
    ) -> Result<Self, ParameterError> {
        let angle = |name, value| ParameterError::check(name, value, f64::MIN..=f64::MAX, "a finite angle in radians");
        let tilt_rad = ParameterError::check("tilt_rad", tilt_rad, 0.0..=1.5, "from 0 to 1.5")?;
        let azimuth = angle("tilt_azimuth_rad", tilt_azimuth_rad)?;
        let rotation = angle("rotation_rad", rotation_rad)?;
        let tilt = DMat3::from_rotation_z(azimuth) * DMat3::from_rotation_y(tilt_rad);
        Ok(Self {
            tangent_from_axes: tilt * DMat3::from_rotation_z(rotation - azimuth),
            alpha_x: check_alpha("alpha_x", alpha_x)?,
            alpha_y: check_alpha("alpha_y", alpha_y)?,
        })
    }

    /// Density of normals per unit of macroscopic area, 1/sr; of the whole ellipsoid, even in `m`.
    pub fn D(&self, m: DVec3) -> f64 {
        let in_axes = self.tangent_from_axes.transpose() * m;
        // |A^T m|^2.
        let squared = (in_axes / DVec3::new(self.alpha_x, self.alpha_y, 1.0)).length_squared();
        let determinant = 1.0 / (self.alpha_x * self.alpha_y);
        determinant / (PI * self.shadow(DVec3::Z).length() * squared * squared)
    }

    /// Area that the whole ellipsoid covers, seen along `v`, per unit of macroscopic area: |A^-1 v| / |A^-1 n|.
    pub fn projected_area(&self, v: DVec3) -> f64 {
        self.shadow(v).length() / self.shadow(DVec3::Z).length()
    }

    /// N: the vector area of the facets that face upward, per unit of macroscopic area. (0, 0, 1) without a lean.
    pub fn mean_normal(&self) -> DVec3 {
        let shadow = self.shadow(DVec3::Z);
        // A^-T = R S^-1.
        let stretched = shadow * DVec3::new(self.alpha_x, self.alpha_y, 1.0);
        self.tangent_from_axes * stretched / shadow.length_squared()
    }

    /// The unit normal that most facets are near to.
    pub fn predominant_normal(&self) -> DVec3 {
        self.tangent_from_axes.z_axis
    }

    /// `(alpha_x, alpha_y)`.
    pub fn alphas(&self) -> (f64, f64) {
        (self.alpha_x, self.alpha_y)
    }

    /// Smith's Lambda (Heitz 2014, equation 31, reads G1 = 1 / (1 + Lambda)): the area of facets that face away from `v`
    /// per unit of area seen. `v.z` in (0, 1].
    ///
    /// Facets of the upper half that face `v` cover (projected_area + v.N) / 2: their area and that of those that face
    /// away add up to the ellipsoid's shadow and differ by v.N. Risers that face `v` come on top.
    pub fn Lambda(&self, v: DVec3) -> f64 {
        let mean = self.mean_normal();
        let facing = 0.5 * (self.projected_area(v) + v.dot(mean));
        let risers = v.dot(DVec3::Z - mean).max(0.0);
        (facing + risers) / v.z - 1.0
    }

    /// A^-1 v, in the axes of the ellipsoid.
    fn shadow(&self, v: DVec3) -> DVec3 {
        self.tangent_from_axes.transpose() * v * DVec3::new(self.alpha_x, self.alpha_y, 1.0)
    }
}

/// Alpha along one axis. Above 1 because Burley's aspect stretches it by up to sqrt(10).
pub(super) fn check_alpha(parameter: &'static str, alpha: f64) -> Result<f64, ParameterError> {
    ParameterError::check(parameter, alpha, 1e-4..=4.0, "from 1e-4 to 4")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn without_a_lean_it_is_anisotropic_ggx() {
        let ellipsoid = Ellipsoid::new(0.2, 0.7, 0.0, 0.0, 1.3).unwrap();
        for (x, y, z) in [(0.0, 0.0, 1.0), (0.6, 0.0, 0.8), (-0.48, 0.64, 0.6)] {
            let m = DVec3::new(x, y, z);
            let expected = super::super::distribution::D_GGX_anisotropic(0.2, 0.7, x, y, z);
            assert!((ellipsoid.D(m) / expected - 1.0).abs() < 1e-13, "{m}");
        }
        assert!((ellipsoid.mean_normal() - DVec3::Z).length() < 1e-15);
        let v = DVec3::new(0.6, 0.0, 0.8);
        let Lambda = ((1.0 + (0.2_f64 * 0.6 / 0.8).powi(2)).sqrt() - 1.0) / 2.0;
        assert!((ellipsoid.Lambda(v) - Lambda).abs() < 1e-14);
    }

    #[test]
    fn the_predominant_normal_leans_where_it_is_told_to() {
        let ellipsoid = Ellipsoid::new(0.3, 0.1, 0.4, 0.5, 2.0).unwrap();
        let expected = DVec3::new(0.5_f64.sin() * 2.0_f64.cos(), 0.5_f64.sin() * 2.0_f64.sin(), 0.5_f64.cos());
        assert!((ellipsoid.predominant_normal() - expected).length() < 1e-15);
        assert!(ellipsoid.D(expected) > ellipsoid.D(DVec3::Z));
        assert!((ellipsoid.mean_normal().z - 1.0).abs() < 1e-14);
    }

    #[test]
    fn facets_that_face_away_are_never_fewer_than_none() {
        let ellipsoid = Ellipsoid::new(0.4, 0.1, 0.3, 0.8, 0.0).unwrap();
        for i in 0..500 {
            let z = 0.002 + 0.998 * (0.754_877 * f64::from(i)).fract();
            let (sin, cos) = (0.569_84 * f64::from(i) * std::f64::consts::TAU).sin_cos();
            let v = DVec3::new((1.0 - z * z).sqrt() * cos, (1.0 - z * z).sqrt() * sin, z);
            assert!(ellipsoid.Lambda(v) >= -1e-12, "{v}: {}", ellipsoid.Lambda(v));
        }
    }

    #[test]
    fn bad_parameters_are_named() {
        let parameter = |result: Result<Ellipsoid, ParameterError>| result.unwrap_err().parameter;
        assert_eq!(parameter(Ellipsoid::new(0.0, 0.1, 0.0, 0.0, 0.0)), "alpha_x");
        assert_eq!(parameter(Ellipsoid::new(0.1, f64::NAN, 0.0, 0.0, 0.0)), "alpha_y");
        assert_eq!(parameter(Ellipsoid::new(0.1, 0.1, f64::INFINITY, 0.0, 0.0)), "rotation_rad");
        assert_eq!(parameter(Ellipsoid::new(0.1, 0.1, 0.0, 1.6, 0.0)), "tilt_rad");
        assert_eq!(parameter(Ellipsoid::new(0.1, 0.1, 0.0, 0.1, f64::NAN)), "tilt_azimuth_rad");
    }
}
