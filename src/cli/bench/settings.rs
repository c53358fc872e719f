//! The settings that trade time for error, and which of them are compared.

use crate::bake::environment::BakeOptions;
use crate::capture::CaptureOptions;
use crate::gpu::formats::Precision;
use crate::renderer::PathChoice;
use crate::scene::Quality;
use std::fmt;

/// One way to draw a picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::cli) struct Setting {
    pub(in crate::cli) quality: Quality,
    /// Samples a pixel of the rasteriser.
    pub(in crate::cli) msaa: u32,
    /// The picture is drawn this many times wider and higher, and box-filtered.
    pub(in crate::cli) supersampling: u32,
    pub(in crate::cli) precision: Precision,
    /// The most texels on a side of the prefiltered environment.
    pub(in crate::cli) prefilter_side: u32,
    /// From triangles to radiance.
    pub(in crate::cli) path: PathChoice,
    /// Where that is not the base's, as names have it.
    pub(in crate::cli) path_name: &'static str,
}

/// Samples of the rasteriser, and how much larger the picture is drawn, that every tier is combined with.
const SAMPLINGS: [(u32, u32); 3] = [(1, 1), (4, 1), (1, 2)];
/// Smaller prefiltered environments, each with everything else as the base has it.
const PREFILTER_SIDES: [u32; 2] = [512, 256];

impl Setting {
    pub(in crate::cli) fn new(quality: Quality, capture: CaptureOptions, path: PathChoice) -> Self {
        let CaptureOptions { samples: msaa, precision } = capture;
        let prefilter_side = BakeOptions::default().max_side;
        Self { quality, msaa, supersampling: 1, precision, prefilter_side, path, path_name: "" }
    }

    /// The same light, through the middle of each pixel.
    pub(super) fn with_one_sample(self) -> Self {
        Self { msaa: 1, supersampling: 1, ..self }
    }

    /// How edges are smoothed.
    pub(super) fn sampling(&self) -> &'static str {
        match (self.msaa > 1, self.supersampling > 1) {
            (false, false) => "1 sample",
            (true, false) => "MSAA",
            (false, true) => "SSAA",
            (true, true) => "SSAA+MSAA",
        }
    }
}

impl Setting {
    /// What sets its light apart: tier, and what is not as usual.
    pub(super) fn light_name(&self) -> String {
        format!("{}{}{}", self.quality.name(), self.path_name, self.extras())
    }

    fn extras(&self) -> String {
        let float = if self.precision == Precision::Float { ", float" } else { "" };
        let side = self.prefilter_side;
        let prefilter =
            if side == BakeOptions::default().max_side { String::new() } else { format!(", prefilter {side}") };
        format!("{float}{prefilter}")
    }
}

/// What sets a setting apart: tier, samples, and what is not as usual.
impl fmt::Display for Setting {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.quality.name())?;
        match (self.msaa, self.supersampling) {
            (1, 1) => f.write_str(", 1 sample")?,
            (msaa, 1) => write!(f, ", {msaa}x MSAA")?,
            (1, side) => write!(f, ", {side}x{side} SSAA")?,
            (msaa, side) => write!(f, ", {side}x{side} SSAA + {msaa}x MSAA")?,
        }
        f.write_str(self.path_name)?;
        f.write_str(&self.extras())
    }
}

/// The base first, then everything that it is compared with: tiers by samplings, and the rest one at a time. Tiers and
/// prefiltering only differ where there is an environment.
///
/// The size of the split-sum table is not among them: one lookup costs the same in a small table, and the error of the
/// table (`docs/brdf.md`) is a hundredth of the smallest that shows here.
pub(super) fn settings(base: Setting, has_environment: bool) -> Vec<Setting> {
    let tiers: &[Quality] = if has_environment { &Quality::ALL } else { std::slice::from_ref(&base.quality) };
    let crossed = tiers
        .iter()
        .flat_map(|&quality| SAMPLINGS.map(|(msaa, supersampling)| Setting { quality, msaa, supersampling, ..base }));
    let other_precision = match base.precision {
        Precision::Half => Precision::Float,
        Precision::Float => Precision::Half,
    };
    let (path, path_name) = match base.path {
        PathChoice::Forward => (PathChoice::Deferred, ", deferred"),
        PathChoice::Faster | PathChoice::Deferred => (PathChoice::Forward, ", forward"),
    };
    let alone = [
        Setting { supersampling: 2, ..base },
        Setting { precision: other_precision, ..base },
        Setting { path, path_name, ..base },
    ];
    let prefiltered = PREFILTER_SIDES.map(|prefilter_side| Setting { prefilter_side, ..base });
    let prefiltered = prefiltered.into_iter().filter(|_| has_environment);
    let mut settings = vec![base];
    for setting in crossed.chain(alone).chain(prefiltered) {
        if !settings.contains(&setting) {
            settings.push(setting);
        }
    }
    settings
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_base_comes_first_and_nothing_twice() {
        let base = Setting::new(Quality::Standard, CaptureOptions::default(), PathChoice::Faster);
        let all = settings(base, true);
        assert_eq!(all[0], base);
        assert!(all.iter().enumerate().all(|(i, setting)| !all[..i].contains(setting)));
        assert_eq!(all.len(), 4 * 3 + 3 + 2);
        assert_eq!(settings(base, false).len(), 3 + 3);
        let names: Vec<String> = all.iter().map(ToString::to_string).collect();
        assert_eq!(names[0], "standard, 4x MSAA");
        assert!(names.iter().enumerate().all(|(i, name)| !names[..i].contains(name)), "{names:?}");
    }
}
