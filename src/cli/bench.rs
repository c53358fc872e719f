//! `specula bench`: what settings cost in time, and what they gain in error against the reference renderer.

mod clock;
mod pareto;
mod plot;
mod report;
mod settings;
mod stage;
mod steady;
mod truth;

use super::driver::DriverArgs;
use super::error::CliError;
use super::output;
use super::progress::StderrProgress;
use super::stats::{AdapterStats, Stopwatch};
use super::subject::SubjectArgs;
use super::truth::parse_error;
use super::view::ViewArgs;
use crate::gpu::formats::Precision;
use crate::gpu::{Gpu, GpuOptions};
use crate::metrics::truth::RelativeError;
use crate::progress::Progress;
use crate::reference::color::to_srgb8;
use crate::scene::{Quality, Scene, View};
pub(super) use clock::{Basis, median_ms, process_ms};
use clock::{FrameTimes, median_times};
use report::{DisplayRow, Row, TermRow, TruthReport};
pub(super) use settings::Setting;
pub(super) use stage::{Shot, Stage};
use std::path::{Path, PathBuf};
pub(super) use truth::{Truth, TruthOptions, with_bare_textures};

/// Draws the model with every setting that trades time for error, in turn, and compares each picture with the reference
/// renderer's. The setting that --quality, --msaa and --precision ask for is the base of the comparison.
#[derive(Debug, clap::Args)]
#[command(mut_arg("size", |size| size.default_value("256x256")))]
pub(super) struct BenchArgs {
    #[command(flatten)]
    subject: SubjectArgs,
    #[command(flatten)]
    view: ViewArgs,
    #[command(flatten)]
    driver: DriverArgs,
    #[command(flatten)]
    effort: EffortArgs,
    /// Print everything as JSON instead of tables.
    #[arg(long)]
    json: bool,
    /// Write the same JSON to a file.
    #[arg(long, value_name = "FILE.json")]
    stats: Option<PathBuf>,
    /// Draw error over time, with the front of the settings that no other beats in both.
    #[arg(long, value_name = "FILE.svg")]
    pareto: Option<PathBuf>,
    /// Print neither progress nor warnings.
    #[arg(short, long)]
    quiet: bool,
}

#[derive(Debug, Clone, Copy, clap::Args)]
#[command(next_help_heading = "Measurement")]
struct EffortArgs {
    /// Frames of each setting, of which the median counts.
    #[arg(long, value_name = "N", default_value_t = 30, value_parser = clap::value_parser!(u32).range(1..))]
    frames: u32,
    /// What settings are compared by. By default the processors' time on a software driver, else the GPU's own clock where
    /// it has one.
    #[arg(long, value_enum)]
    clock: Option<Basis>,
    /// Samples a pixel of the truth, for each term of the light: they contain its edges and textures.
    #[arg(long, value_name = "N", default_value_t = 128, value_parser = clap::value_parser!(u32).range(8..))]
    truth_samples: u32,
    /// Stop sampling a term at this standard error, relative to its radiance.
    #[arg(long, value_name = "PERCENT%", value_parser = parse_error)]
    truth_error: Option<f64>,
}

pub(super) fn run(args: &BenchArgs) -> Result<(), CliError> {
    if args.driver.is_reference() {
        return Err(CliError::Usage("bench measures the GPU against the reference; leave out --renderer".into()));
    }
    let progress = StderrProgress::new(args.quiet);
    let (scene, warnings) = args.subject.load(&progress, &Stopwatch::default())?;
    let view = args.view.view(&scene, args.subject.has_panorama())?;
    // Float targets are among the settings.
    let gpu = Gpu::open(&args.driver.request(), GpuOptions { precision: Precision::Float });
    let gpu = gpu.map_err(CliError::NeedsAdapter)?;
    let report = measure(args, &gpu, &scene, &view, &progress);
    progress.finish();
    let mut report = report?;
    report.warnings.splice(0..0, warnings);
    if !args.quiet {
        report.warnings.iter().for_each(|warning| eprintln!("specula: warning: {warning}"));
    }
    write(args, &report)
}

fn write(args: &BenchArgs, report: &report::Report) -> Result<(), CliError> {
    let json = report.json()?;
    if let Some(path) = &args.stats {
        output::write(path, json.as_bytes())?;
    }
    if let Some(path) = &args.pareto {
        output::write(path, plot::svg(report).as_bytes())?;
    }
    let text = if args.json { json } else { report.text() };
    output::write(Path::new("-"), text.as_bytes())
}

