//! FLIP: the difference that a person sees who flips between two pictures.
//!
//! Andersson, Nilsson, Akenine-Moller, Oskarsson, Astrom and Fairchild 2020, "FLIP: A Difference Evaluator for
//! Alternating Images", for pictures on a display; the constants below are of this paper. [`hdr_flip`] is that
//! of Andersson, Nilsson, Shirley and Akenine-Moller 2021, "Visualizing Errors in Rendered High Dynamic Range Images".

mod color;
mod hdr;
mod kernels;

pub use hdr::{Exposures, hdr_flip};

use super::filter::Plane;
use super::map::ErrorMap;
use super::pair::Pair;
use crate::math::color::linear_from_srgb;
use crate::scene::{Encoding, Picture};
use crate::threads::*;
use color::{ColorSpaces, hunt_adjusted, hyab};
use glam::DVec3;
use kernels::{Contrast, Features};
use std::f64::consts::{FRAC_1_SQRT_2, PI};

/// Pixels per degree of the viewer's field: a display 3840 pixels and 0.7 m wide, seen from 0.7 m.
pub const PIXELS_PER_DEGREE: f64 = 3840.0 * PI / 180.0;

/// Exponent that compresses large colour differences, the paper's q_c.
const Q_C: f64 = 0.7;
/// Colour differences up to this share of the largest are spread over [0, `P_T`]; the paper's p_c and p_t.
const P_C: f64 = 0.4;
const P_T: f64 = 0.95;
/// Exponent that raises small feature differences, the paper's q_f.
const Q_F: f64 = 0.5;

/// The FLIP error in [0, 1] of each pixel of a pair that is sRGB-encoded. It is symmetric, and a pixel's error depends
/// on the pixels around it, whether or not the pair's mask selects them.
///
/// For a pair in linear radiance see [`hdr_flip`]; here it is taken as light of a display, clamped to [0, 1].
pub fn flip(pair: &Pair<'_>) -> ErrorMap {
    let [actual, expected] = [pair.actual(), pair.expected()].map(linear_display_light);
    let width = pair.actual().width;
    let values = Flip::new(PIXELS_PER_DEGREE).errors(width as usize, &actual, &expected);
    ErrorMap { width, height: pair.actual().height, values }
}

fn linear_display_light(picture: &Picture) -> Vec<DVec3> {
    let decode = |texel: &glam::Vec4| {
        let color = texel.truncate().as_dvec3().clamp(DVec3::ZERO, DVec3::ONE);
        match picture.encoding {
            Encoding::Srgb => color.to_array().map(linear_from_srgb).into(),
            Encoding::Linear => color,
        }
    };
    picture.texels.par_iter().map(decode).collect()
}

/// What does not depend on the pictures.
#[derive(Debug)]
struct Flip {
    spaces: ColorSpaces,
    contrast: Contrast,
    features: Features,
    /// The largest compressed colour difference: green against blue.
    largest_color_difference: f64,
}

/// A picture as FLIP sees it.
struct Perceived {
    /// Filtered and Hunt-adjusted CIELAB.
    lab: Vec<DVec3>,
    edges: Vec<f64>,
    points: Vec<f64>,
}

impl Flip {
    fn new(pixels_per_degree: f64) -> Self {
        let spaces = ColorSpaces::rec709();
        let [green, blue] = [DVec3::Y, DVec3::Z].map(|linear| hunt_adjusted(spaces.lab_from_linear(linear)));
        Self {
            largest_color_difference: hyab(green, blue).powf(Q_C),
            spaces,
            contrast: Contrast::new(pixels_per_degree),
            features: Features::new(pixels_per_degree),
        }
    }

    /// The error of each pixel; colours are linear Rec.709 in [0, 1].
    fn errors(&self, width: usize, actual: &[DVec3], expected: &[DVec3]) -> Vec<f64> {
        let [a, b] = [actual, expected].map(|picture| self.perceive(width, picture));
        let error = |i: usize| {
            let color = self.color_difference(a.lab[i], b.lab[i]);
            let feature = (a.edges[i] - b.edges[i]).abs().max((a.points[i] - b.points[i]).abs());
            let feature = (FRAC_1_SQRT_2 * feature).powf(Q_F);
            // Features make a colour difference more visible.
            color.powf(1.0 - feature)
        };
        (0..actual.len()).into_par_iter().map(error).collect()
    }

    fn perceive(&self, width: usize, linear: &[DVec3]) -> Perceived {
        let opponent: Vec<DVec3> = linear.par_iter().map(|&color| self.spaces.ycxcz_from_linear(color)).collect();
        let plane = |c: usize| Plane { width, values: opponent.iter().map(|color| color[c]).collect() };
        let [y, cx, cz] = [plane(0), plane(1), plane(2)];
        let filtered = self.contrast.filtered(&y, &cx, &cz);
        let lab = |i: usize| {
            let color = DVec3::new(filtered[0].values[i], filtered[1].values[i], filtered[2].values[i]);
            let linear = self.spaces.linear_from_ycxcz(color).clamp(DVec3::ZERO, DVec3::ONE);
            hunt_adjusted(self.spaces.lab_from_linear(linear))
        };
        let lab = (0..linear.len()).into_par_iter().map(lab).collect();
        // Luminance relative to white.
        let luminance = Plane { width, values: y.values.iter().map(|y| (y + 16.0) / 116.0).collect() };
        Perceived { lab, edges: self.features.edges(&luminance), points: self.features.points(&luminance) }
    }

    /// The distance, compressed and spread over [0, 1].
    fn color_difference(&self, a: DVec3, b: DVec3) -> f64 {
        let difference = hyab(a, b).powf(Q_C);
        let knee = P_C * self.largest_color_difference;
        if difference < knee {
            P_T / knee * difference
        } else {
            P_T + (difference - knee) / (self.largest_color_difference - knee) * (1.0 - P_T)
        }
    }
}
