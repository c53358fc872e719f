//! Every formula of the light and material model: where it is, what checks it, and how exact it is. The table behind
//! docs/brdf.md.

use super::markdown::{code, error, table};
use super::report::{FunctionReport, StabilityReport};
use std::fmt::Write;

/// One formula.
#[derive(Debug, Clone, Copy)]
pub struct Formula {
    pub group: &'static str,
    pub name: &'static str,
    pub equation: &'static str,
    /// In float64.
    pub rust: Option<Place>,
    /// In a shader.
    pub wgsl: Option<Place>,
    /// Tests of what must hold whatever the algebra.
    pub laws: &'static [Place],
}

/// A function in a file, from the root of the repository.
#[derive(Debug, Clone, Copy)]
pub struct Place {
    pub file: &'static str,
    pub function: &'static str,
}

const fn at(file: &'static str, function: &'static str) -> Place {
    Place { file, function }
}

const BRDF: &str = "src/reference/brdf.rs";
const ALBEDO: &str = "src/reference/albedo.rs";
const BSDF: &str = "src/reference/bsdf.rs";
const LIGHTS: &str = "src/reference/lights.rs";
const LOBES: &str = "shaders/lighting/lobes.wgsl";
const FRAMES: &str = "tests/suite/frames.rs";
const PLANE: &str = "tests/suite/lit_plane.rs";

const fn formula(group: &'static str, name: &'static str, equation: &'static str) -> Formula {
    Formula { group, name, equation, rust: None, wgsl: None, laws: &[] }
}

/// All of them, group by group.
pub const FORMULAS: &[Formula] = &[Formula {
    rust: Some(at("src/reference/integrator.rs", "RADIANCE")),
    wgsl: Some(at("shaders/lighting/punctual.wgsl", "punctual_radiance")),
    laws: &[],
    ..formula("Light", "Reflectance equation", "L_o(v) = integral of f(l, v) L_i(l) n.l dl")
}];

/// The formulas of a group stand together; a table each.
pub fn document(report: &StabilityReport) -> String {
    let mut text = String::from(
        "# Formulas\n\n\
         Written by `specula stability --write docs`. Where each formula of the model is, in float64 and in WGSL, which \
         tests check its laws, and how far f32 on the GPU is from float64 (worst point of the grids of \
         `src/proof/rows.rs`; the scale is given where it is not the result).\n\n",
    );
    let _ = writeln!(text, "Adapter: {}\n", report.adapter);
    for formulas in FORMULAS.chunk_by(|a, b| a.group == b.group) {
        let _ = writeln!(text, "## {}\n", formulas[0].group);
        let head = ["formula", "equation", "Rust", "WGSL", "law checks", "worst error"].map(str::to_owned).to_vec();
        let rows = formulas.iter().map(|formula| row(formula, report));
        table(&mut text, &std::iter::once(head).chain(rows).collect::<Vec<_>>());
    }
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
        places(formula.rust.as_slice()),
        places(formula.wgsl.as_slice()),
        places(formula.laws),
        formula.wgsl.and_then(|place| measured(place, report)).map_or_else(|| "-".to_owned(), figure),
    ]
}

/// The row of a WGSL function in the report: from the twins, or from a stress test of an entry to it.
fn measured(place: Place, report: &StabilityReport) -> Option<&FunctionReport> {
    let file = place.file.strip_prefix("shaders/")?;
    report.functions.iter().find(|row| row.file == file && row.function == place.function)
}

fn figure(row: &FunctionReport) -> String {
    let worst = error(row.errors.worst);
    if row.scale == "relative" { worst } else { format!("{worst} ({})", row.scale) }
}
