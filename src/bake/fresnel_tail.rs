//! The table of Lazanyi's Fresnel term: what it takes from the albedo of a metal's lobe.
//!
//! `assets/fresnel_tail.bin` has the layout of `assets/dfg.bin` with one channel: the lobe's integral with
//! F = v.h (1 - v.h)^6, times [`SCALE`].

use super::dfg::SIZE;
use super::table::{EmbeddedTable, unorm16};
use crate::reference::albedo::DfgIntegrator;
use crate::threads::*;

/// The term's maximum is (1/7) (6/7)^6 = 0.057, so 16 times it fills the range.
pub const SCALE: f64 = 16.0;

static EMBEDDED: &[u8; SIZE * SIZE * 2] = include_bytes!("../../assets/fresnel_tail.bin");

/// The table and its file.
pub const TABLE: EmbeddedTable = EmbeddedTable {
    file: "fresnel_tail.bin",
    width: SIZE,
    height: SIZE,
    channels: 1,
    bytes: EMBEDDED,
    bake,
    check: EmbeddedTable::is_what_a_bake_makes,
};

/// Integrates the table: `SIZE * SIZE` unorm16, row-major.
pub fn bake() -> Vec<u16> {
    (0..SIZE).into_par_iter().flat_map_iter(bake_row).collect()
}

fn bake_row(row: usize) -> impl Iterator<Item = u16> {
    let integrator = DfgIntegrator::default();
    let last = (SIZE - 1) as f64;
    let tail = move |column: usize| integrator.fresnel_tail(row as f64 / last, (column as f64 / last).powi(2));
    (0..SIZE).map(move |column| unorm16(SCALE * tail(column)))
}
