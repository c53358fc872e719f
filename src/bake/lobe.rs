//! The GGX lobe of prefiltering as a kernel on the sphere.
#![expect(non_snake_case, reason = "D_GGX is the symbol of the paper")]

use super::harmonics::fejer_weights;
use std::f64::consts::PI;

/// Radiance is weighted with `D_GGX(alpha, NoH) NoL` around the normal when n = v = r (Karis 2013, "Real Shading in
/// Unreal Engine 4"): the density NoH D / (4 VoH) of mirrored half vectors, times NoL. A function of `NoL` alone then,
/// up to a constant factor; zero below the horizon. `alpha` above 0.
pub(super) fn prefilter_kernel(alpha: f64, NoL: f64) -> f64 {
    let NoH2 = 0.5 * (1.0 + NoL);
    D_GGX(alpha, NoH2) * NoL.max(0.0)
}

/// Walter et al. 2007, equation 33, of the squared cosine.
fn D_GGX(alpha: f64, NoH2: f64) -> f64 {
    let alpha2 = alpha * alpha;
    alpha2 / (PI * (NoH2 * (alpha2 - 1.0) + 1.0).powi(2))
}

/// The Legendre coefficients `int_0^1 k(x) P_l(x) dx / int_0^1 k(x) dx` of [`prefilter_kernel`] for l below `degrees`:
/// what the convolution with it multiplies a harmonic of degree l with.
pub(super) fn legendre_coefficients(alpha: f64, degrees: usize) -> Vec<f64> {
    // Fejer's rule on [0, 1] alone leaves the kink of the kernel at 0 out. The pole of D lies 2 alpha^2 beyond 1, for
    // which 1024 nodes leave an error of about e^(-4 alpha 1024).
    let weights = fejer_weights(1024);
    let mut sums = vec![0.0; degrees];
    for (j, weight) in weights.iter().enumerate() {
        let x = 0.5 * (1.0 + ((j as f64 + 0.5) * PI / weights.len() as f64).cos());
        let value = weight * prefilter_kernel(alpha, x);
        let (mut previous, mut current) = (0.0, 1.0);
        for (degree, sum) in sums.iter_mut().enumerate() {
            *sum += value * current;
            let l = degree as f64;
            (previous, current) = (current, ((2.0 * l + 1.0) * x * current - l * previous) / (l + 1.0));
        }
    }
    let total = sums[0];
    sums.iter().map(|sum| sum / total).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn at_alpha_1_the_lobe_is_the_clamped_cosine() {
        // Ramamoorthi and Hanrahan 2001: 1, 2/3, 1/4, 0, -1/24.
        let coefficients = legendre_coefficients(1.0, 5);
        for (got, expected) in coefficients.iter().zip([1.0, 2.0 / 3.0, 0.25, 0.0, -1.0 / 24.0]) {
            assert!((got - expected).abs() < 1e-13, "{coefficients:?}");
        }
    }

    #[test]
    fn narrow_lobes_keep_high_degrees() {
        // The pole of D in the complex plane makes the coefficients fall about as e^(-2 alpha l).
        let coefficients = legendre_coefficients(1.0 / 64.0, 512);
        assert!(coefficients[32] > 0.5 && coefficients[511] < 1e-5, "{} {}", coefficients[32], coefficients[511]);
    }
}
