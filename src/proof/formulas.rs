//! Every formula of the light and material model: where it is, what checks it, and how exact it is. The table behind
//! docs/brdf.md.

mod table;

pub use table::FORMULAS;

use super::markdown::{code, error, table};
use super::report::{FunctionReport, StabilityReport};
use super::stress::Stress;
use std::fmt::Write;

/// One formula.
#[derive(Debug, Clone, Copy)]
pub struct Formula {
    pub name: &'static str,
    pub equation: &'static str,
    /// In float64.
    pub rust: Place,
    /// In a shader, where one needs it.
    pub wgsl: Option<Place>,
    /// Tests of what must hold whatever the algebra.
    pub laws: &'static [Place],
    /// What measures it where it has no twin of its own.
    pub stress: Option<&'static Stress>,
}

/// A function in a file, from the root of the repository.
#[derive(Debug, Clone, Copy)]
pub struct Place {
    pub file: &'static str,
    pub function: &'static str,
}

/// `docs/brdf.md`: a table for each group.
pub fn document(report: &StabilityReport) -> String {
    let mut text = String::from(
        "# Formulas\n\n\
         Written by `specula stability --write docs`. Where each formula of the model is, in float64 and in WGSL, which \
         tests check its laws, and how far f32 on the GPU is from float64 (worst point of the grids of \
         `src/proof/rows.rs`; the scale is given where it is not the result).\n\n",
    );
    let _ = writeln!(text, "Adapter: {}\n", report.adapter);
    for (group, formulas) in FORMULAS {
        let _ = writeln!(text, "## {group}\n");
        let head = ["formula", "equation", "Rust", "WGSL", "law checks", "worst error"].map(str::to_owned).to_vec();
        let rows = formulas.iter().map(|formula| row(formula, report));
        table(&mut text, &std::iter::once(head).chain(rows).collect::<Vec<_>>());
    }
    text.truncate(text.trim_end().len() + 1);
    text
}

fn row(formula: &Formula, report: &StabilityReport) -> Vec<String> {
    let place = |place: &Place| format!("{} in {}", code(place.function), code(place.file));
    let places = |places: &[Place]| {
        if places.is_empty() { "-".to_owned() } else { places.iter().map(place).collect::<Vec<_>>().join(", ") }
    };
    vec![
        formula.name.to_owned(),
        code(formula.equation),
        place(&formula.rust),
        places(formula.wgsl.as_slice()),
        places(formula.laws),
        worst(formula, report),
    ]
}

/// Of the WGSL function by its twin, or of its 99 % in each group of the stress test.
fn worst(formula: &Formula, report: &StabilityReport) -> String {
    let stress = formula.stress.and_then(|stress| report.stresses.iter().find(|found| found.title == stress.title));
    if let Some(stress) = stress {
        let p99 = stress.forms.iter().take(1).flat_map(|form| form.groups.iter().map(|group| error(group.p99)));
        return format!("p99 {} by decade of {}", p99.collect::<Vec<_>>().join(", "), stress.axis);
    }
    formula.wgsl.and_then(|place| twin(place, report)).map_or_else(|| "-".to_owned(), figure)
}

/// The row of a WGSL function in the report.
fn twin(place: Place, report: &StabilityReport) -> Option<&FunctionReport> {
    let file = place.file.strip_prefix("shaders/")?;
    report.functions.iter().find(|row| row.file == file && row.function == place.function)
}

fn figure(row: &FunctionReport) -> String {
    let worst = error(row.errors.worst);
    if row.scale == "relative" { worst } else { format!("{worst} ({})", row.scale) }
}
