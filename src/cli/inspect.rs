//! `specula inspect`: what a model holds, and what made one pixel.

mod gather;
mod model;
mod report;
mod rows;
mod shaders;

use super::driver::DriverArgs;
use super::environment::bake_maps;
use super::error::CliError;
use super::output;
use super::progress::StderrProgress;
use super::stats::Stopwatch;
use super::subject::{Loaded, SubjectArgs};
use super::view::ViewArgs;
use crate::capture::PIXEL_OPTIONS;
use crate::scene::View;
use glam::UVec2;
use shaders::Shaders;
use std::path::Path;

#[derive(Debug, clap::Args)]
pub(super) struct InspectArgs {
    #[command(flatten)]
    subject: SubjectArgs,
    /// Explain this pixel of the picture that `render` would draw, counted from the top left: what it shows, and what of
    /// its light comes from where, by the shaders and by the float64 reference. Both look through the middle of it.
    #[arg(long, value_name = "X,Y", allow_hyphen_values = true)]
    pixel: Option<String>,
    #[command(flatten)]
    view: ViewArgs,
    #[command(flatten)]
    driver: DriverArgs,
    /// Samples of each technique by which the reference estimates light from the environment.
    #[arg(long, value_name = "N", default_value_t = 65536, value_parser = clap::value_parser!(u32).range(1..=1 << 24))]
    samples: u32,
    /// Print everything as JSON instead of text.
    #[arg(long)]
    json: bool,
    /// Print neither progress nor warnings on stderr.
    #[arg(short, long)]
    quiet: bool,
}

pub(super) fn run(args: &InspectArgs) -> Result<(), CliError> {
    let progress = StderrProgress::new(args.quiet);
    let watch = Stopwatch::default();
    let loaded = args.subject.load_with_file(&progress, &watch)?;
    let text = match &args.pixel {
        None => model::describe(args, &loaded)?,
        Some(pixel) => explain(args, pixel, loaded, &progress)?,
    };
    progress.finish();
    output::write(Path::new("-"), text.as_bytes())
}

fn explain(args: &InspectArgs, pixel: &str, loaded: Loaded, progress: &StderrProgress) -> Result<String, CliError> {
    let Loaded { scene, mut warnings, .. } = loaded;
    let view = args.view.view(&scene, args.subject.has_panorama(), None)?;
    let pixel = parse_pixel(pixel, &view)?;
    let gpu = args.driver.open_for(PIXEL_OPTIONS.precision, &mut warnings)?;
    let maps = || bake_maps(&scene, view.quality, args.subject.cache(), progress).map(|baked| baked.maps);
    let shaders = gpu.as_ref().map(|gpu| Shaders::new(gpu, &scene, &view, pixel, maps())).transpose()?;
    let explained = gather::explain(&scene, &view, pixel, args.samples, shaders)?;
    if !args.quiet {
        warnings.iter().for_each(|warning| eprintln!("specula: warning: {warning}"));
    }
    if args.json { report::json(args, &view, &explained) } else { Ok(report::text(args, &view, &explained)) }
}

/// A pixel of the picture.
fn parse_pixel(text: &str, view: &View) -> Result<UVec2, CliError> {
    let numbers: Option<Vec<i64>> = text.split(',').map(|number| number.trim().parse().ok()).collect();
    let Some(&[x, y]) = numbers.as_deref() else {
        return Err(CliError::Usage(format!("--pixel {text}: expected X,Y, such as 512,300")));
    };
    let (width, height) = (view.size_px.x, view.size_px.y);
    let inside = |value: i64, size: u32| u32::try_from(value).ok().filter(|value| *value < size);
    match (inside(x, width), inside(y, height)) {
        (Some(x), Some(y)) => Ok(UVec2::new(x, y)),
        _ => Err(CliError::Usage(format!(
            "--pixel {text}: the picture is {width} x {height}; X goes from 0 to {}, Y from 0 to {}",
            width - 1,
            height - 1
        ))),
    }
}
