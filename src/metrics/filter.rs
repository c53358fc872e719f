//! Separable filters over planes of numbers.

use crate::threads::*;

/// One number a pixel, row by row from the top left.
#[derive(Debug, Clone)]
pub(super) struct Plane {
    pub(super) width: usize,
    pub(super) values: Vec<f64>,
}

impl Plane {
    pub(super) fn height(&self) -> usize {
        self.values.len() / self.width
    }

    /// Correlates rows with `horizontal` and then columns with `vertical`, both of odd length and centred. Beyond its
    /// borders the plane continues as its last pixel.
    pub(super) fn filtered(&self, horizontal: &[f64], vertical: &[f64]) -> Self {
        let (width, height) = (self.width, self.height());
        let mut rows = vec![0.0; self.values.len()];
        rows.par_chunks_mut(width).zip(self.values.par_chunks(width)).for_each(|(out, row)| {
            for (x, out) in out.iter_mut().enumerate() {
                *out = (0..horizontal.len()).map(|tap| horizontal[tap] * row[tap_at(x, tap, horizontal, width)]).sum();
            }
        });
        let mut values = vec![0.0; self.values.len()];
        values.par_chunks_mut(width).enumerate().for_each(|(y, out)| {
            for (tap, weight) in vertical.iter().enumerate() {
                let start = tap_at(y, tap, vertical, height) * width;
                for (out, value) in out.iter_mut().zip(&rows[start..start + width]) {
                    *out += weight * value;
                }
            }
        });
        Self { width, values }
    }
}

/// Where a tap of the filter lies that is centred on `at`.
fn tap_at(at: usize, tap: usize, filter: &[f64], length: usize) -> usize {
    (at + tap).saturating_sub(filter.len() / 2).min(length - 1)
}

/// `f(offset)` for offsets from `-radius` to `radius`.
pub(super) fn taps(radius: usize, f: impl Fn(f64) -> f64) -> Vec<f64> {
    (0..=2 * radius).map(|tap| f(tap as f64 - radius as f64)).collect()
}

/// Scales the filter so that its taps sum to 1.
pub(super) fn normalized(mut filter: Vec<f64>) -> Vec<f64> {
    let sum: f64 = filter.iter().sum();
    filter.iter_mut().for_each(|tap| *tap /= sum);
    filter
}
