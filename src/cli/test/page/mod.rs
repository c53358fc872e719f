//! A report as one page that needs nothing else: no network, no files beside it.
//!
//! All text goes through the templates, which escape it, and through [`visible`]. The page's policy lets nothing run but
//! the script with the nonce, which is a hash of the report: no name in a report can contain it.

mod pictures;
#[cfg(test)]
mod tests;

use super::report::{AdapterReport, CaseReport, Kind, MetricReport, Provenance, Status, SuiteReport};
use super::text::changed;
use super::verdicts::visible;
use crate::cli::compare::number;
use crate::cli::error::CliError;
use maud::{DOCTYPE, Markup, PreEscaped, html};
use pictures::{Budget, Shown};
use std::path::Path;

const STYLE: &str = include_str!("page.css");
const SCRIPT: &str = include_str!("page.js");

/// Cases that are open at first.
const OPEN: usize = 3;

/// How pictures can be looked at: the name in page.js and the one on the button.
const MODES: [(&str, &str); 5] = [
    ("side", "Side by side"),
    ("slider", "Slider"),
    ("flicker", "Flicker"),
    ("difference", "Difference"),
    ("heat", "FLIP"),
];

/// The page of the report that is in `folder`, with pictures of at most `limit_bytes` together.
///
/// # Errors
/// When the report cannot be written as JSON.
pub(super) fn html(report: &SuiteReport, folder: &Path, limit_bytes: u64) -> Result<String, CliError> {
    let nonce = blake3::hash(report.json()?.as_bytes()).to_hex();
    let policy = format!(
        "default-src 'none'; img-src data:; style-src 'nonce-{nonce}'; script-src 'nonce-{nonce}'; base-uri 'none'; \
         form-action 'none'"
    );
    let mut budget = Budget::new(folder, limit_bytes);
    let mut cases = Vec::new();
    for (index, case) in report.by_error().into_iter().enumerate() {
        let is_open = index < OPEN && case.status.is_broken();
        cases.push(of_case(case, &budget.take(case), is_open));
    }
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta http-equiv="Content-Security-Policy" content=(policy);
                meta name="viewport" content="width=device-width, initial-scale=1";
                title { (visible(&report.suite)) ": " (report.summary()) }
                style nonce=(nonce) { (PreEscaped(STYLE)) }
            }
            body {
                (header(report))
                main { @for case in &cases { (case) } }
                script nonce=(nonce) { (PreEscaped(SCRIPT)) }
            }
        }
    };
    Ok(page.into_string())
}

fn header(report: &SuiteReport) -> Markup {
    let is_broken = report.cases.iter().any(|case| case.status.is_broken());
    let (shown, all) = (report.cases.len(), report.cases_in_suite);
    html! {
        header {
            h1 { (name(&report.suite)) }
            p.summary.broken[is_broken] { (report.summary()) }
            p.faint {
                (name(&report.suite_file.display().to_string())) " with Specula " (name(&report.version)) " on "
                (adapter(&report.adapter)) ", " (format!("{:.1}", report.milliseconds / 1e3)) " s"
                @if let Some(part) = &report.part {
                    "; part " (part.number) " of " (part.of) " by " (name(&part.scheme))
                }
                @if shown != all { "; " (shown) " of the suite's " (all) " cases" }
            }
            noscript { p { "Without scripts all pictures are shown, but none can be moved." } }
            div.filters {
                @for status in Status::ALL {
                    @let count = report.count(&[status]);
                    @if count > 0 {
                        label { input type="checkbox" value=(status.word()) checked; " " (count) " " (status.word()) }
                    }
                }
                input type="search" aria-label="Search cases" placeholder="search";
            }
        }
    }
}

fn adapter(adapter: &AdapterReport) -> Markup {
    let AdapterReport { name: device, backend, driver, class, cpu } = adapter;
    html! { (name(device)) " (" (name(backend)) ", " (name(driver)) ", class " (name(class)) ", " (name(cpu)) ")" }
}

/// A stranger's text, which cannot reorder what is around it.
fn name(text: &str) -> Markup {
    html! { bdi { (visible(text)) } }
}

fn of_case(case: &CaseReport, shown: &Shown, is_open: bool) -> Markup {
    let complaints = case.complaints();
    html! {
        details.case data-status=(case.status.word()) open[is_open] {
            summary {
                span.status.(case.status.word()) { (case.status.word()) }
                (name(&case.id))
                span.worst { (worst(case)) }
            }
            div.body {
                @if !complaints.is_empty() {
                    ul.complaints { @for line in &complaints { li { (name(line)) } } }
                }
                @if !case.moved.is_empty() { (moved(case)) }
                (stage(case, shown))
                @if let Some(command) = &case.accept { (accept(command)) }
                @if !case.metrics.is_empty() { (metrics(&case.metrics)) }
                (provenance(case))
            }
        }
    }
}

