//! Where to look for what a GGX lobe reflects of the environment: a few prefiltered taps in the plane of incidence.
//!
//! Prefiltered maps are made for a lobe seen along its axis. Seen from the side it is longer than wide and leans away
//! from the mirror direction; a few round taps, each with its own place and width, follow that. Irradiance, which is at
//! hand, stands for the wide skirt: what the taps leave, and its parts of degree 1 and 2, each with a weight.
//!
//! `assets/taps.bin` is the bare texture: [`TILES`] tiles of [`COLUMNS`] x [`ROWS`] texels above one another, each with
//! sqrt(NoV) to the right from 0 to 1 and the level of the specular maps downward from 0 to 8, end points on texel
//! centres. A texel is four little-endian unorm16: places and spreads as x / 8 + 1/2, levels as an eighth, shares of taps
//! as they are, weights of irradiance's parts as x / 4 + 1/2. What the shares leave of 1 is irradiance's. For two, three and
//! four taps in turn, k being their number, a texel each:
//!
//! | | |
//! |---|---|
//! | k times | place, level, spread of a tap, and its share for F0 = 1 |
//! | once | the weights of degree 1 and 2, the shares of the first two taps for F0 = 0.04 |
//! | once, of more than two | the shares of the third and fourth tap for F0 = 0.04, nothing |

mod fit;
mod grid;
mod kernels;
mod lobe;
mod shared;
mod weights;

use super::table::{EmbeddedTable, unorm16};
use crate::threads::*;
use fit::Lobes;
use kernels::Kernels;
use lobe::{PLACE_MAX, Tap};
use shared::{Shared, variables_of};
use std::ops::Range;

/// Steps of sqrt(NoV), of 1/16.
pub const COLUMNS: usize = 17;
/// Steps of a quarter of a level.
pub const ROWS: usize = 33;
/// Tiles of the table.
pub const TILES: usize = 14;

/// Above, taps mix with the mirror image, all to the same share, and are placed as at level 1.
const FITTED_ROWS: Range<usize> = 4..ROWS;
/// Taps of the tiers from draft to high.
const TAPS: [usize; 3] = [2, 3, 4];
/// Where their tiles begin.
const FIRST_TILES: [usize; 3] = [0, 3, 8];
const CHANNELS: usize = 4;
const LAST_LEVEL: f64 = 8.0;
/// What [`check`] lets searches gain on average, in shares of the variance of what is seen, for each number of taps: a
/// quarter more than measured. Texels that suit all lobes around them are not the best for one.
const LARGEST_GAINS: [f64; 3] = [1.65e-3, 6.7e-4, 4.6e-4];

static EMBEDDED: &[u8; COLUMNS * ROWS * TILES * CHANNELS * 2] = include_bytes!("../../assets/taps.bin");

/// The table and its file.
pub const TABLE: EmbeddedTable = EmbeddedTable {
    file: "taps.bin",
    width: COLUMNS,
    height: ROWS * TILES,
    channels: CHANNELS,
    bytes: EMBEDDED,
    bake,
    check,
};

fn level_of_row(row: f64) -> f64 {
    0.25 * row
}

/// The first column stands for views that graze: there is no lobe at 0 itself.
fn nov_of_column(column: f64) -> f64 {
    (column / (COLUMNS - 1) as f64).powi(2).max(0.01)
}

/// Fits all taps: `COLUMNS * ROWS * TILES` texels of four unorm16, row-major. Takes minutes.
pub fn bake() -> Vec<u16> {
    let kernels = Kernels::new();
    let lobes = Lobes::new(&kernels);
    let sets = lobes.fit(TAPS);
    let texels = |y: usize| {
        let (tile, row) = (y / ROWS, y % ROWS);
        let sets = &sets;
        (0..COLUMNS)
            .flat_map(move |column| texel(tile, &sets.each_ref().map(|set| entry(set, row, column))).map(unorm16))
    };
    (0..ROWS * TILES).flat_map(texels).collect()
}

fn entry(set: &[Shared], row: usize, column: usize) -> Shared {
    let fitted = row.max(FITTED_ROWS.start) - FITTED_ROWS.start;
    let mut entry = set[fitted * COLUMNS + column].clone();
    if row < FITTED_ROWS.start {
        let smooth = |tap: &Tap| Tap { place: tap.place, level: level_of_row(row as f64), spread: 0.0 };
        entry.taps = entry.taps.iter().map(smooth).collect();
    }
    entry
}

