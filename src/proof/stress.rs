//! Functions over the whole range of their arguments, decade by decade, with the naive forms beside the form in use.

use super::grid::{directions, log_steps, microfacets, product, sampled_lobe, spread};
use super::twin::{Measurement, Scale, Summary, Twin};
use super::{ProofError, truth};
use crate::gpu::Gpu;
use crate::reference::{brdf, lights};
use crate::shader::ShaderSources;
use glam::DVec3;
use serde::Serialize;

/// One function under stress: the form that draws, and those that it was chosen over.
#[derive(Debug, Clone, Copy)]
pub struct Stress {
    pub title: &'static str,
    /// What breaks, and what is done about it.
    pub why: &'static str,
    pub axis: Axis,
    /// The form in use. Its limit is not looked at.
    pub used: Twin,
    /// File and function of other forms, with the same arguments.
    pub naive: &'static [(&'static str, &'static str)],
}

/// What the results are grouped by.
#[derive(Debug, Clone, Copy)]
pub struct Axis {
    pub name: &'static str,
    pub value: fn(&[f32]) -> f32,
    /// Ascending; a group reaches from one edge up to the next, without it.
    pub edges: &'static [f32],
}

/// One form in each group of the axis.
#[derive(Debug, Clone, Serialize)]
pub struct FormReport {
    pub file: &'static str,
    pub function: &'static str,
    pub in_use: bool,
    pub groups: Vec<Summary>,
}

/// All forms of one function.
#[derive(Debug, Clone, Serialize)]
pub struct StressReport {
    pub title: &'static str,
    pub why: &'static str,
    /// What the groups are ranges of.
    pub axis: &'static str,
    pub groups: Vec<String>,
    pub forms: Vec<FormReport>,
}

const fn used(file: &'static str, function: &'static str, grid: fn() -> Vec<Vec<f32>>, truth: Truth) -> Twin {
    Twin { file, function, grid, truth, scale: Scale::Result, limit: f64::INFINITY }
}

type Truth = fn(&[f64]) -> Vec<f64>;

const ALPHA: Axis = Axis { name: "alpha", value: |x| x[0], edges: &[1e-4, 1e-3, 1e-2, 1e-1, 1.001] };
/// The same for functions that take its root.
const ALPHA_OF_ROOT: Axis =
    Axis { value: |x| x[0] * x[0], edges: &[0.999e-4, 0.999e-3, 0.999e-2, 0.999e-1, 1.001], ..ALPHA };

/// The specular lobe as drawn, and the one that a lecture prints.
pub const SPECULAR_LOBE: Stress = Stress {
    title: "Specular lobe times cosine, from l and v",
    why: "Everything together: half vector, D, V and the cosine of the light from unit vectors in f32, where a picture \
          samples them. The lobe is evaluated without the floor of alpha (1e-3) that materials have. What is left is \
          the rounding of the half vector in units of alpha.",
    axis: ALPHA_OF_ROOT,
    used: used("proof/specular_lobe.wgsl", "specular_lobe", || sampled_lobe(8, 500), truth::specular_lobe),
    naive: &[("naive/specular_lobe.wgsl", "specular_lobe_naive")],
};

/// D in the form that draws.
pub const D_CHORD: Stress = Stress {
    title: "Distribution D (GGX)",
    why: "The denominator holds 1 - (n.h)^2, in which f32 has no digits left near the peak of a smooth surface. The \
          chord n - h is exact there.",
    axis: ALPHA,
    used: used(
        "brdf/d_ggx.wgsl",
        "D_GGX",
        || microfacets(&log_steps(1e-4, 1.0, 8)),
        |x| vec![brdf::D_GGX(x[0], truth::vec3(x, 1).normalize().dot(truth::vec3(x, 4).normalize()))],
    ),
    naive: &[
        ("naive/d_ggx.wgsl", "D_GGX_cross"),
        ("naive/d_ggx.wgsl", "D_GGX_from_cosine"),
        ("naive/d_ggx.wgsl", "D_GGX_textbook"),
    ],
};

