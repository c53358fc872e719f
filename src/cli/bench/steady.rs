//! Which pixels both renderers see alike through their middle.

use crate::reference::geometry::Ray;
use crate::reference::surface::{Surface, World};
use crate::scene::{Scene, View};
use glam::{DVec2, DVec3};
use rayon::prelude::*;

/// A rasteriser moves vertices to a grid of 1/256 pixel: near an edge it may see the other side of it. This far around
/// the middle nothing may change.
const NEAR_PX: f64 = 1.0 / 64.0;
/// A surface that goes on is not displaced by more than this so near, in pixels; one that begins elsewhere is.
const JUMP_PX: f64 = 0.5;
/// Nor does its normal turn by more than this cosine says.
const SAME_NORMAL: f64 = 0.95;

/// For every pixel, whether the surfaces near its middle are one.
pub(super) fn steady_pixels(scene: &Scene, view: &View) -> Vec<bool> {
    let world = World::new(scene, view);
    let (width, count) = (view.size_px.x, view.size_px.x * view.size_px.y);
    let is_steady = |i: u32| {
        let middle = DVec2::new(f64::from(i % width), f64::from(i / width)) + 0.5;
        let Some((surfaces, footprint_m)) = seen(&world, view, middle) else { return false };
        let corners = [DVec2::ONE, DVec2::NEG_ONE, DVec2::new(1.0, -1.0), DVec2::new(-1.0, 1.0)];
        corners.into_iter().all(|corner| {
            let other = seen(&world, view, middle + corner * NEAR_PX);
            other.is_some_and(|(other, _)| {
                other.len() == surfaces.len() && other.iter().zip(&surfaces).all(|(a, b)| are_one(a, b, footprint_m))
            })
        })
    };
    (0..count).into_par_iter().map(is_steady).collect()
}

fn are_one(a: &Surface, b: &Surface, footprint_m: f64) -> bool {
    a.position_in_world.distance(b.position_in_world) <= JUMP_PX * footprint_m
        && a.normal_in_world.dot(b.normal_in_world) >= SAME_NORMAL
}

/// The surfaces along the ray through a place of the picture, and the width of a pixel at the first of them, metres.
fn seen(world: &World<'_>, view: &View, place: DVec2) -> Option<(Vec<Surface>, f64)> {
    let ray_at = |place| view.camera.ray(place, view.size_px);
    let (origin, direction) = ray_at(place);
    let ray = Ray { origin, direction, t_min: 0.0, t_max: f64::INFINITY };
    let surfaces: Vec<Surface> = world.layers(&ray).iter().map(|layer| world.surface(&layer.hit)).collect();
    let distance_m = (surfaces.first()?.position_in_world - origin).dot(direction);
    let (beside, beside_direction): (DVec3, DVec3) = ray_at(place + DVec2::X);
    let footprint_m = ((beside + beside_direction * distance_m) - (origin + direction * distance_m)).length();
    Some((surfaces, footprint_m))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::framing::default_view;
    use crate::scene::{Mesh, Node, shapes};
    use glam::UVec2;

    #[test]
    fn the_inside_of_a_sphere_is_steady_and_its_edge_and_the_void_are_not() {
        let scene = Scene {
            nodes: vec![Node { mesh: Some(0), ..Default::default() }],
            roots: vec![0],
            meshes: vec![Mesh { name: None, primitives: vec![shapes::sphere(1.0, 64, 0)] }],
            materials: vec![Default::default()],
            ..Default::default()
        };
        let view = default_view(&scene, UVec2::splat(64));
        let steady = steady_pixels(&scene, &view);
        assert!(steady[32 * 64 + 32] && !steady[0]);
        let count = steady.iter().filter(|steady| **steady).count();
        // The disc has nine tenths of the side: 0.64 of the pixels.
        assert!((2400..2650).contains(&count), "{count}");
    }
}
