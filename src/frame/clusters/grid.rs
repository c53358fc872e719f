//! The cuts between clusters, in view space.

use super::reach::ReachInView;
use crate::scene::{Camera, Projection};
use glam::{UVec2, Vec3};

/// Side of a tile, pixels, unless the picture would have more than about [`MOST_TILES`] of them.
const TILE_PX: f64 = 16.0;
const MOST_TILES: f64 = 2048.0;
const SLICES: u32 = 64;
/// Octaves of depth below that of the farthest light that slices are spent on; what is nearer is in the first.
const OCTAVES: f32 = 7.0;
/// Parts of a cluster along the line of sight that cones are tested against.
const PARTS: usize = 4;

/// How many clusters there are along each axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Resolution {
    pub(super) columns: u32,
    pub(super) rows: u32,
    pub(super) slices: u32,
}

impl Resolution {
    pub(super) fn of(size_px: UVec2) -> Self {
        let area_px = f64::from(size_px.x) * f64::from(size_px.y);
        let side_px = TILE_PX.max((area_px / MOST_TILES).sqrt());
        let tiles = |px: u32| (f64::from(px) / side_px).ceil().max(1.0) as u32;
        Self { columns: tiles(size_px.x), rows: tiles(size_px.y), slices: SLICES }
    }

    /// Half as many along every axis; one cluster at last.
    pub(super) fn coarser(self) -> Self {
        let half = |count: u32| count.div_ceil(2);
        Self { columns: half(self.columns), rows: half(self.rows), slices: half(self.slices) }
    }

    pub(super) fn clusters(self) -> usize {
        self.columns as usize * self.rows as usize * self.slices as usize
    }
}

/// A plane that cuts tiles apart: the signed distance is positive on the side of the higher tile.
#[derive(Debug, Clone, Copy)]
pub(super) struct Cut {
    /// Along the axis that is cut: x for columns, y for rows.
    across: f32,
    /// Along z of the view, which points at the viewer.
    toward_viewer: f32,
    offset_m: f32,
    /// Its place at the depth of the eye, and for each metre of depth.
    at_eye_m: f32,
    per_depth: f32,
}

impl Cut {
    pub(super) fn distance_m(&self, across_m: f32, z_m: f32) -> f32 {
        self.across * across_m + self.toward_viewer * z_m + self.offset_m
    }

    /// Unit normal in the plane of the axis that is cut and z.
    pub(super) fn normal(&self) -> (f32, f32) {
        (self.across, self.toward_viewer)
    }

    /// Normal and offset of a cut between rows.
    pub(super) fn across_y(&self) -> (Vec3, f32) {
        (Vec3::new(0.0, self.across, self.toward_viewer), self.offset_m)
    }

    /// Where the cut is at a depth.
    fn at_depth(&self, depth_m: f32) -> f32 {
        self.per_depth * depth_m + self.at_eye_m
    }
}

/// The cuts of one view.
#[derive(Debug)]
pub(super) struct Grid {
    pub(super) resolution: Resolution,
    /// One more than there are columns, from the left; and rows, from below.
    pub(super) columns: Vec<Cut>,
    pub(super) rows: Vec<Cut>,
    /// One more than there are slices: depths from the viewer on, within which all lights end.
    pub(super) depths_m: Vec<f32>,
    /// Slice of a depth: `scale` times its logarithm to base 2, or times the depth itself, plus `bias`.
    scale: f32,
    bias: f32,
    logarithmic: bool,
}

