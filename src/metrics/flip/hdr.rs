//! FLIP of radiance: the largest error over the exposures at which the picture may be shown.

use super::{Flip, PIXELS_PER_DEGREE};
use crate::math::color::luminance;
use crate::metrics::{ErrorMap, Pair};
use crate::scene::Picture;
use crate::threads::*;
use glam::DVec3;

/// The curve that stands for a display's tone map, `(a x^2 + b x) / (d x^2 + e x + f)`: Narkowicz 2015, "ACES Filmic
/// Tone Mapping Curve", with the scene scaled by 0.6: the default of the HDR paper.
const PRE_SCALE: f64 = 0.6;
const A: f64 = 2.51;
const B: f64 = 0.03;
const D: f64 = 2.43;
const E: f64 = 0.59;
const F: f64 = 0.14;

/// What the tone map should make of the brightest and of the median luminance.
const SHOWN_AS: f64 = 0.85;

/// The exposures in stops at which two pictures are compared, evenly spaced, both ends included.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Exposures {
    /// Shows the brightest pixel of the expected picture well.
    pub start_ev: f64,
    /// Shows its median well.
    pub stop_ev: f64,
    pub count: u32,
}

impl Exposures {
    /// The exposures that show a picture in radiance from its brightest pixel down to its median.
    pub fn of(picture: &Picture) -> Self {
        let mut luminances: Vec<f64> = picture.texels.iter().map(|texel| luminance(radiance(texel))).collect();
        luminances.sort_unstable_by(f64::total_cmp);
        // A picture of nothing but black has no brightest pixel; any exposure shows it.
        let floor = f64::from(f32::EPSILON);
        let median = luminances.get(luminances.len() / 2).map_or(floor, |value| value.max(floor));
        let largest = luminances.last().map_or(floor, |value| value.max(floor));
        let shown = shown_well();
        let (start_ev, stop_ev) = ((shown / largest).log2(), (shown / median).log2());
        let count = if start_ev == stop_ev { 1 } else { ((stop_ev - start_ev).ceil() as u32).max(2) };
        Self { start_ev, stop_ev, count }
    }

    fn iter(self) -> impl Iterator<Item = f64> {
        let step = (self.stop_ev - self.start_ev) / f64::from(self.count - 1).max(1.0);
        (0..self.count).map(move |i| self.start_ev + f64::from(i) * step)
    }
}

/// The HDR-FLIP error in [0, 1] of each pixel of a pair in linear radiance, at the [`Exposures`] of the expected
/// picture. Negative radiance counts as none.
pub fn hdr_flip(pair: &Pair<'_>) -> ErrorMap {
    let flip = Flip::new(PIXELS_PER_DEGREE);
    let (width, height) = (pair.expected().width, pair.expected().height);
    let mut values = vec![0.0_f64; pair.expected().texels.len()];
    for exposure_ev in Exposures::of(pair.expected()).iter() {
        let scale = exposure_ev.exp2();
        let [actual, expected] = [pair.actual(), pair.expected()].map(|picture| shown(picture, scale));
        let errors = flip.errors(width as usize, &actual, &expected);
        values.iter_mut().zip(errors).for_each(|(largest, error)| *largest = largest.max(error));
    }
    ErrorMap { width, height, values }
}

fn radiance(texel: &glam::Vec4) -> DVec3 {
    texel.truncate().as_dvec3().max(DVec3::ZERO)
}

fn shown(picture: &Picture, scale: f64) -> Vec<DVec3> {
    let show = |texel: &glam::Vec4| radiance(texel).to_array().map(|value| tone_map(value * scale)).into();
    picture.texels.par_iter().map(show).collect()
}

/// Display light in [0, 1] for exposed radiance.
fn tone_map(exposed: f64) -> f64 {
    let x = PRE_SCALE * exposed;
    ((A * x + B) * x / ((D * x + E) * x + F)).min(1.0)
}

/// The exposed radiance that [`tone_map`] shows as [`SHOWN_AS`].
fn shown_well() -> f64 {
    // The positive root of (a - t d) x^2 + (b - t e) x - t f = 0.
    let [a, b, c] = [A - SHOWN_AS * D, B - SHOWN_AS * E, -SHOWN_AS * F];
    (-b + (b * b - 4.0 * a * c).sqrt()) / (2.0 * a) / PRE_SCALE
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_tone_map_is_inverted() {
        assert!((tone_map(shown_well()) - SHOWN_AS).abs() < 1e-12);
        assert_eq!(tone_map(1e30), 1.0);
    }
}
