//! Whether surfaces are shaded as they are rasterised, or in a pass of their own when it is known which are seen.

use super::cull::clip_from_origin;
use super::drawables::{Drawable, Drawables};
use crate::scene::{Topology, View};
use crate::shader::Alpha;
use glam::{Mat4, UVec2, Vec2, Vec3};

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

/// Pixels of the picture a triangle, below which the deferred path is the faster one on a software driver, for shaders
/// with and without textures (docs/performance.md). With several samples blocks beside edges cost more.
const SMALL_TRIANGLE_PX: f64 = 75.0;
const SMALL_TRIANGLE_MULTISAMPLED_PX: f64 = 250.0;

/// Whether the deferred path can draw these: a few opaque draws of triangles, each at one place.
pub fn is_deferrable(drawables: &Drawables) -> bool {
    let fits = |drawable: &Drawable| {
        drawable.material_features.alpha == Alpha::Opaque
            && drawable.topology == Topology::Triangles
            && drawable.placements.len() == 1
    };
    (1..=MAX_DRAWS).contains(&drawables.draws.len()) && drawables.draws.iter().all(fits)
}

/// Whether triangles are small enough for the deferred path to pay, over all drawables; `triangles` says how many one has.
pub fn are_small(drawables: &Drawables, view: &View, samples: u32, triangles: impl Fn(usize) -> u64) -> bool {
    let clip = clip_from_origin(view, drawables.origin_in_world);
    let (mut pixels, mut count) = (0.0, 0);
    for (index, drawable) in drawables.draws.iter().enumerate() {
        if let Some([_, size]) = rectangle_around(drawable.bounds, &clip, view.size_px) {
            pixels += f64::from(size.x) * f64::from(size.y);
            count += triangles(index);
        }
    }
    let limit = if samples > 1 { SMALL_TRIANGLE_MULTISAMPLED_PX } else { SMALL_TRIANGLE_PX };
    pixels < limit * count as f64
}

/// Corner and size, in pixels, of the part of the picture that a box can cover, given by its centre and half extent: the
/// rectangle around its corners, or all of the picture where one is beside or behind the eye. None where it is out of
/// sight.
pub fn rectangle_around((center, half): (Vec3, Vec3), clip_from_origin: &Mat4, size_px: UVec2) -> Option<[UVec2; 2]> {
    let (mut least, mut largest) = (Vec2::INFINITY, Vec2::NEG_INFINITY);
    for corner in 0..8 {
        let sign = |axis: u32| if corner >> axis & 1 == 1 { 1.0 } else { -1.0 };
        let clip = *clip_from_origin * (center + half * Vec3::new(sign(0), sign(1), sign(2))).extend(1.0);
        if !clip.is_finite() || clip.w <= 0.0 {
            return Some([UVec2::ZERO, size_px]);
        }
        let pixel = (Vec2::new(clip.x, -clip.y) / clip.w * 0.5 + 0.5) * size_px.as_vec2();
        (least, largest) = (least.min(pixel), largest.max(pixel));
    }
    // A pixel of room for rounding, here and in the rasteriser.
    let first = (least - 1.0).floor().max(Vec2::ZERO).min(size_px.as_vec2());
    let last = (largest + 1.0).ceil().max(Vec2::ZERO).min(size_px.as_vec2());
    first.cmplt(last).all().then(|| [first.as_uvec2(), (last - first).as_uvec2()])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::framing::default_view;
    use crate::scene::{Mesh, Node, Scene, shapes};
    use crate::shader::SceneFeatures;

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
    fn triangles_are_small_or_large_by_the_picture() {
        let scene = sphere();
        let drawables = Drawables::new(&scene, SceneFeatures::of(&scene));
        assert!(is_deferrable(&drawables));
        // Some 8000 triangles.
        let small = |side, samples| {
            let view = default_view(&scene, UVec2::splat(side));
            are_small(&drawables, &view, samples, |_| scene.meshes[0].primitives[0].indices.len() as u64 / 3)
        };
        assert!(small(512, 1) && small(512, 4) && !small(4096, 1) && !small(4096, 4));
        assert!(!small(1300, 1) && small(1300, 4));
    }

    #[test]
    fn rectangles_hold_what_is_seen_of_a_box() {
        let size = UVec2::new(300, 200);
        let view = default_view(&sphere(), size);
        let clip = clip_from_origin(&view, glam::DVec3::ZERO);
        let all = Some([UVec2::ZERO, size]);
        assert_eq!(rectangle_around((Vec3::ZERO, Vec3::splat(100.0)), &clip, size), all);
        assert_eq!(rectangle_around((Vec3::ZERO, Vec3::INFINITY), &clip, size), all);
        let Some([corner, side]) = rectangle_around((Vec3::ZERO, Vec3::splat(0.1)), &clip, size) else {
            panic!("out of sight")
        };
        assert!(corner.cmpgt(UVec2::new(100, 60)).all() && (corner + side).cmplt(UVec2::new(200, 140)).all());
        let beside = view.camera.world_from_view.transform_point3(glam::DVec3::new(1e3, 0.0, -10.0)).as_vec3();
        assert_eq!(rectangle_around((beside, Vec3::ONE), &clip, size), None);
    }
}
