//! Where to look for what a GGX lobe reflects of the environment: a few prefiltered taps in the plane of incidence.
//!
//! Prefiltered maps are made for a lobe seen along its axis. Seen from the side it is longer than wide and leans away
//! from the mirror direction; a few round taps, each with its own place and width, follow that. Irradiance, of which the
//! harmonics are at hand, stands for the wide skirt: its mean, and its parts of degree 1 and 2, each with a weight.
//!
//! `assets/taps.bin` is the bare texture: [`TILES`] tiles of [`COLUMNS`] x [`ROWS`] texels above one another, each with
//! NoV to the right from 0 to 1 and the level of the specular maps downward from 0 to 8, end points on texel centres. A
//! texel is four little-endian unorm16: places and spreads as x / 8 + 1/2, levels as an eighth, shares of taps as they
//! are, weights of irradiance's parts as x / 4 + 1/2. What the shares leave of 1 is the mean's. For one, two and three
//! taps in turn, k being their number, a texel each:
//!
//! | | |
//! |---|---|
//! | k times | place, level, spread of a tap, and its share for F0 = 1 |
//! | once | the weights of degree 1 and 2 for F0 = 1, and for 0.04 |
//! | once | the shares of the taps for F0 = 0.04 |

mod fit;
mod kernels;
mod lobe;
mod weights;

use super::table::{EmbeddedTable, unorm16};
use crate::scene::EnvironmentMaps;
use fit::Lobes;
use kernels::Kernels;
use lobe::{Lobe, PLACE_MAX, Tap};
use rayon::prelude::*;
use std::ops::Range;

/// Steps of NoV, of 0.05.
pub const COLUMNS: usize = 21;
/// Steps of a quarter of a level.
pub const ROWS: usize = 33;
/// Tiles of the table.
pub const TILES: usize = 12;

/// Above, taps mix with the mirror image, all to the same share, and are placed as at level 1.
const FITTED_ROWS: Range<usize> = 4..ROWS;
/// Where the tiles of one, two and three taps begin.
const FIRST_TILES: [usize; 3] = [0, 3, 7];
const CHANNELS: usize = 4;
const LAST_LEVEL: f64 = 8.0;
/// What [`check`] lets a search gain, in shares of the variance of what is seen. Smoothness costs that much in places.
const LARGEST_GAIN: f64 = 3e-3;

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

fn level_of_row(row: usize) -> f64 {
    0.25 * row as f64
}

/// The first column stands for views that graze: there is no lobe at 0 itself.
fn nov_of_column(column: usize) -> f64 {
    (column as f64 / (COLUMNS - 1) as f64).max(0.02)
}

/// Taps with their weights for F0 = 1 and 0.04: shares, and weights of irradiance's parts of degree 1 and 2.
#[derive(Debug, Clone, PartialEq)]
struct Shared {
    taps: Vec<Tap>,
    weights: [Vec<f64>; 2],
}

/// Fits all taps: `COLUMNS * ROWS * TILES` texels of four unorm16, row-major. Takes minutes.
pub fn bake() -> Vec<u16> {
    let kernels = Kernels::new();
    let lobes = Lobes::new(&kernels);
    let sets = [1, 2, 3].map(|count| lobes.fit(count));
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
        let smooth = |tap: &Tap| Tap { place: tap.place, level: level_of_row(row), spread: 0.0 };
        entry.taps = entry.taps.iter().map(smooth).collect();
    }
    entry
}

fn texel(tile: usize, sets: &[Shared; 3]) -> [f64; CHANNELS] {
    let set = FIRST_TILES.partition_point(|first| *first <= tile) - 1;
    let tile = tile - FIRST_TILES[set];
    let Shared { taps, weights: [metal, dielectric] } = &sets[set];
    let count = taps.len();
    let part = |weight: f64| weight / 4.0 + 0.5;
    if let Some(Tap { place, level, spread }) = taps.get(tile) {
        return [place / (2.0 * PLACE_MAX) + 0.5, level / LAST_LEVEL, spread / (2.0 * PLACE_MAX) + 0.5, metal[tile]];
    }
    if tile == count {
        return [metal[count], metal[count + 1], dielectric[count], dielectric[count + 1]].map(part);
    }
    std::array::from_fn(|k| if k < count { dielectric[k] } else { 0.0 })
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
    [1, 2, 3].map(|count| {
        let first = FIRST_TILES[count - 1];
        let texels: Vec<_> = (first..first + count).map(texel).collect();
        let parts = texel(first + count).map(|part| (part - 0.5) * 4.0);
        let metal = texels.iter().map(|texel| texel[3]).chain([parts[0], parts[1]]).collect();
        let dielectric = texel(first + count + 1).into_iter().take(count).chain([parts[2], parts[3]]).collect();
        Shared { taps: texels.into_iter().map(tap).collect(), weights: [metal, dielectric] }
    })
}

/// A search ends elsewhere when a rounding differs, so another bake is not asked for: no short search from the stored
/// taps of a few lobes may find much better ones.
fn check(table: &EmbeddedTable) -> Result<(), String> {
    let kernels = Kernels::new();
    let places: Vec<(usize, usize)> =
        FITTED_ROWS.step_by(4).flat_map(|row| (1..COLUMNS).step_by(3).map(move |column| (row, column))).collect();
    let values = table.values();
    let gains = places.par_iter().flat_map_iter(|&(row, column)| {
        let level = level_of_row(row);
        let lobe = Lobe::new(&kernels, EnvironmentMaps::perceptual_roughness_at(level), nov_of_column(column));
        stored(&values, row, column).map(|set| (row, column, set.taps.len(), fit::gain(&lobe, level, &set)))
    });
    let worst = gains.max_by(|a, b| a.3.total_cmp(&b.3));
    match worst {
        Some((row, column, count, gain)) if gain > LARGEST_GAIN => Err(format!(
            "{}: {count} taps in row {row}, column {column} leave an error that is {gain:.1e} of the variance too large",
            table.file
        )),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests;
