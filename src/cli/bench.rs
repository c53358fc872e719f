//! `specula bench`: what settings cost in time, and what they gain in error against the reference renderer.

mod frames;
mod pareto;
mod plot;
mod report;
mod settings;
mod stage;
mod steady;
mod suite;
mod truth;

use super::clock::{self, Basis, FrameTimes, median_times};
use super::driver::DriverArgs;
use super::error::CliError;
use super::measure::{Floor, Rates};
use super::output;
use super::progress::StderrProgress;
use super::stats::{AdapterStats, Stopwatch};
use super::subject::SubjectArgs;
use super::truth::parse_error;
use super::view::ViewArgs;
use crate::capture::CaptureError;
use crate::gpu::formats::Precision;
use crate::gpu::{Gpu, GpuOptions};
use crate::metrics::truth::RelativeError;
use crate::progress::Progress;
use crate::reference::color::to_srgb8;
use crate::renderer::RenderError;
use crate::scene::{Quality, Scene, View};
use frames::{SteadyReport, steady_frames};
use report::{DisplayRow, Row, TermRow, TruthReport};
pub(super) use settings::Setting;
pub(super) use stage::{Shot, Stage};
use std::path::{Path, PathBuf};
pub(super) use truth::{Truth, TruthOptions, with_bare_textures};

/// Draws the model with every setting that trades time for error, in turn, and compares each picture with the reference
/// renderer's. The setting that --quality, --msaa and --precision ask for is the base of the comparison.
#[derive(Debug, clap::Args)]
#[command(mut_arg("model", |model| model.default_value_if("suite", clap::builder::ArgPredicate::IsPresent, "-")))]
#[command(mut_arg("size", |size| size.default_value("256x256").default_value_if("steady", "true", "1024x1024")))]
pub(super) struct BenchArgs {
    #[command(flatten)]
    subject: SubjectArgs,
    #[command(flatten)]
    view: ViewArgs,
    #[command(flatten)]
    driver: DriverArgs,
    #[command(flatten)]
    effort: EffortArgs,
    #[command(flatten)]
    suite: SuiteArgs,
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

#[derive(Debug, clap::Args)]
#[command(next_help_heading = "The suite")]
struct SuiteArgs {
    /// Time fixed scenes instead of MODEL: all, or those with these names or these beginnings of names, such as
    /// helmet,lights. The helmet is looked for in the folder that SPECULA_SAMPLES names.
    #[arg(
        long, value_name = "NAME,...", num_args = 0..=1, value_delimiter = ',', default_missing_value = "",
        conflicts_with_all = NOT_OF_THE_SUITE,
    )]
    suite: Option<Vec<String>>,
    /// Compare the suite with another build of the program, which runs in turn with this one, or with the figures in a
    /// .json file that --stats has written.
    #[arg(long, value_name = "PROGRAM|FILE.json")]
    baseline: Option<PathBuf>,
    /// Draw the suite as bars, with floors and baseline.
    #[arg(long, value_name = "FILE.svg")]
    plot: Option<PathBuf>,
}

/// What the scenes of the suite have of their own.
const NOT_OF_THE_SUITE: [&str; 25] = [
    "model",
    "scene",
    "variant",
    "overrides",
    "env",
    "env_rotation",
    "env_intensity",
    "specs",
    "size",
    "camera",
    "orbit",
    "target",
    "eye",
    "look_at",
    "fov",
    "ortho",
    "exposure",
    "background",
    "quality",
    "msaa",
    "steady",
    "pareto",
    "truth_samples",
    "truth_error",
    "tone_map",
];

