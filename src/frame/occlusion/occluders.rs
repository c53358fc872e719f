//! Surfaces that may hide others, as closed to cracks as a rasteriser sees them.

use crate::frame::Drawables;
use crate::scene::{Primitive, Scene, Topology};
use crate::shader::Alpha;
use glam::Vec3;
use std::collections::HashMap;

/// Scenes of fewer placed primitives have too little to hide.
const PLACEMENTS: usize = 32;

/// Triangles that are kept of a scene, some 40 bytes each: those of the primitives that hide most for each of theirs.
const TRIANGLES: usize = 1 << 17;

/// Opaque primitives with the edges between their triangles.
#[derive(Debug, Clone, Default)]
pub struct Occluders {
    /// By drawable.
    of: Vec<Option<Occluder>>,
    triangles: Vec<usize>,
}

/// One of them, in object space. Vertices at the same place are one: wherever it is placed, they stay together to the bit.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Occluder {
    pub(super) positions: Vec<Vec3>,
    pub(super) triangles: Vec<[u32; 3]>,
    pub(super) edges: Vec<Edge>,
    pub(super) double_sided: bool,
}

/// A side of a triangle, and of its neighbour's if they turn the same way around.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Edge {
    pub(super) ends: [u32; 2],
    pub(super) triangle: u32,
    pub(super) neighbour: Option<u32>,
}

impl Occluders {
    /// Those of `drawables`, which are of `scene`.
    pub fn new(scene: &Scene, drawables: &Drawables) -> Self {
        let placements = &drawables.placements;
        if placements.instances.len() < PLACEMENTS {
            return Self::default();
        }
        let primitive = |index: usize| {
            let drawable = &drawables.draws[index];
            &scene.meshes[drawable.mesh].primitives[drawable.primitive]
        };
        let triangles: Vec<usize> = (0..drawables.draws.len()).map(|index| triangles_of(primitive(index))).collect();
        // The largest of its places, in m2 for each triangle.
        let worth = |index: usize| {
            let area = drawables.draws[index].placements.clone().map(|placement| {
                let half = placements.boxes.get(placement).1;
                half.x * half.y + half.y * half.z + half.z * half.x
            });
            area.filter(|area| area.is_finite()).fold(0.0, f32::max) / triangles[index].max(1) as f32
        };
        let hides = |index: &usize| {
            let drawable = &drawables.draws[*index];
            drawable.topology == Topology::Triangles && drawable.material_features.alpha == Alpha::Opaque
        };
        let mut by_worth: Vec<(f32, usize)> =
            (0..drawables.draws.len()).filter(hides).map(|index| (worth(index), index)).collect();
        by_worth.sort_by(|a, b| b.0.total_cmp(&a.0));
        let mut of = vec![None; drawables.draws.len()];
        let mut left = TRIANGLES;
        for (_, index) in by_worth {
            if let Some(rest) = left.checked_sub(triangles[index]) {
                of[index] =
                    Some(Occluder::new(primitive(index), drawables.draws[index].material_features.double_sided));
                left = rest;
            }
        }
        Self { of, triangles }
    }

    /// How many triangles a drawable has; 0 where nothing can be hidden.
    pub(super) fn triangles(&self, drawable: usize) -> usize {
        self.triangles.get(drawable).copied().unwrap_or(0)
    }

    pub(super) fn get(&self, drawable: usize) -> Option<&Occluder> {
        self.of.get(drawable)?.as_ref()
    }

    /// Whether nothing can hide anything.
    pub fn is_empty(&self) -> bool {
        self.of.iter().all(Option::is_none)
    }
}

fn triangles_of(primitive: &Primitive) -> usize {
    if primitive.topology == Topology::Triangles { primitive.indices.len() / 3 } else { 0 }
}

impl Occluder {
    pub(super) fn new(primitive: &Primitive, double_sided: bool) -> Self {
        let mut positions = Vec::new();
        let mut first: HashMap<[u32; 3], u32> = HashMap::new();
        let welded: Vec<u32> = primitive
            .positions
            .iter()
            .map(|position| {
                // Whatever the sign of a 0.
                let bits = (*position + Vec3::ZERO).to_array().map(f32::to_bits);
                *first.entry(bits).or_insert_with(|| {
                    positions.push(*position);
                    positions.len() as u32 - 1
                })
            })
            .collect();
        let corners = primitive.indices.chunks_exact(3).map(|corners| [0, 1, 2].map(|i| welded[corners[i] as usize]));
        // Those without an area make no fragment and hold no neighbours together.
        let triangles: Vec<[u32; 3]> = corners.filter(|[a, b, c]| a != b && b != c && c != a).collect();
        let edges = edges(&triangles);
        Self { positions, triangles, edges, double_sided }
    }
}

/// The sides of all triangles, those that two of them run along in opposite directions once.
fn edges(triangles: &[[u32; 3]]) -> Vec<Edge> {
    let mut edges: Vec<Edge> = Vec::with_capacity(triangles.len() * 3 / 2);
    // Those that have no neighbour yet, by their ends as a neighbour has them.
    let mut open: HashMap<[u32; 2], u32> = HashMap::with_capacity(triangles.len());
    for (triangle, &[a, b, c]) in (0..).zip(triangles) {
        for ends in [[a, b], [b, c], [c, a]] {
            match open.remove(&ends) {
                Some(edge) => edges[edge as usize].neighbour = Some(triangle),
                None => {
                    // Where three meet, one of two with the same ends stays open for good.
                    open.insert([ends[1], ends[0]], edges.len() as u32);
                    edges.push(Edge { ends, triangle, neighbour: None });
                }
            }
        }
    }
    edges
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::shapes;

    #[test]
    fn a_closed_surface_has_no_open_edge() {
        // Corners of a cube, three vertices at each; zeros of either sign.
        let corner = |i: usize| Vec3::new((i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2) as f32);
        let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let sign = |face: usize| if face.is_multiple_of(2) { Vec3::splat(-0.0) } else { Vec3::ZERO };
        let positions = faces.iter().enumerate().flat_map(|(f, face)| face.map(|i| corner(i) + sign(f))).collect();
        let indices = (0..6).flat_map(|f| [0, 1, 2, 0, 2, 3].map(|i| 4 * f + i)).collect();
        let cube = Primitive { positions, indices, ..shapes::sphere(1.0, 2, 0) };
        let cube = Occluder::new(&cube, false);
        assert_eq!((cube.positions.len(), cube.triangles.len(), cube.edges.len()), (8, 12, 18));
        assert!(cube.edges.iter().all(|edge| edge.neighbour.is_some()));
    }

    #[test]
    fn what_does_not_turn_the_same_way_around_stays_open() {
        let open = |triangles: &[[u32; 3]]| edges(triangles).iter().filter(|edge| edge.neighbour.is_none()).count();
        assert_eq!(open(&[[0, 1, 2]]), 3);
        assert_eq!(open(&[[0, 1, 2], [2, 1, 3]]), 4);
        assert_eq!(open(&[[0, 1, 2], [1, 2, 3]]), 6);
        // Three wings at one edge: two of them hold together.
        assert_eq!(open(&[[0, 1, 2], [2, 1, 3], [2, 1, 4]]), 7);
    }
}
