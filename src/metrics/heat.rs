//! Error maps as pictures.

use super::map::ErrorMap;

/// Colours of errors from 0 to 1 at equal steps, sRGB: luminance rises all the way, so that the map can be read in grey.
const RAMP: [[f64; 3]; 6] =
    [[0.0, 0.0, 0.0], [0.25, 0.06, 0.42], [0.62, 0.13, 0.45], [0.93, 0.36, 0.30], [0.99, 0.70, 0.33], [1.0, 1.0, 0.85]];

/// The colour of an error in [0, 1]; what lies outside is clamped.
pub fn heat(error: f64) -> [u8; 3] {
    let at = error.clamp(0.0, 1.0) * (RAMP.len() - 1) as f64;
    let below = (at as usize).min(RAMP.len() - 2);
    let t = at - below as f64;
    std::array::from_fn(|c| {
        let value = RAMP[below][c] + (RAMP[below + 1][c] - RAMP[below][c]) * t;
        (value * 255.0).round() as u8
    })
}

/// Every pixel's colour as opaque RGBA, row by row.
pub fn heat_map(map: &ErrorMap) -> Vec<u8> {
    map.values.iter().map(|&error| heat(error)).flat_map(|[r, g, b]| [r, g, b, 255]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::color::{linear_from_srgb, luminance};

    #[test]
    fn luminance_rises_with_the_error() {
        let of = |error: f64| luminance(heat(error).map(|code| linear_from_srgb(f64::from(code) / 255.0)).into());
        for step in 0..100 {
            let (low, high) = (f64::from(step) / 100.0, f64::from(step + 1) / 100.0);
            assert!(of(low) < of(high), "{low}");
        }
        assert_eq!(heat(-1.0), heat(0.0));
        assert_eq!(heat(2.0), heat(1.0));
    }
}
