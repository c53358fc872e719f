//! Whether surfaces are shaded as they are rasterised, or in a pass of their own when it is known which are seen.

use super::cull::clip_from_origin;
use super::drawables::{Drawable, Drawables};
use super::rectangle::Rectangle;
use crate::scene::{Topology, View};
use crate::shader::{Alpha, SceneFeatures};

/// The way from triangles to radiance.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum RenderPath {
    /// Each triangle shades its pixels.
    #[default]
    Forward,
    /// Triangles leave their numbers, then each pixel is shaded once for all that belong together.
    Deferred,
    /// Deferred where that is possible; over it, forward, what is left.
    Mixed,
}

impl RenderPath {
    /// As reports have it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Forward => "forward",
            Self::Deferred => "deferred",
            Self::Mixed => "mixed",
        }
    }
}

/// Each place of a draw is a draw of its own, which goes once more over the part of the picture that it can be in, to find
/// its pixels.
const MAX_PLACES: usize = 64;

/// The most vertices that draws may have together at places but their first: they are kept where they are placed.
const MAX_COPIED_VERTICES: usize = 1 << 20;

/// Pixels of the picture a triangle, below which the deferred path is the faster one on a software driver, for shaders
/// with and without textures (docs/performance.md). With several samples blocks beside edges cost more.
const SMALL_TRIANGLE_PX: f64 = 75.0;
const SMALL_TRIANGLE_MULTISAMPLED_PX: f64 = 250.0;

/// Lamps alone take about half as long as an environment, and so does what is won by shading less.
const WITHOUT_ENVIRONMENT: f64 = 0.5;

/// What a pixel costs that may be drawn over, of what it costs to be gone over by a deferred draw.
const OVER: f64 = 0.4;

/// Which drawables are deferred: those of opaque triangles, if they have few places together, else those of them at one
/// place. `vertices` says how many one has.
pub fn deferred(drawables: &Drawables, vertices: impl Fn(&Drawable) -> usize) -> Vec<bool> {
    let copies = |drawable: &Drawable| (drawable.placements.len() - 1) * vertices(drawable);
    let fits = |drawable: &Drawable, most: usize| {
        let places = &drawables.placements.instances[drawable.placements.clone()];
        drawable.material_features.alpha == Alpha::Opaque
            && drawable.topology == Topology::Triangles
            && (1..=most).contains(&places.len())
            // A mesh may hold a primitive twice.
            && places.windows(2).all(|two| two[0] != two[1])
    };
    for most in [MAX_PLACES, 1] {
        let chosen: Vec<bool> = drawables.draws.iter().map(|drawable| fits(drawable, most)).collect();
        let sum = |of: &dyn Fn(&Drawable) -> usize| -> usize {
            let draws = drawables.draws.iter().zip(&chosen).filter(|(_, chosen)| **chosen);
            draws.map(|(drawable, _)| of(drawable)).sum()
        };
        if sum(&|drawable| drawable.placements.len()) <= MAX_PLACES && sum(&copies) <= MAX_COPIED_VERTICES {
            return chosen;
        }
    }
    vec![false; drawables.draws.len()]
}

/// Where a view may show something that is not deferred, draw by draw.
pub fn left_over(
    drawables: &Drawables,
    view: &View,
    is_deferred: impl Fn(usize) -> bool,
) -> impl Iterator<Item = Rectangle> {
    let (clip, size_px) = (clip_from_origin(view, drawables.origin_in_world), view.size_px);
    let left = drawables.draws.iter().enumerate().filter(move |(index, _)| !is_deferred(*index));
    left.filter_map(move |(_, drawable)| Rectangle::around(drawable.bounds, &clip, size_px))
}

