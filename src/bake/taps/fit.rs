//! The search for taps. What counts is what a lookup between texels sees, so all texels are sought at once: from one lobe
//! over coarse tables to the fine one.

use super::grid::Grid;
use super::kernels::Kernels;
use super::lobe::{Lobe, Tap};
use super::shared::{Shared, TAP_VARIABLES, variables_of};
use super::weights::best;
use super::{COLUMNS, FITTED_ROWS, level_of_row, nov_of_column};
use crate::math::descent::descend;
use crate::math::simplex::minimize;
use crate::reference::sampling::PixelSampler;
use crate::scene::EnvironmentMaps;
use crate::threads::*;

/// Rows and columns of the tables on the way, and the steps of the search in each.
const GRIDS: [(usize, usize, usize); 5] =
    [(3, 3, 200), (5, 5, 200), (8, 9, 400), (15, COLUMNS, 400), (FITTED_ROWS.end - FITTED_ROWS.start, COLUMNS, 900)];
/// Lobes that are looked at to a step between texels of the finest table.
const LOBES_PER_STEP: usize = 2;
/// Starts of the search at the first lobe.
const STARTS: u32 = 96;
const EVALUATIONS: usize = 400;
/// What a difference of 1 between neighbours costs, in shares of the variance of what is seen.
const SMOOTHNESS: f64 = 1e-7;
/// What the square of a number costs by which a bound is broken, in the same shares.
const OUTSIDE: f64 = 0.1;

/// A lobe of the table, at or between its texels.
struct Sample<'a> {
    lobe: Lobe<'a>,
    level: f64,
    /// Where among the rows and the columns that are fitted, in [0, 1].
    place: [f64; 2],
    /// What its error counts: the reciprocal of the variance of what is seen, more where more of a sphere looks so.
    counts: f64,
}

/// All lobes that are looked at.
pub(super) struct Lobes<'a> {
    samples: Vec<Sample<'a>>,
}

impl<'a> Lobes<'a> {
    pub(super) fn new(kernels: &'a Kernels) -> Self {
        let (rows, columns) = (LOBES_PER_STEP * (FITTED_ROWS.len() - 1), LOBES_PER_STEP * (COLUMNS - 1));
        let count = (rows + 1) * (columns + 1);
        let sample = |i: usize| {
            let (row, column) = (i / (columns + 1), i % (columns + 1));
            let between = |i: usize| i as f64 / LOBES_PER_STEP as f64;
            let level = level_of_row(FITTED_ROWS.start as f64 + between(row));
            let nov = nov_of_column(between(column));
            let lobe = lobe_at(kernels, level, nov);
            let counts = (0.1 + nov) / (lobe.scale(level) * count as f64);
            Sample { lobe, level, place: [row as f64 / rows as f64, column as f64 / columns as f64], counts }
        };
        Self { samples: (0..count).into_par_iter().map(sample).collect() }
    }

    /// For each of `counts`, which ascend by one, taps for every texel that is fitted, row by row. They are sought from
    /// random starts, and again from what was found for one tap less.
    pub(super) fn fit<const N: usize>(&self, counts: [usize; N]) -> [Vec<Shared>; N] {
        let mut fewer: Option<Grid> = None;
        counts.map(|count| {
            let new = self.refined(Grid::uniform(&self.first(count)), &GRIDS);
            let best = match fewer.take() {
                None => new,
                Some(fewer) => self.better(new, self.with_one_more(&fewer)),
            };
            let grid = fewer.insert(best);
            (0..grid.len()).map(|i| Shared::from_variables(&grid.held(i)).with_bounded_shares()).collect()
        })
    }

    fn refined(&self, grid: Grid, grids: &[(usize, usize, usize)]) -> Grid {
        grids.iter().fold(grid, |grid, &(rows, columns, steps)| self.descended(&grid.resampled(rows, columns), steps))
    }

    /// Whichever tap is split, the best of what comes of it.
    fn with_one_more(&self, grid: &Grid) -> Grid {
        let (rows, columns, steps) = GRIDS[2];
        let split = |tap: usize| self.descended(&grid.resampled(rows, columns).split(tap), steps);
        let best = (1..grid.taps()).fold(split(0), |best, tap| self.better(best, split(tap)));
        self.refined(best, &GRIDS[3..])
    }

    fn better(&self, a: Grid, b: Grid) -> Grid {
        if self.cost(&a).0 <= self.cost(&b).0 { a } else { b }
    }

    fn descended(&self, grid: &Grid, steps: usize) -> Grid {
        grid.with(&descend(|at| self.cost(&grid.with(at)), grid.variables().to_vec(), 0.3, steps))
    }

