//! `specula stability`: what f32 on this device makes of the shading model, and where naive forms would break.

use super::error::CliError;
use super::output;
use super::progress::StderrProgress;
use crate::gpu::{Gpu, GpuOptions, GpuRequest};
use crate::proof::fuzz::FuzzOptions;
use crate::proof::report::StabilityReport;
use crate::proof::{formulas, markdown};
use std::path::{Path, PathBuf};

#[derive(Debug, clap::Args)]
pub(super) struct StabilityArgs {
    /// Random evaluations of the forward shader, of all its variants together.
    #[arg(long, value_name = "N", default_value_t = 1 << 24, value_parser = clap::value_parser!(u64).range(1..=1 << 32))]
    evaluations: u64,
    /// Start of the random sequence.
    #[arg(long, default_value_t = 1)]
    seed: u32,
    /// Print everything as JSON instead of a document.
    #[arg(long)]
    json: bool,
    /// Write stability.md and brdf.md to this folder, and print nothing.
    #[arg(long, value_name = "FOLDER", conflicts_with = "json")]
    write: Option<PathBuf>,
    /// Part of the name of the adapter to use.
    #[arg(long, value_name = "NAME")]
    adapter: Option<String>,
}

pub(super) fn run(args: &StabilityArgs) -> Result<(), CliError> {
    let request = GpuRequest { adapter: args.adapter.clone(), backends: None };
    let gpu = Gpu::open(&request, GpuOptions::default()).map_err(CliError::NeedsAdapter)?;
    let progress = StderrProgress::new(false);
    let options = FuzzOptions { evaluations: args.evaluations, seed: args.seed };
    let report = StabilityReport::measure(&gpu, options, &progress);
    progress.finish();
    let report = report?;
    match &args.write {
        Some(folder) => write(folder, &report)?,
        None if args.json => output::write(Path::new("-"), &json(&report)?)?,
        None => output::write(Path::new("-"), markdown::stability(&report).as_bytes())?,
    }
    let offences = report.offences();
    if offences.is_empty() { Ok(()) } else { Err(CliError::CheckFailed(offences.join("\n"))) }
}

fn write(folder: &Path, report: &StabilityReport) -> Result<(), CliError> {
    let documents = [("stability.md", markdown::stability(report)), ("brdf.md", formulas::document(report))];
    for (name, text) in documents {
        let path = folder.join(name);
        output::write(&path, text.as_bytes())?;
        eprintln!("specula: wrote {}", path.display());
    }
    Ok(())
}

fn json(report: &StabilityReport) -> Result<Vec<u8>, CliError> {
    let mut bytes = serde_json::to_vec_pretty(report).map_err(|error| CliError::Usage(error.to_string()))?;
    bytes.push(b'\n');
    Ok(bytes)
}
