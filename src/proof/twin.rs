//! Runs one WGSL function on the GPU over a grid of arguments and compares it with its float64 twin.

use super::ProofError;
use super::call::{UNWRITTEN, call};
use super::signature::Signature;
use super::stage;
use crate::gpu::Gpu;
use crate::shader::{Composed, ShaderSources, compose, create_module};
use serde::Serialize;
use std::fmt;

/// One WGSL function, what it is compared with, and where.
#[derive(Debug, Clone, Copy)]
pub struct Twin {
    pub file: &'static str,
    pub function: &'static str,
    /// The arguments of every call, components of vectors and arrays in a row.
    pub grid: fn() -> Vec<Vec<f32>>,
    /// The components of the true result at one point of the grid.
    pub truth: fn(&[f64]) -> Vec<f64>,
    pub scale: Scale,
    /// Largest error allowed, in units of the scale.
    pub limit: f64,
}

/// What an error is measured against.
#[derive(Debug, Clone, Copy)]
pub enum Scale {
    /// The true result: relative error, for products and sums that cannot cancel.
    Result,
    /// 1: absolute error, for what ends on a display or in a texture coordinate.
    One,
    /// The largest term of a sum that may cancel, from the arguments.
    Terms(fn(&[f64]) -> f64),
}

impl Scale {
    /// What the scale is, for a table.
    pub fn name(self) -> &'static str {
        match self {
            Self::Result => "relative",
            Self::One => "absolute",
            Self::Terms(_) => "of the largest term",
        }
    }
}

/// What a function gave at every point of a grid, beside the truth.
#[derive(Debug, Clone)]
pub struct Measurement {
    names: Vec<String>,
    grid: Vec<Vec<f32>>,
    width: usize,
    results: Vec<f32>,
    truth: Vec<f64>,
    /// In units of the scale, one a component; infinite for a result that is no number.
    errors: Vec<f64>,
}

/// The errors of many comparisons in short, in units of the scale.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Summary {
    pub comparisons: usize,
    /// The error that 99 of 100 comparisons do not exceed.
    pub p99: f64,
    pub worst: f64,
    /// Results that are infinite or NaN.
    pub not_finite: usize,
}

/// The point of a grid where a function is farthest from its twin.
#[derive(Debug, Clone)]
pub struct Worst {
    /// In units of the scale; infinite for a result that is no number.
    pub error: f64,
    arguments: Vec<(String, f32)>,
    component: usize,
    got: f32,
    expected: f64,
}

impl Twin {
    pub fn name(&self) -> String {
        format!("{} {}", self.file, self.function)
    }

    /// A compute module that calls the function once a grid point.
    ///
    /// # Errors
    /// When the file cannot be composed, or the function is not in it or takes something unknown.
    pub fn compose(&self, sources: &ShaderSources) -> Result<Composed, ProofError> {
        let slots = stage::slots(&stage::plain_metal());
        let mut sources = stage::sources_without_bindings(sources)?;
        let alone = compose(&sources, self.file, &slots)?.parse()?;
        let caller = Signature::find(&alone, self.function)?.caller()?;
        sources.insert("twin.wgsl", format!("#import \"{}\"\n{caller}", self.file));
        Ok(compose(&sources, "twin.wgsl", &slots)?)
    }

    /// Calls the function at every point and compares.
    ///
    /// # Errors
    /// When grid, twin and function do not fit each other, or the device fails.
    pub fn measure(&self, gpu: &Gpu, sources: &ShaderSources) -> Result<Measurement, ProofError> {
        self.measure_on(gpu, sources, (self.grid)())
    }

    /// [`Self::measure`] on another grid.
    ///
    /// # Errors
    /// As there.
    pub fn measure_on(
        &self,
        gpu: &Gpu,
        sources: &ShaderSources,
        grid: Vec<Vec<f32>>,
    ) -> Result<Measurement, ProofError> {
        let composed = self.compose(sources)?;
        let module = composed.parse()?;
        let signature = Signature::find(&module, self.function)?;
        let (names, width) = (signature.argument_names(), signature.width()?);
        if grid.is_empty() || grid.iter().any(|point| point.len() != names.len()) {
            return Err(self.misfit(format!("the grid has to give {} numbers a point", names.len())));
        }
        let shader = create_module(&gpu.device, &self.name(), &composed)?;
        let results = call(gpu, &shader, &grid.concat(), grid.len() * width)?;
        self.compare(names, grid, results, width)
    }

