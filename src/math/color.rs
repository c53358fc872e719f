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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn srgb_round_trips_every_8_bit_code() {
        for code in 0..=255u32 {
            let encoded = f64::from(code) / 255.0;
            assert!((srgb_from_linear(linear_from_srgb(encoded)) - encoded).abs() < 1e-7, "code {code}");
        }
    }
}