    /// The mean error with a table, and how it grows with each of the table's variables.
    fn cost(&self, grid: &Grid) -> (f64, Vec<f64>) {
        let see = |sample: &Sample| {
            let corners = grid.corners(sample.place);
            let (cost, gradient) = sample.lobe.cost_and_gradient(&grid.mean(corners));
            (corners, sample.counts, cost, gradient)
        };
        let seen: Vec<_> = self.samples.par_iter().map(see).collect();
        let bounded: Vec<f64> = (0..grid.len()).flat_map(|node| grid.bounded(node, grid.at(node))).collect();
        let (mut value, mut gradient) = grid.penalties(SMOOTHNESS, OUTSIDE);
        for (corners, counts, cost, by) in seen {
            value += counts * cost;
            for (node, share) in corners {
                for (k, by) in by.iter().enumerate() {
                    let i = node * grid.size() + k;
                    // Beyond a bound nothing changes.
                    gradient[i] += if grid.variables()[i] == bounded[i] { counts * share * by } else { 0.0 };
                }
            }
        }
        (value, gradient)
    }

    /// Taps of the lobe in the middle, from several starts.
    fn first(&self, count: usize) -> Vec<f64> {
        let middle = &self.samples[self.samples.len() / 2];
        let from = |start: u32| middle.alone(&random_start(start, count, middle.level));
        let ends: Vec<_> = (0..STARTS).into_par_iter().map(from).collect();
        let cost = |end: &Vec<f64>| middle.lobe.cost(&Shared::from_variables(&middle.absolute(end)));
        ends.into_iter().min_by(|a, b| cost(a).total_cmp(&cost(b))).unwrap_or_default()
    }
}

impl Sample<'_> {
    /// Variables of the best taps of this lobe near a start, with levels relative to its own.
    fn alone(&self, start: &[f64]) -> Vec<f64> {
        let cost = |at: &[f64]| cost(&self.lobe, at);
        let once = minimize(cost, start, 0.25, EVALUATIONS, 1e-9);
        let mut shared = weighed(&self.lobe, taps_of(&minimize(cost, &once.at, 0.1, EVALUATIONS, 1e-10).at));
        shared.taps.iter_mut().for_each(|tap| tap.level -= self.level);
        variables_of(&shared)
    }

    /// Variables with levels as they are.
    fn absolute(&self, variables: &[f64]) -> Vec<f64> {
        let mut shared = Shared::from_variables(variables);
        shared.taps.iter_mut().for_each(|tap| tap.level += self.level);
        variables_of(&shared)
    }
}

pub(super) fn lobe_at(kernels: &Kernels, level: f64, nov: f64) -> Lobe<'_> {
    Lobe::new(kernels, EnvironmentMaps::perceptual_roughness_at(level), nov)
}

/// What a search from the given taps gains, in shares of the variance of what is seen.
pub(super) fn gain(lobe: &Lobe, level: f64, given: &Shared) -> f64 {
    let start: Vec<f64> = given.taps.iter().flat_map(|tap| [tap.place, tap.level, tap.spread]).collect();
    let best = minimize(|at| cost(lobe, at), &start, 0.1, EVALUATIONS, 1e-10);
    (lobe.cost_and_gradient(given).0 - best.value) / lobe.scale(level)
}

/// The error of taps with their best weights.
fn cost(lobe: &Lobe, at: &[f64]) -> f64 {
    let bounded: f64 = taps_of(at).iter().map(|tap| tap.distance2(tap.bounded(f64::INFINITY))).sum();
    lobe.cost_and_gradient(&weighed(lobe, taps_of(at).iter().map(|tap| tap.bounded(f64::INFINITY)).collect())).0
        + bounded * lobe.scale(4.0)
}

fn weighed(lobe: &Lobe, taps: Vec<Tap>) -> Shared {
    let count = taps.len();
    let covariances = lobe.covariances(&taps);
    let metal = best(&covariances.squares, &covariances.products[0], count);
    let parts = [metal[count], metal[count + 1]];
    // The dielectric has the metal's parts of irradiance, and taps for the rest.
    let squares: Vec<Vec<f64>> = covariances.squares[..count].iter().map(|row| row[..count].to_vec()).collect();
    let of_parts = |row: &[f64]| row[count] * parts[0] + row[count + 1] * parts[1];
    let products: Vec<f64> =
        (0..count).map(|i| covariances.products[1][i] - of_parts(&covariances.squares[i])).collect();
    let dielectric = best(&squares, &products, count);
    Shared { taps, shares: [metal[..count].to_vec(), dielectric], parts }
}

fn taps_of(variables: &[f64]) -> Vec<Tap> {
    variables.chunks_exact(TAP_VARIABLES).map(|tap| Tap { place: tap[0], level: tap[1], spread: tap[2] }).collect()
}

fn random_start(start: u32, count: usize, level: f64) -> Vec<f64> {
    let pair = |dimension: u32| PixelSampler::new(1, 0, 0).pair(start, dimension);
    let tap = |k: usize| {
        let (a, b) = (pair(2 * k as u32), pair(2 * k as u32 + 1));
        [-2.5 + 4.0 * a.x, level - 1.5 + 2.5 * a.y, -1.0 + 2.0 * b.x]
    };
    (0..count).flat_map(tap).collect()
}
