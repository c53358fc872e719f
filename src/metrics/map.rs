//! An error for each pixel, and what it comes to.

use super::pair::Pair;

/// An error for each pixel.
#[derive(Debug, Clone, PartialEq)]
pub struct ErrorMap {
    pub width: u32,
    pub height: u32,
    /// `width * height`, from the top left.
    pub values: Vec<f64>,
}

/// The distribution of an [`ErrorMap`] over the pixels that count.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pool {
    pub mean: f64,
    /// The smallest error that at least half of the pixels do not exceed.
    pub median: f64,
    /// The smallest error that at least 99 % of the pixels do not exceed.
    pub p99: f64,
    pub max: f64,
    /// Column and row of the largest error.
    pub max_at: (u32, u32),
}

impl ErrorMap {
    /// The distribution over the pixels that `pair` selects; the map is one of that pair.
    pub fn pool(&self, pair: &Pair<'_>) -> Pool {
        let mut values = Vec::new();
        let mut max = (f64::NEG_INFINITY, 0);
        for index in pair.selected() {
            let value = self.values[index];
            values.push(value);
            if value > max.0 {
                max = (value, index);
            }
        }
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        values.sort_unstable_by(f64::total_cmp);
        let rank = |share: f64| values[((share * values.len() as f64).ceil() as usize).clamp(1, values.len()) - 1];
        Pool { mean, median: rank(0.5), p99: rank(0.99), max: max.0, max_at: pair.place(max.1) }
    }
}
