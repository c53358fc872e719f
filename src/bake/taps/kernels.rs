//! How alike two pieces of prefiltered light are, on average over all environments.

use crate::bake::lobe::legendre_coefficients;
use crate::scene::EnvironmentMaps;
use crate::threads::*;
use std::f64::consts::PI;

/// Levels of the specular maps but the mirror image: round kernels that shading can look through.
pub(super) const LEVELS: usize = EnvironmentMaps::LEVELS - 1;
/// They, and the parts of irradiance over pi of degree 1 and 2 (Ramamoorthi and Hanrahan 2001).
pub(super) const KERNELS: usize = LEVELS + 2;
/// The last level, along the normal, is irradiance over pi: GGX of alpha 1 is the cosine.
pub(super) const COSINE: usize = LEVELS - 1;
pub(super) const LINEAR: usize = LEVELS;
pub(super) const QUADRATIC: usize = LEVELS + 1;

const DEGREES: usize = 1024;
const ANGLES: usize = 8192;
const PAIRS: usize = KERNELS * (KERNELS + 1) / 2;

/// Covariances of what is seen through two kernels, by the angle between their axes. Environments are random, with a
/// power of their harmonics that falls with the degree l as (1 + l)^-2, which is about what photographs have, up to the
/// sharpness of a panorama of a thousand texels; their mean is left out, as it is the same through all kernels.
pub(super) struct Kernels {
    /// Between a direction and a kernel.
    to_direction: [Vec<f64>; KERNELS],
    between: Vec<Vec<f64>>,
}

fn power(degree: usize) -> f64 {
    let l = degree as f64;
    if degree == 0 { 0.0 } else { (1.0 + l).powi(-2) * (-(l / 512.0).powi(2)).exp() }
}

fn coefficients(kernel: usize) -> Vec<f64> {
    let only = |degree: usize, value: f64| (0..DEGREES).map(|l| if l == degree { value } else { 0.0 }).collect();
    match kernel {
        LINEAR => return only(1, 2.0 / 3.0),
        QUADRATIC => return only(2, 0.25),
        _ => {}
    }
    let alpha = EnvironmentMaps::perceptual_roughness_at((kernel + 1) as f64).powi(2);
    legendre_coefficients(alpha, DEGREES)
}

fn pair(a: usize, b: usize) -> usize {
    let (a, b) = (a.min(b), a.max(b));
    b * (b + 1) / 2 + a
}

impl Kernels {
    pub(super) fn new() -> Self {
        let kernels: Vec<Vec<f64>> = (0..KERNELS).map(coefficients).collect();
        let weights: Vec<f64> = (0..DEGREES).map(|l| power(l) * (2 * l + 1) as f64 / (4.0 * PI)).collect();
        let sums = |i: usize| sums((i as f64 * PI / (ANGLES - 1) as f64).cos(), &kernels, &weights);
        let rows: Vec<Sums> = (0..ANGLES).into_par_iter().map(sums).collect();
        Self {
            to_direction: std::array::from_fn(|kernel| rows.iter().map(|row| row.to_direction[kernel]).collect()),
            between: (0..PAIRS).map(|pair| rows.iter().map(|row| row.between[pair]).collect()).collect(),
        }
    }

    /// Covariances of the radiance in one direction with all kernels.
    pub(super) fn to_direction(&self, angle_rad: f64) -> [f64; KERNELS] {
        let place = place(angle_rad);
        std::array::from_fn(|kernel| lookup(&self.to_direction[kernel], place))
    }

    pub(super) fn between(&self, a: usize, b: usize, angle_rad: f64) -> f64 {
        lookup(&self.between[pair(a, b)], place(angle_rad))
    }
}

fn place(angle_rad: f64) -> (usize, f64) {
    let place = angle_rad * ((ANGLES - 1) as f64 / PI);
    let left = (place as usize).min(ANGLES - 2);
    (left, place - left as f64)
}

fn lookup(table: &[f64], (left, fraction): (usize, f64)) -> f64 {
    table[left] + (table[left + 1] - table[left]) * fraction
}

struct Sums {
    to_direction: [f64; KERNELS],
    between: [f64; PAIRS],
}

fn sums(x: f64, kernels: &[Vec<f64>], weights: &[f64]) -> Sums {
    let mut sums = Sums { to_direction: [0.0; KERNELS], between: [0.0; PAIRS] };
    let (mut previous, mut current) = (0.0, 1.0);
    for (degree, weight) in weights.iter().enumerate() {
        let value = weight * current;
        for (a, kernel) in kernels.iter().enumerate() {
            let through = value * kernel[degree];
            sums.to_direction[a] += through;
            for (b, other) in kernels[..=a].iter().enumerate() {
                sums.between[pair(a, b)] += through * other[degree];
            }
        }
        let l = degree as f64;
        (previous, current) = (current, ((2.0 * l + 1.0) * x * current - l * previous) / (l + 1.0));
    }
    sums
}
