//! `specula bench --steady`: frames of one setting, one after the other, with the times of each.

use super::report::{precision_name, table, time_text};
use super::settings::Setting;
use super::stage::{Shot, Stage, WARM_UP_FRAMES};
use crate::cli::clock::{Basis, FrameTimes, median_times};
use crate::cli::error::CliError;
use crate::cli::measure::Floor;
use crate::cli::stats::AdapterStats;
use crate::progress::Progress;
use crate::scene::View;
use serde::Serialize;

/// What was drawn, and how long each frame took.
#[derive(Debug, Serialize)]
pub(in crate::cli) struct SteadyFrames {
    pub(in crate::cli) size_px: [u32; 2],
    /// What is drawn with, in words.
    pub(in crate::cli) setting: String,
    pub(in crate::cli) quality: &'static str,
    pub(in crate::cli) msaa: u32,
    pub(in crate::cli) precision: &'static str,
    /// From triangles to radiance, as it was taken: `forward`, `deferred`, or `mixed`, which is forward over deferred.
    pub(in crate::cli) path: &'static str,
    pub(in crate::cli) draws: u32,
    pub(in crate::cli) triangles: u64,
    /// Frames that were drawn before and are not counted: the first compiles shaders.
    pub(in crate::cli) warm_up_frames: u32,
    /// In the order in which they were drawn. Each ends when the device has finished it.
    pub(in crate::cli) frames: Vec<FrameTimes>,
    /// Of each of the times.
    pub(in crate::cli) median: FrameTimes,
}

/// Draws `frames` frames of a view, each of them whole.
///
/// # Errors
/// When the adapter cannot draw so, or does not know the time that is asked for.
pub(in crate::cli) fn steady_frames(
    stage: &mut Stage<'_>,
    (setting, view): (Setting, &View),
    (frames, basis): (u32, Basis),
    progress: &dyn Progress,
) -> Result<(SteadyFrames, Shot), CliError> {
    let shot = stage.shot(setting, view, progress)?;
    let drawn = stage.draw(&shot)?;
    let frames = stage.measure(std::slice::from_ref(&shot), frames, progress)?.pop().unwrap_or_default();
    basis.check(frames.iter())?;
    let nothing = || CliError::Usage("no frame was drawn; ask for more with --frames".into());
    let median = median_times(&frames).ok_or_else(nothing)?;
    let steady = SteadyFrames {
        size_px: view.size_px.to_array(),
        setting: setting.to_string(),
        quality: setting.quality.name(),
        msaa: setting.msaa,
        precision: precision_name(setting.precision),
        path: drawn.path.name(),
        draws: drawn.draws,
        triangles: drawn.triangles,
        // The one that told what is drawn, too.
        warm_up_frames: WARM_UP_FRAMES + 1,
        frames,
        median,
    };
    Ok((steady, shot))
}

impl SteadyFrames {
    /// Medians and extremes as Markdown.
    pub(in crate::cli) fn text(&self) -> String {
        let bases = [Basis::Wall, Basis::Cpu, Basis::Gpu];
        let row = |basis: Basis| {
            let times: Vec<f64> = self.frames.iter().filter_map(|frame| basis.of(frame)).collect();
            let end = |fold: fn(f64, f64) -> f64| times.iter().copied().reduce(fold);
            let cells = [basis.of(&self.median), end(f64::min), end(f64::max)];
            std::iter::once(basis.name().to_owned()).chain(cells.map(time_text)).collect()
        };
        let mut text = String::new();
        table(&mut text, &["a frame, ms", "median", "least", "most"], bases.into_iter().map(row));
        text
    }
}

/// What `--steady` prints.
#[derive(Debug, Serialize)]
pub(super) struct SteadyReport {
    /// Name and version of this layout.
    pub(super) schema: &'static str,
    pub(super) specula: &'static str,
    pub(super) model: String,
    pub(super) environment: String,
    pub(super) adapter: AdapterStats,
    /// Which of the times says most on this adapter, or was asked for.
    pub(super) basis: Basis,
    #[serde(flatten)]
    pub(super) steady: SteadyFrames,
    /// None where it was not wanted, or the scene is too large for it.
    pub(super) floor: Option<Floor>,
    pub(super) warnings: Vec<String>,
}

impl SteadyReport {
    pub(super) fn text(&self) -> String {
        let AdapterStats { name, backend, driver, .. } = &self.adapter;
        let SteadyFrames { setting, size_px: [width, height], path, draws, triangles, frames, .. } = &self.steady;
        format!(
            "{}\n{} frames after {} others, {setting}, {width}x{height} pixels, {draws} draws of {triangles} triangles by the \
             {path} path, on {name} ({backend}, {driver}).\n{}",
            self.steady.text(),
            frames.len(),
            self.steady.warm_up_frames,
            self.floor.as_ref().map(|floor| floor.text(self.basis)).unwrap_or_default(),
        )
    }
}
