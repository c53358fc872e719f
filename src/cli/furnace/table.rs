//! What was found, as text and as JSON.

use super::Checked;
use crate::cli::error::CliError;
use crate::reference::laws::{AlbedoSample, Violation};
use glam::DVec3;
use serde_json::{Value, json};
use std::fmt::Write;

/// A table for each group. Albedos are those of the strongest channel.
pub(super) fn text(checked: &[Checked]) -> String {
    let label_width = checked.iter().map(|one| one.subject.label.chars().count()).max().unwrap_or(0);
    let mut text = String::new();
    let mut group = None;
    for one in checked {
        if group != Some(&one.subject.group) {
            let gap = if group.is_some() { "\n" } else { "" };
            // Writing to a String cannot fail.
            let _ = writeln!(text, "{gap}{}", one.subject.group);
            let _ = writeln!(
                text,
                "  {:label_width$}  E normal   E average        +-   E largest  at deg   f(v,l)/f(l,v)-1   smallest f   facets     laws",
                ""
            );
            group = Some(&one.subject.group);
        }
        let _ = writeln!(text, "  {:label_width$}  {}", one.subject.label, columns(one));
    }
    text
}

fn columns(one: &Checked) -> String {
    let (albedo, pairs) = (&one.report.albedo, &one.report.pairs);
    let normal = albedo.curve.last().map_or(f64::NAN, |sample| sample.albedo.value.max_element());
    let facets = one.report.facets.map_or_else(|| "-".into(), |facets| format!("{:.1e}", facets.difference));
    let verdict = if one.violations.is_empty() {
        "hold".to_owned()
    } else {
        format!("BROKEN: {}", one.violations.iter().map(describe).collect::<Vec<_>>().join(", "))
    };
    format!(
        "{normal:8.5}   {:9.5}   {:7.1e}   {:9.5}   {:5.1}   {:15.1e}   {:10.1e}   {facets:>7}   {verdict}",
        albedo.average.value.max_element(),
        albedo.average.error,
        albedo.largest.albedo.value.max_element(),
        theta_deg(&albedo.largest),
        pairs.relative_difference,
        pairs.smallest,
    )
}

fn describe(violation: &Violation) -> String {
    match violation {
        Violation::Reciprocity(difference) => format!("reciprocity by {difference:.1e}"),
        Violation::Positivity(smallest) => format!("positivity, f is {smallest:.1e}"),
        Violation::Energy(albedo) => format!("energy, E is {albedo:.5}"),
        Violation::Facets(difference) => format!("facets by {difference:.1e}"),
    }
}

/// Angle between a direction and the normal.
pub(super) fn theta_deg(sample: &AlbedoSample) -> f64 {
    sample.v.x.hypot(sample.v.y).atan2(sample.v.z).to_degrees()
}

/// Everything, for other programs.
pub(super) fn json(checked: &[Checked], tolerance: f64) -> Result<String, CliError> {
    let report = json!({
        "schema": "specula-furnace/1",
        "specula": env!("CARGO_PKG_VERSION"),
        "tolerance": tolerance,
        "surfaces": checked.iter().map(surface).collect::<Vec<_>>(),
    });
    let text = serde_json::to_string_pretty(&report).map_err(|error| CliError::Usage(error.to_string()))?;
    Ok(format!("{text}\n"))
}

fn surface(one: &Checked) -> Value {
    let (albedo, pairs) = (&one.report.albedo, &one.report.pairs);
    let sample = |sample: &AlbedoSample| {
        json!({
            "theta_deg": theta_deg(sample),
            "albedo": color(sample.albedo.value),
            "error": sample.albedo.error,
        })
    };
    json!({
        "group": one.subject.group,
        "label": one.subject.label,
        "average": { "value": color(albedo.average.value), "error": albedo.average.error },
        "largest": sample(&albedo.largest),
        "curve": albedo.curve.iter().map(sample).collect::<Vec<_>>(),
        "reciprocity": { "relative_difference": pairs.relative_difference, "pairs": pairs.pairs },
        "smallest_f": pairs.smallest,
        "facets": one.report.facets.map(|facets| json!({ "difference": facets.difference, "error": facets.error })),
        "broken": one.violations.iter().map(describe).collect::<Vec<_>>(),
    })
}

fn color(value: DVec3) -> [f64; 3] {
    value.to_array()
}
