//! Which lights reach which part of the view: froxels, that is tiles of the picture cut into slices of depth, and for
//! each the lights that end in it (Olsson, Billeter and Assarsson 2012, "Clustered Deferred and Forward Shading").
//!
//! Light must not change by it: a light is left out of a cluster only where it sends exactly nothing.

mod assign;
mod grid;
mod reach;
#[cfg(test)]
mod tests;

pub use reach::Reach;

use crate::scene::{Camera, Projection};
use crate::shader::types::ClusterUniform;
use assign::{Spans, spans};
use glam::{DMat4, DVec3, UVec2};
use grid::{Grid, Resolution};
use reach::ReachInView;

/// Entries of all lists together beyond which the grid is made coarser: 8 MiB.
const MOST_ENTRIES: usize = 1 << 21;

/// The lights of every cluster of one view.
#[derive(Debug, Clone, PartialEq)]
pub struct Clusters {
    pub uniform: ClusterUniform,
    /// For each cluster where its list begins in this table, then where the last one ends, then the lists: indices of
    /// lights, ascending.
    pub table: Vec<u32>,
}

/// Sorts lights into the clusters of a view. `reaches` are relative to `origin_in_world`; the first of them has the index
/// `unbounded`, before which are the lights that reach everything.
pub fn clusters(
    reaches: &[Reach],
    unbounded: u32,
    origin_in_world: DVec3,
    camera: &Camera,
    size_px: UVec2,
) -> Clusters {
    let mut camera = camera.clone();
    camera.world_from_view.w_axis = (camera.position_in_world() - origin_in_world).extend(1.0);
    let view_from_world = camera.world_from_view.inverse();
    let nearest_m = match camera.projection {
        Projection::Perspective { .. } => camera.near_m,
        Projection::Orthographic { .. } => f64::NEG_INFINITY,
    };
    // Numbered before those behind the camera are left out.
    let seen: Vec<(u32, ReachInView)> = (unbounded..)
        .zip(reaches)
        .map(|(index, reach)| (index, reach.in_view(&view_from_world)))
        .filter(|(_, reach)| reach.farthest_m() >= nearest_m as f32)
        .collect();
    let mut resolution = Resolution::of(size_px);
    loop {
        let grid = Grid::new(&camera, size_px, resolution, seen.iter().map(|(_, reach)| reach));
        // One cluster holds every light once, however many there are.
        if let Some(spans) = spans(&grid, &seen, MOST_ENTRIES.max(seen.len())) {
            return Clusters {
                uniform: uniform(&grid, &camera, size_px, &view_from_world, unbounded),
                table: table(&grid, &spans),
            };
        }
        resolution = resolution.coarser();
    }
}

fn uniform(grid: &Grid, camera: &Camera, size_px: UVec2, view_from_world: &DMat4, unbounded: u32) -> ClusterUniform {
    let Resolution { columns, rows, slices } = grid.resolution;
    let clip_from_view = camera.clip_from_view(size_px).as_dmat4();
    // From [-w, w] to [0, count w], upward.
    let (half_columns, half_rows) = (0.5 * f64::from(columns), 0.5 * f64::from(rows));
    let tiles_from_clip = DMat4::from_cols_array(&[
        half_columns,
        0.0,
        0.0,
        0.0, //
        0.0,
        half_rows,
        0.0,
        0.0, //
        0.0,
        0.0,
        1.0,
        0.0, //
        half_columns,
        half_rows,
        0.0,
        1.0,
    ]);
    let [slice_per_octave, slice_per_clip_z, slice_bias] = grid.slice_from_clip(camera);
    ClusterUniform {
        tiles_from_world: (tiles_from_clip * clip_from_view * *view_from_world).as_mat4().to_cols_array_2d(),
        slice_per_octave,
        slice_per_clip_z,
        slice_bias,
        unbounded,
        columns,
        rows,
        slices,
        pad_0: 0,
    }
}

/// Lists in the order of the clusters, from lists in the order of the lights.
fn table(grid: &Grid, spans: &Spans) -> Vec<u32> {
    let clusters = grid.resolution.clusters();
    let mut table = Vec::with_capacity(clusters + 1 + spans.entries);
    let mut end = clusters as u32 + 1;
    for count in &spans.counts {
        table.push(end);
        end += count;
    }
    table.push(end);
    table.resize(clusters + 1 + spans.entries, 0);
    let mut next: Vec<u32> = table[..clusters].to_vec();
    for span in &spans.spans {
        let first = span.cluster as usize;
        for next in &mut next[first..first + span.length as usize] {
            table[*next as usize] = span.light;
            *next += 1;
        }
    }
    table
}
