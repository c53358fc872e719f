//! What was found about a pixel, as text and as JSON.

use super::InspectArgs;
use super::gather::{Explained, Seen};
use super::rows::{Group, Row};
use crate::cli::error::CliError;
use crate::scene::{Background, View};
use glam::DVec3;
use serde_json::{Value, json};
use std::fmt::Write;

/// A table for each group of rows, under a head that says what is seen.
pub(super) fn text(args: &InspectArgs, view: &View, explained: &Explained) -> String {
    let (x, y) = (explained.pixel.x, explained.pixel.y);
    let (width, height) = (view.size_px.x, view.size_px.y);
    let mut text = format!("{}: pixel {x},{y} of {width} x {height}\n", args.subject.model().display());
    match &explained.hit {
        Some(seen) => text.push_str(&surface(seen)),
        None => text.push_str(&background(view, explained.ray.direction)),
    }
    // Writing to a String cannot fail.
    if explained.layers.len() > 1 {
        text.push_str("\nlayers, front to back       alpha  distance, m  radiance, cd/m2\n");
        for seen in &explained.layers {
            let (layer, radiance) = (&seen.layer, numbers(&seen.radiance.to_array()));
            let _ = writeln!(text, "  {:24} {:6.4}  {:11.5}  {radiance}", seen.material, layer.alpha, layer.hit.t);
        }
    }
    for (group, title) in
        [(Group::Input, "inputs"), (Group::Light, "light to the eye, cd/m2"), (Group::Pixel, "picture")]
    {
        table(&mut text, title, explained.rows.iter().filter(|row| row.group == group));
    }
    if let Some(adapter) = &explained.adapter {
        let _ = writeln!(text, "\nGPU: {adapter}");
    }
    for note in &explained.notes {
        let _ = writeln!(text, "note: {note}");
    }
    text
}

fn surface(seen: &Seen) -> String {
    let Seen { details, layer, node, mesh, material, .. } = seen;
    let [a, b, c] = details.vertices;
    let weights = layer.hit.barycentric;
    let side = if layer.hit.front { "front" } else { "back" };
    format!(
        "  node {} \"{node}\", mesh {} \"{mesh}\", primitive {}, material {} \"{material}\"\n  \
         triangle {} (vertices {a}, {b}, {c}) at {:.5} {:.5} {:.5}, {side} side, {:.6} m from the eye\n",
        details.node,
        details.mesh,
        details.primitive,
        details.material,
        details.triangle,
        weights.x,
        weights.y,
        weights.z,
        layer.hit.t,
    )
}

fn background(view: &View, direction: DVec3) -> String {
    let shows = match view.background {
        Background::Environment => "the environment",
        Background::Transparent => "nothing",
        Background::Color(_) => "the background colour",
    };
    format!(
        "  background: no surface along ({:.6}, {:.6}, {:.6}); the picture shows {shows}\n",
        direction.x, direction.y, direction.z
    )
}

fn table<'a>(text: &mut String, title: &str, rows: impl Iterator<Item = &'a Row> + Clone) {
    let width = rows.clone().map(|row| row.name.chars().count()).max().unwrap_or(0).max(title.len());
    if rows.clone().next().is_none() {
        return;
    }
    let _ = writeln!(text, "\n{title:width$}    {:34} {:34} {:>10}", "GPU", "reference", "difference");
    for row in rows {
        let cell = |values: &Option<Vec<f64>>| values.as_deref().map_or_else(|| "-".into(), numbers);
        let difference = match (row.relative_difference, &row.gpu, &row.reference) {
            (Some(0.0), ..) => "0".into(),
            (Some(difference), ..) => format!("{difference:.1e}"),
            (None, Some(_), Some(_)) => "not 0".into(),
            _ => "-".into(),
        };
        let error = row.standard_error.as_deref().map(|error| error.iter().copied().fold(0.0, f64::max));
        let error = error.filter(|error| *error > 0.0).map(|error| format!("  +- {error:.1e}")).unwrap_or_default();
        let (gpu, reference) = (cell(&row.gpu), cell(&row.reference));
        let _ = writeln!(text, "  {:width$}  {gpu:34} {reference:34} {difference:>10}{error}", row.name);
    }
}

/// Values with the digits that matter, in columns.
fn numbers(values: &[f64]) -> String {
    let number = |value: &f64| {
        let magnitude = value.abs();
        let text = if *value == value.round() && magnitude < 1e6 {
            format!("{value:.0}")
        } else if (1e-3..1e4).contains(&magnitude) {
            // Five digits, and no more of a small number than it has.
            format!("{value:.*}", (4 - magnitude.log10().floor() as i32).clamp(0, 7) as usize)
        } else {
            format!("{value:.3e}")
        };
        format!("{text:>10}")
    };
    values.iter().map(number).collect::<Vec<_>>().join(" ")
}

/// Everything, for other programs.
pub(super) fn json(args: &InspectArgs, view: &View, explained: &Explained) -> Result<String, CliError> {
    let of_surface = |seen: &Seen| -> Value {
        let (details, hit) = (&seen.details, &seen.layer.hit);
        json!({
            "node": { "index": details.node, "name": seen.node },
            "mesh": { "index": details.mesh, "name": seen.mesh, "primitive": details.primitive },
            "material": { "index": details.material, "name": seen.material },
            "triangle": details.triangle,
            "vertices": details.vertices,
            "barycentric": hit.barycentric.to_array(),
            "front": hit.front,
            "distance_m": hit.t,
            "position_in_world": details.surface.position_in_world.to_array(),
            "alpha": seen.layer.alpha,
            "radiance": seen.radiance.to_array(),
        })
    };
    let report = json!({
        "schema": "specula-inspect-pixel/1",
        "specula": env!("CARGO_PKG_VERSION"),
        "model": args.subject.model().display().to_string(),
        "size_px": view.size_px.to_array(),
        "pixel": explained.pixel.to_array(),
        "adapter": explained.adapter,
        "ray": { "origin": explained.ray.origin.to_array(), "direction": explained.ray.direction.to_array() },
        "hit": explained.hit.as_ref().map(of_surface),
        "layers": explained.layers.iter().map(of_surface).collect::<Vec<_>>(),
        "rows": explained.rows,
        "notes": explained.notes,
    });
    pretty(&report)
}

/// JSON as people read it, with a newline at its end.
pub(super) fn pretty(report: &Value) -> Result<String, CliError> {
    let text = serde_json::to_string_pretty(report).map_err(|error| CliError::Usage(error.to_string()))?;
    Ok(format!("{text}\n"))
}
