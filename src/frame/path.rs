//! Whether surfaces are shaded as they are rasterised, or in a pass of their own when it is known which are seen.

use super::Drawables;
use crate::scene::{Bounds, Topology, View};
use crate::shader::Alpha;
use glam::{DVec2, UVec2};

/// The way from triangles to radiance.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum RenderPath {
    /// Each triangle shades its pixels.
    #[default]
    Forward,
    /// Triangles leave their numbers, then each pixel is shaded once for all that belong together.
    Deferred,
}

impl RenderPath {
    /// As reports have it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Forward => "forward",
            Self::Deferred => "deferred",
        }
    }
}

/// Each draw goes once more over the part of the picture that it can be in, to find its pixels.
const MAX_DRAWS: usize = 64;

/// Pixels of the picture a triangle, below which the deferred path is faster on a software driver: measured with grids of
/// 2 to 32768 triangles (docs/performance.md). With several samples blocks beside edges cost more.
const SMALL_TRIANGLE_PX: f64 = 100.0;
const SMALL_TRIANGLE_MULTISAMPLED_PX: f64 = 300.0;

/// Whether the deferred path can draw these: a few opaque draws of triangles, one instance each.
pub fn is_deferrable(drawables: &Drawables) -> bool {
    let fits = |drawable: &super::Drawable| {
        drawable.material_features.alpha == Alpha::Opaque
            && drawable.topology == Topology::Triangles
            && drawable.instances.len() == 1
    };
    (1..=MAX_DRAWS).contains(&drawables.draws.len()) && drawables.draws.iter().all(fits)
}

/// Whether `triangles` within `bounds_in_world` are small enough in a picture of `view` for the deferred path to pay.
pub fn are_small(triangles: u64, bounds_in_world: &Bounds, view: &View, samples: u32) -> bool {
    let limit = if samples > 1 { SMALL_TRIANGLE_MULTISAMPLED_PX } else { SMALL_TRIANGLE_PX };
    pixels_within(bounds_in_world, view) < limit * triangles as f64
}

fn pixels_within(bounds: &Bounds, view: &View) -> f64 {
    rectangle_around(bounds, view).map_or(0.0, |[_, size]| f64::from(size.x) * f64::from(size.y))
}

/// Corner and size, in pixels, of the part of the picture that a box can cover: the rectangle around its corners, or all
/// of the picture where one is beside or behind the eye. None where it is out of sight.
pub fn rectangle_around(bounds: &Bounds, view: &View) -> Option<[UVec2; 2]> {
    let size = view.size_px.as_dvec2();
    let clip_from_world = view.camera.clip_from_view(view.size_px).as_dmat4() * view.camera.world_from_view.inverse();
    let (mut least, mut largest) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
    for corner in bounds.corners() {
        let clip = clip_from_world * corner.extend(1.0);
        if clip.w <= 0.0 {
            return Some([UVec2::ZERO, view.size_px]);
        }
        let pixel = (DVec2::new(clip.x, -clip.y) / clip.w * 0.5 + 0.5) * size;
        (least, largest) = (least.min(pixel), largest.max(pixel));
    }
    // Rasterisers move corners by fractions of a pixel.
    let (first, last) = ((least - 1.0).floor().max(DVec2::ZERO), (largest + 1.0).ceil().min(size));
    (first.cmplt(last).all()).then(|| [first.as_uvec2(), (last - first).as_uvec2()])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::framing::default_view;
    use crate::scene::{Mesh, Node, Scene, shapes};
    use glam::DVec3;

    fn sphere() -> Scene {
        Scene {
            nodes: vec![Node { mesh: Some(0), ..Default::default() }],
            roots: vec![0],
            meshes: vec![Mesh { name: None, primitives: vec![shapes::sphere(1.0, 64, 0)] }],
            materials: vec![Default::default()],
            ..Default::default()
        }
    }

    #[test]
    fn the_rectangle_around_a_framed_sphere_is_most_of_the_picture() {
        let scene = sphere();
        let view = default_view(&scene, UVec2::new(300, 200));
        let seen = pixels_within(&scene.bounds(), &view);
        assert!((0.6 * 200.0 * 200.0..=300.0 * 200.0).contains(&seen), "{seen}");
        assert!(are_small(8192, &scene.bounds(), &view, 1) && !are_small(100, &scene.bounds(), &view, 4));
    }

    #[test]
    fn around_the_eye_a_box_is_everywhere_and_behind_it_nowhere() {
        let view = default_view(&sphere(), UVec2::new(30, 20));
        let cube = |center: DVec3, half: f64| Bounds { min: center - half, max: center + half };
        assert_eq!(pixels_within(&cube(DVec3::ZERO, 100.0), &view), 600.0);
        let beside = view.camera.world_from_view.transform_point3(DVec3::new(1e3, 0.0, -10.0));
        assert_eq!(rectangle_around(&cube(beside, 1.0), &view), None);
    }
}
