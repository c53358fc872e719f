//! From lights to clusters.
//!
//! A sphere shrinks as it is cut: to the circle in which it meets a slice, and that to what of it is in a row (Persson
//! and Olsson 2013, "Practical Clustered Deferred and Forward Shading").

use super::grid::{Cut, Grid};
use super::reach::{Cone, ReachInView, Stretch};
use glam::Vec3;
use std::ops::Range;

/// Neighbouring clusters of a row that a light reaches.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Span {
    pub(super) cluster: u32,
    pub(super) length: u32,
    pub(super) light: u32,
}

/// The clusters of every light, in the order of the lights.
#[derive(Debug)]
pub(super) struct Spans {
    pub(super) spans: Vec<Span>,
    /// How many lights each cluster has.
    pub(super) counts: Vec<u32>,
    pub(super) entries: usize,
}

/// `None` when there are more entries than `most`.
pub(super) fn spans(grid: &Grid, lights: &[(u32, ReachInView)], most: usize) -> Option<Spans> {
    let counts = vec![0; grid.resolution.clusters()];
    let mut spans = Spans { spans: Vec::with_capacity(16 * lights.len()), counts, entries: 0 };
    for (light, reach) in lights {
        for slice in grid.slice(reach.nearest_m())..=grid.slice(reach.farthest_m()) {
            match &reach.cone {
                None => spans.push_sphere(grid, *light, slice, reach),
                Some(cone) => spans.push_cone(grid, *light, slice, reach, cone),
            }
        }
        if spans.entries > most {
            return None;
        }
    }
    Some(spans)
}

impl Spans {
    fn push(&mut self, grid: &Grid, light: u32, (slice, row): (usize, usize), columns: Range<usize>) {
        if columns.is_empty() {
            return;
        }
        let (width, height) = (grid.resolution.columns as usize, grid.resolution.rows as usize);
        let first = (slice * height + row) * width + columns.start;
        self.counts[first..first + columns.len()].iter_mut().for_each(|count| *count += 1);
        self.entries += columns.len();
        self.spans.push(Span { cluster: first as u32, length: columns.len() as u32, light });
    }

    fn push_sphere(&mut self, grid: &Grid, light: u32, slice: usize, reach: &ReachInView) {
        let ball = Ball { center: reach.center, radius_m: reach.radius_m };
        let ball = ball.in_slice(grid.depths_m[slice], grid.depths_m[slice + 1]);
        for row in tiles(&grid.rows, ball.center.y, &ball) {
            let ball = ball.in_row(&grid.rows[row], &grid.rows[row + 1]);
            let columns = tiles(&grid.columns, ball.center.x, &ball);
            self.push(grid, light, (slice, row), columns);
        }
    }

    /// The same, with what of the cone is in a slice, and in a row of it.
    fn push_cone(&mut self, grid: &Grid, light: u32, slice: usize, reach: &ReachInView, cone: &Cone) {
        let (near_m, far_m) = (grid.depths_m[slice], grid.depths_m[slice + 1]);
        let whole = Ball { center: reach.center, radius_m: reach.radius_m }.in_slice(near_m, far_m);
        let smaller = |ball: Ball, stretch: Option<Stretch>| {
            let Some(stretch) = stretch else { return Some(ball) };
            let (center, radius_m) = cone.bounding_sphere(stretch)?;
            let part = Ball { center, radius_m }.in_slice(near_m, far_m);
            Some(if part.radius_m < ball.radius_m { part } else { ball })
        };
        let in_slice =
            cone.stretch().map(|stretch| cone.between(stretch, (Vec3::NEG_Z, -near_m), (Vec3::NEG_Z, -far_m)));
        let Some(ball) = smaller(whole, in_slice) else { return };
        for row in tiles(&grid.rows, ball.center.y, &ball) {
            let (below, above) = (&grid.rows[row], &grid.rows[row + 1]);
            let in_row = in_slice.map(|stretch| cone.between(stretch, below.across_y(), above.across_y()));
            let Some(ball) = smaller(ball, in_row) else { continue };
            let columns = tiles(&grid.columns, ball.center.x, &ball.in_row(below, above));
            self.push_met(grid, light, (slice, row), columns, cone);
        }
    }

    /// The first to the last column that the cone meets: what it meets is convex.
    fn push_met(&mut self, grid: &Grid, light: u32, (slice, row): (usize, usize), columns: Range<usize>, cone: &Cone) {
        let met = |column: &usize| {
            let parts = grid.bounding_spheres(*column, row, slice);
            parts.into_iter().any(|(center, radius_m)| !cone.misses(center, radius_m))
        };
        let Some(first) = columns.clone().find(met) else { return };
        let last = columns.rev().find(met).unwrap_or(first);
        self.push(grid, light, (slice, row), first..last + 1);
    }
}

/// What is left of a sphere between two cuts is in a sphere around the circle that the nearer of them cuts out.
#[derive(Debug, Clone, Copy)]
struct Ball {
    center: Vec3,
    radius_m: f32,
}

impl Ball {
    fn in_slice(self, near_m: f32, far_m: f32) -> Self {
        let depth_m = -self.center.z;
        let nearest_m = depth_m.max(near_m).min(far_m);
        let center = Vec3 { z: -nearest_m, ..self.center };
        Self { center, radius_m: cut_radius_m(self.radius_m, nearest_m - depth_m) }
    }

    fn in_row(self, below: &Cut, above: &Cut) -> Self {
        let Vec3 { y, z, .. } = self.center;
        let (under_m, over_m) = (below.distance_m(y, z), above.distance_m(y, z));
        let (cut, distance_m) = match (under_m < 0.0, over_m > 0.0) {
            (true, _) => (below, under_m),
            (_, true) => (above, over_m),
            _ => return self,
        };
        let (across, toward_viewer) = cut.normal();
        let center = Vec3 { y: y - distance_m * across, z: z - distance_m * toward_viewer, ..self.center };
        Self { center, radius_m: cut_radius_m(self.radius_m, distance_m) }
    }
}

/// Radius of the circle that a plane at a distance cuts out of a sphere.
fn cut_radius_m(radius_m: f32, distance_m: f32) -> f32 {
    (radius_m * radius_m - distance_m * distance_m).max(0.0).sqrt()
}

/// The tiles between `cuts` that a ball reaches; `across_m` is its place along the axis that is cut.
///
/// Planes through the eye: a ball that is wholly to the right of one is to the right of all that are left of it, as far
/// as they are in front of the eye, and no more is needed.
fn tiles(cuts: &[Cut], across_m: f32, ball: &Ball) -> Range<usize> {
    let distance_m = |cut: &Cut| cut.distance_m(across_m, ball.center.z);
    let first = cuts[1..].partition_point(|cut| distance_m(cut) >= ball.radius_m);
    let end = cuts[..cuts.len() - 1].partition_point(|cut| distance_m(cut) > -ball.radius_m);
    first..end.max(first)
}
