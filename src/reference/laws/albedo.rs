//! Energy: the directional albedo of a BRDF, for light from everywhere.

use super::brdf::Brdf;
use super::exceeds;
use super::hemisphere::Polar;
use crate::math::quadrature::adaptive::{Accuracy, Estimate, kronrod_nodes};
use glam::DVec3;
use std::f64::consts::TAU;

/// The share of light that is reflected.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AlbedoSample {
    /// Where the light comes from, or the eye is: f is the same for both.
    pub v: DVec3,
    pub albedo: Estimate<DVec3>,
}

/// The albedo over all directions.
#[derive(Debug, Clone, PartialEq)]
pub struct AlbedoReport {
    /// By ascending cosine, in the plane of the tangent and the normal; the last along the normal.
    pub curve: Vec<AlbedoSample>,
    /// The largest of all directions tried, by its largest channel.
    pub largest: AlbedoSample,
    /// Cosine-weighted average over the hemisphere; its error contains those of the samples.
    pub average: Estimate<DVec3>,
}

/// E(v) = int f(v, l) (n.l) dl over the hemisphere, per channel; `v.z` above 0.
pub fn directional_albedo(brdf: &dyn Brdf, v: DVec3, accuracy: Accuracy) -> Estimate<DVec3> {
    let f = brdf.seen_from(v);
    Polar::over_light(brdf.lobe(), v, brdf.is_isotropic(), accuracy, |l| f(l) * l.z)
}

/// Albedos at 30 angles, and at 16 azimuths where these matter; then nearer and nearer to the largest.
pub fn check_albedo(brdf: &dyn Brdf, accuracy: Accuracy) -> AlbedoReport {
    let azimuths: u32 = if brdf.is_isotropic() { 1 } else { 16 };
    let sample = |root: f64, turn: f64| {
        let v = direction(root, turn);
        AlbedoSample { v, albedo: directional_albedo(brdf, v, accuracy) }
    };
    // cos = x^2, where the albedo has its features at small cosines; 2 E cos dcos = 4 E x^3 dx.
    let nodes = kronrod_nodes(0.0, 0.5).chain(kronrod_nodes(0.5, 1.0));
    let mut average = Estimate { value: DVec3::ZERO, error: 0.0, evaluations: 0 };
    let (mut gauss, mut every_other) = (DVec3::ZERO, DVec3::ZERO);
    let mut curve = Vec::new();
    let normal = sample(1.0, 0.0);
    let mut largest = Largest { root: 1.0, turn: 0.0, sample: normal };
    for (root, kronrod_weight, gauss_weight) in nodes {
        for azimuth in 0..azimuths {
            let turn = f64::from(azimuth) / f64::from(azimuths);
            let here = sample(root, turn);
            let share = here.albedo.value * (4.0 * root.powi(3) / f64::from(azimuths));
            average.value += share * kronrod_weight;
            gauss += share * gauss_weight;
            every_other += if azimuth % 2 == 0 { share * (2.0 * kronrod_weight) } else { DVec3::ZERO };
            average.error = average.error.max(here.albedo.error);
            average.evaluations += here.albedo.evaluations;
            largest.take_larger(root, turn, here);
            if azimuth == 0 {
                curve.push(here);
            }
        }
    }
    curve.push(normal);
    average.error += (average.value - gauss).abs().max_element();
    if azimuths > 1 {
        average.error += (average.value - every_other).abs().max_element();
    }
    largest.climb(&sample);
    AlbedoReport { curve, largest: largest.sample, average }
}

/// The direction whose cosine is the square of `root`, kept off the horizon.
fn direction(root: f64, turn: f64) -> DVec3 {
    let cos = (root * root).max(1e-4);
    let (sin_phi, cos_phi) = (TAU * turn).sin_cos();
    let sin = (1.0 - cos * cos).sqrt();
    DVec3::new(sin * cos_phi, sin * sin_phi, cos)
}

struct Largest {
    root: f64,
    turn: f64,
    sample: AlbedoSample,
}

impl Largest {
    fn take_larger(&mut self, root: f64, turn: f64, sample: AlbedoSample) {
        if exceeds(sample.albedo.value.max_element(), self.sample.albedo.value.max_element()) {
            *self = Self { root, turn, sample };
        }
    }

    /// Steps to the larger neighbour, halving the step: a bend between two nodes is not missed.
    fn climb(&mut self, sample: &impl Fn(f64, f64) -> AlbedoSample) {
        let mut step = 0.03;
        for _ in 0..5 {
            let (root, turn) = (self.root, self.turn);
            for root in [root - step, root + step].into_iter().filter(|root| (0.01..=1.0).contains(root)) {
                self.take_larger(root, turn, sample(root, turn));
            }
            step *= 0.5;
        }
    }
}