/// All functions under stress.
pub const STRESSES: &[Stress] = &[
    D_CHORD,
    Stress {
        title: "Visibility V (height-correlated Smith)",
        why: "G / (4 n.v n.l) is 0/0 at the horizon, and the tangent in Lambda infinite. Solved for V nothing is \
              divided by a cosine.",
        axis: Axis { name: "smaller cosine", value: |x| x[1].min(x[2]), edges: &[0.0, 1e-6, 1e-4, 1e-2, 1.001] },
        used: used("brdf/v_smith_ggx_correlated.wgsl", "V_SmithGGXCorrelated", cosine_pairs, |x| {
            // The paper's form is 0/0 at NoL = 0; 1e-15 gives its limit to 1e-9.
            vec![brdf::V_SmithGGXCorrelated(x[0], x[1], x[2].max(1e-15))]
        }),
        naive: &[("naive/v_smith_ggx.wgsl", "V_from_G")],
    },
    Stress {
        title: "Weight of F90 in Schlick's Fresnel",
        why: "v.h comes out above 1 by a rounding, and pow of a negative base is undefined in WGSL. Products of a \
              clamped number are defined, and cheaper.",
        axis: Axis { name: "v.h", value: |x| x[0], edges: &[0.0, 0.5, 0.999, 1.0, 1.01] },
        used: used("brdf/f_schlick.wgsl", "F_Schlick_weight", fresnel_cosines, |x| {
            vec![brdf::F_Schlick(DVec3::ZERO, 1.0, x[0].clamp(0.0, 1.0)).x]
        }),
        naive: &[("naive/f_schlick.wgsl", "F_Schlick_weight_pow")],
    },
    Stress {
        title: "Illuminance from a point light",
        why: "The square of a distance leaves f32 below 1e-19 and above 1e19 m, and a light inside a surface would \
              overflow the target: distances count as 1e-2 m at least, by the model (which a form without that floor \
              does not follow), and their squares as 3e38 m2 at most. Intensities are 1 and 1e30 cd. Beyond 1e19 m the \
              attenuation stays at 3e-39 or is flushed to zero: wrong by any factor, and dark at 1e30 cd.",
        axis: Axis {
            name: "metres",
            value: |x| x[1].abs().max(x[2].abs()).max(x[3].abs()),
            edges: &[0.0, 1e-19, 1e-2, 1e3, 1e18, 2e20],
        },
        used: used("proof/illuminance.wgsl", "point_illuminance", lights_at_distances, |x| {
            vec![x[0] * lights::distance_falloff(truth::vec3(x, 1).length())]
        }),
        naive: &[("naive/attenuation.wgsl", "point_illuminance_naive")],
    },
    Stress {
        title: "Unit vectors",
        why: "The square of a length leaves f32 long before the length does, and zero has no direction. The largest \
              component is divided out first, and what has no direction gets the fallback. Errors are absolute.",
        axis: Axis {
            name: "largest component",
            value: |x| x[0].abs().max(x[1].abs()).max(x[2].abs()),
            edges: &[0.0, 1e-30, 1e-18, 1e-3, 1e18, 1e37],
        },
        used: Twin {
            scale: Scale::One,
            ..used("math/vectors.wgsl", "normalize_or", vectors_of_all_lengths, truth::normalize_or)
        },
        naive: &[("naive/vectors.wgsl", "normalize_naive")],
    },
    SPECULAR_LOBE,
    Stress {
        title: "Specular lobe times cosine, toward the horizon",
        why: "A cosine is a dot product of unit vectors and carries a rounding at the size of 1, whatever its own size: \
              near the horizon no form has more digits than n, l and v in f32.",
        axis: Axis {
            name: "smaller cosine",
            value: |x| truth::smaller_cosine(x),
            edges: &[1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 1e-1, 1.001],
        },
        used: used("proof/specular_lobe.wgsl", "specular_lobe", grazing_lobe, truth::specular_lobe),
        naive: &[("naive/specular_lobe.wgsl", "specular_lobe_naive")],
    },
];

