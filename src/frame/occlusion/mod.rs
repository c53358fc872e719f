//! What is hidden behind other things: a coarse picture of how far away the nearest of them are, made for every view.
//!
//! On the CPU, and from this frame's view alone: it works in the first frame and in a host's pass, needs no readback, and
//! what it says is proven, so that the picture has the same bits. Taken for granted is only that no fragment is nearer than
//! the nearest corner of its triangle.

mod cells;
mod occluders;
mod raster;

use super::boxes::rounding;
use super::cull::{BORDER_PX, Frustum, spread};
use super::drawables::Drawables;
use cells::Cells;
use glam::{DMat4, DVec4, Vec3};
use raster::{Placed, Raster};

pub use occluders::Occluders;

/// A box that covers less of the picture than this hides too little to be drawn first.
const LEAST_SHARE: f32 = 1.0 / 64.0;

/// One triangle is drawn here for at least so many that may be spared.
const SPARED_PER_DRAWN: usize = 8;

/// What hides in a view, made anew for each. Keeps its memory.
#[derive(Debug, Default)]
pub(super) struct Occlusion {
    cells: Cells,
    raster: Raster,
    chosen: Vec<Candidate>,
    /// Whether anything hides.
    is_on: bool,
}

/// A placement that may hide others.
#[derive(Debug, Clone, Copy)]
struct Candidate {
    /// Of the picture.
    share: f32,
    /// As z / w.
    nearest: f32,
    drawable: usize,
    placement: usize,
}

impl Occlusion {
    /// Hides nothing.
    pub(super) fn clear(&mut self) {
        self.is_on = false;
    }

    /// Draws what may hide others in this view.
    pub(super) fn look(&mut self, drawables: &Drawables, frustum: &Frustum) {
        self.is_on = false;
        let mut spared = self.choose(drawables, frustum) / SPARED_PER_DRAWN;
        if self.chosen.is_empty() {
            return;
        }
        self.chosen.sort_unstable_by(|a, b| {
            let order = b.share.total_cmp(&a.share).then(b.nearest.total_cmp(&a.nearest));
            order.then(a.placement.cmp(&b.placement))
        });
        self.cells.clear(frustum.size_px);
        for &Candidate { drawable, placement, .. } in &self.chosen {
            let count = drawables.occluders.triangles(drawable);
            let Some(rest) = spared.checked_sub(count) else { continue };
            spared = rest;
            if let Some(placed) = placed(drawables, (drawable, placement), frustum) {
                self.raster.draw(&placed, &mut self.cells);
                self.is_on = true;
            }
        }
        self.cells.finish();
    }

    /// Lists what is large in the picture. Returns how many triangles are in it, hidden or not.
    fn choose(&mut self, drawables: &Drawables, frustum: &Frustum) -> usize {
        self.chosen.clear();
        let mut triangles = 0;
        for (index, drawable) in drawables.draws.iter().enumerate() {
            if frustum.is_outside(drawable.bounds) {
                continue;
            }
            triangles += drawable.placements.len() * drawables.occluders.triangles(index);
            if drawables.occluders.get(index).is_none() {
                continue;
            }
            let boxes = &drawables.placements.boxes;
            frustum.large(boxes, drawable.placements.clone(), LEAST_SHARE, |placement| {
                let Some(shadow) = frustum.shadow(boxes.get(placement)) else { return };
                let (share, nearest) = (shadow.share(frustum.size_px), shadow.nearest as f32);
                if share > LEAST_SHARE {
                    self.chosen.push(Candidate { share, nearest, drawable: index, placement });
                }
            });
        }
        triangles
    }

    /// Whether nothing in a box is seen, because something else is before it. Proven.
    pub(super) fn hides(&self, frustum: &Frustum, bounds: (Vec3, Vec3)) -> bool {
        if !self.is_on {
            return false;
        }
        let Some(shadow) = frustum.shadow(bounds) else { return false };
        let touched = self.cells.touched(shadow.low - BORDER_PX, shadow.high + BORDER_PX);
        touched.is_some_and(|touched| shadow.nearest < f64::from(self.cells.farthest(touched)))
    }
}

/// A drawable at one of its places, as the GPU puts it there.
fn placed<'a>(
    drawables: &'a Drawables,
    (drawable, placement): (usize, usize),
    frustum: &Frustum,
) -> Option<Placed<'a>> {
    let occluder = drawables.occluders.get(drawable)?;
    let (drawable, instance) = (&drawables.draws[drawable], drawables.placements.instances[placement] as usize);
    let world_from_object = drawables.instances[instance].instance.world_from_object;
    let origin_from_object = DMat4::from_translation(-drawables.origin_in_world) * world_from_object;
    let (center, half) = drawables.placements.boxes.get(placement);
    let reach = (center.abs() + half).as_dvec3().extend(1.0);
    let moved = rounding(&drawable.object, &origin_from_object);
    let clip = frustum.clip_from_origin;
    let error = DVec4::from_array([0, 1, 2, 3].map(|row| spread(clip.row(row), moved, reach)));
    let handedness = if drawable.mirrored { -1.0 } else { 1.0 };
    let clip_from_object = clip * origin_from_object;
    Some(Placed { occluder, clip_from_object, size_px: frustum.size_px, error, handedness })
}
