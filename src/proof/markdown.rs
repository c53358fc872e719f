//! The reports as documents.

use super::report::StabilityReport;
use super::stress::StressReport;
use super::twin::Summary;
use std::fmt::Write;

/// `docs/stability.md`.
pub fn stability(report: &StabilityReport) -> String {
    let mut text = String::from(
        "# Numerical stability\n\n\
         Written by `specula stability --write docs`. Every function of the shading model runs in f32 on the GPU and \
         is compared with float64. Figures are those of one device and driver; `cargo test` holds the limits on the \
         device it runs on.\n\n",
    );
    let _ = writeln!(text, "Adapter: {}\n", report.adapter);
    text.push_str("## Forms beside each other\n\n");
    text.push_str(
        "Each cell is the error that 99 of 100 points do not exceed, and the largest one; `n.f.` counts results that \
         are infinite or NaN. The first row is the form in use, the others are what it was chosen over.\n\n",
    );
    for stress in &report.stresses {
        forms(&mut text, stress);
    }
    edge_cases(&mut text, report);
    fuzz(&mut text, report);
    functions(&mut text, report);
    text.truncate(text.trim_end().len() + 1);
    text
}

/// Rows of a table, the first of them the head.
pub(super) fn table(text: &mut String, rows: &[Vec<String>]) {
    for (index, row) in rows.iter().enumerate() {
        let _ = writeln!(text, "| {} |", row.join(" | "));
        if index == 0 {
            let _ = writeln!(text, "|{}", "---|".repeat(row.len()));
        }
    }
    text.push('\n');
}

pub(super) fn code(text: &str) -> String {
    format!("`{text}`")
}

/// Two digits of an error.
pub(super) fn error(value: f64) -> String {
    match value {
        0.0 => "0".to_owned(),
        _ if value.is_infinite() => "inf".to_owned(),
        0.1..10.0 => format!("{value:.1}"),
        10.0..1e4 => format!("{value:.0}"),
        _ => format!("{value:.1e}"),
    }
}

fn cells(columns: &[&str]) -> Vec<String> {
    columns.iter().map(|column| (*column).to_owned()).collect()
}

fn forms(text: &mut String, stress: &StressReport) {
    let _ = writeln!(text, "### {}\n\n{}\n", stress.title, stress.why);
    let head = std::iter::once(stress.axis.to_owned()).chain(stress.groups.iter().cloned()).collect();
    let rows = stress.forms.iter().map(|form| {
        let name = if form.in_use { format!("**`{}`**", form.function) } else { code(form.function) };
        std::iter::once(name).chain(form.groups.iter().map(group)).collect()
    });
    table(text, &std::iter::once(head).chain(rows).collect::<Vec<_>>());
}

fn group(summary: &Summary) -> String {
    let figures = format!("{} / {}", error(summary.p99), error(summary.worst));
    match summary {
        Summary { comparisons: 0, .. } => "-".to_owned(),
        Summary { not_finite: 0, .. } => figures,
        Summary { not_finite, comparisons, .. } => format!("{figures}, {not_finite} of {comparisons} n.f."),
    }
}

fn edge_cases(text: &mut String, report: &StabilityReport) {
    text.push_str("## Single points\n\n");
    let head = cells(&["case", "right", "form in use", "gives", "naive form", "gives"]);
    let rows = report.edge_cases.iter().map(|case| {
        let (used, naive) = (code(case.function), code(case.naive_function));
        vec![case.title.to_owned(), case.expected.clone(), used, case.used.clone(), naive, case.naive.clone()]
    });
    table(text, &std::iter::once(head).chain(rows).collect::<Vec<_>>());
}

fn fuzz(text: &mut String, report: &StabilityReport) {
    let total: u64 = report.fuzz.shaders.iter().map(|found| found.evaluations).sum();
    let _ = writeln!(
        text,
        "## Search for faults\n\n\
         Random materials, lights and views through the whole forward shader, a third of the parameters of materials at or \
         beyond the ends of their ranges: {total} evaluations, seed {}. Nothing that is stored may be NaN, infinite or \
         negative.\n",
        report.fuzz.seed
    );
    let head = cells(&["shader", "evaluations", "not black", "NaN", "infinite", "negative"]);
    let rows = report.fuzz.shaders.iter().map(|found| {
        let counts = [found.evaluations, found.lit].into_iter().chain(found.faults.iter().map(|fault| fault.count));
        std::iter::once(found.shader.to_owned()).chain(counts.map(|count| count.to_string())).collect()
    });
    table(text, &std::iter::once(head).chain(rows).collect::<Vec<_>>());
    for found in &report.fuzz.shaders {
        for first in found.faults.iter().filter_map(|fault| fault.first.as_ref()) {
            let _ = writeln!(text, "First in {}: {first}\n", found.shader);
        }
    }
}

fn functions(text: &mut String, report: &StabilityReport) {
    text.push_str("## Every function\n\nOn the grids of the twin tests, with the limits that they hold.\n\n");
    let head = cells(&["function", "file", "comparisons", "error", "p99", "worst", "limit"]);
    let rows = report.functions.iter().map(|row| {
        let errors = &row.errors;
        let figures = [error(errors.p99), error(errors.worst), error(row.limit)];
        let start = [code(row.function), code(row.file), errors.comparisons.to_string(), row.scale.to_owned()];
        start.into_iter().chain(figures).collect()
    });
    table(text, &std::iter::once(head).chain(rows).collect::<Vec<_>>());
}

/// What has to be the same wherever a document was measured: headings, heads of tables, and the names of their rows.
pub fn structure(document: &str) -> Vec<String> {
    let mut lines = Vec::new();
    let mut in_table = false;
    for line in document.lines() {
        match line.strip_prefix('|') {
            Some(head) if !in_table => lines.push(head.to_owned()),
            Some(row) => lines.push(row.split('|').next().unwrap_or_default().trim().to_owned()),
            None if line.starts_with('#') => lines.push(line.to_owned()),
            None => {}
        }
        in_table = line.starts_with('|');
    }
    lines
}
