//! The cone of a spot light, and how much light it holds.

use crate::radiometry::{RadiometryError, SolidAngle};
use std::f64::consts::{FRAC_PI_2, TAU};

/// Inner and outer cones closer than this, as cosines, count as this far apart (docs/model.md, "Lights").
const FALLOFF_WIDTH_MIN: f64 = 1e-3;

/// Half angles of a spot light, radians: full intensity inside the inner cone, none outside the outer one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpotCone {
    inner_rad: f64,
    outer_rad: f64,
}

impl SpotCone {
    /// 0 <= inner <= outer <= pi/2 and outer > 0 (KHR_lights_punctual, "Inner and Outer Cone Angles").
    pub fn new(inner_rad: f64, outer_rad: f64) -> Result<Self, RadiometryError> {
        let outer_in_domain = outer_rad > 0.0 && outer_rad <= FRAC_PI_2;
        RadiometryError::check(
            outer_in_domain,
            "outer cone angle",
            outer_rad,
            "an angle above 0 and up to pi/2, in rad",
        )?;
        let inner_in_domain = (0.0..=outer_rad).contains(&inner_rad);
        RadiometryError::check(
            inner_in_domain,
            "inner cone angle",
            inner_rad,
            "an angle from 0 to the outer one, in rad",
        )?;
        Ok(Self { inner_rad, outer_rad })
    }

    pub fn inner_rad(self) -> f64 {
        self.inner_rad
    }

    pub fn outer_rad(self) -> f64 {
        self.outer_rad
    }

    /// The solid angle that would hold the same flux at full intensity: the integral of the fall-off over the sphere.
    ///
    /// With x = cos - cos_outer the fall-off is min(x / w, 1)^2, w = max(1e-3, cos_inner - cos_outer), and x runs up to
    /// X = 1 - cos_outer: 2 pi (X - 2 w / 3), or 2 pi X^3 / (3 w^2) for a cone so narrow that it never gets to 1.
    pub fn effective_solid_angle(self) -> SolidAngle {
        // 1 - cos by the half angle, which keeps the digits of narrow cones.
        let one_minus_cos = |angle_rad: f64| 2.0 * (0.5 * angle_rad).sin().powi(2);
        let reach = one_minus_cos(self.outer_rad);
        let width = (reach - one_minus_cos(self.inner_rad)).max(FALLOFF_WIDTH_MIN);
        let integral = if reach >= width { reach - 2.0 / 3.0 * width } else { reach.powi(3) / (3.0 * width * width) };
        SolidAngle::raw(TAU * integral)
    }
}
