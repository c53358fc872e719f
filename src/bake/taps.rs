//! Where to look for what a GGX lobe reflects of the environment: a few prefiltered taps in the plane of incidence.
//!
//! Prefiltered maps are made for a lobe seen along its axis. Seen from the side it is longer than wide and leans away
//! from the mirror direction; a few round taps, each with its own place and width, follow that.
//!
//! `assets/taps.bin` is the bare texture: [`TILES`] tiles of [`SIDE`] x [`SIDE`] texels above one another, each with NoV
//! to the right and perceptual roughness downward from 0 to 1, end points on texel centres. A texel is four
//! little-endian unorm16: offsets o over alpha as o / 16 + 1/2, widths over alpha as an eighth, shares as they are.
//!
//! | tile | |
//! |---|---|
//! | 0 | two taps: both offsets, both widths |
//! | 1 | share of the first of two for F0 = 1 and 0.04; offset and width of one tap |
//! | 2 | three taps: their offsets, share of the first for F0 = 1 |
//! | 3 | their widths, share of the second for F0 = 1 |
//! | 4 | shares of the first and second for F0 = 0.04 |

mod fit;

use super::table::{EmbeddedTable, unorm16};
use fit::{FIT_1, FIT_2, FIT_3, NOV, PERCEPTUAL_ROUGHNESS, Tap};

/// Columns and rows of a tile: steps of 0.05, so that the rows of the fit are met.
pub const SIDE: usize = 21;
/// Tiles of the table.
pub const TILES: usize = 5;

const CHANNELS: usize = 4;

static EMBEDDED: &[u8; SIDE * SIDE * TILES * CHANNELS * 2] = include_bytes!("../../assets/taps.bin");

/// The table and its file.
pub const TABLE: EmbeddedTable =
    EmbeddedTable { file: "taps.bin", width: SIDE, height: SIDE * TILES, channels: CHANNELS, bytes: EMBEDDED, bake };

/// Resamples the fit: `SIDE * SIDE * TILES` texels of four unorm16, row-major.
pub fn bake() -> Vec<u16> {
    let cosine = |i: usize| i as f64 / (SIDE - 1) as f64;
    let texel = |tile: usize, row: usize, column: usize| texel(tile, cosine(row), cosine(column)).map(unorm16);
    let row = |y: usize| (0..SIDE).flat_map(move |column| texel(y / SIDE, y % SIDE, column));
    (0..SIDE * TILES).flat_map(row).collect()
}

fn texel(tile: usize, perceptual_roughness: f64, cosine: f64) -> [f64; CHANNELS] {
    let at = |offset: f64| offset / 16.0 + 0.5;
    let wide = |width: f64| width / 8.0;
    let [one] = taps(&FIT_1, perceptual_roughness, cosine);
    let [near, far] = taps(&FIT_2, perceptual_roughness, cosine);
    let [first, second, third] = taps(&FIT_3, perceptual_roughness, cosine);
    match tile {
        0 => [at(near.offset), at(far.offset), wide(near.width), wide(far.width)],
        1 => [near.share_metal, near.share_dielectric, at(one.offset), wide(one.width)],
        2 => [at(first.offset), at(second.offset), at(third.offset), first.share_metal],
        3 => [wide(first.width), wide(second.width), wide(third.width), second.share_metal],
        _ => [first.share_dielectric, second.share_dielectric, 0.0, 0.0],
    }
}

/// The fit between its nodes, and beyond them as at the nearest. Seen from above the lobe has no plane of incidence, so
/// the offsets end there, lest the direction of a plane be seen that does not exist.
fn taps<const K: usize>(
    fit: &[[[Tap; K]; NOV.len()]; PERCEPTUAL_ROUGHNESS.len()],
    perceptual_roughness: f64,
    cosine: f64,
) -> [Tap; K] {
    let (row, down) = node(&PERCEPTUAL_ROUGHNESS, perceptual_roughness);
    let (column, right) = node(&NOV, cosine);
    let facing = ((1.0 - cosine) / (1.0 - NOV[NOV.len() - 1])).min(1.0);
    std::array::from_fn(|k| {
        let mixed = |value: fn(&Tap) -> f64| {
            let line = |row: usize| {
                let (left, next) = (value(&fit[row][column][k]), value(&fit[row][column + 1][k]));
                left + (next - left) * right
            };
            line(row) + (line(row + 1) - line(row)) * down
        };
        Tap {
            offset: mixed(|tap| tap.offset) * facing,
            width: mixed(|tap| tap.width),
            share_metal: mixed(|tap| tap.share_metal),
            share_dielectric: mixed(|tap| tap.share_dielectric),
        }
    })
}

/// The interval of `nodes` around `x`, and how far into it.
fn node(nodes: &[f64], x: f64) -> (usize, f64) {
    let interval = nodes.partition_point(|node| *node <= x).clamp(1, nodes.len() - 1) - 1;
    let (from, to) = (nodes[interval], nodes[interval + 1]);
    (interval, ((x - from) / (to - from)).clamp(0.0, 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_of_every_set_add_up_and_fit_the_table() {
        fn check<const K: usize>(fit: &[[[Tap; K]; NOV.len()]; PERCEPTUAL_ROUGHNESS.len()]) {
            for taps in fit.iter().flatten() {
                for share in [|tap: &Tap| tap.share_metal, |tap: &Tap| tap.share_dielectric] {
                    let sum: f64 = taps.iter().map(share).sum();
                    // Five digits are printed of each.
                    assert!((sum - 1.0).abs() < 2e-4, "{taps:?}");
                }
                assert!(taps.iter().all(|tap| tap.offset.abs() < 8.0 && (0.0..8.0).contains(&tap.width)), "{taps:?}");
            }
        }
        check(&FIT_1);
        check(&FIT_2);
        check(&FIT_3);
    }

    #[test]
    fn the_embedded_table_is_what_a_bake_writes() {
        assert_eq!(TABLE.worst_difference(), 0, "bake the table again");
    }

    #[test]
    fn nodes_are_met_and_offsets_end_where_the_view_is_straight() {
        assert_eq!(taps(&FIT_2, 0.6, 0.45), FIT_2[2][2]);
        assert_eq!(taps(&FIT_2, 0.1, 0.05), FIT_2[0][0]);
        assert!(taps(&FIT_3, 0.7, 1.0).iter().all(|tap| tap.offset == 0.0));
    }
}
