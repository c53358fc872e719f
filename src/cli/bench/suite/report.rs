//! What the suite has measured, as a table and as JSON.

use super::super::frames::SteadyFrames;
use super::super::report::{table, time_text};
use super::baseline::Comparison;
use super::cold::ColdStart;
use crate::cli::clock::Basis;
use crate::cli::measure::{Floor, RatesReport};
use crate::cli::stats::AdapterStats;
use serde::Serialize;
use std::fmt::Write;

/// Name and version of the layout.
pub(super) const SCHEMA: &str = "specula-suite/1";

#[derive(Debug, Serialize)]
pub(super) struct SuiteReport {
    pub(super) schema: &'static str,
    pub(super) specula: &'static str,
    pub(super) adapter: AdapterStats,
    /// Which of the times is compared.
    pub(super) basis: Basis,
    /// None with --no-floor.
    pub(super) rates: Option<RatesReport>,
    pub(super) scenes: Vec<SceneReport>,
    pub(super) cold_start: Option<ColdStart>,
    pub(super) skipped: Vec<Skipped>,
}

#[derive(Debug, Serialize)]
pub(super) struct SceneReport {
    pub(super) name: &'static str,
    pub(super) what: &'static str,
    #[serde(flatten)]
    pub(super) steady: SteadyFrames,
    /// None with --no-floor, and for scenes that are too large for it.
    pub(super) floor: Option<Floor>,
    /// None without a baseline, or where it does not have the scene.
    pub(super) baseline: Option<Comparison>,
}

/// Something that was not measured.
#[derive(Debug, Serialize)]
pub(super) struct Skipped {
    pub(super) name: &'static str,
    pub(super) why: String,
}

impl SuiteReport {
    /// Markdown that reads well as it is.
    pub(super) fn text(&self) -> String {
        let mut text = String::new();
        let has_baseline = self.scenes.iter().any(|scene| scene.baseline.is_some());
        let mut head = vec!["scene", "pixels, samples", "wall ms", "CPU ms", "GPU ms", "floor ms", "of the floor"];
        if has_baseline {
            head.extend(["baseline ms", "of the baseline"]);
        }
        let rows = self.scenes.iter().map(|scene| {
            let [width, height] = scene.steady.size_px;
            let median = &scene.steady.median;
            let ratio = |ratio: Option<f64>| ratio.map_or_else(|| "-".into(), |ratio| format!("{ratio:.2}"));
            let mut cells = vec![
                format!("{}: {}", scene.name, scene.what),
                format!("{width}x{height}, {}", scene.steady.msaa),
                time_text(Some(median.wall_ms)),
                time_text(median.cpu_ms),
                time_text(median.gpu_ms),
                time_text(scene.floor.as_ref().map(|floor| floor.ms)),
                ratio(scene.floor.as_ref().and_then(|floor| floor.ratio)),
            ];
            if has_baseline {
                let baseline = scene.baseline;
                cells.push(time_text(baseline.map(|found| found.baseline_ms)));
                cells.push(ratio(baseline.map(|found| found.ratio)));
            }
            cells
        });
        table(&mut text, &head, rows);
        if let Some(cold) = &self.cold_start {
            text.push('\n');
            table(&mut text, &["cold start, median", "wall ms", "CPU ms"], cold.rows());
            if let Some(baseline_ms) = cold.baseline_wall_ms {
                let ratio = cold.wall_ms / baseline_ms;
                // Writing to a String cannot fail.
                let _ = writeln!(text, "\nThe baseline starts in {baseline_ms:.0} ms; this is {ratio:.2} of it.");
            }
        }
        text.push('\n');
        for Skipped { name, why } in &self.skipped {
            let _ = writeln!(text, "{name} is skipped: {why}.");
        }
        let AdapterStats { name, backend, driver, .. } = &self.adapter;
        let _ = writeln!(
            text,
            "Medians; the camera moves between frames, so that every frame is planned anew. Floors and ratios are of {}, \
             on {name} ({backend}, {driver}).",
            self.basis.name()
        );
        text
    }
}