    /// Compares results that are there: `width` numbers a point of the grid.
    ///
    /// # Errors
    /// When the twin does not give that many finite numbers.
    pub fn compare(
        &self,
        names: Vec<String>,
        grid: Vec<Vec<f32>>,
        results: Vec<f32>,
        width: usize,
    ) -> Result<Measurement, ProofError> {
        let (mut truth, mut errors) = (Vec::with_capacity(results.len()), Vec::with_capacity(results.len()));
        for (point, results) in grid.iter().zip(results.chunks_exact(width)) {
            let exact: Vec<f64> = point.iter().copied().map(f64::from).collect();
            let expected = (self.truth)(&exact);
            if expected.len() != width || !expected.iter().all(|value| value.is_finite()) {
                return Err(self.misfit(format!("the twin gives {expected:?} at {point:?}")));
            }
            errors.extend(results.iter().zip(&expected).map(|(&got, &expected)| self.error(&exact, got, expected)));
            truth.extend(expected);
        }
        Ok(Measurement { names, grid, width, results, truth, errors })
    }

    fn error(&self, arguments: &[f64], got: f32, expected: f64) -> f64 {
        let difference = (f64::from(got) - expected).abs();
        let scale = match self.scale {
            Scale::Result => expected.abs(),
            Scale::One => 1.0,
            Scale::Terms(terms) => terms(arguments),
        };
        match (got.is_finite(), difference) {
            (false, _) => f64::INFINITY,
            // Shaders may flush what is below the smallest normal number to zero.
            (true, difference) if difference < f64::from(f32::MIN_POSITIVE) => 0.0,
            (true, difference) => difference / scale,
        }
    }

    fn misfit(&self, reason: String) -> ProofError {
        ProofError::Row { row: self.name(), reason }
    }
}

impl Measurement {
    /// All comparisons.
    pub fn summary(&self) -> Summary {
        self.summary_where(|_| true)
    }

    /// The comparisons at the points whose arguments are `wanted`.
    pub fn summary_where(&self, wanted: impl Fn(&[f32]) -> bool) -> Summary {
        let points = self.grid.iter().zip(self.errors.chunks_exact(self.width)).filter(|(point, _)| wanted(point));
        let mut errors: Vec<f64> = points.flat_map(|(_, errors)| errors.iter().copied()).collect();
        errors.sort_by(f64::total_cmp);
        let at = |share: f64| errors.get(((errors.len() as f64 * share).ceil() as usize).saturating_sub(1)).copied();
        Summary {
            comparisons: errors.len(),
            p99: at(0.99).unwrap_or(0.0),
            worst: at(1.0).unwrap_or(0.0),
            not_finite: errors.iter().filter(|error| error.is_infinite()).count(),
        }
    }

    /// The worst point; its error is negative when nothing was compared.
    pub fn worst(&self) -> Worst {
        let mut order = self.errors.iter().enumerate();
        let first = order.next().map(|(index, error)| (index, *error));
        let worst = order.fold(first, |best, (index, &error)| match best {
            Some((_, largest)) if largest >= error => best,
            _ => Some((index, error)),
        });
        let Some((index, error)) = worst else {
            return Worst { error: -1.0, arguments: Vec::new(), component: 0, got: 0.0, expected: 0.0 };
        };
        let arguments = self.names.iter().cloned().zip(self.grid[index / self.width].iter().copied()).collect();
        let (got, expected) = (self.results[index], self.truth[index]);
        Worst { error, arguments, component: index % self.width, got, expected }
    }

    /// The results at one point of the grid.
    pub fn results_at(&self, point: usize) -> &[f32] {
        &self.results[point * self.width..(point + 1) * self.width]
    }

    /// The truth at one point of the grid.
    pub fn truth_at(&self, point: usize) -> &[f64] {
        &self.truth[point * self.width..(point + 1) * self.width]
    }
}

impl fmt::Display for Worst {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let in_eps = self.error / f64::from(f32::EPSILON);
        write!(f, "{:.2e} of the scale ({in_eps:.2} eps) at ", self.error)?;
        // Of an array of coefficients, those that take part.
        let told = |value: f32| value != 0.0 || self.arguments.len() <= 8;
        for (name, value) in self.arguments.iter().filter(|(_, value)| told(*value)) {
            write!(f, "{name} = {value:e}, ")?;
        }
        let got = if self.got.to_bits() == UNWRITTEN { "nothing".to_owned() } else { format!("{:e}", self.got) };
        write!(f, "component {}: got {got}, expected {:e}", self.component, self.expected)?;
        let relative = (f64::from(self.got) - self.expected).abs() / self.expected.abs();
        if self.expected == 0.0 { Ok(()) } else { write!(f, ", relative {relative:.2e}") }
    }
}
