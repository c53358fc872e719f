//! A GGX lobe and how well taps stand for it.

#![expect(non_snake_case, reason = "NoV, VoH and Lambda are the symbols of the papers")]

use super::kernels::{COSINE, KERNELS, Kernels, LEVELS, LINEAR, QUADRATIC};
use super::shared::Shared;
use crate::reference::microfacet::distribution::Lambda_GGX_anisotropic;
use crate::reference::sampling::sample_visible_normal;
use glam::{DVec2, DVec3};

/// Directions that stand for the lobe.
const DIRECTIONS: usize = 1024;
/// Places of a lookup that are tabulated: steps of 1/32 of alpha.
const PLACES: usize = 2 * 32 * PLACE_MAX as usize + 1;
/// Places end here, in units of alpha times the sine of the view's angle.
pub(super) const PLACE_MAX: f64 = 4.0;
/// F0 of the two lobes that share places and levels.
const F0: [f64; 2] = [1.0, 0.04];
/// What an error of the second counts against one of the first.
const DIELECTRIC: f64 = 0.5;
const COUNTS: [f64; 2] = [1.0, DIELECTRIC];
/// Irradiance and its parts of degree 1 and 2, all seen along the normal.
const PARTS: [usize; 3] = [COSINE, LINEAR, QUADRATIC];
/// Of places, levels and spreads, to find how the cost grows.
const DIFFERENCE: f64 = 1e-4;

/// One tap: two lookups of neighbouring levels, each at its own place.
///
/// The mirror direction R and, within the plane of incidence, T across it away from the normal, scaled by the sine of
/// the view's angle: a lookup is toward R + t alpha T.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Tap {
    /// Where both lookups meet, t.
    pub(super) place: f64,
    /// Level of the specular maps, from 1; the fraction is the share of the wider lookup.
    pub(super) level: f64,
    /// How far apart the lookups are, t: the narrower is moved by the wider's share of it, the wider back by the rest.
    pub(super) spread: f64,
}

impl Tap {
    /// Kernel, place and share of the two lookups.
    fn lookups(self) -> [(usize, f64, f64); 2] {
        let level = self.level.clamp(1.0, LEVELS as f64) - 1.0;
        let lower = (level as usize).min(LEVELS - 2);
        let share = level - lower as f64;
        let (near, far) = (self.place + self.spread * share, self.place - self.spread * (1.0 - share));
        [(lower, near, 1.0 - share), (lower + 1, far, share)]
    }
}

/// The lobe for one view, and its covariances with what a lookup sees.
pub(super) struct Lobe<'a> {
    kernels: &'a Kernels,
    /// Angle of the mirror direction from the normal.
    theta: f64,
    /// Tangents of angles per unit of place.
    reach: f64,
    /// For each lobe and place, with all levels.
    places: [Vec<[f64; KERNELS]>; 2],
    /// For each lobe, with irradiance, its linear and its quadratic part.
    irradiance: [[f64; 3]; 2],
}

/// What is seen through taps in the place of irradiance: covariances of taps and irradiance's two parts among themselves,
/// and with either lobe, of all of which irradiance is taken away. Weights w leave an expected squared error of
/// w.S w - 2 w.p, but for a constant.
pub(super) struct Covariances {
    pub(super) squares: Vec<Vec<f64>>,
    pub(super) products: [Vec<f64>; 2],
}

impl Covariances {
    /// Of one lobe.
    pub(super) fn error(&self, lobe: usize, weights: &[f64]) -> f64 {
        let rows = weights.iter().enumerate().map(|(i, weight)| {
            let row: f64 = self.squares[i].iter().zip(weights).map(|(square, weight)| square * weight).sum();
            weight * (row - 2.0 * self.products[lobe][i])
        });
        rows.sum()
    }

    /// Of both lobes, each with its weights.
    fn cost(&self, weights: &[Vec<f64>; 2]) -> f64 {
        self.error(0, &weights[0]) + DIELECTRIC * self.error(1, &weights[1])
    }

    /// How the cost grows with each weight.
    fn by_weights(&self, weights: &[Vec<f64>; 2]) -> [Vec<f64>; 2] {
        [0, 1].map(|lobe| {
            let by_weight = |(row, product): (&Vec<f64>, &f64)| {
                let seen: f64 = row.iter().zip(&weights[lobe]).map(|(square, weight)| square * weight).sum();
                2.0 * COUNTS[lobe] * (seen - product)
            };
            self.squares.iter().zip(&self.products[lobe]).map(by_weight).collect()
        })
    }
}