fn texel(tile: usize, sets: &[Shared; 3]) -> [f64; CHANNELS] {
    let set = FIRST_TILES.partition_point(|first| *first <= tile) - 1;
    let tile = tile - FIRST_TILES[set];
    let Shared { taps, shares: [metal, dielectric], parts } = &sets[set];
    if let Some(Tap { place, level, spread }) = taps.get(tile) {
        return [place / (2.0 * PLACE_MAX) + 0.5, level / LAST_LEVEL, spread / (2.0 * PLACE_MAX) + 0.5, metal[tile]];
    }
    let share = |k: usize| dielectric.get(k).copied().unwrap_or(0.0);
    if tile > taps.len() {
        return [share(2), share(3), 0.0, 0.0];
    }
    let [linear, quadratic] = parts.map(|part| part / 4.0 + 0.5);
    [linear, quadratic, share(0), share(1)]
}

/// What [`texel`] stored.
fn stored(values: &[u16], row: usize, column: usize) -> [Shared; 3] {
    let texel = |tile: usize| -> [f64; CHANNELS] {
        let start = ((tile * ROWS + row) * COLUMNS + column) * CHANNELS;
        std::array::from_fn(|channel| f64::from(values[start + channel]) / f64::from(u16::MAX))
    };
    let tap = |[place, level, spread, _]: [f64; CHANNELS]| Tap {
        place: (place - 0.5) * 2.0 * PLACE_MAX,
        level: level * LAST_LEVEL,
        spread: (spread - 0.5) * 2.0 * PLACE_MAX,
    };
    [0, 1, 2].map(|set| {
        let (first, count) = (FIRST_TILES[set], TAPS[set]);
        let texels: Vec<_> = (first..first + count).map(texel).collect();
        let [linear, quadratic, one, two] = texel(first + count);
        let [three, four, ..] = if count > 2 { texel(first + count + 1) } else { [0.0; CHANNELS] };
        Shared {
            shares: [texels.iter().map(|texel| texel[3]).collect(), [one, two, three, four][..count].to_vec()],
            taps: texels.into_iter().map(tap).collect(),
            parts: [linear, quadratic].map(|part| (part - 0.5) * 4.0),
        }
    })
}

/// What a bilinear lookup returns at a row and a column, either of which may lie between two.
fn looked_up(values: &[u16], row: f64, column: f64) -> [Shared; 3] {
    let split = |at: f64, count: usize| {
        let first = (at as usize).min(count - 2);
        [(first, 1.0 - (at - first as f64)), (first + 1, at - first as f64)]
    };
    let corners = split(row, ROWS).into_iter().flat_map(|(row, down)| {
        split(column, COLUMNS)
            .map(|(column, right)| (stored(values, row, column).map(|set| variables_of(&set)), down * right))
    });
    let corners: Vec<([Vec<f64>; 3], f64)> = corners.collect();
    [0, 1, 2].map(|set| {
        let mean = |k: usize| corners.iter().map(|(sets, share)| share * sets[set][k]).sum();
        Shared::from_variables(&(0..corners[0].0[set].len()).map(mean).collect::<Vec<f64>>())
    })
}

/// A search ends elsewhere when a rounding differs, so another bake is not asked for: short searches from what is looked
/// up for a few lobes, at texels and between them, may not find much better taps.
fn check(table: &EmbeddedTable) -> Result<(), String> {
    let kernels = Kernels::new();
    let rows = FITTED_ROWS.start as f64..FITTED_ROWS.end as f64;
    let places: Vec<(f64, f64)> = (0..48)
        .map(|i| {
            // Additive recurrence of the plastic number (Roberts 2018), in steps of half a texel.
            let even = |step: f64, count: f64| (step * f64::from(i + 1)).fract() * count;
            let half_steps = |at: f64| (2.0 * at).round() / 2.0;
            let row = rows.start + even(0.754_877_666_246_692_8, rows.end - 1.0 - rows.start);
            (half_steps(row), half_steps(1.0 + even(0.569_840_290_998_053_2, (COLUMNS - 2) as f64)))
        })
        .collect();
    let values = table.values();
    let gains = |&(row, column): &(f64, f64)| {
        let level = level_of_row(row);
        let lobe = fit::lobe_at(&kernels, level, nov_of_column(column));
        looked_up(&values, row, column).map(|set| fit::gain(&lobe, level, &set))
    };
    let gains: Vec<[f64; 3]> = places.par_iter().map(gains).collect();
    let means = [0, 1, 2].map(|set| gains.iter().map(|gains| gains[set]).sum::<f64>() / gains.len() as f64);
    if means.iter().zip(LARGEST_GAINS).all(|(mean, largest)| *mean <= largest) {
        Ok(())
    } else {
        Err(format!("{}: searches gain {means:?} of the variance, {LARGEST_GAINS:?} are allowed", table.file))
    }
}

#[cfg(test)]
mod tests;
