//! `specula compare`: how far two pictures are apart.

pub(in crate::cli) mod conditions;
pub(in crate::cli) mod measure;
pub(in crate::cli) mod pictures;
mod report;

use super::error::CliError;
use super::output;
use crate::import::{picture_from_path, picture_from_slice};
use crate::metrics::{Mask, Pair, PairError, Side};
use crate::scene::{Encoding, Picture};
use conditions::Condition;
use measure::{Measured, Metric};
pub(in crate::cli) use report::number;
use std::io::Read;
use std::path::{Path, PathBuf};

#[derive(Debug, clap::Args)]
pub(super) struct CompareArgs {
    /// Picture in question (.png or .exr); - reads it from stdin.
    actual: PathBuf,
    /// Picture that it should be, of the same kind and size.
    expected: PathBuf,
    /// Count only the pixels where this picture (.png or .exr) is at least half white.
    #[arg(long, value_name = "FILE")]
    mask: Option<PathBuf>,
    /// Metrics to compute [default: all that suit the pictures].
    #[arg(long, value_enum, value_delimiter = ',')]
    metric: Vec<Metric>,
    /// What must hold, such as 'flip.mean<=0.01,max-abs<=0.1'; without it the pictures must be equal.
    #[arg(long, value_name = "CONDITIONS", value_delimiter = ',')]
    fail: Vec<Condition>,
    /// Write the difference of each colour: .png absolute and scaled so that the largest is white, .exr as it is.
    #[arg(long, value_name = "OUT.png|.exr")]
    difference: Option<PathBuf>,
    /// Write the FLIP error of each pixel, from black over red to white.
    #[arg(long, value_name = "OUT.png")]
    heat_map: Option<PathBuf>,
    /// Print everything as JSON instead of a table.
    #[arg(long)]
    json: bool,
}

pub(super) fn run(args: &CompareArgs) -> Result<(), CliError> {
    if [&args.difference, &args.heat_map].into_iter().flatten().any(|path| path == Path::new("-")) {
        return Err(CliError::Usage("--difference and --heat-map cannot go to stdout: the results do".into()));
    }
    let inputs = [Some(&args.actual), Some(&args.expected), args.mask.as_ref()];
    if inputs.into_iter().flatten().filter(|path| *path == Path::new("-")).count() > 1 {
        return Err(CliError::Usage("only one picture can come from stdin".into()));
    }
    let (actual, expected) = (load(&args.actual)?, load(&args.expected)?);
    let mask = args.mask.as_deref().map(load).transpose()?.map(|picture| Mask::from_picture(&picture));
    let pair = Pair::new(&actual, &expected, mask.as_ref()).map_err(|error| explain(&error, args))?;
    let metrics = measure::chosen(&args.metric, &args.fail, args.heat_map.is_some(), pair.encoding())?;
    let measured = measure::measure(&pair, &metrics);
    let broken = conditions::broken(&args.fail, &measured)?;
    write_pictures(args, &pair, &measured)?;
    let text =
        if args.json { report::json(args, &pair, &measured, &broken)? } else { report::text(args, &pair, &measured) };
    output::write(Path::new("-"), text.as_bytes())?;
    verdict(args, &measured, &broken)
}

fn load(path: &Path) -> Result<Picture, CliError> {
    if path != Path::new("-") {
        return Ok(picture_from_path(path)?);
    }
    let mut bytes = Vec::new();
    let read = std::io::stdin().lock().read_to_end(&mut bytes);
    read.map_err(|error| CliError::Usage(format!("stdin: cannot read the picture: {error}")))?;
    Ok(picture_from_slice(&bytes, "stdin")?)
}

/// The error with the names of the files.
fn explain(error: &PairError, args: &CompareArgs) -> CliError {
    let (actual, expected) = (args.actual.display(), args.expected.display());
    let mask = args.mask.as_deref().unwrap_or(Path::new("mask")).display();
    let size = |(width, height): (u32, u32)| format!("{width} x {height}");
    CliError::Usage(match *error {
        PairError::Size { actual: a, expected: b } => {
            format!("{actual} is {} pixels, {expected} is {}; compare pictures of one size", size(a), size(b))
        }
        PairError::Encoding { actual: a, expected: b } => {
            format!("{actual} is {}, {expected} is {}; compare two of a kind", kind(a), kind(b))
        }
        PairError::NotFinite { side, x, y, channel, value } => {
            let file = if side == Side::Actual { actual } else { expected };
            format!("{file}: pixel ({x}, {y}): {channel} is {value}; a picture that is compared is finite everywhere")
        }
        PairError::MaskSize { mask: a, pictures } => {
            format!("{mask} is {} pixels, the pictures are {}; make the mask as large", size(a), size(pictures))
        }
        PairError::MaskEmpty => format!("{mask}: selects no pixel; make it white where pixels count"),
    })
}

/// What a picture's numbers are, in words.
fn kind(encoding: Encoding) -> &'static str {
    match encoding {
        Encoding::Srgb => "display-referred (PNG)",
        Encoding::Linear => "linear radiance (EXR)",
    }
}

fn write_pictures(args: &CompareArgs, pair: &Pair<'_>, measured: &Measured) -> Result<(), CliError> {
    let mut files = Vec::new();
    if let Some(path) = &args.difference {
        files.push((path, pictures::difference(path, pair)?));
    }
    if let (Some(path), Some(map)) = (&args.heat_map, &measured.flip_map) {
        files.push((path, pictures::heat_map(path, pair, map)?));
    }
    files.into_iter().try_for_each(|(path, bytes)| output::write(path, &bytes))
}

fn verdict(args: &CompareArgs, measured: &Measured, broken: &[(&Condition, f64)]) -> Result<(), CliError> {
    if let [(condition, value), ..] = broken {
        let more = if broken.len() > 1 { format!(" (and {} more)", broken.len() - 1) } else { String::new() };
        return Err(CliError::CheckFailed(format!("{} is {}, not {condition}{more}", condition.name, number(*value))));
    }
    if args.fail.is_empty() && measured.differing > 0.0 {
        return Err(CliError::CheckFailed(format!(
            "{} differs from {} in {:.4} % of the pixels",
            args.actual.display(),
            args.expected.display(),
            measured.differing * 100.0
        )));
    }
    Ok(())
}