/// Whether triangles are small enough for the deferred path to pay, over all that can take it. `triangles` says how many a
/// drawable has, if it is deferred.
pub fn are_small(
    drawables: &Drawables,
    light: SceneFeatures,
    view: &View,
    samples: u32,
    triangles: impl Fn(usize) -> Option<u64>,
) -> bool {
    let clip = clip_from_origin(view, drawables.origin_in_world);
    let (mut pixels, mut count) = (0.0, 0);
    for (index, drawable) in drawables.draws.iter().enumerate() {
        let Some(triangles) = triangles(index) else { continue };
        for placement in drawable.placements.clone() {
            let bounds = drawables.placements.boxes.get(placement);
            if let Some(rectangle) = Rectangle::around(bounds, &clip, view.size_px) {
                pixels += rectangle.area();
                count += triangles;
            }
        }
    }
    let over = left_over(drawables, view, |index| triangles(index).is_some()).reduce(Rectangle::with);
    let limit = if samples > 1 { SMALL_TRIANGLE_MULTISAMPLED_PX } else { SMALL_TRIANGLE_PX };
    let worth = if light.environment { 1.0 } else { WITHOUT_ENVIRONMENT };
    pixels + OVER * over.map_or(0.0, Rectangle::area) < worth * limit * count as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::framing::default_view;
    use crate::scene::{AlphaMode, Material, Mesh, Node, Scene, shapes};
    use glam::UVec2;

    /// So many spheres of some 8000 triangles at the same place, which are one draw, and one of another material.
    fn spheres(count: usize, alpha_mode: AlphaMode) -> Scene {
        let node = |mesh| Node { mesh: Some(mesh), ..Default::default() };
        Scene {
            nodes: (0..count).map(|_| node(0)).chain([node(1)]).collect(),
            roots: (0..=count).collect(),
            meshes: [0, 1].map(|i| Mesh { name: None, primitives: vec![shapes::sphere(1.0, 64, i)] }).into(),
            materials: vec![Material::default(), Material { alpha_mode, ..Default::default() }],
            ..Default::default()
        }
    }

    fn deferred_of(scene: &Scene, vertices: usize) -> Vec<bool> {
        deferred(&Drawables::new(scene, SceneFeatures::of(scene)), |_| vertices)
    }

    #[test]
    fn few_places_are_deferred() {
        assert_eq!(deferred_of(&spheres(1, AlphaMode::Opaque), 8000), [true, true]);
        assert_eq!(deferred_of(&spheres(63, AlphaMode::Opaque), 8000), [true, true]);
        assert_eq!(deferred_of(&spheres(64, AlphaMode::Opaque), 8000), [false, true]);
        assert_eq!(deferred_of(&spheres(64, AlphaMode::Blend), 8000), [true, false]);
        assert_eq!(deferred_of(&spheres(63, AlphaMode::Opaque), 80_000), [false, true]);
        let mut twice = spheres(1, AlphaMode::Blend);
        let again = twice.meshes[0].primitives[0].clone();
        twice.meshes[0].primitives.push(again);
        assert_eq!(deferred_of(&twice, 8000), [false, false]);
    }

    #[test]
    fn triangles_are_small_or_large_by_the_picture() {
        let largest_in = |scene: &Scene, environment, samples| {
            let light = SceneFeatures { environment, ..SceneFeatures::of(scene) };
            let drawables = Drawables::new(scene, light);
            let is_deferred = deferred(&drawables, |_| 8000);
            let triangles = |index: usize| is_deferred[index].then_some(8000);
            let small = |side: &u32| {
                are_small(&drawables, light, &default_view(scene, UVec2::splat(*side)), samples, triangles)
            };
            let sides: Vec<u32> = (1..=64).map(|i| 64 * i).filter(small).collect();
            // What is small in a picture is small in a smaller one.
            assert_eq!(sides, (1..=sides.len() as u32).map(|i| 64 * i).collect::<Vec<_>>());
            sides.last().copied()
        };
        let largest = |scene: &Scene, samples| largest_in(scene, true, samples);
        let (opaque, glazed) = (spheres(1, AlphaMode::Opaque), spheres(1, AlphaMode::Blend));
        let limits = [1, 4].map(|samples| [&opaque, &glazed].map(|scene| largest(scene, samples)));
        let [[one, one_glazed], [four, four_glazed]] = limits;
        assert!(one > Some(512) && one < Some(1300) && four > one && four < Some(4096), "{limits:?}");
        assert!(one_glazed < one && one_glazed > Some(512) && four_glazed < four, "{limits:?}");
        let without = [1, 4].map(|samples| largest_in(&opaque, false, samples));
        assert!(without[0] < one && without[1] < four && without[0] >= Some(512), "{without:?}, {limits:?}");
    }
}
