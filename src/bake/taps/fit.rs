//! The search for taps: one lobe from many starts, its neighbours from there, and then all of them against each other
//! until the table is smooth.

use super::kernels::Kernels;
use super::lobe::{Lobe, PLACE_MAX, Tap};
use super::{COLUMNS, FITTED_ROWS, LAST_LEVEL, Shared, level_of_row, nov_of_column};
use crate::math::simplex::minimize;
use crate::reference::sampling::PixelSampler;
use crate::scene::EnvironmentMaps;
use rayon::prelude::*;

/// Variables of a tap: place, level and spread.
const VARIABLES: usize = 3;
/// Starts of the search at the first lobe.
const STARTS: u32 = 96;
const EVALUATIONS: usize = 400;
/// In a sweep, where the start is close.
const EVALUATIONS_OF_SWEEP: usize = 100;
const SWEEPS: i32 = 24;
/// What a difference of 1 from the mean of the neighbours costs, in shares of the variance of what is seen: in the first
/// sweep, where regions that follow different minima have to agree, and in the last.
const SMOOTHNESS: [f64; 2] = [3e-3, 1e-5];

/// All lobes of the table that are fitted, row by row.
pub(super) struct Lobes<'a> {
    lobes: Vec<Lobe<'a>>,
    levels: Vec<f64>,
    scales: Vec<f64>,
}

impl<'a> Lobes<'a> {
    pub(super) fn new(kernels: &'a Kernels) -> Self {
        let level = |i: usize| level_of_row(FITTED_ROWS.start + i / COLUMNS);
        let lobe = |i: usize| {
            Lobe::new(kernels, EnvironmentMaps::perceptual_roughness_at(level(i)), nov_of_column(i % COLUMNS))
        };
        let count = FITTED_ROWS.len() * COLUMNS;
        let lobes: Vec<Lobe> = (0..count).into_par_iter().map(lobe).collect();
        let levels: Vec<f64> = (0..count).map(level).collect();
        let scales = lobes.iter().zip(&levels).map(|(lobe, level)| lobe.scale(*level)).collect();
        Self { lobes, levels, scales }
    }

    fn cost(&self, i: usize, variables: &[f64]) -> f64 {
        cost(&self.lobes[i], self.levels[i], self.scales[i], variables)
    }

    /// The best end of searches from several starts; `rough` is added to the cost.
    fn search(
        &self,
        i: usize,
        starts: impl IntoIterator<Item = Vec<f64>>,
        evaluations: usize,
        rough: impl Fn(&[f64]) -> f64,
    ) -> Vec<f64> {
        let cost = |variables: &[f64]| self.cost(i, variables) + rough(variables);
        let ends = starts.into_iter().map(|start| {
            let once = minimize(cost, &start, 0.25, evaluations, 1e-9);
            minimize(cost, &once.at, 0.1, evaluations, 1e-10)
        });
        ends.min_by(|a, b| a.value.total_cmp(&b.value)).map(|end| end.at).unwrap_or_default()
    }

    /// `count` taps for every lobe.
    pub(super) fn fit(&self, count: usize) -> Vec<Shared> {
        let mut found = self.spread_out(count);
        for sweep in 0..SWEEPS {
            let smoothness =
                SMOOTHNESS[0] * (SMOOTHNESS[1] / SMOOTHNESS[0]).powf(f64::from(sweep) / f64::from(SWEEPS - 1));
            for color in 0..2 {
                let is_next = |i: &usize| (i / COLUMNS + i % COLUMNS) % 2 == color;
                let better = |i: usize| (i, self.smoothed(&found, i, sweep as usize, smoothness));
                let better: Vec<_> = (0..self.lobes.len()).into_par_iter().filter(is_next).map(better).collect();
                better.into_iter().for_each(|(i, at)| found[i] = at);
            }
        }
        let shared = |(i, variables): (usize, &Vec<f64>)| {
            let taps = held(self.levels[i], variables);
            let weights = self.lobes[i].fit(&taps).weights;
            Shared { taps, weights }
        };
        found.iter().enumerate().map(shared).collect()
    }

    /// One lobe from many starts, and from there to all others.
    fn spread_out(&self, count: usize) -> Vec<Vec<f64>> {
        let first = FITTED_ROWS.len() / 2 * COLUMNS + COLUMNS / 2;
        let from =
            |start: u32| self.search(first, [random_start(start, count, self.levels[first])], EVALUATIONS, |_| 0.0);
        let ends: Vec<Vec<f64>> = (0..STARTS).into_par_iter().map(from).collect();
        let mut found: Vec<Option<Vec<f64>>> = vec![None; self.lobes.len()];
        found[first] = Some(self.search(first, ends, EVALUATIONS, |_| 0.0));
        while found.iter().any(Option::is_none) {
            let reached = |i: usize| {
                let starts: Vec<Vec<f64>> =
                    neighbours(i).filter_map(|j| Some(self.moved(found[j].as_ref()?, j, i))).collect();
                (!starts.is_empty()).then(|| (i, self.search(i, starts, EVALUATIONS, |_| 0.0)))
            };
            let next: Vec<_> =
                (0..found.len()).into_par_iter().filter(|&i| found[i].is_none()).filter_map(reached).collect();
            next.into_iter().for_each(|(i, at)| found[i] = Some(at));
        }
        found.into_iter().flatten().collect()
    }

