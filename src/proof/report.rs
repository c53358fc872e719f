//! All measurements of the shaders' arithmetic on one device.

use super::edge_cases::{EDGE_CASES, EdgeReport};
use super::fuzz::{FuzzOptions, ShaderFindings, fuzz};
use super::stress::{STRESSES, StressReport};
use super::twin::Summary;
use super::{ProofError, TWINS};
use crate::gpu::Gpu;
use crate::progress::Progress;
use crate::shader::ShaderSources;
use serde::Serialize;

/// What `specula stability` finds.
#[derive(Debug, Clone, Serialize)]
pub struct StabilityReport {
    /// Name and version of this layout.
    pub schema: &'static str,
    /// Name, API and driver.
    pub adapter: String,
    pub functions: Vec<FunctionReport>,
    pub stresses: Vec<StressReport>,
    pub edge_cases: Vec<EdgeReport>,
    pub fuzz: FuzzReport,
}

/// One WGSL function against its float64 twin.
#[derive(Debug, Clone, Serialize)]
pub struct FunctionReport {
    pub file: &'static str,
    pub function: &'static str,
    /// What errors are measured against.
    pub scale: &'static str,
    pub limit: f64,
    pub errors: Summary,
}

/// The search for faults.
#[derive(Debug, Clone, Serialize)]
pub struct FuzzReport {
    pub seed: u32,
    pub shaders: Vec<ShaderFindings>,
}

impl StabilityReport {
    /// Runs everything.
    ///
    /// # Errors
    /// When a shader cannot be made or the device fails; large errors and faults that are found are no error.
    pub fn measure(gpu: &Gpu, options: FuzzOptions, progress: &dyn Progress) -> Result<Self, ProofError> {
        let sources = ShaderSources::default();
        let total = TWINS.len() + STRESSES.len() + EDGE_CASES.len();
        progress.begin("comparing with float64", total as u64);
        let functions = measure_functions(gpu, &sources, progress)?;
        let stresses = STRESSES.iter().map(|stress| {
            progress.advance(1);
            stress.run(gpu, &sources)
        });
        let stresses = stresses.collect::<Result<_, _>>()?;
        let edge_cases = EDGE_CASES.iter().map(|case| {
            progress.advance(1);
            case.run(gpu, &sources)
        });
        let edge_cases = edge_cases.collect::<Result<_, _>>()?;
        progress.begin("searching for faults", options.evaluations);
        let shaders = fuzz(gpu, &sources, options, |evaluations| progress.advance(evaluations))?;
        Ok(Self {
            schema: "specula.stability.1",
            adapter: gpu.description(),
            functions,
            stresses,
            edge_cases,
            fuzz: FuzzReport { seed: options.seed, shaders },
        })
    }

    /// What exceeds its limit or is not a number, one line each.
    pub fn offences(&self) -> Vec<String> {
        let functions = self.functions.iter().filter(|row| row.errors.worst > row.limit);
        let functions = functions.map(|row| {
            format!("{} {}: error {:.1e}, allowed {:.1e}", row.file, row.function, row.errors.worst, row.limit)
        });
        let forms = self.stresses.iter().flat_map(|stress| stress.forms.iter().filter(|form| form.in_use));
        let forms = forms.filter(|form| form.groups.iter().any(|group| group.not_finite > 0));
        let forms = forms.map(|form| format!("{} {}: gives no numbers", form.file, form.function));
        // Measured 1.2e-7 at worst, margin 8.
        let edges = self.edge_cases.iter().filter(|case| case.error > 1e-6);
        let edges = edges.map(|case| format!("{}: {} instead of {}", case.title, case.used, case.expected));
        let faults = self.fuzz.shaders.iter().flat_map(|found| {
            found.faults.iter().filter(|fault| fault.count > 0).map(move |fault| {
                let first = fault.first.as_ref().map(ToString::to_string).unwrap_or_default();
                format!("{}: {} {}: {first}", found.shader, fault.count, fault.kind)
            })
        });
        functions.chain(forms).chain(edges).chain(faults).collect()
    }
}

/// Every function that has a twin.
///
/// # Errors
/// As [`StabilityReport::measure`].
pub fn measure_functions(
    gpu: &Gpu,
    sources: &ShaderSources,
    progress: &dyn Progress,
) -> Result<Vec<FunctionReport>, ProofError> {
    let measure = |twin: &super::Twin| {
        progress.advance(1);
        let errors = twin.measure(gpu, sources)?.summary();
        let (file, function, limit) = (twin.file, twin.function, twin.limit);
        Ok(FunctionReport { file, function, scale: twin.scale.name(), limit, errors })
    };
    TWINS.iter().map(measure).collect()
}