/// What a tap has to do with everything else.
struct Row {
    squares: Vec<f64>,
    products: [f64; 2],
}

impl<'a> Lobe<'a> {
    pub(super) fn new(kernels: &'a Kernels, perceptual_roughness: f64, NoV: f64) -> Self {
        let alpha = perceptual_roughness * perceptual_roughness;
        let sin_theta = (1.0 - NoV * NoV).max(0.0).sqrt();
        let lobe = directions(alpha, NoV);
        let reach = alpha * sin_theta;
        let (R, T) = (DVec3::new(-sin_theta, 0.0, NoV), DVec3::new(-NoV, 0.0, -sin_theta));
        let seen = |axis: DVec3| {
            let mut sums = [[0.0; KERNELS]; 2];
            for (l, weights) in &lobe {
                let covariances = kernels.to_direction(l.dot(axis).clamp(-1.0, 1.0).acos());
                for (sums, weight) in sums.iter_mut().zip(weights) {
                    for (sum, covariance) in sums.iter_mut().zip(covariances) {
                        *sum += weight * covariance;
                    }
                }
            }
            sums
        };
        let place = |i: usize| (i as f64 / 32.0 - PLACE_MAX) * reach;
        let rows: Vec<_> = (0..PLACES).map(|i| seen((R + T * place(i)).normalize())).collect();
        let normal = seen(DVec3::Z);
        Self {
            kernels,
            theta: NoV.clamp(0.0, 1.0).acos(),
            reach,
            places: std::array::from_fn(|lobe| rows.iter().map(|row| row[lobe]).collect()),
            irradiance: normal.map(|normal| PARTS.map(|kernel| normal[kernel])),
        }
    }

    /// The variance of what a lookup of the lobe's own level sees, to compare errors with.
    pub(super) fn scale(&self, level: f64) -> f64 {
        let tap = Tap { place: 0.0, level, spread: 0.0 };
        self.between(tap, tap)
    }

    /// The error of both lobes.
    pub(super) fn cost(&self, shared: &Shared) -> f64 {
        self.covariances(&shared.taps).cost(&shared.weights())
    }

    /// The error of both lobes, and how it grows with each of the variables.
    pub(super) fn cost_and_gradient(&self, shared: &Shared) -> (f64, Vec<f64>) {
        let weights = shared.weights();
        let covariances = self.covariances(&shared.taps);
        let count = shared.taps.len();
        let [metal, dielectric] = covariances.by_weights(&weights);
        let parts = metal[count..].iter().zip(&dielectric[count..]).map(|(metal, dielectric)| metal + dielectric);
        let by_taps = self.by_taps(&shared.taps, &weights);
        let shares = metal[..count].iter().chain(&dielectric[..count]).copied();
        (covariances.cost(&weights), by_taps.into_iter().flatten().chain(shares).chain(parts).collect())
    }

    /// Of taps and the two parts of irradiance.
    pub(super) fn covariances(&self, taps: &[Tap]) -> Covariances {
        let (count, size) = (taps.len(), taps.len() + 2);
        let mut squares = vec![vec![0.0; size]; size];
        let mut products = [vec![0.0; size], vec![0.0; size]];
        for i in 0..count {
            let row = self.row(taps, i);
            for (j, square) in row.squares.iter().enumerate().take(size) {
                (squares[i][j], squares[j][i]) = (*square, *square);
            }
            (products[0][i], products[1][i]) = (row.products[0], row.products[1]);
        }
        for part in 0..2 {
            let kernel = PARTS[1 + part];
            squares[count + part][count + part] = self.kernels.between(kernel, kernel, 0.0);
            let with_irradiance = self.kernels.between(COSINE, kernel, 0.0);
            for (products, irradiance) in products.iter_mut().zip(&self.irradiance) {
                products[count + part] = irradiance[1 + part] - with_irradiance;
            }
        }
        Covariances { squares, products }
    }

    /// How the cost grows with place, level and spread of each tap, by differences.
    fn by_taps(&self, taps: &[Tap], weights: &[Vec<f64>; 2]) -> Vec<[f64; 3]> {
        let part = |i: usize, moved: Tap| {
            let mut taps = taps.to_vec();
            taps[i] = moved;
            let row = self.row(&taps, i);
            let lobes = [0, 1].map(|lobe| {
                let weights = &weights[lobe];
                let seen: f64 = row.squares.iter().zip(weights).map(|(square, weight)| square * weight).sum();
                COUNTS[lobe] * weights[i] * (2.0 * seen - row.squares[i] * weights[i] - 2.0 * row.products[lobe])
            });
            lobes[0] + lobes[1]
        };
        let by = |i: usize, step: fn(&mut Tap) -> &mut f64| {
            let moved = |by: f64| {
                let mut tap = taps[i];
                *step(&mut tap) += by;
                part(i, tap)
            };
            (moved(DIFFERENCE) - moved(-DIFFERENCE)) / (2.0 * DIFFERENCE)
        };
        (0..taps.len())
            .map(|i| [by(i, |tap| &mut tap.place), by(i, |tap| &mut tap.level), by(i, |tap| &mut tap.spread)])
            .collect()
    }

