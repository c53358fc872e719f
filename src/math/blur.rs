//! The lobe through which a blurred background is seen: the one of prefiltered maps, with n = v = r (Karis 2013).
#![expect(non_snake_case, reason = "equations keep the symbols of their papers")]

use glam::{DVec2, DVec3};
use std::f64::consts::{PI, TAU};

/// A direction about +Z, where microfacets of GGX with `alpha` mirror what comes from +Z. `u` in (0, 1)^2.
pub fn sample(alpha: f64, u: DVec2) -> DVec3 {
    // Facets by D NoH (Walter et al. 2007, equation 35); the mirror doubles their angle.
    let NoH2 = (1.0 - u.x) / (1.0 + (alpha * alpha - 1.0) * u.x);
    let NoL = 2.0 * NoH2 - 1.0;
    let sin = 2.0 * (NoH2 * (1.0 - NoH2)).max(0.0).sqrt();
    let (sin_phi, cos_phi) = (TAU * u.y).sin_cos();
    DVec3::new(sin * cos_phi, sin * sin_phi, NoL)
}

/// The density of [`sample`], 1/sr, of directions above the horizon: D NoH / (4 VoH), where both cosines are the same.
pub fn density(alpha: f64, NoL: f64) -> f64 {
    let (alpha2, NoH2) = (alpha * alpha, 0.5 * (1.0 + NoL));
    0.25 * alpha2 / (PI * (NoH2 * (alpha2 - 1.0) + 1.0).powi(2))
}

/// The mean cosine of [`sample`] where that is above 0, for `alpha` in [0, 1]: int max(2 (1 - u) / (1 + k u) - 1, 0) du over [0, 1], with
/// k = alpha^2 - 1. So D_GGX(alpha, NoH) NoL / (4 times this) integrates to 1 over the directions.
pub fn mean_cosine(alpha: f64) -> f64 {
    // The integral is smooth at both ends, its closed form is not.
    let alpha2 = (alpha * alpha).clamp(1e-12, 0.9999);
    let k = alpha2 - 1.0;
    let horizon = 1.0 / (1.0 + alpha2);
    2.0 * (alpha2 / (k * k) * (k * horizon).ln_1p() - horizon / k) - horizon
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mean_cosine_is_that_of_the_samples() {
        for alpha in [0.0, 0.01, 0.3, 0.99, 1.0] {
            let count = 100_000;
            let u = |i: u32| DVec2::new((f64::from(i) + 0.5) / f64::from(count), 0.3);
            let mean = (0..count).map(|i| sample(alpha, u(i)).z.max(0.0)).sum::<f64>() / f64::from(count);
            assert!((mean - mean_cosine(alpha)).abs() < 2e-5, "{alpha}: {mean} {}", mean_cosine(alpha));
        }
        // A cosine, weighted with itself: 1/4 of what 2 cos gives, see Lambert.
        assert!((mean_cosine(1.0) - 0.25).abs() < 1e-4);
        assert!((sample(0.3, DVec2::new(0.4, 0.7)).length() - 1.0).abs() < 1e-12);
    }

    #[test]
    fn the_density_is_that_of_the_samples() {
        for alpha in [0.1, 0.5, 1.0] {
            // The share of samples within a cone, and the density integrated over it.
            let (count, edge) = (100_000, 0.8);
            let within = |i: &u32| sample(alpha, DVec2::new((f64::from(*i) + 0.5) / f64::from(count), 0.3)).z > edge;
            let share = f64::from((0..count).filter(within).count() as u32) / f64::from(count);
            let step = (1.0 - edge) / f64::from(count);
            let integral: f64 = (0..count).map(|i| density(alpha, edge + (f64::from(i) + 0.5) * step)).sum();
            assert!((share - TAU * step * integral).abs() < 1e-4, "{alpha}: {share} {}", TAU * step * integral);
        }
    }
}
