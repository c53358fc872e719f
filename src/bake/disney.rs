//! The directional albedos of the Disney lobes, as they are embedded in the library.
//!
//! `assets/disney.bin` is the bare texture: tiles of [`SIDE`] x [`SIDE`] texels above one another, each with
//! sqrt(NoV) to the right and a parameter of a lobe downward, end points on texel centres. A texel is four
//! little-endian unorm16.
//!
//! - Four tiles for each of 8 layers, over perceptual roughness; the logarithm of 1 - 0.9 anisotropic falls evenly to
//!   that of 0.1. The specular lobe's albedo is `F0 scale + bias`, and both are series in the view's azimuth: the root
//!   of the mean, then coefficients of the cosines of 2, 4, 6... times the azimuth, relative to the mean, from -1.5 to
//!   1.5. The first tile holds mean and three coefficients of `scale`, the second four more, the others those of `bias`.
//! - Tile 32: half the albedo of `Fd_Burley`, half of that of `Fd_Subsurface` and the root of that of the sheen, over
//!   perceptual roughness; the root of the clearcoat's albedo over its gloss.
//!
//! Roots, because the lobes fall to zero toward grazing angles quadratically in NoV.
#![expect(non_snake_case, reason = "equations keep the symbols of their papers")]

use super::table::{EmbeddedTable, unorm16};
use crate::reference::disney::albedo::DisneyAlbedo;
use crate::threads::*;
use std::f64::consts::PI;

/// Columns and rows of a tile.
pub const SIDE: usize = 32;
/// Tiles over the anisotropy.
pub const LAYERS: usize = 8;
/// Tiles of each layer.
pub const TILES_PER_LAYER: usize = 4;
/// Rows of the whole table.
pub const HEIGHT: usize = SIDE * (TILES_PER_LAYER * LAYERS + 1);

const CHANNELS: usize = 4;

static EMBEDDED: &[u8; SIDE * HEIGHT * CHANNELS * 2] = include_bytes!("../../assets/disney.bin");

/// The table and its file.
pub const TABLE: EmbeddedTable = EmbeddedTable {
    file: "disney.bin",
    width: SIDE,
    height: HEIGHT,
    channels: CHANNELS,
    bytes: EMBEDDED,
    bake,
    check: EmbeddedTable::is_what_a_bake_makes,
};

/// Integrates the table.
pub fn bake() -> Vec<u16> {
    (0..HEIGHT).into_par_iter().flat_map_iter(bake_row).collect()
}

fn bake_row(row: usize) -> Vec<u16> {
    let albedo = DisneyAlbedo::default();
    let last = (SIDE - 1) as f64;
    let parameter = (row % SIDE) as f64 / last;
    let texel = |column: usize| {
        let NoV = (column as f64 / last).powi(2).max(1e-7);
        let tile = row / SIDE;
        if tile == TILES_PER_LAYER * LAYERS {
            return smooth_texel(&albedo, parameter, NoV);
        }
        let series = specular_series(&albedo, parameter, tile / TILES_PER_LAYER, NoV);
        series[tile % TILES_PER_LAYER]
    };
    (0..SIDE).flat_map(|column| texel(column).map(unorm16)).collect()
}

/// The anisotropy of a layer.
fn anisotropic(layer: usize) -> f64 {
    ((1.0 - 0.1_f64.powf(layer as f64 / (LAYERS - 1) as f64)) / 0.9).clamp(0.0, 1.0)
}

/// The three texels of the specular lobe.
fn specular_series(
    albedo: &DisneyAlbedo,
    perceptual_roughness: f64,
    layer: usize,
    NoV: f64,
) -> [[f64; CHANNELS]; TILES_PER_LAYER] {
    const AZIMUTHS: usize = 8;
    // The lobe is even about tangent and bitangent, so eight azimuths of a quadrant tell eight cosines.
    let azimuths: [f64; AZIMUTHS] = std::array::from_fn(|i| (i as f64 + 0.5) * 0.5 * PI / AZIMUTHS as f64);
    let pairs = azimuths.map(|azimuth| albedo.specular(perceptual_roughness, anisotropic(layer), NoV, azimuth));
    let series = |values: [f64; AZIMUTHS]| {
        let mean = values.iter().sum::<f64>() / AZIMUTHS as f64;
        let coefficient = |order: usize| {
            let cosines = azimuths.iter().map(|azimuth| (2.0 * order as f64 * azimuth).cos());
            let sum: f64 = cosines.zip(values).map(|(cosine, value)| cosine * value).sum();
            0.5 + 2.0 * sum / (AZIMUTHS as f64 * mean.max(1e-12)) / 3.0
        };
        std::array::from_fn::<f64, AZIMUTHS, _>(|order| if order == 0 { mean.sqrt() } else { coefficient(order) })
    };
    let [scale, bias] = [series(pairs.map(|pair| pair.scale)), series(pairs.map(|pair| pair.bias))];
    let texels = |[a, b, c, d, e, f, g, h]: [f64; AZIMUTHS]| [[a, b, c, d], [e, f, g, h]];
    let ([first, second], [third, fourth]) = (texels(scale), texels(bias));
    [first, second, third, fourth]
}

fn smooth_texel(albedo: &DisneyAlbedo, parameter: f64, NoV: f64) -> [f64; CHANNELS] {
    let diffuse = albedo.diffuse(parameter, NoV);
    let clearcoat = albedo.clearcoat(parameter, NoV);
    [0.5 * diffuse.burley, 0.5 * diffuse.subsurface, diffuse.sheen.sqrt(), clearcoat.sqrt()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_embedded_table_is_what_a_bake_writes() {
        let table = TABLE.values();
        let width = SIDE * CHANNELS;
        // A sample; `specula bake --check` compares all.
        let rows: Vec<usize> = (0..HEIGHT).step_by(17).collect();
        let worst = rows.par_iter().map(|&row| {
            let baked = bake_row(row);
            baked.iter().zip(&table[row * width..]).map(|(a, b)| a.abs_diff(*b)).max()
        });
        let worst = worst.max().flatten();
        assert!(worst <= Some(1), "bake the table again: {worst:?} steps of difference");
    }
}
