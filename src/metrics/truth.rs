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

/// Mean squares over pixels and channels of relative errors.
///
/// A difference counts relative to the radiance of its pixel, the mean of the channels: that of the truth, or of the picture
/// where it is brighter, and no less than a floor. Over the radiance of the whole picture instead, a few pixels that mirror
/// the sun would outweigh all others.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct RelativeError {
    /// Of the difference from the truth, the truth's own noise taken out. Below zero by chance.
    excess: f64,
    /// Standard deviation of the excess.
    uncertainty: f64,
    /// Of the truth's noise.
    noise: f64,
}

impl RelativeError {
    /// Compares `actual`, which has no noise, over the pixels that count. Errors are relative to `scale`, and to no less than
    /// `floor_nits`. The pictures have one size. Without a pixel that counts there is no error.
    ///
    /// With truth T + e and E[e^2] = s^2, E[(A - T - e)^2] = (A - T)^2 + s^2, so that subtracting s^2 leaves the error
    /// alone. Its variance for normal e is 4 (A - T)^2 s^2 + 2 s^4, and 2 s^4 / n more for an s^2 estimated with n
    /// degrees of freedom.
    pub fn of(
        actual: &RadianceImage,
        truth: &EstimatedTruth<'_>,
        (scale, floor_nits): (&RadianceImage, f64),
        counts: impl Fn(usize) -> bool,
    ) -> Self {
        let (mut sums, mut variance, mut count) = (Self::default(), 0.0, 0.0);
        let color = |image: &RadianceImage, i: usize| image.texels[i].truncate().as_dvec3();
        for i in (0..actual.texels.len()).filter(|&i| counts(i)) {
            let [actual, scale] = [actual, scale].map(|image| color(image, i));
            let [expected, error] = [truth.radiance, truth.standard_error].map(|image| color(image, i));
            let per_nit = 1.0 / gray(scale).max(gray(actual)).max(floor_nits);
            let noise = (error * per_nit) * (error * per_nit);
            let difference = (actual - expected) * per_nit;
            let excess = difference * difference - noise;
            sums.excess += excess.element_sum();
            sums.noise += noise.element_sum();
            let of_error = 4.0 * excess.max(DVec3::ZERO) * noise;
            let of_noise = noise * noise * (2.0 + 2.0 / truth.degrees_of_freedom);
            variance += (of_error + of_noise).element_sum();
            count += 3.0;
        }
        let count = f64::max(count, 1.0);
        Self { excess: sums.excess / count, uncertainty: variance.sqrt() / count, noise: sums.noise / count }
    }

    /// Root mean square of the relative error; 0 where noise covers it.
    pub fn rms(&self) -> f64 {
        self.excess.max(0.0).sqrt()
    }

    /// Root mean square of the relative noise of the truth.
    pub fn noise_rms(&self) -> f64 {
        self.noise.sqrt()
    }

    /// The smallest error that would show: two standard deviations above none.
    pub fn smallest_visible(&self) -> f64 {
        (2.0 * self.uncertainty).sqrt()
    }

    /// Whether there is an error beyond the truth's noise, at two standard deviations.
    pub fn is_visible(&self) -> bool {
        self.excess > 2.0 * self.uncertainty
    }

    /// The error or, where it does not show, the smallest one that would: a bound from above.
    pub fn upper(&self) -> f64 {
        if self.is_visible() { self.rms() } else { self.smallest_visible() }
    }
}

fn gray(color: DVec3) -> f64 {
    color.element_sum() / 3.0
}

/// The median radiance of the pixels that count, the mean of the channels; 1 where it is black, cd/m2.
pub fn median_nits(image: &RadianceImage, counts: impl Fn(usize) -> bool) -> f64 {
    let texels = image.texels.iter().enumerate().filter(|(i, _)| counts(*i));
    let mut values: Vec<f64> = texels.map(|(_, texel)| gray(texel.truncate().as_dvec3())).collect();
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().filter(|median| *median > 0.0).unwrap_or(1.0)
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

    fn compare(actual: f32, amplitude: f32) -> RelativeError {
        let (radiance, standard_error) = truth(amplitude);
        let degrees_of_freedom = f64::from(REPLICATES - 1);
        let truth = EstimatedTruth { radiance: &radiance, standard_error: &standard_error, degrees_of_freedom };
        RelativeError::of(&image(|_| actual), &truth, (&image(|_| 2.0), 0.0), |_| true)
    }

    #[test]
    fn an_error_below_the_noise_is_found_without_the_noise() {
        // The noise of the mean is 0.3 / sqrt(3 * 8) / 2 = 3 %, three times the error.
        let found = compare(2.02, 0.3);
        assert!((found.rms() - 0.01).abs() < 0.002, "{found:?}");
        assert!((found.noise_rms() - 0.0306).abs() < 0.0015, "{found:?}");
        assert!(found.is_visible() && found.smallest_visible() < 0.01, "{found:?}");
        assert_eq!(found.upper(), found.rms());
    }

    #[test]
    fn noise_alone_is_no_error() {
        let found = compare(2.0, 0.3);
        assert!(!found.is_visible(), "{found:?}");
        assert!(found.excess.abs() < 3.0 * found.uncertainty, "{found:?}");
        assert_eq!(found.upper(), found.smallest_visible());
    }

    #[test]
    fn pixels_count_alike_however_bright_they_are() {
        let exact = image(|_| 0.0);
        let truth_image = image(|i| if i == 0 { 1e5 } else { 1.0 });
        let truth = EstimatedTruth { radiance: &truth_image, standard_error: &exact, degrees_of_freedom: 7.0 };
        let actual = image(|i| if i == 0 { 0.5e5 } else { 1.0 });
        let error =
            |floor, counts: fn(usize) -> bool| RelativeError::of(&actual, &truth, (&truth_image, floor), counts).rms();
        assert!((error(0.0, |_| true) - 0.5 / f64::from(SIDE)).abs() < 1e-12);
        assert!((error(0.0, |i| i == 0) - 0.5).abs() < 1e-12);
        assert!((error(1e6, |i| i == 0) - 0.05).abs() < 1e-12);
        assert_eq!((error(0.0, |i| i != 0), error(0.0, |_| false)), (0.0, 0.0));
        assert_eq!(median_nits(&truth_image, |_| true), 1.0);
    }
}
