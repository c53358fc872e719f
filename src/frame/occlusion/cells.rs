//! The picture in coarse cells: how far away what fills them is at most.
//!
//! Depths are those of our own clip space, z / w: larger is nearer, 0 is nowhere.

use glam::{DVec2, UVec2};
use std::ops::RangeInclusive;

/// Cells are squares of at least this many pixels, and few enough to be looked through quickly.
const LEAST_PX: u32 = 8;
const MOST_CELLS: u32 = 128;

/// Cells from the top left, row by row, and ever coarser levels below of which each has the least of four.
#[derive(Debug, Default)]
pub(super) struct Cells {
    pub(super) side_px: f64,
    pub(super) size: UVec2,
    /// The levels one behind the other, the finest first.
    depths: Vec<f32>,
    /// Where each begins, and its size.
    levels: Vec<(usize, UVec2)>,
}

impl Cells {
    /// Makes all cells of a picture empty.
    pub(super) fn clear(&mut self, size_px: UVec2) {
        let side_px = LEAST_PX.max(size_px.max_element().div_ceil(MOST_CELLS));
        self.side_px = f64::from(side_px);
        self.size = size_px.map(|px| px.div_ceil(side_px)).max(UVec2::ONE);
        self.levels.clear();
        let (mut start, mut size) = (0, self.size);
        loop {
            self.levels.push((start, size));
            start += size.element_product() as usize;
            if size == UVec2::ONE {
                break;
            }
            size = size.map(|side| side.div_ceil(2));
        }
        self.depths.clear();
        self.depths.resize(start, 0.0);
    }

    /// Whatever fills this cell is no farther than `depth`.
    pub(super) fn fill(&mut self, cell: usize, depth: f32) {
        self.depths[cell] = self.depths[cell].max(depth);
    }

    /// Makes the coarser levels, once the finest is filled.
    pub(super) fn finish(&mut self) {
        for pair in self.levels.windows(2) {
            let [(above, from), (start, to)] = [pair[0], pair[1]];
            let (finer, coarser) = self.depths.split_at_mut(start);
            for y in 0..to.y {
                for x in 0..to.x {
                    let last = from - 1;
                    let at = |dx: u32, dy: u32| {
                        let (x, y) = ((2 * x + dx).min(last.x), (2 * y + dy).min(last.y));
                        finer[above + (y * from.x + x) as usize]
                    };
                    let least = at(0, 0).min(at(1, 0)).min(at(0, 1)).min(at(1, 1));
                    coarser[(y * to.x + x) as usize] = least;
                }
            }
        }
    }

    /// The cells that a part of the picture touches, px from the top left; `None` if it is beside the picture.
    pub(super) fn touched(&self, low: DVec2, high: DVec2) -> Option<[RangeInclusive<u32>; 2]> {
        let range = |axis: usize| {
            let (low, high) = (low[axis] / self.side_px, high[axis] / self.side_px);
            let last = self.size[axis] - 1;
            let is_in = high >= 0.0 && low < f64::from(last) + 1.0;
            // A cast ends at the borders.
            is_in.then(|| (low.max(0.0) as u32)..=(high as u32).min(last))
        };
        Some([range(0)?, range(1)?])
    }

    /// What fills all of the cells that a part of the picture touches is no farther than this. Looks at a few cells of a
    /// level on which they are few.
    pub(super) fn farthest(&self, [columns, rows]: [RangeInclusive<u32>; 2]) -> f32 {
        let span = (columns.end() - columns.start()).max(rows.end() - rows.start());
        let level = (32 - (span >> 2).leading_zeros()).min(self.levels.len() as u32 - 1);
        let (start, size) = self.levels[level as usize];
        let mut least = f32::INFINITY;
        for y in rows.start() >> level..=rows.end() >> level {
            let row = start + (y * size.x) as usize;
            for x in columns.start() >> level..=columns.end() >> level {
                least = least.min(self.depths[row + x as usize]);
            }
        }
        least
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_have_the_farthest_of_what_fills_a_part() {
        let mut cells = Cells::default();
        for size_px in [UVec2::new(1, 1), UVec2::new(200, 72), UVec2::new(1921, 1080), UVec2::new(5, 4000)] {
            cells.clear(size_px);
            let size = cells.size;
            assert!(size.max_element() <= MOST_CELLS && cells.side_px >= f64::from(LEAST_PX));
            let depth = |x: u32, y: u32| 1.0 + ((x * 7919 + y * 104_729) % 1009) as f32;
            (0..size.y).for_each(|y| (0..size.x).for_each(|x| cells.fill((y * size.x + x) as usize, depth(x, y))));
            cells.finish();
            for i in 0..300 {
                let corner = |k: u32| UVec2::new((i * 31 + k * 17) % size.x, (i * 13 + k * 29) % size.y);
                let (low, high) = (corner(0).min(corner(1)), corner(0).max(corner(1)));
                let exact = (low.y..=high.y).flat_map(|y| (low.x..=high.x).map(move |x| depth(x, y)));
                let exact = exact.fold(f32::INFINITY, f32::min);
                let found = cells.farthest([low.x..=high.x, low.y..=high.y]);
                assert!(found <= exact, "{size}: {low} to {high}");
                let is_small = (high - low).max_element() < 4;
                assert!(!is_small || found == exact, "{size}: {low} to {high}");
            }
        }
    }

    #[test]
    fn what_is_beside_the_picture_touches_nothing() {
        let mut cells = Cells::default();
        cells.clear(UVec2::new(100, 50));
        let touched = |x: [f64; 2], y: [f64; 2]| cells.touched(DVec2::new(x[0], y[0]), DVec2::new(x[1], y[1]));
        assert_eq!(touched([-1e300, 1e300], [-1e300, 1e300]), Some([0..=12, 0..=6]));
        assert_eq!(touched([7.9, 8.0], [40.0, 49.0]), Some([0..=1, 5..=6]));
        assert_eq!(touched([-5.0, -0.1], [0.0, 1.0]), None);
        assert_eq!(touched([104.0, 105.0], [0.0, 1.0]), None);
        assert_eq!(touched([f64::NAN, f64::NAN], [0.0, 1.0]), None);
    }
}
