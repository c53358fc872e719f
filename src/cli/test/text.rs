//! A run for people: a line for each case, and what is needed to act on those that failed.

use super::publish;
use super::report::{CaseReport, Kind, MetricReport, Status, SuiteReport};
use super::verdicts::visible;
use crate::cli::compare::number;
use std::fmt::Write;
use std::path::Path;

/// All cases in the order of the suite, and how many there are of each state.
pub(super) fn text(report: &SuiteReport, out: &Path) -> String {
    let mut text = String::new();
    for case in &report.cases {
        // Writing to a String cannot fail.
        let _ = write_case(&mut text, case);
    }
    let of = |states: &[Status], what: &str| match report.count(states) {
        0 => None,
        count => Some(format!("{count} {what}")),
    };
    let counts = [
        of(&[Status::Pass], "passed"),
        of(&[Status::Fail], "failed"),
        of(&[Status::New], "without a golden"),
        of(&[Status::Error], "in error"),
        of(&[Status::Skipped], "skipped"),
    ];
    let counts = counts.into_iter().flatten().collect::<Vec<_>>().join(", ");
    let seconds = report.milliseconds / 1e3;
    let _ = writeln!(
        text,
        "{}: {counts}, in {seconds:.1} s on {}; {}",
        report.suite,
        report.adapter.class,
        out.join(publish::PAGE).display()
    );
    text
}

fn write_case(text: &mut String, case: &CaseReport) -> std::fmt::Result {
    let state = match case.status {
        Status::Pass => "pass",
        Status::Fail => "FAIL",
        Status::Skipped => "skip",
        Status::Error => "ERROR",
        Status::New => "NEW",
    };
    let reason = case.reason.as_ref().map_or_else(String::new, |reason| format!(": {reason}"));
    writeln!(text, "{state:5} {}{reason}", case.id)?;
    if !matches!(case.status, Status::Fail | Status::New) {
        return Ok(());
    }
    for metric in case.metrics.iter().filter(|metric| !metric.holds) {
        writeln!(text, "        {}", broken(metric))?;
    }
    let paths = [
        ("actual", &case.paths.actual),
        (if case.kind == Kind::Reference { "truth" } else { "golden" }, &case.paths.golden),
        ("difference", &case.paths.difference),
        ("flip", &case.paths.heat_map),
    ];
    for (name, path) in paths {
        if let Some(path) = path {
            writeln!(text, "        {name:10} {}", path.display())?;
        }
    }
    for finding in &case.moved {
        writeln!(text, "        {:10} {}", "moved", visible(&finding.text))?;
    }
    if let Some(changed) = changed(case) {
        writeln!(text, "        {:10} {changed}", "changed")?;
    }
    case.accept.iter().try_for_each(|command| writeln!(text, "        {:10} {command}", "accept"))
}

/// What is not as it was when the golden was drawn, as far as that is known.
pub(super) fn changed(case: &CaseReport) -> Option<String> {
    let (now, then) = (case.provenance.as_ref()?, case.golden_provenance.as_ref()?);
    let changes = [
        ("the scene's files", now.scene_hash != then.scene_hash),
        ("the settings", now.settings_hash != then.settings_hash),
        ("the adapter", now.adapter != then.adapter),
        ("the version of Specula", now.version != then.version),
    ];
    let changed: Vec<&str> = changes.into_iter().filter(|(_, changed)| *changed).map(|(name, _)| name).collect();
    Some(if changed.is_empty() { "nothing but the program".to_owned() } else { changed.join(", ") })
}

/// `flip.mean is 0.0213, not <= 0.004 (suite.toml:12)`.
pub(super) fn broken(metric: &MetricReport) -> String {
    let value = metric.value.map_or_else(|| "not a finite number".to_owned(), number);
    let remark = if metric.remark.is_empty() { String::new() } else { format!("; {}", metric.remark) };
    let MetricReport { name, comparison, limit, limit_from, .. } = metric;
    format!("{name} is {value}, not {comparison} {limit} ({limit_from}{remark})")
}