    fn row(&self, taps: &[Tap], i: usize) -> Row {
        let own = self.with_irradiance(taps[i], COSINE);
        let irradiance = self.kernels.between(COSINE, COSINE, 0.0);
        let with_tap = |tap: &Tap| self.between(taps[i], *tap) - own - self.with_irradiance(*tap, COSINE) + irradiance;
        let with_part =
            |kernel: &usize| self.with_irradiance(taps[i], *kernel) - self.kernels.between(COSINE, *kernel, 0.0);
        let squares = taps.iter().map(with_tap).chain(PARTS[1..].iter().map(with_part)).collect();
        let with_lobes = self.with_lobes(taps[i]);
        let products = [0, 1].map(|lobe| with_lobes[lobe] - own - self.irradiance[lobe][0] + irradiance);
        Row { squares, products }
    }

    fn with_lobes(&self, tap: Tap) -> [f64; 2] {
        let [near, far] = tap.lookups();
        std::array::from_fn(|lobe| self.with_lobe(lobe, near) + self.with_lobe(lobe, far))
    }

    fn with_lobe(&self, lobe: usize, (kernel, place, share): (usize, f64, f64)) -> f64 {
        let at = ((place + PLACE_MAX) * 32.0).clamp(0.0, (PLACES - 1) as f64);
        let left = (at as usize).min(PLACES - 2);
        let (a, b) = (self.places[lobe][left][kernel], self.places[lobe][left + 1][kernel]);
        share * (a + (b - a) * (at - left as f64))
    }

    fn angle(&self, place: f64) -> f64 {
        (place.clamp(-PLACE_MAX, PLACE_MAX) * self.reach).atan()
    }

    fn between(&self, a: Tap, b: Tap) -> f64 {
        let pairs = a.lookups().into_iter().flat_map(|a| b.lookups().map(|b| (a, b)));
        pairs
            .map(|((kernel_a, place_a, share_a), (kernel_b, place_b, share_b))| {
                let angle = (self.angle(place_a) - self.angle(place_b)).abs();
                share_a * share_b * self.kernels.between(kernel_a, kernel_b, angle)
            })
            .sum()
    }

    fn with_irradiance(&self, tap: Tap, part: usize) -> f64 {
        let lookups = tap.lookups().into_iter();
        let one = |(kernel, place, share): (usize, f64, f64)| {
            share * self.kernels.between(kernel, part, (self.theta + self.angle(place)).abs())
        };
        lookups.map(one).sum()
    }
}

/// Directions of the light with their shares of the lobes, which sum to 1: +Z is the normal, and the view in the half
/// plane of positive x. Half of them: the others mirror these at the plane of incidence.
fn directions(alpha: f64, NoV: f64) -> Vec<(DVec3, [f64; 2])> {
    let v = DVec3::new((1.0 - NoV * NoV).max(0.0).sqrt(), 0.0, NoV);
    let Lambda = |x: DVec3| Lambda_GGX_anisotropic(alpha, alpha, x.x, x.y, x.z);
    let direction = |i: usize| {
        let golden = (i as f64 * 0.618_033_988_749_894_9).fract();
        let u = DVec2::new((i as f64 + 0.5) / DIRECTIONS as f64, 0.5 * golden);
        let h = sample_visible_normal(DVec2::splat(alpha), v, u);
        let VoH = v.dot(h);
        let l = 2.0 * VoH * h - v;
        let weight = if l.z > 1e-9 { (1.0 + Lambda(v)) / (1.0 + Lambda(v) + Lambda(l)) } else { 0.0 };
        (l, F0.map(|f0| weight * (f0 + (1.0 - f0) * (1.0 - VoH).max(0.0).powi(5))))
    };
    let mut lobe: Vec<_> = (0..DIRECTIONS).map(direction).collect();
    for i in 0..2 {
        let sum: f64 = lobe.iter().map(|(_, weights)| weights[i]).sum();
        lobe.iter_mut().for_each(|(_, weights)| weights[i] /= sum);
    }
    lobe
}
