//! From scene radiance to the screen: exposure, tone maps, compositing, sRGB.

use crate::math::color::{linear_from_srgb, srgb_from_linear};
use crate::scene::{Background, RadianceImage, ToneMap, View};
use glam::{DMat3, DVec3, DVec4, Vec4Swizzles};

/// Display-linear light in [0, 1] from exposed radiance (finite, not negative).
pub fn tone_map(curve: ToneMap, exposed: DVec3) -> DVec3 {
    let display = match curve {
        ToneMap::Neutral => neutral(exposed),
        ToneMap::Aces => aces(exposed),
        ToneMap::AgX => agx(exposed),
        ToneMap::Reinhard => exposed.map(reinhard),
        ToneMap::Linear | ToneMap::None => exposed,
    };
    display.clamp(DVec3::ZERO, DVec3::ONE)
}

/// Scale from radiance to what the tone map takes: 2^EV, or 1 where the view shows data.
pub fn exposure_scale(view: &View) -> f64 {
    if view.tone_map == ToneMap::None { 1.0 } else { f64::from(view.exposure_ev).exp2() }
}

/// Khronos PBR Neutral (Khronos 2024, "PBR Neutral Tone Mapper specification"): the reflection of a dielectric at normal
/// incidence, 0.04, is taken off, colours below 0.8 - 0.04 stay as they are, brighter ones are compressed and desaturated.
pub fn neutral(exposed: DVec3) -> DVec3 {
    const F90: f64 = 0.04;
    const START: f64 = 0.8 - F90;
    const DESATURATION: f64 = 0.15;
    let low = exposed.min_element();
    let offset = if low < 2.0 * F90 { low - low * low / (4.0 * F90) } else { F90 };
    let color = exposed - offset;
    let peak = color.max_element();
    if peak < START {
        return color;
    }
    let room = 1.0 - START;
    let compressed = 1.0 - room * room / (peak + room - START);
    let whiteness = 1.0 - 1.0 / (DESATURATION * (peak - compressed) + 1.0);
    (color * (compressed / peak)).lerp(DVec3::splat(compressed), whiteness)
}

/// ACES RRT and sRGB ODT as fitted by Stephen Hill (BakingLab, ACES.hlsl, 2016), after the customary exposure of 1/0.6.
pub fn aces(exposed: DVec3) -> DVec3 {
    // Columns. sRGB to the space of the RRT, saturation included, and back from that of the ODT.
    const RRT_FROM_SRGB: DMat3 = DMat3::from_cols(
        DVec3::new(0.59719, 0.07600, 0.02840),
        DVec3::new(0.35458, 0.90834, 0.13383),
        DVec3::new(0.04823, 0.01566, 0.83777),
    );
    const SRGB_FROM_ODT: DMat3 = DMat3::from_cols(
        DVec3::new(1.60475, -0.10208, -0.00327),
        DVec3::new(-0.53108, 1.10813, -0.07276),
        DVec3::new(-0.07367, -0.00605, 1.07602),
    );
    SRGB_FROM_ODT * (RRT_FROM_SRGB * (exposed / 0.6)).map(aces_curve)
}

/// Hill's rational fit of RRT and ODT, one channel.
fn aces_curve(x: f64) -> f64 {
    let numerator = x * x + 0.024_578_6 * x - 0.000_090_537;
    numerator / (0.983_729 * x * x + 0.432_951 * x + 0.238_081)
}

/// AgX, default look (Troy Sobotka, 2022), for Rec.709 primaries, with the contrast curve as fitted by Benjamin Wrensch
/// (2023, "Minimal AgX Implementation"). The curve gives values for a display of gamma 2.2; they are returned linear.
pub fn agx(exposed: DVec3) -> DVec3 {
    // Columns. The inset narrows the gamut before the curve, the outset is its inverse.
    const INSET: DMat3 = DMat3::from_cols(
        DVec3::new(0.842_479_062_253_094, 0.042_328_242_261_012_3, 0.042_375_654_905_705_1),
        DVec3::new(0.078_433_599_999_999_2, 0.878_468_636_469_772, 0.078_433_6),
        DVec3::new(0.079_223_745_147_764_3, 0.079_166_127_460_543_4, 0.879_142_973_793_104),
    );
    const OUTSET: DMat3 = DMat3::from_cols(
        DVec3::new(1.196_879_005_120_17, -0.052_896_851_757_456_2, -0.052_971_635_514_443_8),
        DVec3::new(-0.098_020_881_140_136_8, 1.151_903_129_904_17, -0.098_043_450_117_124_1),
        DVec3::new(-0.099_029_744_079_720_5, -0.098_961_176_844_843_3, 1.151_073_672_641_16),
    );
    let encoded = OUTSET * (INSET * exposed).map(|x| agx_contrast(agx_log(x)));
    encoded.map(|x| x.max(0.0).powf(2.2))
}

/// Position of a channel in AgX's range of 16.5 stops around middle grey (0.18 = 2^-2.474), in [0, 1].
fn agx_log(x: f64) -> f64 {
    const DARKEST_EV: f64 = -12.473_93;
    const BRIGHTEST_EV: f64 = 4.026_069;
    ((x.max(1e-10).log2() - DARKEST_EV) / (BRIGHTEST_EV - DARKEST_EV)).clamp(0.0, 1.0)
}

