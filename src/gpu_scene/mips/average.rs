//! Averages of texels: one level of the one above.

use super::texels::{Encoder, Linear};
use super::{Bytes, Level};
use crate::threads::*;
use glam::Vec4;

/// The source texels that one destination texel covers along an axis, with their weights (which sum to 1).
fn coverage(source: u32, target: u32, index: u32) -> impl Iterator<Item = (usize, f32)> + Clone {
    let ratio = f64::from(source) / f64::from(target);
    let (start, end) = (f64::from(index) * ratio, (f64::from(index) + 1.0) * ratio);
    let texels = start as u32..(end.ceil() as u32).min(source);
    texels.filter_map(move |texel| {
        let overlap = end.min(f64::from(texel) + 1.0) - start.max(f64::from(texel));
        (overlap > 1e-9).then_some((texel as usize, (overlap / ratio) as f32))
    })
}

/// Averages the `texels` of a level of `width` x `height` to one of `w` x `h`.
pub(super) fn halve(texels: &(impl Linear + ?Sized), (width, height): (u32, u32), (w, h): (u32, u32)) -> Vec<Vec4> {
    let mut out = vec![Vec4::ZERO; w as usize * h as usize];
    let is_even = width == 2 * w && height == 2 * h;
    out.par_chunks_exact_mut(w as usize).zip(0..h).for_each(|(row, y)| {
        if is_even {
            halve_row(texels, 2 * y as usize * width as usize, width as usize, row);
            return;
        }
        let rows: Vec<(usize, f32)> = coverage(height, h, y).collect();
        for (x, sum) in row.iter_mut().enumerate() {
            for (column, weight_x) in coverage(width, w, x as u32) {
                for &(line, weight_y) in &rows {
                    *sum += texels.texel(line * width as usize + column) * (weight_x * weight_y);
                }
            }
        }
    });
    out
}

/// Averages two lines of `line` texels, the upper of which begins at `top`.
fn halve_row(texels: &(impl Linear + ?Sized), top: usize, line: usize, row: &mut [Vec4]) {
    for (x, sum) in row.iter_mut().enumerate() {
        let corner = top + 2 * x;
        let upper = texels.texel(corner) + texels.texel(corner + line);
        *sum = (upper + texels.texel(corner + 1) + texels.texel(corner + line + 1)) * 0.25;
    }
}

/// The levels as far as all sides are even, made band by band: the floats of a band stay in a core's cache, and those of
/// no level are held as a whole but of the last.
#[derive(Debug)]
pub(super) struct Bands {
    size: (u32, u32),
    steps: u32,
}

impl Bands {
    /// Bands of more than 2^5 lines make no level of any size.
    const STEPS: u32 = 5;

    /// Below a level of `size`.
    pub(super) fn of(size: (u32, u32)) -> Self {
        Self { size, steps: size.0.trailing_zeros().min(size.1.trailing_zeros()).min(Self::STEPS) }
    }

    /// The size after `step` halvings.
    fn size(&self, step: u32) -> (u32, u32) {
        (self.size.0 >> step, self.size.1 >> step)
    }

    /// The size of the smallest level.
    pub(super) fn last(&self) -> (u32, u32) {
        self.size(self.steps)
    }

    /// The levels that fit, and the texels of the last level. None if there is no band.
    pub(super) fn average(
        &self,
        texels: &impl Linear,
        encoder: &Encoder,
        fits: impl Fn((u32, u32)) -> bool,
    ) -> (Vec<Level>, Vec<Vec4>) {
        if self.steps == 0 {
            return Default::default();
        }
        let count = |step: u32| self.size(step).0 as usize * self.size(step).1 as usize;
        let bytes = |step: u32| if fits(self.size(step)) { count(step) * encoder.texel_bytes() } else { 0 };
        let mut levels: Vec<_> = (1..=self.steps).map(|step| (self.size(step), vec![0_u8; bytes(step)])).collect();
        let mut last = vec![Vec4::ZERO; count(self.steps)];
        let lines = self.last().1 as usize;
        let mut bands: Vec<Vec<&mut [u8]>> = std::iter::repeat_with(Vec::new).take(lines).collect();
        for (_, level) in &mut levels {
            let share = level.len() / lines;
            let mut rest = level.as_mut_slice();
            for band in &mut bands {
                let (part, after) = rest.split_at_mut(share);
                band.push(part);
                rest = after;
            }
        }
        last.par_chunks_exact_mut(self.last().0 as usize).zip(bands).enumerate().for_each_init(
            || [Vec::new(), Vec::new()],
            |scratch, (band, (last, outs))| self.band(texels, encoder, band, (scratch, last), outs),
        );
        let levels = levels.into_iter().filter(|(_, bytes)| !bytes.is_empty());
        let level = |((width, height), bytes)| Level { width, height, bytes: Bytes::Own(bytes) };
        (levels.map(level).collect(), last)
    }

    /// One band of all levels.
    fn band(
        &self,
        texels: &impl Linear,
        encoder: &Encoder,
        band: usize,
        ([above, below], last): (&mut [Vec<Vec4>; 2], &mut [Vec4]),
        outs: Vec<&mut [u8]>,
    ) {
        for (step, out) in (1..).zip(outs) {
            let (line, width) = (self.size(step - 1).0 as usize, self.size(step).0 as usize);
            let lines = 1_usize << (self.steps - step);
            below.resize(width * lines, Vec4::ZERO);
            for (y, row) in below.chunks_exact_mut(width).enumerate() {
                if step == 1 {
                    halve_row(texels, 2 * (band * lines + y) * line, line, row);
                } else {
                    halve_row(above.as_slice(), 2 * y * line, line, row);
                }
            }
            if !out.is_empty() {
                encoder.encode(below.as_slice(), 0, out);
            }
            std::mem::swap(above, below);
        }
        last.copy_from_slice(above);
    }
}
