//! Which cells of the picture one surface fills, proven: wherever in them a sample is, and however a rasteriser rounds.
//!
//! Take the triangles that face the eye. How many of them lie over a point of the picture, those that rounding has turned
//! over counted as -1, is the same on both sides of an edge that two of them share, and changes only where an edge is
//! that of one. So a cell is filled if its middle is, and no such edge passes through it.

use super::cells::Cells;
use super::occluders::{Edge, Occluder};
use glam::{DMat4, DVec2, DVec3, DVec4, UVec2};
use std::ops::RangeInclusive;

/// How far rounding may move a point of a surface in the picture, px: half of it what a rasteriser may do by the Vulkan
/// specification, twice over, and half the arithmetic before it, which is checked.
pub(super) const MOVED_PX: f64 = 0.25;

/// Vertices farther than this from the middle, in halves of the picture, are too far for what clipping rounds.
const FAR_NDC: f64 = 64.0;

/// What a depth may be off, of its triangle's largest and of what it changes by over the picture: 16 steps of f32.
const DEPTH_ROUNDING: f64 = 16.0 * f32::EPSILON as f64;

/// A surface at one of its places.
#[derive(Debug)]
pub(super) struct Placed<'a> {
    pub(super) occluder: &'a Occluder,
    pub(super) clip_from_object: DMat4,
    pub(super) size_px: UVec2,
    /// What the clip coordinates of its vertices may be off.
    pub(super) error: DVec4,
    /// 1 if its triangles turn counterclockwise to whom they face, -1 if a mirror is on the way.
    pub(super) handedness: f64,
}

/// A vertex in the picture: px from the top left, and depth.
#[derive(Debug, Clone, Copy)]
struct Vertex {
    px: DVec2,
    depth: f64,
    w: f64,
}

/// What is known of a cell while one surface is drawn.
#[derive(Debug, Clone, Copy)]
struct Cell {
    has_middle: bool,
    has_edge: bool,
    farthest: f32,
}

impl Cell {
    const EMPTY: Self = Self { has_middle: false, has_edge: false, farthest: f32::INFINITY };
}

/// Draws surfaces into cells, one after the other.
#[derive(Debug, Default)]
pub(super) struct Raster {
    cells: Vec<Cell>,
    touched: Vec<u32>,
    vertices: Vec<Option<Vertex>>,
    facing: Vec<bool>,
}

impl Raster {
    /// Fills the cells that a surface fills.
    pub(super) fn draw(&mut self, placed: &Placed<'_>, cells: &mut Cells) {
        self.cells.resize(cells.size.element_product() as usize, Cell::EMPTY);
        let occluder = placed.occluder;
        self.vertices.clear();
        self.vertices.extend(occluder.positions.iter().map(|position| placed.vertex(position.as_dvec3())));
        let backs = if occluder.double_sided { &[1.0, -1.0][..] } else { &[1.0] };
        for side in backs {
            self.draw_side(placed, side * placed.handedness, cells);
        }
    }

    /// The triangles that turn counterclockwise in the picture, or clockwise for a negative `sign`.
    fn draw_side(&mut self, placed: &Placed<'_>, sign: f64, cells: &mut Cells) {
        let Placed { occluder, error, .. } = placed;
        self.facing.clear();
        for corners in &occluder.triangles {
            let triangle = self.triangle(corners).filter(|[a, b, c]| sign * (b.px - a.px).perp_dot(c.px - a.px) < 0.0);
            self.facing.push(triangle.is_some());
            if let Some(triangle) = triangle {
                self.draw_triangle(&triangle, *error, cells);
            }
        }
        for &Edge { ends, triangle, neighbour } in &occluder.edges {
            let faces = |triangle: u32| self.facing[triangle as usize];
            if faces(triangle) != neighbour.is_some_and(faces)
                && let [Some(a), Some(b)] = ends.map(|end| self.vertices[end as usize])
            {
                self.draw_edge(a.px, b.px, cells);
            }
        }
        for cell in self.touched.drain(..) {
            let found = std::mem::replace(&mut self.cells[cell as usize], Cell::EMPTY);
            if found.has_middle && !found.has_edge {
                cells.fill(cell as usize, found.farthest);
            }
        }
    }

    fn triangle(&self, corners: &[u32; 3]) -> Option<[Vertex; 3]> {
        let [a, b, c] = corners.map(|corner| self.vertices[corner as usize]);
        Some([a?, b?, c?])
    }

    fn draw_triangle(&mut self, triangle: &[Vertex; 3], error: DVec4, cells: &Cells) {
        let px = triangle.map(|vertex| vertex.px);
        let (low, high) = (px[0].min(px[1]).min(px[2]) - MOVED_PX, px[0].max(px[1]).max(px[2]) + MOVED_PX);
        let Some([columns, rows]) = cells.touched(low, high) else { return };
        let depth = Depth::of(triangle, error, cells);
        // Positive inside, whichever way the triangle turns.
        let area = (px[1] - px[0]).perp_dot(px[2] - px[0]);
        let sides = [0, 1, 2].map(|i| {
            let (from, along) = (px[i], px[(i + 1) % 3] - px[i]);
            let inward = along.perp() * area.signum();
            (inward, -inward.dot(from))
        });
        let reach = 0.5 * cells.side_px + MOVED_PX;
        for y in rows {
            for x in columns.clone() {
                let middle = (DVec2::new(f64::from(x), f64::from(y)) + 0.5) * cells.side_px;
                let heights = sides.map(|(inward, offset)| (inward.dot(middle) + offset, inward.abs().element_sum()));
                if heights.iter().any(|(height, slope)| height + slope * reach < 0.0) {
                    continue;
                }
                let has_middle = heights.iter().all(|(height, _)| *height >= 0.0);
                let cell = self.touch(x, y, cells);
                cell.has_middle |= has_middle;
                cell.farthest = cell.farthest.min(depth.farthest(middle, reach));
            }
        }
    }

