//! Metrics of single pixels: how many differ, the largest difference, relative RMS, PSNR.

use super::pair::{CHANNELS, Pair};
use crate::math::color::linear_from_srgb;
use crate::scene::Encoding;
use glam::DVec3;

/// The largest difference of one channel, in the numbers of the files.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MaxAbs {
    pub value: f64,
    /// Column and row of the first pixel that has it.
    pub at: (u32, u32),
    pub channel: &'static str,
    pub actual: f32,
    pub expected: f32,
}

/// Share of the pixels in [0, 1] that differ in any of the four channels.
pub fn differing_pixels(pair: &Pair<'_>) -> f64 {
    let (mut differing, mut count) = (0_u64, 0_u64);
    for index in pair.selected() {
        count += 1;
        differing += u64::from(pair.actual().texels[index] != pair.expected().texels[index]);
    }
    differing as f64 / count as f64
}

/// The largest difference of the four channels of one pixel, by its index.
pub fn pixel_max_abs(pair: &Pair<'_>, index: usize) -> f64 {
    let [a, b] = [pair.actual(), pair.expected()].map(|picture| picture.texels[index].as_dvec4());
    (a - b).abs().max_element()
}

/// The largest difference over pixels and the four channels.
pub fn max_abs(pair: &Pair<'_>) -> MaxAbs {
    let mut worst = MaxAbs { value: -1.0, at: (0, 0), channel: CHANNELS[0], actual: 0.0, expected: 0.0 };
    for index in pair.selected() {
        let (actual, expected) = (pair.actual().texels[index], pair.expected().texels[index]);
        for (c, channel) in CHANNELS.into_iter().enumerate() {
            let value = (f64::from(actual[c]) - f64::from(expected[c])).abs();
            if value > worst.value {
                worst = MaxAbs { value, at: pair.place(index), channel, actual: actual[c], expected: expected[c] };
            }
        }
    }
    worst
}

/// `sqrt(sum |a - b|^2 / sum |b|^2)` over R, G and B in linear light; b is the expected picture. Infinite where that is
/// black and the other is not.
pub fn relative_rms(pair: &Pair<'_>) -> f64 {
    let linear = |texel: glam::Vec4| {
        let color = texel.truncate().as_dvec3();
        match pair.encoding() {
            Encoding::Linear => color,
            Encoding::Srgb => color.to_array().map(linear_from_srgb).into(),
        }
    };
    let (mut difference, mut power) = (0.0, 0.0);
    for index in pair.selected() {
        let [a, b]: [DVec3; 2] = [pair.actual(), pair.expected()].map(|picture| linear(picture.texels[index]));
        difference += (a - b).length_squared();
        power += b.length_squared();
    }
    if difference == 0.0 { 0.0 } else { (difference / power).sqrt() }
}

/// Peak signal-to-noise ratio in dB over R, G and B as the files have them, for a peak of 1: `-10 log10(MSE)`.
/// Infinite for equal pictures. For sRGB-encoded pictures; radiance has no peak.
pub fn psnr_db(pair: &Pair<'_>) -> f64 {
    let (mut squares, mut count) = (0.0, 0.0);
    for index in pair.selected() {
        let [a, b] = [pair.actual(), pair.expected()].map(|picture| picture.texels[index].truncate().as_dvec3());
        squares += (a - b).length_squared();
        count += 3.0;
    }
    -10.0 * (squares / count).log10()
}