impl Stress {
    /// The form in use and the naive ones.
    pub fn forms(&self) -> impl Iterator<Item = Twin> + '_ {
        let naive = self.naive.iter().map(|&(file, function)| Twin { file, function, ..self.used });
        std::iter::once(self.used).chain(naive)
    }

    /// Names of the groups: `1e-4 .. 1e-3`.
    pub fn group_names(&self) -> Vec<String> {
        // The last edge lies a little above what it is named after, so that its group includes that.
        let edge = |x: f32| match x {
            0.0 => "0".to_owned(),
            _ if (x - 1.0).abs() < 2e-3 && x >= 1.0 => "1".to_owned(),
            0.01..10.0 => format!("{x}"),
            _ => format!("{x:.0e}"),
        };
        self.axis.edges.windows(2).map(|ends| format!("{} .. {}", edge(ends[0]), edge(ends[1]))).collect()
    }

    /// Runs all forms.
    ///
    /// # Errors
    /// When a form does not fit the grid, or the device fails.
    pub fn run(&self, gpu: &Gpu, sources: &ShaderSources) -> Result<StressReport, ProofError> {
        let form = |(index, twin): (usize, Twin)| -> Result<FormReport, ProofError> {
            let measured = twin.measure(gpu, sources)?;
            let Twin { file, function, .. } = twin;
            Ok(FormReport { file, function, in_use: index == 0, groups: self.groups(&measured) })
        };
        let forms = self.forms().enumerate().map(form).collect::<Result<_, _>>()?;
        let Self { title, why, axis, .. } = *self;
        Ok(StressReport { title, why, axis: axis.name, groups: self.group_names(), forms })
    }

    fn groups(&self, measured: &Measurement) -> Vec<Summary> {
        let value = self.axis.value;
        let group = |ends: &[f32]| measured.summary_where(|point| (ends[0]..ends[1]).contains(&value(point)));
        self.axis.edges.windows(2).map(group).collect()
    }
}

fn cosine_pairs() -> Vec<Vec<f32>> {
    let cosines = log_steps(1e-6, 1.0, 4);
    product(&[&log_steps(1e-4, 1.0, 4), &cosines, &[&[0.0], cosines.as_slice()].concat()])
}

fn fresnel_cosines() -> Vec<Vec<f32>> {
    let from_both_ends = log_steps(1e-6, 1.0, 64).into_iter().flat_map(|x| [x, 1.0 - x]);
    let above = (1..=8).map(|ulps| 1.0 + ulps as f32 * f32::EPSILON);
    product(&[&from_both_ends.chain(above).collect::<Vec<f32>>()])
}

fn lights_at_distances() -> Vec<Vec<f32>> {
    let ways = directions(40);
    let distances = [&[0.0], log_steps(1e-20, 1e20, 4).as_slice()].concat();
    let points = distances
        .iter()
        .flat_map(|&distance| ways.iter().map(move |way| (way.as_dvec3() * f64::from(distance)).as_vec3()));
    points.flat_map(|toward| [1.0, 1e30].map(|candela| [&[candela], toward.as_ref() as &[f32]].concat())).collect()
}

fn vectors_of_all_lengths() -> Vec<Vec<f32>> {
    let ways = directions(40);
    let lengths = [&[0.0], log_steps(1e-36, 1e36, 2).as_slice()].concat();
    let all =
        lengths.iter().flat_map(|&length| ways.iter().map(move |way| (way.as_dvec3() * f64::from(length)).as_vec3()));
    all.map(|v| [v.to_array(), [0.6, -0.48, 0.64]].concat()).collect()
}

/// Views and lights whose cosines take every size, in random frames.
fn grazing_lobe() -> Vec<Vec<f32>> {
    let cosines = log_steps(1e-6, 1.0, 3);
    let frames = directions(8);
    let mut points = Vec::new();
    for (index, pair) in product(&[&[0.1, 0.3, 1.0], &cosines, &cosines]).iter().enumerate() {
        for (frame, n) in frames.iter().enumerate() {
            let (tangent, bitangent) = crate::math::spaces::orthonormal_basis(n.as_dvec3().normalize());
            let way = |cosine: f32, turn: f32| {
                let (cosine, phi) = (f64::from(cosine), std::f64::consts::TAU * f64::from(turn));
                let sine = (1.0 - cosine * cosine).sqrt();
                (tangent * (sine * phi.cos()) + bitangent * (sine * phi.sin()) + n.as_dvec3().normalize() * cosine)
                    .as_vec3()
            };
            let (v, l) = (way(pair[1], spread(index, 0)), way(pair[2], spread(8 * index + frame, 1)));
            points.push([&[pair[0]], n.as_ref() as &[f32], v.as_ref(), l.as_ref()].concat());
        }
    }
    points
}
