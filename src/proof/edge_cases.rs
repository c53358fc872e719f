//! Single points at which textbook forms break: what they give, and what the form in use gives.

use super::twin::{Scale, Twin};
use super::{ProofError, truth};
use crate::gpu::Gpu;
use crate::reference::{brdf, lights};
use crate::shader::ShaderSources;
use glam::{DVec3, Vec3};
use serde::Serialize;

/// One point.
#[derive(Debug, Clone, Copy)]
pub struct EdgeCase {
    pub title: &'static str,
    used: Call,
    naive: Call,
    /// The right answer, from the arguments of the form in use.
    truth: fn(&[f64]) -> Vec<f64>,
}

#[derive(Debug, Clone, Copy)]
struct Call {
    file: &'static str,
    function: &'static str,
    arguments: fn() -> Vec<f32>,
}

/// What came out of both forms, as text: JSON has neither NaN nor infinity.
#[derive(Debug, Clone, Serialize)]
pub struct EdgeReport {
    pub title: &'static str,
    pub function: &'static str,
    pub naive_function: &'static str,
    pub expected: String,
    pub used: String,
    pub naive: String,
    /// Largest difference of the form in use from the truth, in units of the largest component or of 1.
    pub error: f64,
}

const fn call(file: &'static str, function: &'static str, arguments: fn() -> Vec<f32>) -> Call {
    Call { file, function, arguments }
}

const fn lobe(title: &'static str, arguments: fn() -> Vec<f32>) -> EdgeCase {
    EdgeCase {
        title,
        used: call("proof/specular_lobe.wgsl", "specular_lobe", arguments),
        naive: call("naive/specular_lobe.wgsl", "specular_lobe_naive", arguments),
        truth: truth::specular_lobe,
    }
}

const fn vector(title: &'static str, arguments: fn() -> Vec<f32>) -> EdgeCase {
    EdgeCase {
        title,
        used: call("math/vectors.wgsl", "normalize_or", arguments),
        naive: call("naive/vectors.wgsl", "normalize_naive", arguments),
        truth: truth::normalize_or,
    }
}

const fn mapped(title: &'static str, arguments: fn() -> Vec<f32>, truth: fn(&[f64]) -> Vec<f64>) -> EdgeCase {
    EdgeCase {
        title,
        used: call("proof/shading_normal.wgsl", "mapped_normal", arguments),
        naive: call("naive/tangent_frame.wgsl", "shading_normal_naive", arguments),
        truth,
    }
}

const fn light(title: &'static str, arguments: fn() -> Vec<f32>) -> EdgeCase {
    EdgeCase {
        title,
        used: call("proof/illuminance.wgsl", "point_illuminance", arguments),
        naive: call("naive/attenuation.wgsl", "point_illuminance_naive", arguments),
        truth: |x| vec![x[0] * lights::distance_falloff(truth::vec3(x, 1).length())],
    }
}

const fn resolved(title: &'static str, arguments: fn() -> Vec<f32>) -> EdgeCase {
    EdgeCase {
        title,
        used: call("proof/store.wgsl", "resolve_halves", arguments),
        naive: call("naive/half_range.wgsl", "resolve_halves_naive", arguments),
        truth: |x| vec![x[0].min(65504.0) * (1.0 - x[2]) + x[1].min(65504.0) * x[2]],
    }
}

