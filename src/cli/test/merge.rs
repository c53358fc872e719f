//! `specula merge-reports`: the parts of a run become one report, or it is said what they lack.

use super::judge::accept_command;
use super::publish::{self, PublishArgs};
use super::report::{CaseReport, Kind, SuiteReport};
use super::verdicts::visible;
use super::{blobs, text, verdict};
use crate::cli::error::CliError;
use crate::cli::output;
use std::collections::{BTreeMap, HashMap};
use std::path::{Path, PathBuf};

/// Join the reports of a suite whose cases several processes have shared.
///
/// Exit codes: 0 all cases passed or were skipped; 1 a case failed or has no golden; 2 the parts make no whole, or a case is
/// in error.
#[derive(Debug, clap::Args)]
pub(in crate::cli) struct MergeArgs {
    /// Folders of the parts, as `specula test --out` has filled them.
    #[arg(required = true, value_name = "DIR")]
    parts: Vec<PathBuf>,
    /// Folder for the report of the whole: report.html, report.json, junit.xml, blobs.
    #[arg(short, long, value_name = "DIR")]
    out: PathBuf,
    #[command(flatten)]
    publish: PublishArgs,
    /// Print report.json instead of text.
    #[arg(long, conflicts_with = "github")]
    json: bool,
}

/// A report and the folder that it comes from.
struct Part {
    folder: PathBuf,
    report: SuiteReport,
}

pub(in crate::cli) fn run(args: &MergeArgs) -> Result<(), CliError> {
    let read = |folder: &PathBuf| Ok(Part { report: SuiteReport::read(folder)?, folder: folder.clone() });
    let parts = args.parts.iter().map(read).collect::<Result<Vec<_>, CliError>>()?;
    check(&parts).map_err(CliError::Usage)?;
    // Unless that is one of the parts.
    if !args.parts.contains(&args.out) {
        publish::forget(&args.out)?;
    }
    let merged = merge(parts, &args.out)?;
    publish::publish(&merged, &args.out, &args.publish)?;
    let text = if args.json { merged.json()? } else { text::text(&merged, &args.out) };
    output::write(Path::new("-"), text.as_bytes())?;
    verdict(&merged)
}

/// Whether they are the parts of one run, each once.
fn check(parts: &[Part]) -> Result<(), String> {
    let Some((first, others)) = parts.split_first() else { return Err("there is no part to merge".into()) };
    for other in others {
        is_same_run(first, other)?;
    }
    let expected = each_part_once(parts)?;
    let mut owners: HashMap<&str, &Part> = HashMap::new();
    for part in parts {
        for case in &part.report.cases {
            if let Some(owner) = owners.insert(&case.id, part) {
                let (a, b) = (owner.folder.display(), part.folder.display());
                return Err(format!(
                    "{a} and {b}: both have the case {:?}; each belongs to one part",
                    visible(&case.id)
                ));
            }
        }
    }
    let there = owners.len();
    if there != expected {
        return Err(format!(
            "the parts have {there} of {expected} cases; give all of them the same --filter and --times"
        ));
    }
    Ok(())
}

/// Whether the two can be parts of one run.
fn is_same_run(first: &Part, other: &Part) -> Result<(), String> {
    let differ = |what: &str, a: &str, b: &str| {
        let (one, two) = (first.folder.display(), other.folder.display());
        format!(
            "{one} and {two}: {what} differ, {a:?} and {b:?}; merge what one version drew of one suite on one adapter"
        )
    };
    let (a, b) = (&first.report, &other.report);
    let same = [
        ("suites", &a.suite, &b.suite),
        ("suite files", &a.suite_hash, &b.suite_hash),
        ("versions of Specula", &a.version, &b.version),
        ("adapters", &a.adapter.name, &b.adapter.name),
        ("backends", &a.adapter.backend, &b.adapter.backend),
        ("drivers", &a.adapter.driver, &b.adapter.driver),
        ("adapter classes", &a.adapter.class, &b.adapter.class),
        ("processors", &a.adapter.cpu, &b.adapter.cpu),
    ];
    if let Some((what, a, b)) = same.into_iter().find(|(_, a, b)| a != b) {
        return Err(differ(what, &visible(a), &visible(b)));
    }
    let shared = |report: &SuiteReport| match &report.part {
        Some(part) => format!("{} in {} parts of {} cases", part.scheme, part.of, part.cases),
        None => "the whole".into(),
    };
    let (a, b) = (shared(a), shared(b));
    if a == b { Ok(()) } else { Err(differ("partitions", &a, &b)) }
}

/// Checks the numbers of the parts, and returns how many cases they have together.
fn each_part_once(parts: &[Part]) -> Result<usize, String> {
    let mut numbers: BTreeMap<usize, &Part> = BTreeMap::new();
    for part in parts {
        let number = part.report.part.as_ref().map_or(1, |part| part.number);
        if let Some(other) = numbers.insert(number, part) {
            let (a, b) = (other.folder.display(), part.folder.display());
            return Err(format!("{a} and {b}: both are part {number}; name each part once"));
        }
    }
    let Some(first) = parts.first() else { return Ok(0) };
    let Some(part) = &first.report.part else { return Ok(first.report.cases.len()) };
    // A report that was tampered with may claim any number of parts: look for gaps among those that are there.
    let missing = (1..=part.of).find(|number| !numbers.contains_key(number));
    match missing {
        Some(number) => Err(format!("part {number} of {} is missing; there are {} parts", part.of, parts.len())),
        None => Ok(part.cases),
    }
}

/// The whole, with its pictures in `out`.
fn merge(parts: Vec<Part>, out: &Path) -> Result<SuiteReport, CliError> {
    let mut merged: Option<SuiteReport> = None;
    for Part { folder, mut report } in parts {
        blobs::gather(&mut report, &folder, out)?;
        match &mut merged {
            Some(merged) => {
                merged.cases.append(&mut report.cases);
                // The parts have run beside each other.
                merged.milliseconds = merged.milliseconds.max(report.milliseconds);
            }
            None => merged = Some(SuiteReport { part: None, ..report }),
        }
    }
    let mut merged = merged.ok_or_else(|| CliError::Usage("there is no part to merge".into()))?;
    merged.cases.sort_by_key(|case| case.index);
    for case in &mut merged.cases {
        point_to_blobs(case, out);
        case.accept = case.accept.as_ref().map(|_| accept_command(&merged.suite_file, &case.id, out));
    }
    Ok(merged)
}

/// Where the run had its pictures may be another machine. A golden keeps its name: it belongs to the suite; a truth is of the
/// run.
fn point_to_blobs(case: &mut CaseReport, out: &Path) {
    let path = |blob: &Option<String>| blob.as_ref().map(|hash| out.join(blobs::file_of(hash)));
    case.paths.actual = path(&case.blobs.actual);
    case.paths.difference = path(&case.blobs.difference);
    case.paths.heat_map = path(&case.blobs.heat_map);
    if case.kind == Kind::Reference {
        case.paths.golden = path(&case.blobs.golden);
    }
}