/// Wrensch's fit of AgX's sigmoid, by Horner's rule.
fn agx_contrast(x: f64) -> f64 {
    const ASCENDING: [f64; 7] = [-0.002_32, 0.119_1, 0.429_8, -6.868, 31.96, -40.14, 15.5];
    ASCENDING.iter().rev().fold(0.0, |sum, coefficient| sum * x + coefficient)
}

/// Reinhard et al. 2002, equation 3.
pub fn reinhard(x: f64) -> f64 {
    1.0 - 1.0 / (1.0 + x)
}

/// One pixel of scene radiance, multiplied with its coverage in w, as it goes to the display: linear light in [0, 1],
/// straight (not multiplied), and alpha.
pub fn display(view: &View, radiance_premultiplied: DVec4) -> [f64; 4] {
    let alpha = radiance_premultiplied.w.clamp(0.0, 1.0);
    // Nothing covered is black, and not 0/0.
    let straight = if alpha > 0.0 { radiance_premultiplied.xyz() / alpha } else { DVec3::ZERO };
    let mapped = tone_map(view.tone_map, straight * exposure_scale(view));
    match view.background {
        Background::Color(srgb) => {
            let behind = srgb.as_dvec3().map(linear_from_srgb);
            (mapped * alpha + behind * (1.0 - alpha)).extend(1.0).to_array()
        }
        Background::Transparent | Background::Environment => mapped.extend(alpha).to_array(),
    }
}

/// The picture as 8-bit sRGB with straight alpha, row-major from the top left.
pub fn to_srgb8(image: &RadianceImage, view: &View) -> Vec<u8> {
    let encode = |texel: &glam::Vec4| {
        let [r, g, b, alpha] = display(view, texel.as_dvec4());
        [srgb_from_linear(r), srgb_from_linear(g), srgb_from_linear(b), alpha].map(|x| (x * 255.0).round() as u8)
    };
    image.texels.iter().flat_map(encode).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reference::tests::view;
    use glam::{Vec3, Vec4};

    const CURVES: [ToneMap; 6] =
        [ToneMap::Neutral, ToneMap::Aces, ToneMap::AgX, ToneMap::Reinhard, ToneMap::Linear, ToneMap::None];

    #[test]
    fn greys_rise_monotonically_from_black_to_white() {
        for curve in CURVES {
            let mut previous = DVec3::ZERO;
            for i in -400..400 {
                let mapped = tone_map(curve, DVec3::splat((f64::from(i) * 0.1).exp2()));
                assert!(mapped.cmpge(previous - 1e-12).all(), "{curve:?} falls at step {i}");
                assert!((mapped.max_element() - mapped.min_element()) < 1e-3, "{curve:?} tints greys: {mapped}");
                previous = mapped;
            }
            assert!(tone_map(curve, DVec3::ZERO).max_element() < 1e-3, "{curve:?} lifts black");
            assert!(previous.min_element() > 0.96, "{curve:?} ends at {previous}");
        }
    }

    #[test]
    fn huge_radiance_stays_finite() {
        for curve in CURVES {
            for color in [DVec3::splat(f64::from(f32::MAX)), DVec3::new(1e38, 0.0, 0.0), DVec3::new(0.0, 3e38, 1.0)] {
                assert!(tone_map(curve, color).is_finite(), "{curve:?} of {color}");
            }
        }
    }

    #[test]
    fn neutral_keeps_base_colours() {
        // A base colour under white light is reflected with 0.04 added; the curve takes that off again.
        for color in [DVec3::new(0.7, 0.2, 0.1), DVec3::splat(0.5), DVec3::new(0.05, 0.75, 0.3)] {
            assert!((neutral(color + 0.04) - color).length() < 1e-12, "{color}");
        }
    }

    #[test]
    fn published_points_of_the_curves() {
        // Middle grey, worked out by hand: log 0.606061, sigmoid 0.496730, to the power of 2.2: 0.214519.
        assert!((agx(DVec3::splat(0.18)).y - 0.214_519).abs() < 1e-4);
        // The limit of Hill's fit is 1 / 0.983729, in a space where white is (1, 1, 1) to 1e-4.
        assert!((aces(DVec3::splat(1e9)).y - 1.0 / 0.983_729).abs() < 1e-3);
        assert_eq!(reinhard(1.0), 0.5);
    }

    #[test]
    fn compositing_happens_in_display_linear_light() {
        let mut view = view();
        view.tone_map = ToneMap::Linear;
        view.exposure_ev = 1.0;
        // Half covered by radiance 0.3: exposed 0.6.
        let half = DVec4::new(0.15, 0.15, 0.15, 0.5);
        assert!((display(&view, half)[0] - 0.6).abs() < 1e-12);
        assert_eq!(display(&view, half)[3], 0.5);
        view.background = Background::Color(Vec3::ONE);
        assert!((display(&view, half)[1] - 0.8).abs() < 1e-12);
        assert_eq!(display(&view, half)[3], 1.0);
        view.tone_map = ToneMap::None;
        assert!((display(&view, half)[1] - 0.65).abs() < 1e-12);
        assert_eq!(display(&view, DVec4::ZERO), [1.0, 1.0, 1.0, 1.0]);
    }

    #[test]
    fn a_background_colour_comes_out_as_it_was_given() {
        let mut view = view();
        view.background = Background::Color(Vec3::new(18.0, 52.0, 86.0) / 255.0);
        let image = RadianceImage { width: 1, height: 1, texels: vec![Vec4::ZERO] };
        assert_eq!(to_srgb8(&image, &view), [18, 52, 86, 255]);
    }
}
