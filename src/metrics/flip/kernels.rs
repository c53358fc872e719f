//! The filters of FLIP: contrast sensitivity of the eye, edges and points. All are separable.

use crate::metrics::filter::{Plane, normalized, taps};
use std::f64::consts::PI;

/// A Gaussian of the contrast sensitivity: `a sqrt(pi / b) exp(-pi^2 d^2 / b)` for d in degrees.
#[derive(Debug, Clone, Copy)]
struct Sensitivity {
    a: f64,
    b: f64,
}

const ACHROMATIC: Sensitivity = Sensitivity { a: 1.0, b: 0.0047 };
const RED_GREEN: Sensitivity = Sensitivity { a: 1.0, b: 0.0053 };
/// Blue-yellow is the sum of two.
const BLUE_YELLOW: [Sensitivity; 2] = [Sensitivity { a: 34.1, b: 0.04 }, Sensitivity { a: 13.5, b: 0.025 }];

/// Width in degrees at which edges and points are seen best, the paper's w.
const FEATURE_WIDTH_DEG: f64 = 0.082;

/// Filters reach out to three standard deviations.
const REACH: f64 = 3.0;

/// What the eye makes of luminance, red-green and blue-yellow.
#[derive(Debug)]
pub(super) struct Contrast {
    achromatic: Vec<f64>,
    red_green: Vec<f64>,
    /// Normalised, with its share of the sum.
    blue_yellow: [(f64, Vec<f64>); 2],
}

impl Contrast {
    pub(super) fn new(pixels_per_degree: f64) -> Self {
        // One radius for all, that of the widest.
        let widest_sigma_deg = (BLUE_YELLOW[0].b / (2.0 * PI * PI)).sqrt();
        let radius = (REACH * widest_sigma_deg * pixels_per_degree).ceil() as usize;
        let profile = |s: Sensitivity| taps(radius, |d| (-(PI * d / pixels_per_degree).powi(2) / s.b).exp());
        let volume = |s: Sensitivity| s.a * (PI / s.b).sqrt() * profile(s).iter().sum::<f64>().powi(2);
        let total: f64 = BLUE_YELLOW.map(volume).iter().sum();
        Self {
            achromatic: normalized(profile(ACHROMATIC)),
            red_green: normalized(profile(RED_GREEN)),
            blue_yellow: BLUE_YELLOW.map(|s| (volume(s) / total, normalized(profile(s)))),
        }
    }

    pub(super) fn filtered(&self, y: &Plane, cx: &Plane, cz: &Plane) -> [Plane; 3] {
        let [(wide_share, wide), (narrow_share, narrow)] = &self.blue_yellow;
        let mut blue_yellow = cz.filtered(wide, wide);
        let narrow = cz.filtered(narrow, narrow);
        for (wide, narrow) in blue_yellow.values.iter_mut().zip(&narrow.values) {
            *wide = wide_share * *wide + narrow_share * narrow;
        }
        [y.filtered(&self.achromatic, &self.achromatic), cx.filtered(&self.red_green, &self.red_green), blue_yellow]
    }
}

/// Detectors of edges and points in luminance: derivatives of a Gaussian.
#[derive(Debug)]
pub(super) struct Features {
    gaussian: Vec<f64>,
    first_derivative: Vec<f64>,
    second_derivative: Vec<f64>,
}

impl Features {
    pub(super) fn new(pixels_per_degree: f64) -> Self {
        let sigma_px = 0.5 * FEATURE_WIDTH_DEG * pixels_per_degree;
        let radius = (REACH * sigma_px).ceil() as usize;
        let gaussian = |d: f64| (-d * d / (2.0 * sigma_px * sigma_px)).exp();
        Self {
            gaussian: normalized(taps(radius, gaussian)),
            first_derivative: balanced(taps(radius, |d| -d * gaussian(d))),
            second_derivative: balanced(taps(radius, |d| (d * d / (sigma_px * sigma_px) - 1.0) * gaussian(d))),
        }
    }

    /// Strength of the edge at each pixel.
    pub(super) fn edges(&self, luminance: &Plane) -> Vec<f64> {
        self.strength(luminance, &self.first_derivative)
    }

    /// Strength of the point at each pixel.
    pub(super) fn points(&self, luminance: &Plane) -> Vec<f64> {
        self.strength(luminance, &self.second_derivative)
    }

    fn strength(&self, luminance: &Plane, derivative: &[f64]) -> Vec<f64> {
        let along_x = luminance.filtered(derivative, &self.gaussian);
        let along_y = luminance.filtered(&self.gaussian, derivative);
        along_x.values.iter().zip(&along_y.values).map(|(x, y)| x.hypot(*y)).collect()
    }
}

/// Scales positive taps to a sum of 1 and negative ones to -1.
fn balanced(mut filter: Vec<f64>) -> Vec<f64> {
    let sum_of = |sign: f64| filter.iter().map(|tap| (tap * sign).max(0.0)).sum::<f64>();
    let (positive, negative) = (sum_of(1.0), sum_of(-1.0));
    filter.iter_mut().for_each(|tap| *tap /= if *tap > 0.0 { positive } else { negative });
    filter
}
