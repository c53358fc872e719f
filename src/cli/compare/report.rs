//! What was measured, as text and as JSON.

use super::conditions::Condition;
use super::measure::Measured;
use super::{CompareArgs, kind};
use crate::cli::error::CliError;
use crate::metrics::Pair;
use serde_json::{Map, Value, json};
use std::fmt::Write;

pub(super) fn text(args: &CompareArgs, pair: &Pair<'_>, measured: &Measured) -> String {
    let (actual, expected) = (args.actual.display(), args.expected.display());
    let (width, height) = (pair.actual().width, pair.actual().height);
    let mut text = format!("{actual} against {expected}: {width} x {height}, {}", kind(pair.encoding()));
    if args.mask.is_some() {
        // Writing to a String cannot fail.
        let _ = write!(text, ", {} pixels count", pair.selected().count());
    }
    text.push('\n');
    for measurement in &measured.measurements {
        let value = measurement.value.map_or_else(|| "-".into(), number);
        let line = format!("  {:15} {value:>12}  {}", measurement.name, measurement.remark);
        let _ = writeln!(text, "{}", line.trim_end());
    }
    text
}

/// A value with the digits that matter.
pub(in crate::cli) fn number(value: f64) -> String {
    if value == 0.0 || value.abs() >= 1e-3 { format!("{value:.6}") } else { format!("{value:.3e}") }
}

/// Infinite values, as the PSNR of equal pictures, and those that do not exist are null.
pub(super) fn json(
    args: &CompareArgs,
    pair: &Pair<'_>,
    measured: &Measured,
    broken: &[(&Condition, f64)],
) -> Result<String, CliError> {
    let values: Map<String, Value> =
        measured.measurements.iter().map(|m| (m.name.to_owned(), json!(m.value))).collect();
    let remarks: Map<String, Value> = measured
        .measurements
        .iter()
        .filter(|m| !m.remark.is_empty())
        .map(|m| (m.name.to_owned(), json!(m.remark)))
        .collect();
    let report = json!({
        "schema": "specula-compare/1",
        "specula": env!("CARGO_PKG_VERSION"),
        "actual": args.actual.display().to_string(),
        "expected": args.expected.display().to_string(),
        "mask": args.mask.as_ref().map(|path| path.display().to_string()),
        "size_px": [pair.actual().width, pair.actual().height],
        "counted_pixels": pair.selected().count(),
        "equal": measured.differing == 0.0,
        "values": values,
        "remarks": remarks,
        "broken": broken.iter().map(|(condition, _)| format!("{} {condition}", condition.name)).collect::<Vec<_>>(),
    });
    let text = serde_json::to_string_pretty(&report).map_err(|error| CliError::Usage(error.to_string()))?;
    Ok(format!("{text}\n"))
}