fn measure(
    args: &BenchArgs,
    gpu: &Gpu,
    scene: &Scene,
    view: &View,
    progress: &dyn Progress,
) -> Result<report::Report, CliError> {
    let EffortArgs { frames, clock, truth_samples, truth_error } = args.effort;
    let cache = args.subject.cache();
    let basis = clock.unwrap_or_else(|| Basis::suiting(gpu));
    let capture = args.driver.capture_options();
    let base = Setting::new(view.quality, capture, args.driver.paths_on(gpu));
    let mut stage = Stage::new(gpu, scene, cache);
    let (base_shot, others, warnings) = shots(&mut stage, base, (scene, view), progress)?;
    let shots: Vec<Shot> = std::iter::once(base_shot).chain(others).collect();
    let times = stage.measure(&shots, frames, progress)?;
    if times.iter().flatten().any(|frame| basis.of(frame).is_none()) {
        return Err(CliError::Usage(format!("{} is not known on this machine; take another --clock", basis.name())));
    }
    let options = TruthOptions { samples: truth_samples, relative_error: truth_error, progress };
    let picture = Truth::of_picture(scene, view, &options);
    let bare = with_bare_textures(scene);
    let mut light =
        Light { truth: Truth::of_shading(&bare, view, &options), stage: Stage::new(gpu, &bare, cache), view };
    Ok(report::Report::new(report::Parts {
        model: args.subject.model().display().to_string(),
        environment: args.subject.environment_name().to_owned(),
        adapter: AdapterStats::of(gpu),
        size_px: view.size_px.to_array(),
        frames,
        basis,
        picture_truth: TruthReport::new(picture.samples, &picture.error(&stage.radiance(&shots[0], None)?)),
        shading_truth: TruthReport::new(light.truth.samples, &light.error(base, progress)?),
        terms: light.terms(base, scene.lit_environment().is_some(), progress)?,
        display: display(&mut stage, &shots[0], &picture)?,
        rows: rows((&mut stage, &picture), &mut light, shots.iter().zip(&times), (basis, progress))?,
        warnings,
    }))
}

/// What is drawn with the base, and with every other setting that the adapter can draw; warnings name those that it cannot.
fn shots(
    stage: &mut Stage<'_>,
    base: Setting,
    (scene, view): (&Scene, &View),
    progress: &dyn Progress,
) -> Result<(Shot, Vec<Shot>, Vec<String>), CliError> {
    let first = stage.shot(base, view, progress)?;
    let (mut others, mut warnings) = (Vec::new(), Vec::new());
    for setting in settings::settings(base, scene.lit_environment().is_some()).into_iter().skip(1) {
        match stage.shot(setting, view, progress) {
            Ok(shot) => others.push(shot),
            Err(error) => warnings.push(format!("{setting} is left out: {error}")),
        }
    }
    Ok((first, others, warnings))
}

/// Both errors and the times of every shot; the first is the base.
fn rows<'t>(
    (stage, picture): (&mut Stage<'_>, &Truth),
    light: &mut Light<'_>,
    timed: impl Iterator<Item = (&'t Shot, &'t Vec<FrameTimes>)>,
    (basis, progress): (Basis, &dyn Progress),
) -> Result<Vec<Row>, CliError> {
    let mut rows = Vec::new();
    let mut base: Option<&[FrameTimes]> = None;
    for (shot, frames) in timed {
        let base = *base.get_or_insert(frames);
        let (Some(times), Some(ratio)) = (median_times(frames), ratio_of(frames, base, basis)) else { continue };
        let actual = stage.radiance(shot, None)?;
        let errors = (picture.error(&actual), light.error(shot.setting, progress)?);
        let flip_mean = picture.flip_mean(&actual).map_err(|error| CliError::Usage(error.to_string()))?;
        rows.push(Row::new(&shot.setting, times, ratio, (&errors.0, &errors.1), flip_mean));
    }
    Ok(rows)
}

/// The median over rounds of a setting's time over the base's in the same round.
fn ratio_of(frames: &[FrameTimes], base: &[FrameTimes], basis: Basis) -> Option<f64> {
    let pairs = frames.iter().zip(base);
    clock::median(pairs.filter_map(|(frame, base)| Some(basis.of(frame)? / basis.of(base)?)))
}

/// The light alone: a scene with bare textures, its truth, and how it is drawn.
pub(super) struct Light<'a> {
    pub(super) truth: Truth,
    pub(super) stage: Stage<'a>,
    pub(super) view: &'a View,
}

impl Light<'_> {
    /// The error of a setting, whatever its samples.
    pub(super) fn error(&mut self, setting: Setting, progress: &dyn Progress) -> Result<RelativeError, CliError> {
        let shot = self.stage.shot(setting.with_one_sample(), self.view, progress)?;
        Ok(self.truth.error(&self.stage.radiance(&shot, None)?))
    }

    /// The error of each term in every tier, relative to the radiance of all terms together.
    fn terms(&mut self, base: Setting, tiers: bool, progress: &dyn Progress) -> Result<Vec<TermRow>, CliError> {
        let mut rows = Vec::new();
        for quality in Quality::ALL.into_iter().filter(|&quality| tiers || quality == base.quality) {
            let setting = Setting { quality, ..base }.with_one_sample();
            let shot = self.stage.shot(setting, self.view, progress)?;
            let mut errors = Vec::new();
            for term in self.truth.terms() {
                let actual = self.stage.radiance(&shot, Some(term))?;
                errors.extend(self.truth.error_of_term(term, &actual).map(|error| (term, error)));
            }
            rows.push(TermRow::new(quality, &errors));
        }
        Ok(rows)
    }
}

/// What the display pass adds: its codes against those that float64 makes of the same radiance.
fn display(stage: &mut Stage<'_>, shot: &Shot, truth: &Truth) -> Result<DisplayRow, CliError> {
    let view = truth.display_view();
    let frame = stage.display(shot, &view)?;
    let expected = frame.radiance.map(|radiance| to_srgb8(&radiance, &view)).unwrap_or_default();
    let codes = expected.into_iter().zip(frame.display.unwrap_or_default());
    Ok(DisplayRow::new(codes.map(|(expected, code)| expected.abs_diff(code))))
}