/// Why the case stands where it does, in a few words.
fn worst(case: &CaseReport) -> Markup {
    match (case.worst(), &case.reason) {
        (_, Some(reason)) => name(reason),
        (Some(metric), None) => html! {
            span.broken[!metric.holds] {
                (name(&metric.name)) ": " (metric.value.map_or_else(|| "–".into(), number)) " (" (name(&metric.comparison)) " " (metric.limit) ")"
            }
        },
        (None, None) => html! {},
    }
}

fn stage(case: &CaseReport, shown: &Shown) -> Markup {
    let has = |role: &str| shown.pictures.iter().any(|picture| picture.role == role);
    // Differences come with both sides.
    let works = |mode: &str| match mode {
        "side" => true,
        "slider" | "flicker" => has("golden") && has("actual"),
        role => has(role),
    };
    html! {
        @for remark in &shown.remarks { p.faint { (name(remark)) } }
        @if !shown.pictures.is_empty() {
            div.stage data-mode="side" tabindex="0" aria-label="Pictures" {
                div.bar {
                    @for (mode, label) in MODES {
                        @if works(mode) { button type="button" data-mode=(mode) { (label) } }
                    }
                    span.gap {}
                    button type="button" data-act="farther" aria-label="smaller" { "−" }
                    button type="button" data-act="closer" aria-label="larger" { "+" }
                    button type="button" data-act="whole" { "whole" }
                    button.only-flicker type="button" data-act="pause" { "pause" }
                    label.divide { "golden " input type="range" min="0" max="100" step="any" value="50"; " actual" }
                }
                div.views {
                    @for picture in &shown.pictures {
                        figure data-role=(picture.role) {
                            div.view {
                                img src=(picture.uri) width=(picture.width) height=(picture.height) draggable="false"
                                    alt=(format!("{} of {}", picture.label, visible(&case.id)));
                            }
                            figcaption { (picture.label) " " (name(&picture.remark)) }
                        }
                    }
                }
                output.readout {}
                p.hint {
                    "Click a picture; then the wheel zooms, dragging moves it or the line, a double click shows the whole. \
                     Keys: 1 to 5, + − 0, arrows, space."
                }
            }
        }
    }
}

fn moved(case: &CaseReport) -> Markup {
    html! {
        h2 { @if case.kind == Kind::Golden { "What has moved since the golden" } @else { "What is not as it should be" } }
        ul.moved { @for finding in &case.moved { li { (name(&finding.text)) } } }
    }
}

fn accept(command: &str) -> Markup {
    html! {
        h2 { "To accept the picture of this run" }
        div.accept {
            pre { code { (visible(command)) } }
            button.copy type="button" { "copy" }
        }
    }
}

fn metrics(metrics: &[MetricReport]) -> Markup {
    html! {
        h2 { "Measured" }
        table {
            tr { th { "metric" } th { "value" } th { "limit" } th { "from" } th { "" } }
            @for metric in metrics {
                tr.broken[!metric.holds] {
                    td { (name(&metric.name)) }
                    td.number { (metric.value.map_or_else(|| "–".into(), number)) }
                    td.number { (name(&metric.comparison)) " " (metric.limit) }
                    td { (name(&metric.limit_from)) }
                    td { (name(&metric.remark)) }
                }
            }
        }
    }
}

fn provenance(case: &CaseReport) -> Markup {
    let settings = case.settings.join(" ");
    html! {
        h2 { "Made of" }
        table {
            tr { th { "model" } td { (name(&case.model)) } }
            tr { th { "settings" } td { code { (name(&settings)) } } }
            tr { th { "line of the suite" } td { (case.line) } }
            tr {
                th { "time" }
                td {
                    (format!("{:.0} ms: {:.0} loading, {:.0} drawing, {:.0} judging", case.milliseconds(),
                        case.times.load_ms, case.times.draw_ms, case.times.judge_ms))
                }
            }
            @if let Some(changed) = changed(case).filter(|_| case.status.is_broken()) {
                tr { th { "changed since the golden" } td { (changed) } }
            }
            @for (label, made) in [("this run", &case.provenance), ("golden", &case.golden_provenance)] {
                @if let Some(made) = made { (made_by(label, made)) }
            }
        }
    }
}

fn made_by(label: &str, made: &Provenance) -> Markup {
    html! {
        tr {
            th { (label) }
            td {
                "Specula " (name(&made.version)) " on " (adapter(&made.adapter)) br;
                "scene " code { (name(&made.scene_hash)) } br;
                "picture " code { (name(&made.picture_hash)) } br;
                "settings " code { (name(&made.settings_hash)) } " " code { (name(&made.settings.join(" "))) }
            }
        }
    }
}