    /// One lobe again, drawn to its neighbours; one of them is tried as a start.
    fn smoothed(&self, found: &[Vec<f64>], i: usize, sweep: usize, smoothness: f64) -> Vec<f64> {
        let beside: Vec<Vec<f64>> = neighbours(i).map(|j| self.moved(&found[j], j, i)).collect();
        let mean: Vec<f64> = (0..found[i].len())
            .map(|k| beside.iter().map(|variables| variables[k]).sum::<f64>() / beside.len() as f64)
            .collect();
        let rough = |variables: &[f64]| {
            let halfway = |other: &Vec<f64>| {
                let middle: Vec<f64> = variables.iter().zip(other).map(|(a, b)| 0.5 * (a + b)).collect();
                self.cost(i, &middle)
            };
            let between = beside.iter().map(halfway).sum::<f64>() / beside.len() as f64;
            between + smoothness * variables.iter().zip(&mean).map(|(a, b)| (a - b).powi(2)).sum::<f64>()
        };
        let starts = [found[i].clone(), mean.clone(), beside[sweep % beside.len()].clone()];
        self.search(i, starts, EVALUATIONS_OF_SWEEP, rough)
    }

    /// The variables of lobe `from` as they would be at `to`: levels follow those of the rows.
    fn moved(&self, variables: &[f64], from: usize, to: usize) -> Vec<f64> {
        let step = self.levels[to] - self.levels[from];
        variables.iter().enumerate().map(|(i, x)| if i % VARIABLES == 1 { x + step } else { *x }).collect()
    }
}

/// What a search from stored taps gains, in shares of the variance of what is seen.
pub(super) fn gain(lobe: &Lobe, level: f64, stored: &Shared) -> f64 {
    let scale = lobe.scale(level);
    let start: Vec<f64> = stored.taps.iter().flat_map(|tap| [tap.place, tap.level, tap.spread]).collect();
    let best = minimize(|variables| cost(lobe, level, scale, variables), &start, 0.1, EVALUATIONS, 1e-10);
    lobe.with_weights(&stored.taps, &stored.weights).cost() / scale - best.value
}

/// Expected squared error over the variance of what is seen, with a penalty outside the table's range.
fn cost(lobe: &Lobe, level: f64, scale: f64, variables: &[f64]) -> f64 {
    let taps = held(level, variables);
    let outside: f64 = taps.iter().zip(unbounded(variables)).map(|(held, tap)| distance(*held, tap)).sum();
    lobe.fit(&taps).cost() / scale + outside
}

/// The nearest taps that the table can hold. Those of level 1 are next to the mirror image and keep off it.
fn held(level: f64, variables: &[f64]) -> Vec<Tap> {
    let widest = if level > 1.0 { LAST_LEVEL } else { 1.0 };
    let held = |tap: Tap| Tap {
        place: tap.place.clamp(-PLACE_MAX, PLACE_MAX),
        level: tap.level.clamp(1.0, widest),
        spread: tap.spread.clamp(-PLACE_MAX, PLACE_MAX),
    };
    unbounded(variables).map(held).collect()
}

fn neighbours(i: usize) -> impl Iterator<Item = usize> {
    let (row, column) = (i / COLUMNS, i % COLUMNS);
    [(0, -1), (0, 1), (-1, 0), (1, 0)].into_iter().filter_map(move |(down, right)| {
        let (row, column) = (row.checked_add_signed(down)?, column.checked_add_signed(right)?);
        (row < FITTED_ROWS.len() && column < COLUMNS).then_some(row * COLUMNS + column)
    })
}

fn random_start(start: u32, count: usize, level: f64) -> Vec<f64> {
    let pair = |dimension: u32| PixelSampler::new(1, 0, 0).pair(start, dimension);
    let tap = |k: usize| {
        let (a, b) = (pair(2 * k as u32), pair(2 * k as u32 + 1));
        [-2.5 + 4.0 * a.x, level - 1.5 + 2.5 * a.y, -1.0 + 2.0 * b.x]
    };
    (0..count).flat_map(tap).collect()
}

fn unbounded(variables: &[f64]) -> impl Iterator<Item = Tap> {
    variables.chunks_exact(VARIABLES).map(|tap| Tap { place: tap[0], level: tap[1], spread: tap[2] })
}

fn distance(a: Tap, b: Tap) -> f64 {
    (a.place - b.place).powi(2) + (a.level - b.level).powi(2) + (a.spread - b.spread).powi(2)
}
