//! Errors against a truth that is itself estimated by sampling.

use crate::scene::RadianceImage;
use glam::DVec3;

/// A picture of the truth with the standard error of every channel of every pixel.
#[derive(Debug, Clone, Copy)]
pub struct EstimatedTruth<'a> {
    /// Linear radiance, cd/m2, multiplied with the coverage.
    pub radiance: &'a RadianceImage,
    /// In the same units, independent from pixel to pixel.
    pub standard_error: &'a RadianceImage,
    /// Of the standard errors: one less than the number of pictures that they were estimated from.
    pub degrees_of_freedom: f64,
}

/// Sums of squares over the three channels of the pixels that count, (cd/m2)^2.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SquaredError {
    /// Of the difference from the truth, the truth's own noise taken out. Below zero by chance.
    pub excess: f64,
    /// Standard deviation of [`Self::excess`].
    pub uncertainty: f64,
    /// Of the truth, its noise taken out.
    pub power: f64,
    /// Of the truth's noise.
    pub noise: f64,
}

impl SquaredError {
    /// Compares `actual`, which has no noise, over the pixels that count. The pictures have one size.
    ///
    /// With truth T + e and E[e^2] = s^2, E[(A - T - e)^2] = (A - T)^2 + s^2, so that subtracting s^2 leaves the error
    /// alone. Its variance for normal e is 4 (A - T)^2 s^2 + 2 s^4, and 2 s^4 / n more for an s^2 estimated with n
    /// degrees of freedom.
    pub fn of(actual: &RadianceImage, truth: &EstimatedTruth<'_>, counts: impl Fn(usize) -> bool) -> Self {
        let (mut sums, mut variance) = (Self::default(), 0.0);
        let pixels = actual.texels.iter().zip(&truth.radiance.texels).zip(&truth.standard_error.texels).enumerate();
        for (_, ((actual, expected), error)) in pixels.filter(|(index, _)| counts(*index)) {
            let [actual, expected, error] = [actual, expected, error].map(|texel| texel.truncate().as_dvec3());
            let (noise, excess) = (error * error, (actual - expected) * (actual - expected) - error * error);
            sums.excess += excess.element_sum();
            sums.noise += noise.element_sum();
            sums.power += (expected * expected - noise).element_sum();
            let of_error = 4.0 * excess.max(DVec3::ZERO) * noise;
            let of_noise = noise * noise * (2.0 + 2.0 / truth.degrees_of_freedom);
            variance += (of_error + of_noise).element_sum();
        }
        sums.uncertainty = variance.sqrt();
        sums
    }

    /// Root mean square error over root mean square of a truth of that `power`; `None` where that is black.
    pub fn relative_to(&self, power: f64) -> Option<f64> {
        (power > 0.0).then(|| (self.excess.max(0.0) / power).sqrt())
    }

    /// The relative error or, where it does not show, the smallest one that would: a bound from above.
    pub fn upper_relative_to(&self, power: f64) -> Option<f64> {
        if self.is_visible() { self.relative_to(power) } else { self.smallest_visible(power) }
    }

    /// Root mean square noise of the truth over its root mean square.
    pub fn noise_relative_to(&self, power: f64) -> Option<f64> {
        (power > 0.0).then(|| (self.noise / power).sqrt())
    }

    /// The smallest relative error that would show: two standard deviations above none.
    pub fn smallest_visible(&self, power: f64) -> Option<f64> {
        (power > 0.0).then(|| (2.0 * self.uncertainty / power).sqrt())
    }

    /// Whether there is an error beyond the truth's noise, at two standard deviations.
    pub fn is_visible(&self) -> bool {
        self.excess > 2.0 * self.uncertainty
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec4;

    const SIDE: u32 = 64;
    const REPLICATES: u32 = 8;

    fn image(texel: impl Fn(u32) -> f32) -> RadianceImage {
        let texels = (0..SIDE * SIDE).map(|i| Vec4::splat(texel(i)).with_w(1.0)).collect();
        RadianceImage { width: SIDE, height: SIDE, texels }
    }

    /// Even numbers in [-1, 1) from a hash of the index: their variance is 1/3.
    fn noise(index: u32) -> f32 {
        let mut x = index.wrapping_mul(0x9e37_79b9) ^ 0x85eb_ca6b;
        x = (x ^ x >> 16).wrapping_mul(0x7feb_352d);
        x = (x ^ x >> 15).wrapping_mul(0x846c_a68b);
        ((x ^ x >> 16) >> 8) as f32 / (1 << 23) as f32 - 1.0
    }

    /// The mean of several noisy pictures of radiance 2, and its standard error by their spread.
    fn truth(amplitude: f32) -> (RadianceImage, RadianceImage) {
        let values = |pixel: u32| (0..REPLICATES).map(move |r| 2.0 + amplitude * noise(pixel * REPLICATES + r));
        let mean = |pixel: u32| values(pixel).sum::<f32>() / REPLICATES as f32;
        let error = |pixel: u32| {
            let squares: f32 = values(pixel).map(|value| (value - mean(pixel)).powi(2)).sum();
            (squares / (REPLICATES * (REPLICATES - 1)) as f32).sqrt()
        };
        (image(mean), image(error))
    }

    fn compare(actual: f32, amplitude: f32) -> SquaredError {
        let (radiance, standard_error) = truth(amplitude);
        let degrees_of_freedom = f64::from(REPLICATES - 1);
        let truth = EstimatedTruth { radiance: &radiance, standard_error: &standard_error, degrees_of_freedom };
        SquaredError::of(&image(|_| actual), &truth, |_| true)
    }

    #[test]
    fn an_error_below_the_noise_is_found_without_the_noise() {
        // The noise of the mean is 0.3 / sqrt(3 * 8) / 2 = 3 %, three times the error.
        let found = compare(2.02, 0.3);
        let (error, noise) = (found.relative_to(found.power).unwrap(), found.noise_relative_to(found.power).unwrap());
        assert!((error - 0.01).abs() < 0.002, "{error}");
        assert!((noise - 0.0306).abs() < 0.0015, "{noise}");
        assert!(found.is_visible() && found.smallest_visible(found.power).unwrap() < 0.01, "{found:?}");
    }

    #[test]
    fn noise_alone_is_no_error() {
        let found = compare(2.0, 0.3);
        assert!(!found.is_visible(), "{found:?}");
        assert!(found.excess.abs() < 3.0 * found.uncertainty, "{found:?}");
    }

    #[test]
    fn pixels_that_do_not_count_do_not() {
        let black = image(|_| 0.0);
        let truth = EstimatedTruth { radiance: &black, standard_error: &black, degrees_of_freedom: 7.0 };
        let actual = image(|i| if i == 5 { 1.0 } else { 0.0 });
        assert_eq!(SquaredError::of(&actual, &truth, |i| i != 5), SquaredError::default());
        let found = SquaredError::of(&actual, &truth, |_| true);
        assert_eq!((found.excess, found.relative_to(found.power)), (3.0, None));
    }
}
