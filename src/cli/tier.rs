//! `--max-error` and `--max-ms`: the tier that a scene and a view ask for, measured on the spot.

use super::bench::{Light, Setting, Stage, Truth, TruthOptions, with_bare_textures};
use super::clock::{Basis, median_ms};
use super::environment::CacheArgs;
use super::error::CliError;
use super::truth::parse_error;
use crate::capture::CaptureOptions;
use crate::gpu::Gpu;
use crate::progress::Progress;
use crate::renderer::PathChoice;
use crate::scene::{Quality, Scene, View};
use serde::Serialize;

/// Longer side of the picture that errors are estimated on, pixels.
const ESTIMATE_SIDE_PX: u32 = 96;
/// Samples a pixel of its truth, for each term of the light.
const TRUTH_SAMPLES: u32 = 128;
/// Frames of each tier that are timed.
const FRAMES: u32 = 5;

#[derive(Debug, clap::Args)]
#[command(next_help_heading = "Choosing the tier")]
pub(super) struct TierArgs {
    /// Take the cheapest --quality whose light is at most this far from the reference: RMS of the relative error of radiance,
    /// estimated on a small picture, without the error of edges and textures.
    #[arg(long, value_name = "PERCENT%", value_parser = parse_error, conflicts_with = "quality")]
    max_error: Option<f64>,
    /// Take the most accurate --quality whose frame takes at most so long; with --max-error only warn where it does not.
    #[arg(long, value_name = "MS", value_parser = parse_ms, conflicts_with = "quality")]
    max_ms: Option<f64>,
}

fn parse_ms(text: &str) -> Result<f64, String> {
    let ms = text.parse::<f64>().ok().filter(|ms| *ms > 0.0 && ms.is_finite());
    ms.ok_or_else(|| "expected milliseconds, more than 0".into())
}

/// What was measured, and what was taken.
#[derive(Debug, Serialize)]
pub(super) struct TierStats {
    taken: &'static str,
    max_error: Option<f64>,
    max_ms: Option<f64>,
    /// Samples a pixel of the truth, of all terms together, and the size of its picture.
    truth_samples: Option<u32>,
    truth_size_px: Option<[u32; 2]>,
    tiers: Vec<Candidate>,
}

/// One tier.
#[derive(Debug, Clone, Copy, Serialize)]
struct Candidate {
    quality: &'static str,
    /// Median wall time of a frame, until the device is done.
    ms: f64,
    /// None where no error was asked for.
    error: Option<f64>,
    /// Whether the error stands out from the noise of the truth; it is an upper bound otherwise.
    error_is_visible: Option<bool>,
}

impl TierArgs {
    pub(super) fn is_asked(&self) -> bool {
        self.max_error.is_some() || self.max_ms.is_some()
    }

    /// The tier for the picture, and how it was found; what is not met is warned of.
    ///
    /// # Errors
    /// When the scene cannot be drawn.
    pub(super) fn choose(
        &self,
        (gpu, cache): (&Gpu, &CacheArgs),
        (scene, view): (&Scene, &View),
        (options, paths): (CaptureOptions, PathChoice),
        (progress, warnings): (&dyn Progress, &mut Vec<String>),
    ) -> Result<(Quality, TierStats), CliError> {
        let tiers: Vec<Quality> =
            if scene.lit_environment().is_some() { Quality::ALL.into() } else { vec![view.quality] };
        let settings: Vec<Setting> = tiers.iter().map(|&quality| Setting::new(quality, options, paths)).collect();
        let mut candidates = times((gpu, cache), scene, view, &settings, progress)?;
        let mut stats = TierStats {
            taken: "",
            max_error: self.max_error,
            max_ms: self.max_ms,
            truth_samples: None,
            truth_size_px: None,
            tiers: Vec::new(),
        };
        if self.max_error.is_some() {
            errors((gpu, cache), (scene, view), &settings, &mut candidates, (&mut stats, progress))?;
        }
        let (taken, missed) = pick(&candidates, self.max_error, self.max_ms);
        warnings.extend(missed);
        stats.taken = candidates[taken].quality;
        stats.tiers = candidates;
        Ok((tiers[taken], stats))
    }
}

fn times(
    (gpu, cache): (&Gpu, &CacheArgs),
    scene: &Scene,
    view: &View,
    settings: &[Setting],
    progress: &dyn Progress,
) -> Result<Vec<Candidate>, CliError> {
    let mut stage = Stage::new(gpu, scene, cache);
    let shots: Result<Vec<_>, CliError> = settings.iter().map(|&s| stage.shot(s, view, progress)).collect();
    let frames = stage.measure(&shots?, FRAMES, progress)?;
    let candidate = |(setting, frames): (&Setting, &Vec<_>)| Candidate {
        quality: setting.quality.name(),
        ms: median_ms(frames, Basis::Wall).unwrap_or(f64::INFINITY),
        error: None,
        error_is_visible: None,
    };
    Ok(settings.iter().zip(&frames).map(candidate).collect())
}

