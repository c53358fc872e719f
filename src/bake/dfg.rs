//! The split-sum table of the GGX lobe, as it is embedded in the library.
//!
//! `assets/dfg.bin` is the bare texture: [`SIZE`] x [`SIZE`] texels, rows of ascending perceptual roughness, in each row
//! ascending sqrt(NoV), end points on texel centres: texel (i, j) holds NoV = (i / 127)^2 and perceptual roughness j / 127.
//! A texel is four little-endian unorm16: scale, bias, and their cosine-weighted averages, which depend on j alone.

use super::table::{EmbeddedTable, unorm16};
use crate::reference::albedo::DfgIntegrator;
use crate::threads::*;

/// Rows and columns of the table.
pub const SIZE: usize = 128;

const CHANNELS: usize = 4;

static EMBEDDED: &[u8; SIZE * SIZE * CHANNELS * 2] = include_bytes!("../../assets/dfg.bin");

/// The table and its file.
pub const TABLE: EmbeddedTable = EmbeddedTable {
    file: "dfg.bin",
    width: SIZE,
    height: SIZE,
    channels: CHANNELS,
    bytes: EMBEDDED,
    bake,
    check: EmbeddedTable::is_what_a_bake_makes,
};

/// Integrates the table: `SIZE * SIZE` texels of four unorm16, row-major.
pub fn bake() -> Vec<u16> {
    (0..SIZE).into_par_iter().flat_map_iter(bake_row).collect()
}

fn bake_row(row: usize) -> impl Iterator<Item = u16> {
    let integrator = DfgIntegrator::default();
    let last = (SIZE - 1) as f64;
    let perceptual_roughness = row as f64 / last;
    let average = integrator.dfg_average(perceptual_roughness);
    (0..SIZE).flat_map(move |column| {
        let dfg = integrator.dfg(perceptual_roughness, (column as f64 / last).powi(2));
        [dfg.scale, dfg.bias, average.scale, average.bias].map(unorm16)
    })
}

#[cfg(test)]
mod tests {
    #![expect(non_snake_case, reason = "equations keep the symbols of their papers")]
    use super::*;

    /// What a bilinear texture fetch returns, in float64.
    fn fetch(table: &[u16], perceptual_roughness: f64, NoV: f64, channel: usize) -> f64 {
        let last = (SIZE - 1) as f64;
        let (x, y) = (NoV.sqrt() * last, perceptual_roughness * last);
        let (i, j) = ((x as usize).min(SIZE - 2), (y as usize).min(SIZE - 2));
        let texel = |i: usize, j: usize| f64::from(table[(j * SIZE + i) * CHANNELS + channel]) / f64::from(u16::MAX);
        let (fx, fy) = (x - i as f64, y - j as f64);
        let row = |j: usize| texel(i, j) * (1.0 - fx) + texel(i + 1, j) * fx;
        row(j) * (1.0 - fy) + row(j + 1) * fy
    }

    #[test]
    fn bilinear_lookup_follows_the_quadrature() {
        let (table, integrator) = (TABLE.values(), DfgIntegrator::default());
        let (mut worst, mut square_sum, count): (f64, f64, u32) = (0.0, 0.0, 4000);
        for i in 0..count {
            // Additive recurrence of the plastic number (Roberts 2018): even cover of both arguments.
            let r = 0.045 + 0.955 * (0.754_877_666_246_692_8 * f64::from(i)).fract();
            let t = (0.569_840_290_998_053_2 * f64::from(i)).fract();
            // A quarter of the points even in log(NoV): grazing angles matter.
            let NoV = if i % 4 == 0 { 0.01_f64.powf(1.0 - t) } else { 0.01 + 0.99 * t };
            let dfg = integrator.dfg(r, NoV);
            for (channel, expected) in [(0, dfg.scale), (1, dfg.bias)] {
                let error = fetch(&table, r, NoV, channel) - expected;
                worst = worst.max(error.abs());
                square_sum += 0.5 * error * error;
            }
        }
        let rms = (square_sum / f64::from(count)).sqrt();
        // Measured RMS 3.6e-5, worst 1.1e-3 (at grazing angles of smooth surfaces); margin 1.25.
        assert!(rms < 4.5e-5 && worst < 1.4e-3, "RMS {rms:e}, worst {worst:e}");
    }
}
