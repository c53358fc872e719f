//! `specula accept`: pictures of the last run become goldens. Nothing is drawn: what people have looked at is taken.

use super::golden;
use super::report::{CaseReport, SuiteReport};
use super::suite::Suite;
use crate::cli::environment::CacheArgs;
use crate::cli::error::CliError;
use crate::cli::{glob, output};
use std::path::{Path, PathBuf};

/// Make pictures of the last `specula test` goldens.
///
/// Exit codes: 0 done; 2 a picture can be no golden, or there is none.
#[derive(Debug, clap::Args)]
pub(in crate::cli) struct AcceptArgs {
    /// The suite.
    #[arg(value_name = "SUITE.toml")]
    suite: PathBuf,
    /// Names of cases, in which * stands for any text; all that failed or have no golden without any.
    #[arg(value_name = "CASE")]
    cases: Vec<String>,
    /// Instead remove the goldens that the suite has drawn for cases that it has no more.
    #[arg(long, conflicts_with_all = ["cases", "out"])]
    remove_unused: bool,
    /// Where the run has left its pictures [default: the suite's name with .out, beside it].
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

/// A picture that was checked and where it goes.
struct Accepted<'a> {
    case: &'a CaseReport,
    png: Vec<u8>,
    golden: PathBuf,
}

pub(in crate::cli) fn run(args: &AcceptArgs) -> Result<(), CliError> {
    let suite = Suite::read(&args.suite, &CacheArgs::default())?;
    if args.remove_unused {
        let removed = suite.remove_unused_goldens()?;
        let text: String = removed.iter().map(|path| format!("removed {}\n", path.display())).collect();
        return output::write(Path::new("-"), text.as_bytes());
    }
    let out = args.out.clone().unwrap_or_else(|| suite.default_out());
    let report = SuiteReport::read(&out)?;
    suite.check_may_bless(&report.adapter.class)?;
    let chosen = chosen(&report, &args.cases)?;
    // All are checked before one is written.
    let checked = chosen.into_iter().map(|case| check(&suite, &report, case)).collect::<Result<Vec<_>, _>>()?;
    suite.clear_stale_goldens();
    let mut names = String::new();
    for Accepted { case, png, golden } in &checked {
        if let Some(provenance) = &case.provenance {
            golden::write(golden, png, (provenance, case.ingredients.as_ref()), suite.golden_bytes_max)?;
            names += &format!("accepted {} as {}\n", case.id, golden.display());
        }
    }
    if names.is_empty() {
        eprintln!("specula: there is nothing to accept");
    }
    output::write(Path::new("-"), names.as_bytes())
}

/// The cases that are named, or all that could be accepted.
fn chosen<'a>(report: &'a SuiteReport, patterns: &[String]) -> Result<Vec<&'a CaseReport>, CliError> {
    if patterns.is_empty() {
        return Ok(report.cases.iter().filter(|case| case.accept.is_some()).collect());
    }
    let fits = |case: &&CaseReport, pattern: &String| glob::matches(pattern, &case.id);
    if let Some(unknown) = patterns.iter().find(|pattern| !report.cases.iter().any(|case| fits(&case, pattern))) {
        return Err(CliError::Usage(format!("no case of the last run is called {unknown}")));
    }
    Ok(report.cases.iter().filter(|case| patterns.iter().any(|pattern| fits(case, pattern))).collect())
}

/// The picture of a case, if it can be a golden.
fn check<'a>(suite: &Suite, report: &SuiteReport, case: &'a CaseReport) -> Result<Accepted<'a>, CliError> {
    let refuse = |why: String| CliError::Usage(format!("{}: {why}", case.id));
    let again = "run `specula test` again";
    if case.accept.is_none() {
        let why = case.reason.clone().unwrap_or_else(|| "it has passed".into());
        return Err(refuse(format!("there is nothing to accept: {why}")));
    }
    let now = suite.cases.iter().find(|other| other.id == case.id);
    let is_current = now.is_some_and(|now| now.settings == case.settings && now.model == case.model);
    if !is_current {
        return Err(refuse(format!("the suite has another such case now; {again}")));
    }
    let path = case.paths.actual.clone().ok_or_else(|| refuse("there is no picture".into()))?;
    let png = golden::read_judged(&path, case.paths.actual_hash.as_deref()).map_err(refuse)?;
    let picture = golden::decode(&png).map_err(refuse)?;
    if let Some(flaw) = golden::blank(&picture.rgba) {
        return Err(refuse(flaw));
    }
    Ok(Accepted { case, png, golden: suite.golden(&case.id, &report.adapter.class) })
}