fn errors(
    (gpu, cache): (&Gpu, &CacheArgs),
    (scene, view): (&Scene, &View),
    settings: &[Setting],
    candidates: &mut [Candidate],
    (stats, progress): (&mut TierStats, &dyn Progress),
) -> Result<(), CliError> {
    let scale = f64::from(ESTIMATE_SIDE_PX) / f64::from(view.size_px.max_element());
    let size_px = (view.size_px.as_dvec2() * scale.min(1.0)).round().as_uvec2().max(glam::UVec2::ONE);
    let (view, bare) = (View { size_px, ..view.clone() }, with_bare_textures(scene));
    let options = TruthOptions { samples: TRUTH_SAMPLES, relative_error: None, progress };
    let mut light =
        Light { truth: Truth::of_shading(&bare, &view, &options), stage: Stage::new(gpu, &bare, cache), view: &view };
    (stats.truth_samples, stats.truth_size_px) = (Some(light.truth.samples), Some(size_px.to_array()));
    for (candidate, setting) in candidates.iter_mut().zip(settings) {
        let error = light.error(*setting, progress)?;
        candidate.error_is_visible = Some(error.is_visible());
        candidate.error = Some(error.upper());
    }
    Ok(())
}

/// The candidate to take, and what it does not meet. There is at least one; they go from the plainest to the best.
fn pick(candidates: &[Candidate], max_error: Option<f64>, max_ms: Option<f64>) -> (usize, Option<String>) {
    let error = |i: &usize| candidates[*i].error.unwrap_or(f64::INFINITY);
    let ms = |i: &usize| candidates[*i].ms;
    let all = || 0..candidates.len();
    let cheapest = |of: Vec<usize>| of.into_iter().min_by(|a, b| ms(a).total_cmp(&ms(b)));
    let taken = match max_error {
        Some(limit) => cheapest(all().filter(|i| error(i) <= limit).collect())
            .or_else(|| all().min_by(|a, b| error(a).total_cmp(&error(b)))),
        // Without errors measured, tiers are as accurate as they are named.
        None => all().rfind(|i| max_ms.is_none_or(|limit| ms(i) <= limit)).or_else(|| cheapest(all().collect())),
    };
    let taken = taken.unwrap_or(0);
    let mut missed = Vec::new();
    if let Some(limit) = max_error.filter(|limit| error(&taken) > *limit) {
        missed.push(format!("an error of {:.2} % instead of {:.2} %", 100.0 * error(&taken), 100.0 * limit));
    }
    if let Some(limit) = max_ms.filter(|limit| ms(&taken) > *limit) {
        missed.push(format!("{:.1} ms a frame instead of {limit:.1} ms", ms(&taken)));
    }
    let warning = |missed: Vec<String>| {
        format!("no tier is within the limits: {} is taken, with {}", candidates[taken].quality, missed.join(" and "))
    };
    (taken, (!missed.is_empty()).then(|| warning(missed)))
}

impl std::fmt::Display for TierStats {
    /// One line: what was taken, and what all tiers are like.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "quality {}:", self.taken)?;
        for (index, tier) in self.tiers.iter().enumerate() {
            write!(f, "{} {} {:.1} ms", if index > 0 { "," } else { "" }, tier.quality, tier.ms)?;
            if let Some(error) = tier.error {
                let bound = if tier.error_is_visible == Some(false) { "< " } else { "" };
                write!(f, " {bound}{:.2} %", 100.0 * error)?;
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn candidates() -> Vec<Candidate> {
        let of = |quality, ms, error| Candidate { quality, ms, error: Some(error), error_is_visible: Some(true) };
        vec![of("split-sum", 8.0, 0.12), of("draft", 9.0, 0.03), of("standard", 11.0, 0.01), of("high", 12.0, 0.011)]
    }

    fn taken(max_error: Option<f64>, max_ms: Option<f64>) -> (&'static str, Option<String>) {
        let candidates = candidates();
        let (index, warning) = pick(&candidates, max_error, max_ms);
        (candidates[index].quality, warning)
    }

    #[test]
    fn the_cheapest_tier_that_is_good_enough_is_taken() {
        assert_eq!(taken(Some(0.05), None), ("draft", None));
        assert_eq!(taken(Some(0.02), Some(20.0)), ("standard", None));
    }

    #[test]
    fn the_best_tier_that_is_fast_enough_is_taken() {
        assert_eq!(taken(None, Some(11.5)), ("standard", None));
        assert_eq!(taken(None, Some(100.0)), ("high", None));
    }

    #[test]
    fn limits_that_cannot_be_met_are_named() {
        let (quality, warning) = taken(Some(0.001), None);
        assert_eq!(quality, "standard");
        assert!(warning.unwrap().contains("an error of 1.00 % instead of 0.10 %"));
        let (quality, warning) = taken(None, Some(2.0));
        assert_eq!(quality, "split-sum");
        assert!(warning.unwrap().contains("8.0 ms a frame instead of 2.0 ms"));
        // The error comes first.
        let (quality, warning) = taken(Some(0.02), Some(10.0));
        assert_eq!(quality, "standard");
        assert!(warning.unwrap().contains("11.0 ms a frame"));
    }
}
