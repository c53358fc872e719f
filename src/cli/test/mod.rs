//! `specula test`: pictures of a suite against goldens, the reference and the laws of energy.
//!
//! One thread draws, case by case, on one device; others compare and write meanwhile.

mod accept;
mod adapter;
mod annotations;
mod blobs;
mod comparison;
mod date;
mod drawing;
mod golden;
mod ingredients;
mod judge;
mod junit;
mod limits;
mod merge;
mod page;
mod part;
mod partition;
mod publish;
mod report;
mod run;
#[cfg(test)]
mod schema;
mod second_look;
mod suite;
mod text;
mod unused;
mod verdicts;

pub(super) use accept::{AcceptArgs, run as accept};
pub(super) use merge::{MergeArgs, run as merge};
pub(super) use partition::{PartitionRequest, Share};

use super::driver::DeviceArgs;
use super::environment::CacheArgs;
use super::error::CliError;
use super::glob;
use super::output;
use super::progress::StderrProgress;
use crate::gpu::formats::Precision;
use crate::gpu::{Gpu, GpuOptions};
use judge::{Judge, Update};
use part::PartArgs;
use publish::PublishArgs;
use report::{AdapterReport, SuiteReport};
use run::Plan;
use std::path::{Path, PathBuf};
use std::time::Instant;
use suite::{Case, Suite};

/// Draw the cases of a suite and compare them with their goldens.
///
/// Exit codes: 0 all passed or were skipped; 1 a case failed or has no golden; 2 the suite or a case cannot be used; 3 no
/// adapter.
#[derive(Debug, clap::Args)]
pub(super) struct TestArgs {
    /// The suite (docs/ci.md says what is in it).
    #[arg(value_name = "SUITE.toml")]
    suite: PathBuf,
    /// Print the names of the cases, and draw none.
    #[arg(long)]
    list: bool,
    /// Take the cases with such names alone; * stands for any text. Repeat for more.
    #[arg(long, value_name = "GLOB")]
    filter: Vec<String>,
    /// Take the cases alone that failed in the last run into the same folder, or had no golden.
    #[arg(long)]
    failed: bool,
    /// Draw every case so often, from the upload on, and fail where a single bit differs.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=1000))]
    repeat: u32,
    /// Write goldens: those that are missing (new), those that pictures fail against (changed), or all that differ.
    #[arg(long, value_enum, value_name = "new|changed|all")]
    update: Option<Update>,
    /// Where pictures, report.html, report.json and junit.xml go [default: the suite's name with .out, beside it].
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Threads that compare and write, beside the one that draws.
    #[arg(short, long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..=256))]
    jobs: u16,
    #[command(flatten)]
    part: PartArgs,
    #[command(flatten)]
    publish: PublishArgs,
    #[command(flatten)]
    device: DeviceArgs,
    #[command(flatten)]
    cache: CacheArgs,
    /// Print report.json instead of text.
    #[arg(long, conflicts_with = "github")]
    json: bool,
    /// Print no progress.
    #[arg(short, long)]
    quiet: bool,
}