#[derive(Debug, Clone, Copy, clap::Args)]
#[command(next_help_heading = "Measurement")]
struct EffortArgs {
    /// Draw the one setting that is asked for, and print the times of each frame: no other setting, no truth. Pictures are
    /// 1024x1024 unless --size says otherwise.
    #[arg(long, conflicts_with_all = ["pareto", "truth_samples", "truth_error"])]
    steady: bool,
    /// Do not measure what the device does at best, and leave out the floor of the frame.
    #[arg(long)]
    no_floor: bool,
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
    if let Some(names) = &args.suite.suite {
        let names: Vec<String> = names.iter().filter(|name| !name.is_empty()).cloned().collect();
        return suite::run(args, &names, &progress);
    }
    if args.suite.plot.is_some() || args.suite.baseline.is_some() {
        return Err(CliError::Usage("--plot and --baseline are for --suite; use --pareto or --stats".into()));
    }
    let (scene, warnings) = args.subject.load(&progress, &Stopwatch::default())?;
    let view = args.view.view(&scene, args.subject.has_panorama(), None)?;
    // Float targets are among the settings.
    let precision = if args.effort.steady { args.driver.precision() } else { Precision::Float };
    let gpu = Gpu::open(&args.driver.request(), GpuOptions { precision }).map_err(CliError::NeedsAdapter)?;
    if args.effort.steady {
        let report = steady(args, &gpu, (&scene, &view), warnings, &progress);
        progress.finish();
        let report = report?;
        warn(args, &report.warnings);
        return write(args, &report::json(&report)?, || report.text());
    }
    let report = measure(args, &gpu, &scene, &view, &progress);
    progress.finish();
    let mut report = report?;
    report.warnings.splice(0..0, warnings);
    warn(args, &report.warnings);
    if let Some(path) = &args.pareto {
        output::write(path, plot::svg(&report).as_bytes())?;
    }
    write(args, &report::json(&report)?, || report.text())
}

fn warn(args: &BenchArgs, warnings: &[String]) {
    if !args.quiet {
        warnings.iter().for_each(|warning| eprintln!("specula: warning: {warning}"));
    }
}

/// Writes a report to where it is wanted.
fn write(args: &BenchArgs, json: &str, text: impl FnOnce() -> String) -> Result<(), CliError> {
    if let Some(path) = &args.stats {
        output::write(path, json.as_bytes())?;
    }
    let text = if args.json { json.to_owned() } else { text() };
    output::write(Path::new("-"), text.as_bytes())
}

/// The base setting alone.
fn steady(
    args: &BenchArgs,
    gpu: &Gpu,
    (scene, view): (&Scene, &View),
    warnings: Vec<String>,
    progress: &dyn Progress,
) -> Result<SteadyReport, CliError> {
    let basis = args.effort.clock.unwrap_or_else(|| Basis::suiting(gpu));
    let setting = Setting::new(view.quality, args.driver.capture_options(), args.driver.paths_on(gpu));
    let mut stage = Stage::new(gpu, scene, args.subject.cache());
    let (steady, shot) = steady_frames(&mut stage, (setting, view), (args.effort.frames, basis), progress)?;
    let floor = floor_of(args, gpu, (&stage, &shot), (basis, &steady.median), progress)?;
    Ok(SteadyReport {
        schema: "specula-steady/1",
        specula: env!("CARGO_PKG_VERSION"),
        model: args.subject.model().display().to_string(),
        environment: args.subject.environment_name().to_owned(),
        adapter: AdapterStats::of(gpu),
        basis,
        steady,
        floor,
        warnings,
    })
}

/// The floor of a shot whose frames take `median`, unless it is not wanted.
fn floor_of(
    args: &BenchArgs,
    gpu: &Gpu,
    (stage, shot): (&Stage<'_>, &Shot),
    (basis, median): (Basis, &FrameTimes),
    progress: &dyn Progress,
) -> Result<Option<Floor>, CliError> {
    if args.effort.no_floor {
        return Ok(None);
    }
    let of = stage.floor_of(shot);
    let rates = Rates::measure(gpu, basis, &of.fills(), progress)?;
    Ok(of.floor(&rates, median).map_err(|error| CaptureError::from(RenderError::from(error)))?)
}

fn measure(
    args: &BenchArgs,
    gpu: &Gpu,
    scene: &Scene,
    view: &View,
    progress: &dyn Progress,
) -> Result<report::Report, CliError> {
    let EffortArgs { frames, clock, truth_samples, truth_error, .. } = args.effort;
    let cache = args.subject.cache();
    let basis = clock.unwrap_or_else(|| Basis::suiting(gpu));
    let capture = args.driver.capture_options();
    let base = Setting::new(view.quality, capture, args.driver.paths_on(gpu));
    let mut stage = Stage::new(gpu, scene, cache);
    let (base_shot, others, warnings) = shots(&mut stage, base, (scene, view), progress)?;
    let shots: Vec<Shot> = std::iter::once(base_shot).chain(others).collect();
    let times = stage.measure(&shots, frames, progress)?;
    basis.check(times.iter().flatten())?;
    let median = times.first().and_then(|frames| median_times(frames));
    let floor =
        median.map(|median| floor_of(args, gpu, (&stage, &shots[0]), (basis, &median), progress)).transpose()?;
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
        floor: floor.flatten(),
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
