//! Pictures as a handful of numbers that tell how far two of them are apart.
//!
//! Alon, Matias and Szegedy 1996, "The Space Complexity of Approximating the Frequency Moments": the sum of all values,
//! each under a random sign, has a square whose expectation is the sum of the squares. Sums are linear, so that the sums of
//! two pictures differ by the sum of their difference.

use super::Quantity;
use glam::Vec3;

/// Sums of a sketch; the estimate of a square is off by a factor of 1 +- sqrt(2 / SUMS), one standard deviation.
pub(super) const SUMS: usize = 16;

/// First two moments and signed sums of vectors, one a pixel.
#[derive(Debug, Clone, Default)]
pub(super) struct Sketch {
    count: u32,
    sum: [f64; 3],
    squares: [f64; 3],
    signed: [f64; SUMS],
}

impl Sketch {
    /// Adds the value of the pixel with a number.
    pub(super) fn add(&mut self, pixel: usize, value: Vec3) {
        self.count += 1;
        for (axis, value) in value.to_array().into_iter().map(f64::from).enumerate() {
            self.sum[axis] += value;
            self.squares[axis] += value * value;
            let signs = scramble((3 * pixel + axis) as u64);
            for (k, signed) in self.signed.iter_mut().enumerate() {
                *signed += if signs >> k & 1 == 0 { value } else { -value };
            }
        }
    }

    /// Whether all values are the same, but for rounding. Then the moments say it all.
    pub(super) fn is_constant(&self) -> bool {
        let size = self.squares.iter().sum::<f64>() / f64::from(self.count.max(1));
        self.spread().iter().map(|spread| spread * spread).sum::<f64>() <= 1e-9 * size
    }

    pub(super) fn mean(&self) -> [f64; 3] {
        self.sum.map(|sum| sum / f64::from(self.count.max(1)))
    }

    /// Standard deviation.
    pub(super) fn spread(&self) -> [f64; 3] {
        let (mean, count) = (self.mean(), f64::from(self.count.max(1)));
        std::array::from_fn(|axis| (self.squares[axis] / count - mean[axis] * mean[axis]).max(0.0).sqrt())
    }

    /// The signed sums; none of what is the same everywhere.
    pub(super) fn sums(&self) -> Option<[f64; SUMS]> {
        (!self.is_constant()).then_some(self.signed)
    }
}

/// Root mean square of the difference of two quantities over the same `pixels`: exact where one of them is the same
/// everywhere, otherwise an estimate.
pub(super) fn distance(a: &Quantity, b: &Quantity, pixels: u32) -> f64 {
    let squares = if let (Some(a), Some(b)) = (&a.sketch, &b.sketch) {
        let squares: f64 = a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum();
        squares / SUMS as f64 / f64::from(pixels.max(1))
    } else {
        let means = a.mean.iter().zip(b.mean).map(|(a, b)| (a - b) * (a - b));
        let varying = if a.sketch.is_none() { b } else { a };
        means.chain(varying.spread.map(|spread| spread * spread)).sum()
    };
    squares.sqrt()
}

/// The finaliser of SplitMix64 (Steele, Lea and Flood 2014), a bijection that leaves no pattern in its low bits.
fn scramble(number: u64) -> u64 {
    let mut z = number.wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// The first digits of the BLAKE3 of something.
pub(in crate::cli::test) fn content_hash(bytes: &[u8]) -> String {
    blake3::hash(bytes).to_hex()[..16].to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    const PIXELS: u32 = 4096;

    fn quantity(picture: impl Fn(usize) -> Vec3) -> Quantity {
        quantity_from(0, picture)
    }

    /// The same under other signs: those of pixels from a number on.
    fn quantity_from(first: usize, picture: impl Fn(usize) -> Vec3) -> Quantity {
        let mut sketch = Sketch::default();
        (0..PIXELS as usize).for_each(|pixel| sketch.add(first + pixel, picture(pixel)));
        Quantity { name: String::new(), mean: sketch.mean(), spread: sketch.spread(), sketch: sketch.sums() }
    }

    fn checker(pixel: usize, odd: bool) -> Vec3 {
        Vec3::new(if (pixel / 8 + pixel / 512).is_multiple_of(2) == odd { 0.2 } else { 0.8 }, 0.5, 0.1)
    }

    #[test]
    fn distances_are_estimated_whatever_the_pictures_are() {
        let pictures: [&dyn Fn(usize) -> Vec3; 6] = [
            &|pixel| checker(pixel, false),
            &|pixel| checker(pixel, true),
            &|_| Vec3::splat(0.3),
            &|_| Vec3::new(0.0, 0.1, 0.9),
            &|pixel| Vec3::splat(pixel as f32 / PIXELS as f32),
            // One pixel in a hundred.
            &|pixel| checker(pixel, false) + Vec3::splat(if pixel % 100 == 7 { 0.3 } else { 0.0 }),
        ];
        let truth = |a: &dyn Fn(usize) -> Vec3, b: &dyn Fn(usize) -> Vec3| {
            let squares = (0..PIXELS as usize).map(|pixel| (a(pixel) - b(pixel)).as_dvec3().length_squared());
            (squares.sum::<f64>() / f64::from(PIXELS)).sqrt()
        };
        const SIGNS: usize = 16;
        for (i, a) in pictures.iter().enumerate() {
            for (j, b) in pictures.iter().enumerate() {
                let squared = |k: usize| {
                    let [a, b] = [a, b].map(|picture| quantity_from(k * PIXELS as usize, picture));
                    distance(&a, &b, PIXELS).powi(2)
                };
                let estimate = (0..SIGNS).map(squared).sum::<f64>() / SIGNS as f64;
                let truth = truth(a, b).powi(2);
                let is_exact = [i, j].iter().any(|place| [2, 3].contains(place)) || i == j;
                // Three standard deviations.
                let allowed = if is_exact { 1e-5 } else { 3.0 * (2.0 / (SUMS * SIGNS) as f64).sqrt() };
                let error = (estimate - truth).abs();
                assert!(error <= allowed * truth + 1e-12, "{i} {j}: {estimate} instead of {truth}");
            }
        }
    }

    #[test]
    fn a_swapped_checker_has_the_moments_of_the_other() {
        let [a, b] = [false, true].map(|odd| quantity(|pixel| checker(pixel, odd)));
        for axis in 0..3 {
            assert!((a.mean[axis] - b.mean[axis]).abs() < 1e-9);
            assert!((a.spread[axis] - b.spread[axis]).abs() < 1e-9);
        }
        assert!((a.spread[0] - 0.3).abs() < 1e-6 && a.spread[1] < 1e-6);
        assert!(distance(&a, &b, PIXELS) > 0.3);
    }
}
