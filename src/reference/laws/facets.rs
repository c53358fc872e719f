//! Facets cover the surface that they make up, seen from anywhere.

use super::brdf::Lobe;
use super::exceeds;
use super::hemisphere::Polar;
use crate::math::quadrature::adaptive::{Accuracy, Estimate};
use crate::reference::microfacet::Distribution;
use glam::DVec3;
use std::f64::consts::TAU;

/// How far a distribution is from its normalisation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FacetReport {
    /// Largest difference, over all directions tried, between int D(m) (v.m) dm over the upper hemisphere and v.N
    /// ([`Distribution::mean_normal`]; v.n but for a leaning ellipsoid), and between int D(m) <v.m> dm over the sphere and
    /// the ellipsoid's shadow. Relative to the macroscopic area.
    pub difference: f64,
    /// Where it is.
    pub v: DVec3,
    /// Estimated error of the integrals there.
    pub error: f64,
}

/// int D(m) (v.m) dm over the normals above the horizon.
pub(super) fn signed_area(distribution: &Distribution, v: DVec3, accuracy: Accuracy) -> Estimate<f64> {
    integrate(distribution, DVec3::Z, v, accuracy)
}

/// int D(m) <v.m> dm over all normals of the ellipsoid, those below the horizon too.
pub(super) fn projected_area(distribution: &Distribution, v: DVec3, accuracy: Accuracy) -> Estimate<f64> {
    integrate(distribution, v, v, accuracy)
}

fn integrate(distribution: &Distribution, pole: DVec3, v: DVec3, accuracy: Accuracy) -> Estimate<f64> {
    Polar::over_hemisphere(Lobe::of(distribution), pole, accuracy, |m| distribution.D(m) * v.dot(m))
}

/// Checks both integrals for views from above to grazing, all around.
pub fn check_facets(distribution: &Distribution, accuracy: Accuracy) -> FacetReport {
    let mean = distribution.mean_normal();
    let mut worst = FacetReport { difference: 0.0, v: DVec3::Z, error: 0.0 };
    for i in 0..6_u32 {
        for j in 0..if distribution.is_isotropic() { 1 } else { 5_u32 } {
            let cos = (1.0 - f64::from(i) / 5.0).max(1e-3);
            // Turned from one ring to the next: no direction is along an axis twice.
            let phi = TAU * (f64::from(j) / 5.0 + 0.07 * f64::from(i));
            let sin = (1.0 - cos * cos).sqrt();
            let v = DVec3::new(sin * phi.cos(), sin * phi.sin(), cos);
            let signed = (signed_area(distribution, v, accuracy), v.dot(mean));
            let shadow = (projected_area(distribution, v, accuracy), distribution.projected_area(v));
            for (found, expected) in [signed, shadow] {
                let difference = (found.value - expected).abs();
                if exceeds(difference, worst.difference) {
                    worst = FacetReport { difference, v, error: found.error };
                }
            }
        }
    }
    worst
}
