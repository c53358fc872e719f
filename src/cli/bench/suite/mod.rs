//! `specula bench --suite`: fixed scenes, each drawn again and again under a camera that moves.

mod baseline;
mod cold;
mod plot;
mod report;
mod scenes;

use super::frames::steady_frames;
use super::report::json;
use super::settings::Setting;
use super::stage::{CameraMotion, Stage};
use super::{BenchArgs, write};
use crate::capture::{CaptureError, CaptureOptions};
use crate::cli::clock::Basis;
use crate::cli::error::CliError;
use crate::cli::measure::{Fill, Rates, Target};
use crate::cli::output;
use crate::cli::progress::StderrProgress;
use crate::cli::stats::AdapterStats;
use crate::gpu::formats::Precision;
use crate::gpu::{Gpu, GpuOptions};
use crate::renderer::RenderError;
use baseline::Baseline;
use cold::cold_start;
use report::{SCHEMA, SceneReport, Skipped, SuiteReport};
use scenes::{COLD_START, SuiteScene, chosen};
use std::path::Path;

/// Everything that the scenes have in common.
struct Suite<'a> {
    args: &'a BenchArgs,
    gpu: &'a Gpu,
    basis: Basis,
    rates: Option<Rates>,
    baseline: Option<Baseline>,
    /// Flags for other processes.
    driver: Vec<String>,
    progress: &'a StderrProgress,
}

/// Measures the scenes that `names` say.
pub(super) fn run(args: &BenchArgs, names: &[String], progress: &StderrProgress) -> Result<(), CliError> {
    let (scenes, is_cold_too) = chosen(names).map_err(CliError::Usage)?;
    let baseline = args.suite.baseline.as_deref().map(Baseline::open).transpose()?;
    let precision = args.driver.precision();
    let gpu = Gpu::open(&args.driver.request(), GpuOptions { precision }).map_err(CliError::NeedsAdapter)?;
    let basis = args.effort.clock.unwrap_or_else(|| Basis::suiting(&gpu));
    let fills = fills(precision);
    let needs_rates = !args.effort.no_floor && !scenes.is_empty();
    let rates = needs_rates.then(|| Rates::measure(&gpu, basis, &fills, progress)).transpose()?;
    let suite = Suite { args, gpu: &gpu, basis, rates, baseline, driver: args.driver.arguments(), progress };
    let report = suite.report(&scenes, is_cold_too);
    progress.finish();
    let report = report?;
    if let Some(path) = &args.suite.plot {
        output::write(path, plot::svg(&report).as_bytes())?;
    }
    write(args, &json(&report)?, || report.text())
}

/// What the scenes' floors need.
fn fills(precision: Precision) -> Vec<Fill> {
    let radiance = |samples| Fill { target: Target::Radiance(precision), samples, depth: true };
    vec![radiance(1), radiance(4), Fill { target: Target::Display, samples: 1, depth: false }]
}

impl Suite<'_> {
    fn report(&self, scenes: &[&'static SuiteScene], is_cold_too: bool) -> Result<SuiteReport, CliError> {
        let (mut measured, mut skipped) = (Vec::new(), Vec::new());
        for scene in scenes {
            match self.scene(scene)? {
                Ok(found) => measured.push(found),
                Err(why) => skipped.push(Skipped { name: scene.name, why }),
            }
        }
        let mut cold = None;
        if is_cold_too {
            let program = std::env::current_exe().map_err(|error| CliError::Usage(error.to_string()))?;
            let other = self.baseline.as_ref().and_then(Baseline::program);
            match cold_start(&program, other, (self.args.effort.frames, &self.driver), self.progress)? {
                Ok(found) => cold = Some(found),
                Err(why) => skipped.push(Skipped { name: COLD_START, why }),
            }
        }
        if !self.args.quiet {
            skipped.iter().for_each(|Skipped { name, why }| eprintln!("specula: {name} is skipped: {why}"));
        }
        Ok(SuiteReport {
            schema: SCHEMA,
            specula: env!("CARGO_PKG_VERSION"),
            adapter: AdapterStats::of(self.gpu),
            basis: self.basis,
            rates: self.rates.as_ref().map(Rates::report),
            scenes: measured,
            cold_start: cold,
            skipped,
        })
    }

    /// One scene; the inner error is why it is skipped.
    fn scene(&self, scene: &'static SuiteScene) -> Result<Result<SceneReport, String>, CliError> {
        let (content, view) = match scene.build() {
            Ok(built) => built,
            Err(why) => return Ok(Err(why)),
        };
        let capture = CaptureOptions { samples: scene.samples, precision: self.args.driver.precision() };
        let setting = Setting::new(view.quality, capture, self.args.driver.paths_on(self.gpu));
        let mut stage = Stage::new(self.gpu, &content, self.args.subject.cache());
        stage.motion = CameraMotion::Sideways;
        let frames = (self.args.effort.frames, self.basis);
        let (steady, shot) = steady_frames(&mut stage, (setting, &view), frames, self.progress)?;
        let floor = self.rates.as_ref().map(|rates| stage.floor_of(&shot).floor(rates, &steady.median));
        let floor = floor.transpose().map_err(|error| CaptureError::from(RenderError::from(error)))?.flatten();
        let own_ms = self.basis.of(&steady.median);
        let compared = self.baseline.as_ref().map(|other| other.compare((scene.name, own_ms), frames, &self.driver));
        let baseline = compared.transpose()?.flatten();
        Ok(Ok(SceneReport { name: scene.name, what: scene.what, steady, floor, baseline }))
    }
}

/// What another process has said last, in one line.
fn child_failed(program: &Path, stderr: &[u8]) -> CliError {
    let text = String::from_utf8_lossy(stderr);
    let last = text.lines().rev().map(str::trim).find(|line| !line.is_empty()).unwrap_or("it says nothing");
    CliError::Usage(format!("{} has failed: {last}", program.display()))
}