    /// Marks the cells that an edge passes through.
    fn draw_edge(&mut self, a: DVec2, b: DVec2, cells: &Cells) {
        let (upper, lower) = if a.y <= b.y { (a, b) } else { (b, a) };
        let Some([_, rows]) = cells.touched(a.min(b) - MOVED_PX, a.max(b) + MOVED_PX) else { return };
        for y in rows {
            let [top, bottom] = [f64::from(y), f64::from(y + 1)].map(|row| row * cells.side_px);
            // Where it enters and leaves the row; all of it where it runs along.
            let at = |line: f64| {
                let fraction = (line - upper.y) / (lower.y - upper.y);
                upper.x + (lower.x - upper.x) * if fraction.is_finite() { fraction.clamp(0.0, 1.0) } else { 0.0 }
            };
            let is_level = lower.y - upper.y < 2.0 * MOVED_PX;
            let [from, to] = if is_level { [upper.x, lower.x] } else { [at(top - MOVED_PX), at(bottom + MOVED_PX)] };
            let (left, right) = (from.min(to) - MOVED_PX, from.max(to) + MOVED_PX);
            let line = DVec2::new(left, top + 0.5 * cells.side_px)..=DVec2::new(right, top + 0.5 * cells.side_px);
            if let Some([columns, _]) = cells.touched(*line.start(), *line.end()) {
                self.mark(columns, y, cells);
            }
        }
    }

    fn mark(&mut self, columns: RangeInclusive<u32>, y: u32, cells: &Cells) {
        for x in columns {
            self.touch(x, y, cells).has_edge = true;
        }
    }

    fn touch(&mut self, x: u32, y: u32, cells: &Cells) -> &mut Cell {
        let index = y * cells.size.x + x;
        let cell = &mut self.cells[index as usize];
        if !cell.has_edge && cell.farthest == f32::INFINITY {
            self.touched.push(index);
        }
        cell
    }
}

impl Placed<'_> {
    /// `None` where a vertex is clipped, or so far away that its neighbours are.
    fn vertex(&self, position: DVec3) -> Option<Vertex> {
        let clip = self.clip_from_object * position.extend(1.0);
        let is_clipped = clip.w <= 0.0 || clip.z < self.error.z || clip.z > clip.w - self.error.z - self.error.w;
        let is_far = clip.x.abs().max(clip.y.abs()) > FAR_NDC * clip.w;
        // Half the allowance is the rasteriser's.
        let error_ndc = (self.error.truncate().truncate() + self.error.w) / clip.w;
        let is_exact = (0.5 * error_ndc * self.size_px.as_dvec2()).cmple(DVec2::splat(0.5 * MOVED_PX)).all();
        let ndc = clip.truncate() / clip.w;
        let px = 0.5 * (DVec2::new(ndc.x, -ndc.y) + 1.0) * self.size_px.as_dvec2();
        (!is_clipped && !is_far && is_exact).then_some(Vertex { px, depth: ndc.z, w: clip.w })
    }
}

/// The depth of a triangle, which is linear in the picture.
#[derive(Debug)]
struct Depth {
    least: f64,
    at: DVec2,
    depth: f64,
    slope: DVec2,
    error: f64,
}

impl Depth {
    fn of([a, b, c]: &[Vertex; 3], error: DVec4, cells: &Cells) -> Self {
        let (ab, ac) = (b.px - a.px, c.px - a.px);
        let (db, dc) = (b.depth - a.depth, c.depth - a.depth);
        let area = ab.perp_dot(ac);
        let slope = DVec2::new(db * ac.y - dc * ab.y, dc * ab.x - db * ac.x) / area;
        let (least, most) = (a.depth.min(b.depth).min(c.depth), a.depth.max(b.depth).max(c.depth));
        let nearest_w = a.w.min(b.w).min(c.w);
        let over_picture = slope.abs().dot(cells.size.as_dvec2() * cells.side_px);
        let error = (error.z + most * error.w) / nearest_w + DEPTH_ROUNDING * (most + over_picture);
        Self { least, at: a.px, depth: a.depth, slope, error }
    }

    /// Of the part of the triangle that is within `reach` px of `middle` on both axes.
    fn farthest(&self, middle: DVec2, reach: f64) -> f32 {
        let farthest = self.depth + self.slope.dot(middle - self.at) - self.slope.abs().element_sum() * reach;
        let depth = farthest.max(self.least) - self.error;
        // Not a number where the triangle has no area in the picture.
        if depth > 0.0 { (depth as f32).next_down() } else { 0.0 }
    }
}