impl Grid {
    pub(super) fn new<'a>(
        camera: &Camera,
        size_px: UVec2,
        resolution: Resolution,
        reaches: impl Iterator<Item = &'a ReachInView>,
    ) -> Self {
        let (nearest_m, farthest_m) = reaches.fold((f32::INFINITY, f32::NEG_INFINITY), |(near, far), reach| {
            (near.min(reach.nearest_m()), far.max(reach.farthest_m()))
        });
        let aspect = f64::from(size_px.x) / f64::from(size_px.y);
        let (half_height, logarithmic) = match camera.projection {
            Projection::Perspective { fov_y_rad } => ((0.5 * fov_y_rad).tan(), true),
            Projection::Orthographic { height_m } => (0.5 * height_m, false),
        };
        // Of no lights nothing is asked.
        let (first_m, last_m) = match (nearest_m <= farthest_m, logarithmic) {
            (false, _) => (1.0, 2.0),
            (true, true) => {
                let near_m = camera.near_m as f32;
                (nearest_m.max(near_m).max(farthest_m * (-OCTAVES).exp2()), farthest_m.max(near_m))
            }
            (true, false) => (nearest_m, farthest_m),
        };
        let level = |depth_m: f32| if logarithmic { depth_m.log2() } else { depth_m };
        let extent = (level(last_m) - level(first_m)).max(1e-6 * level(last_m).abs()).max(1e-20);
        let scale = resolution.slices as f32 / extent;
        let bias = -level(first_m) * scale;
        let depth_m = |slice: u32| {
            let level = (slice as f32 - bias) / scale;
            if logarithmic { level.exp2() } else { level }
        };
        let mut depths_m: Vec<f32> = (0..=resolution.slices).map(depth_m).collect();
        // What is nearer or farther counts to the first and last: no light ends there.
        depths_m[0] = depths_m[0].min(if logarithmic { camera.near_m as f32 } else { nearest_m });
        Self {
            resolution,
            columns: cuts(resolution.columns, half_height * aspect, logarithmic),
            rows: cuts(resolution.rows, half_height, logarithmic),
            depths_m,
            scale,
            bias,
            logarithmic,
        }
    }

    /// The slice of a depth, from 0 up to one below their number.
    pub(super) fn slice(&self, depth_m: f32) -> usize {
        let level = if self.logarithmic { depth_m.max(f32::MIN_POSITIVE).log2() } else { depth_m };
        ((level * self.scale + self.bias).max(0.0) as usize).min(self.resolution.slices as usize - 1)
    }

    /// The same from clip space: slices for each octave of w, for each unit of z, and what is added.
    pub(super) fn slice_from_clip(&self, camera: &Camera) -> [f32; 3] {
        if self.logarithmic {
            return [self.scale, 0.0, self.bias];
        }
        // Reversed: 1 at the near plane, 0 at the far one.
        let (near_m, far_m) = (camera.near_m as f32, camera.far_m as f32);
        [0.0, -(far_m - near_m) * self.scale, self.bias + far_m * self.scale]
    }

    /// Spheres around the parts of a cluster, which is longer than wide: centres in view space, and radii.
    pub(super) fn bounding_spheres(&self, column: usize, row: usize, slice: usize) -> [(Vec3, f32); PARTS] {
        let (near_m, far_m) = (self.depths_m[slice], self.depths_m[slice + 1]);
        let part_m = (far_m - near_m) / PARTS as f32;
        std::array::from_fn(|part| {
            let near_m = near_m + part as f32 * part_m;
            let middle_m = near_m + 0.5 * part_m;
            let ends_m = [near_m, near_m + part_m];
            let (x, half_width_m) = middle(&self.columns[column..column + 2], middle_m, ends_m);
            let (y, half_height_m) = middle(&self.rows[row..row + 2], middle_m, ends_m);
            (Vec3::new(x, y, -middle_m), Vec3::new(half_width_m, half_height_m, 0.5 * part_m).length())
        })
    }
}

/// The middle between two cuts at a depth, and how far from it a cut is at either end.
fn middle(cuts: &[Cut], depth_m: f32, ends_m: [f32; 2]) -> (f32, f32) {
    let middle_m = 0.5 * (cuts[0].at_depth(depth_m) + cuts[1].at_depth(depth_m));
    let reach = ends_m.map(|end_m| (middle_m - cuts[0].at_depth(end_m)).max(cuts[1].at_depth(end_m) - middle_m));
    (middle_m, reach[0].max(reach[1]))
}

/// The cuts between `count` tiles, and the two around them. `half` is the half extent of the picture, in metres, or for a
/// perspective camera at a depth of one metre.
fn cuts(count: u32, half: f64, perspective: bool) -> Vec<Cut> {
    let place = |i: u32| (2.0 * f64::from(i) / f64::from(count) - 1.0) * half;
    let cut = |i| {
        let place: f64 = place(i);
        if perspective {
            // x = -z place: through the eye.
            let length = place.hypot(1.0);
            let (across, toward_viewer) = ((1.0 / length) as f32, (place / length) as f32);
            Cut { across, toward_viewer, offset_m: 0.0, at_eye_m: 0.0, per_depth: place as f32 }
        } else {
            let place = place as f32;
            Cut { across: 1.0, toward_viewer: 0.0, offset_m: -place, at_eye_m: place, per_depth: 0.0 }
        }
    };
    (0..=count).map(cut).collect()
}