/// All points.
pub const EDGE_CASES: &[EdgeCase] = &[
    lobe("light opposite to the view, l = -v", || vec![0.5, 0.0, 0.0, 1.0, 0.6, 0.0, 0.8, -0.6, 0.0, -0.8]),
    lobe("light opposite to the view, both at the horizon", || vec![0.5, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, -1.0, 0.0, 0.0]),
    lobe("view behind the shading normal, n.v = -0.6", || vec![0.5, 0.0, 0.0, 1.0, 0.8, 0.0, -0.6, 0.0, 0.0, 1.0]),
    lobe("view and light along the horizon", || vec![0.1, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]),
    EdgeCase {
        title: "v.h one rounding above 1",
        used: call("brdf/f_schlick.wgsl", "F_Schlick_weight", || vec![1.0_f32.next_up()]),
        naive: call("naive/f_schlick.wgsl", "F_Schlick_weight_pow", || vec![1.0_f32.next_up()]),
        truth: |x| vec![brdf::F_Schlick(DVec3::ZERO, 1.0, x[0].min(1.0)).x],
    },
    vector("zero normal", || vec![0.0, 0.0, 0.0, 0.0, 0.0, 1.0]),
    vector("vector of denormals", || vec![1e-40, 0.0, -1e-40, 0.0, 0.0, 1.0]),
    vector("vector of length 1e-22, whose square is zero", || vec![6e-23, 0.0, 8e-23, 0.0, 0.0, 1.0]),
    vector("vector of length 1e22, whose square is infinite", || vec![6e21, 0.0, 8e21, 0.0, 0.0, 1.0]),
    mapped(
        "zero tangent under a normal map",
        || vec![0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.75, 0.5, 0.75],
        |_| vec![0.0, 0.0, 1.0],
    ),
    mapped(
        "tangent along the normal",
        || vec![0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.5, 0.75, 0.75],
        |_| vec![0.0, 0.0, 1.0],
    ),
    mapped(
        "normal and tangent zero",
        || vec![0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.5, 0.5, 1.0],
        |_| vec![0.0, 0.0, 1.0],
    ),
    EdgeCase {
        title: "degenerate texture coordinates",
        // The importer gives such a triangle any tangent across its normal.
        used: call("proof/shading_normal.wgsl", "mapped_normal", || {
            let tangent = Vec3::Z.any_orthonormal_vector();
            [&[0.0, 0.0, 1.0], tangent.as_ref() as &[f32], &[1.0, 0.5, 0.5, 1.0]].concat()
        }),
        naive: call("naive/tangent_frame.wgsl", "tangent_from_edges", || {
            vec![1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.25, 0.25, 0.5, 0.5]
        }),
        truth: |_| vec![0.0, 0.0, 1.0],
    },
    light("light 1e-20 m away", || vec![1.0, 0.0, 0.0, 1e-20]),
    light("light at the point itself", || vec![1.0, 0.0, 0.0, 0.0]),
    light("light 1e20 m away", || vec![1.0, 0.0, 0.0, 1e20]),
    light("1e30 cd, 1 m away", || vec![1e30, 0.0, 0.0, 1.0]),
    resolved("radiance of 70000 beside one of 1 in a half-float target", || vec![7e4, 1.0, 0.5]),
    resolved("radiance of 1e30 that covers nothing", || vec![1e30, 1.0, 1.0]),
    resolved("two infinite radiances", || vec![f32::INFINITY, f32::INFINITY, 0.25]),
];

impl EdgeCase {
    /// Runs both forms.
    ///
    /// # Errors
    /// When a form does not take the arguments, or the device fails.
    pub fn run(&self, gpu: &Gpu, sources: &ShaderSources) -> Result<EdgeReport, ProofError> {
        let of = |call: &Call, truth| Twin {
            file: call.file,
            function: call.function,
            grid: Vec::new,
            truth,
            scale: Scale::One,
            limit: 0.0,
        };
        let arguments = (self.used.arguments)();
        let exact: Vec<f64> = arguments.iter().copied().map(f64::from).collect();
        let expected = (self.truth)(&exact);
        let used = of(&self.used, self.truth).measure_on(gpu, sources, vec![arguments])?;
        // The naive form may have other arguments: its result is shown, and not compared.
        let width = if expected.len() == 1 { nothing::<1> } else { nothing::<3> };
        let naive = of(&self.naive, width).measure_on(gpu, sources, vec![(self.naive.arguments)()])?;
        let size = expected.iter().fold(1.0, |size: f64, x| size.max(x.abs()));
        Ok(EdgeReport {
            title: self.title,
            function: self.used.function,
            naive_function: self.naive.function,
            expected: text(expected.iter().copied()),
            used: text(used.results_at(0).iter().copied().map(f64::from)),
            naive: text(naive.results_at(0).iter().copied().map(f64::from)),
            error: used.summary().worst / size,
        })
    }
}

fn nothing<const N: usize>(_: &[f64]) -> Vec<f64> {
    vec![0.0; N]
}

fn text(values: impl Iterator<Item = f64>) -> String {
    values.map(number).collect::<Vec<_>>().join(", ")
}

/// A number in few digits.
fn number(value: f64) -> String {
    match value.abs() {
        _ if value.is_nan() => "NaN".to_owned(),
        _ if value.is_infinite() => if value > 0.0 { "inf" } else { "-inf" }.to_owned(),
        0.0 => "0".to_owned(),
        1e-3..1e5 => {
            let text = format!("{value:.4}");
            text.trim_end_matches('0').trim_end_matches('.').to_owned()
        }
        _ => format!("{value:.2e}"),
    }
}
