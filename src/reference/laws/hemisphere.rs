//! Integrals over directions of what is concentrated about an axis, as rectangles for adaptive quadrature.
//!
//! Directions are (theta, phi) about the axis. theta = alpha sinh(s) gives each factor of e between alpha and 1 the same
//! share of s, so that a lobe of any width and the diffuse light around it are equally easy. The limits of phi follow the
//! edge of the domain in closed form; the ranges of theta where an edge begins and ends are substituted flat.

#![expect(non_snake_case, reason = "equations keep the symbols of their papers")]

use super::brdf::Lobe;
use crate::math::quadrature::adaptive::{Accuracy, Estimate, Integrable, Rectangle, integrate_rectangles};
use crate::math::spaces::orthonormal_basis;
use glam::{DMat3, DVec3};
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};

/// Directions about an axis, with a width of what happens around it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Polar {
    /// Columns: where phi = 0, where phi = 90 degrees, the axis.
    frame: DMat3,
    alpha: f64,
    aspect: f64,
}

impl Polar {
    /// phi = 0 is toward `reference`, as far as it is not along the axis.
    fn new(lobe: Lobe, reference: DVec3) -> Self {
        let Lobe { axis, alpha, aspect } = lobe;
        let toward = reference.reject_from_normalized(axis);
        let x = toward.try_normalize().unwrap_or_else(|| orthonormal_basis(axis).0);
        Self { frame: DMat3::from_cols(x, axis.cross(x), axis), alpha, aspect }
    }

    /// The same about the opposite axis.
    fn opposite(self) -> Self {
        Self { frame: DMat3::from_cols(self.frame.x_axis, -self.frame.y_axis, -self.frame.z_axis), ..self }
    }

    /// Integral of `f` over theta in consecutive `ranges` and |phi| below `phi_max(theta)`, or only phi above 0, twice,
    /// when `symmetric`.
    fn integrate<T: Integrable>(
        &self,
        ranges: &[[f64; 2]],
        phi_max: impl Fn(f64) -> f64,
        symmetric: bool,
        accuracy: Accuracy,
        f: impl Fn(DVec3) -> T,
    ) -> Estimate<T> {
        // Across a lobe that is `aspect` times as long as wide, a rule with too few cells all around would miss its flanks, and its
        // error with them.
        let cells = if symmetric { 1 } else { self.aspect.ceil().clamp(4.0, 64.0) as usize };
        let edge = |j: usize| if symmetric { j as f64 } else { 2.0 * j as f64 / cells as f64 - 1.0 };
        // The range is the integer part of x.
        let cell = |i: usize, j: usize| Rectangle { x: [i as f64, i as f64 + 1.0], y: [edge(j), edge(j + 1)] };
        let rectangles: Vec<Rectangle> = (0..ranges.len())
            .filter(|&i| ranges[i][1] > ranges[i][0])
            .flat_map(|i| (0..cells).map(move |j| cell(i, j)))
            .collect();
        let weight = if symmetric { 2.0 } else { 1.0 };
        integrate_rectangles(&rectangles, accuracy, |x, y| {
            let [from, to] = ranges[(x as usize).min(ranges.len() - 1)].map(|theta| (theta / self.alpha).asinh());
            let t = x.fract();
            let s = from + (to - from) * t * t * t * (10.0 - 15.0 * t + 6.0 * t * t);
            let ds_dt = (to - from) * 30.0 * (t * (1.0 - t)).powi(2);
            let theta = self.alpha * s.sinh();
            let last = phi_max(theta);
            let (sin_theta, cos_theta) = theta.sin_cos();
            let (sin_phi, cos_phi) = (last * y).sin_cos();
            let direction = self.frame * DVec3::new(sin_theta * cos_phi, sin_theta * sin_phi, cos_theta);
            f(direction) * (weight * self.alpha * s.cosh() * ds_dt * last * sin_theta)
        })
    }

    /// Integral of `f` over the directions that are less than 90 degrees from `pole`.
    pub(super) fn over_hemisphere<T: Integrable>(
        lobe: Lobe,
        pole: DVec3,
        accuracy: Accuracy,
        f: impl Fn(DVec3) -> T,
    ) -> Estimate<T> {
        let polar = Self::new(lobe, pole);
        let half = |polar: Self| {
            // The angle between the axis and the pole.
            let tilt = polar.frame.z_axis.cross(pole).length().atan2(polar.frame.z_axis.dot(pole));
            let edge = (FRAC_PI_2 - tilt).abs();
            let phi_max = |theta: f64| {
                if theta < edge {
                    return if tilt < FRAC_PI_2 { PI } else { 0.0 };
                }
                // cos(theta) cos(tilt) + sin(theta) sin(tilt) cos(phi) > 0.
                (-theta.cos() * tilt.cos() / (theta.sin() * tilt.sin())).clamp(-1.0, 1.0).acos()
            };
            polar.integrate(&[[0.0, edge], [edge, FRAC_PI_2]], phi_max, false, accuracy, &f)
        };
        let (near, far) = (half(polar), half(polar.opposite()));
        Estimate {
            value: near.value + far.value,
            error: near.error + far.error,
            evaluations: near.evaluations + far.evaluations,
        }
    }

    /// Integral over the light's directions above the horizon of `f(l)`, for the view `v`, by way of the half vector:
    /// dl = 4 (v.h) dh. `symmetric` when `f` is the same on both sides of the plane of incidence.
    pub(super) fn over_light<T: Integrable>(
        lobe: Lobe,
        v: DVec3,
        symmetric: bool,
        accuracy: Accuracy,
        f: impl Fn(DVec3) -> T,
    ) -> Estimate<T> {
        let integrand = |h: DVec3| {
            let VoH = v.dot(h);
            let l = 2.0 * VoH * h - v;
            if l.z > 0.0 && VoH > 0.0 { f(l) * (4.0 * VoH) } else { T::ZERO }
        };
        let polar = Self::new(lobe, v);
        if lobe.axis != DVec3::Z {
            // No closed form for the light's horizon; its bend is left to the adaptive quadrature.
            let lean = lobe.axis.z.clamp(-1.0, 1.0).acos();
            let ranges = [[0.0, FRAC_PI_2 - lean], [FRAC_PI_2 - lean, (FRAC_PI_2 + lean).min(PI)]];
            return polar.integrate(&ranges, |_| PI, false, accuracy, integrand);
        }
        let sin_v = v.x.hypot(v.y);
        let theta_v = sin_v.atan2(v.z);
        // Up to `whole` every azimuth reflects upwards; at `end` none is left.
        let (whole, end) = (FRAC_PI_4 - 0.5 * theta_v, FRAC_PI_4 + 0.5 * theta_v);
        let phi_max = |theta: f64| {
            if theta <= whole {
                return PI;
            }
            // n.l = 2 (v.h) (n.h) - n.v > 0, solved for the azimuth.
            (-v.z * (2.0 * theta).cos() / (sin_v * (2.0 * theta).sin())).clamp(-1.0, 1.0).acos()
        };
        polar.integrate(&[[0.0, whole], [whole, end]], phi_max, symmetric, accuracy, integrand)
    }
}
