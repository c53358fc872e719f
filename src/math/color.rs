//! Colour transfer: the sRGB curve and Rec.709 luminance, in float64.
//!
//! Everything inside Specula is linear Rec.709; sRGB exists only in textures and in display-referred output.

use glam::DVec3;

/// Rec.709 luminance weights (ITU-R BT.709-6, table 1, item 3.2).
pub const LUMINANCE_REC709: DVec3 = DVec3::new(0.2126, 0.7152, 0.0722);

/// Relative luminance of a linear Rec.709 colour; same unit as the input.
pub fn luminance(linear: DVec3) -> f64 {
    LUMINANCE_REC709.dot(linear)
}

/// sRGB electro-optical transfer: encoded value in [0, 1] to linear light in [0, 1] (IEC 61966-2-1, 5.2).
pub fn linear_from_srgb(encoded: f64) -> f64 {
    if encoded <= 0.04045 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) }
}

/// Inverse of [`linear_from_srgb`]; input outside [0, 1] is clamped (IEC 61966-2-1, 5.3).
pub fn srgb_from_linear(linear: f64) -> f64 {
    let x = linear.clamp(0.0, 1.0);
    if x <= 0.003_130_8 { x * 12.92 } else { 1.055 * x.powf(1.0 / 2.4) - 0.055 }
}

/// The nearest 8-bit sRGB codes of linear light, without a power for each: a search among the light halfway between codes.
#[derive(Debug, Clone)]
pub struct SrgbCodes {
    /// From `limits[code]` on light has a higher code than `code`.
    limits: [f32; 255],
    /// The code of the darkest light of each of equal steps.
    first: [u8; SrgbCodes::STEPS],
}

impl SrgbCodes {
    /// At most three codes share a step, in the dark.
    const STEPS: usize = 2048;

    pub fn new() -> Self {
        let limits: [f32; 255] = std::array::from_fn(|code| linear_from_srgb((code as f64 + 0.5) / 255.0) as f32);
        let darkest = |step: usize| step as f32 / Self::STEPS as f32;
        let first = std::array::from_fn(|step| limits.partition_point(|limit| *limit <= darkest(step)) as u8);
        Self { limits, first }
    }

    /// The code of `linear` light, which is clamped to [0, 1].
    #[inline]
    pub fn code(&self, linear: f32) -> u8 {
        let step = (linear * Self::STEPS as f32) as usize;
        let mut code = self.first[step.min(Self::STEPS - 1)];
        while self.limits.get(usize::from(code)).is_some_and(|limit| *limit <= linear) {
            code += 1;
        }
        code
    }
}

impl Default for SrgbCodes {
    fn default() -> Self {
        Self::new()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_are_the_nearest() {
        let codes = SrgbCodes::new();
        for i in -100..=1_000_100 {
            let linear = i as f32 * 1e-6;
            let exact = srgb_from_linear(f64::from(linear)) * 255.0;
            let off = (f64::from(codes.code(linear)) - exact).abs();
            assert!(off < 0.5 + 1e-4, "{linear}: {off}");
        }
        assert_eq!([f32::NAN, f32::INFINITY].map(|light| codes.code(light)), [0, 255]);
    }

    #[test]
    fn srgb_round_trips_every_8_bit_code() {
        for code in 0..=255u32 {
            let encoded = f64::from(code) / 255.0;
            assert!((srgb_from_linear(linear_from_srgb(encoded)) - encoded).abs() < 1e-7, "code {code}");
        }
    }
}