pub(super) fn run(args: &TestArgs) -> Result<(), CliError> {
    let start = Instant::now();
    let suite = Suite::read(&args.suite, &args.cache)?;
    let out = args.out.clone().unwrap_or_else(|| suite.default_out());
    let mut chosen = chosen(&suite, &args.filter)?;
    if args.failed {
        chosen = still_broken(&chosen, &out)?;
    }
    let (cases, part) = args.part.take(&chosen)?;
    if args.list {
        let names: String = cases.iter().map(|case| format!("{}\n", case.id)).collect();
        return output::write(Path::new("-"), names.as_bytes());
    }
    // Of all parts, so that they draw alike.
    let precisions = chosen.iter().map(|case| case.args.frame.precision());
    let precision = precisions.max_by_key(|precision| *precision == Precision::Float).unwrap_or_default();
    let gpu = Gpu::open(&args.device.request(), GpuOptions { precision }).map_err(CliError::NeedsAdapter)?;
    let adapter = AdapterReport::of(&gpu);
    if args.update.is_some() {
        suite.check_may_bless(&adapter.class)?;
    }
    publish::forget(&out)?;
    suite.clear_stale_goldens();
    let progress = StderrProgress::new(args.quiet);
    let judge = Judge { suite: &suite, adapter: &adapter, out: &out, update: args.update, times: args.repeat };
    let plan = Plan { cases: &cases, judge: &judge, jobs: args.jobs.into(), cache: &args.cache };
    let cases = plan.run(&gpu, &progress);
    progress.finish();
    let mut report = SuiteReport {
        schema: report::SCHEMA.into(),
        suite: suite.name.clone(),
        suite_file: suite.file.clone(),
        suite_hash: suite.hash.clone(),
        version: env!("CARGO_PKG_VERSION").into(),
        adapter: adapter.clone(),
        part,
        cases_in_suite: suite.cases.len(),
        cases,
        milliseconds: start.elapsed().as_secs_f64() * 1e3,
    };
    if report.part.is_some() {
        blobs::gather(&mut report, &out, &out)?;
    }
    publish::publish(&report, &out, &args.publish)?;
    let text = if args.json { report.json()? } else { text::text(&report, &out) };
    output::write(Path::new("-"), text.as_bytes())?;
    if !args.quiet {
        warn_of_unused(&suite);
    }
    verdict(&report)
}

/// Those of the cases that the last run into the folder has not passed.
fn still_broken<'a>(cases: &[&'a Case], out: &Path) -> Result<Vec<&'a Case>, CliError> {
    let report = SuiteReport::read(out)?;
    let is_broken = |case: &&&Case| report.cases.iter().any(|other| other.id == case.id && other.status.is_broken());
    let broken: Vec<&Case> = cases.iter().filter(is_broken).copied().collect();
    if broken.is_empty() {
        return Err(CliError::Usage(format!("{}: no such case has failed in the last run", out.display())));
    }
    Ok(broken)
}

fn warn_of_unused(suite: &Suite) {
    let unused = suite.unused_goldens();
    if let Some(first) = unused.first() {
        let more = if unused.len() > 1 { format!(" and {} more", unused.len() - 1) } else { String::new() };
        eprintln!(
            "specula: warning: of no case any more: {}{more}; `specula accept {} --remove-unused` removes such goldens",
            first.display(),
            suite.file.display()
        );
    }
}

/// The cases that fit one of the patterns; all without patterns.
fn chosen<'a>(suite: &'a Suite, patterns: &[String]) -> Result<Vec<&'a Case>, CliError> {
    let fits = |case: &&Case| patterns.is_empty() || patterns.iter().any(|pattern| glob::matches(pattern, &case.id));
    let chosen: Vec<&Case> = suite.cases.iter().filter(fits).collect();
    // A pipeline that tests nothing is green for ever.
    if chosen.is_empty() {
        let patterns = patterns.join(", ");
        return Err(CliError::Usage(format!("no case of {} is called {patterns}; see --list", suite.file.display())));
    }
    Ok(chosen)
}

/// Failures and errors as an exit code, with the first few names.
fn verdict(report: &SuiteReport) -> Result<(), CliError> {
    use report::Status::{Error, Fail, New};
    let named = |states: &[report::Status]| {
        let cases: Vec<&str> =
            report.cases.iter().filter(|case| states.contains(&case.status)).map(|case| case.id.as_str()).collect();
        let more = if cases.len() > 3 { format!(" and {} more", cases.len() - 3) } else { String::new() };
        (!cases.is_empty()).then(|| format!("{}{more}", cases[..cases.len().min(3)].join(", ")))
    };
    if let Some(names) = named(&[Error]) {
        return Err(CliError::Usage(format!("cases could not be judged: {names}")));
    }
    match named(&[Fail, New]) {
        Some(names) => Err(CliError::CheckFailed(format!("cases failed: {names}"))),
        None => Ok(()),
    }
}
