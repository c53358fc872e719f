//! Corners of triangles as the deferred pass compares them: two triangles belong to one smooth surface where they share a
//! corner, though its vertex may be split because texture coordinates have a seam there.

use crate::scene::Primitive;
use crate::shader::{CORNER_COPIES, VertexFeatures};
use std::collections::HashMap;

/// A primitive's vertices in another order: those that differ in texture coordinates and tangents alone side by side.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Corners {
    /// Number of the vertex at each place.
    pub(super) order: Vec<u32>,
    /// By number of the vertex: [`CORNER_COPIES`] times the place where its copies begin, and its own behind that.
    codes: Vec<u32>,
}

impl Corners {
    pub(super) fn of(primitive: &Primitive, features: &VertexFeatures) -> Self {
        let mut open = HashMap::new();
        let mut copies: Vec<Vec<u32>> = Vec::new();
        for vertex in 0..primitive.positions.len() {
            let place = open.entry(smooth_bits(primitive, features, vertex)).or_insert(usize::MAX);
            // More copies than can be told from each other begin another corner.
            if copies.get(*place).is_none_or(|same| same.len() == CORNER_COPIES as usize) {
                *place = copies.len();
                copies.push(Vec::new());
            }
            copies[*place].push(vertex as u32);
        }
        let mut codes = vec![0; primitive.positions.len()];
        let mut first = 0;
        for same in &copies {
            for (copy, vertex) in (0..).zip(same) {
                codes[*vertex as usize] = first * CORNER_COPIES + copy;
            }
            first += same.len() as u32;
        }
        Self { order: copies.concat(), codes }
    }

    /// The triangles, a texel each.
    pub(super) fn triangles<'a>(&'a self, primitive: &'a Primitive) -> impl Iterator<Item = [u32; 4]> {
        let code = |vertex: u32| self.codes[vertex as usize];
        primitive.indices.chunks_exact(3).map(move |t| [code(t[0]), code(t[1]), code(t[2]), 0])
    }
}

/// Of all that is seen to go on smoothly over a seam: position, normal and colour, to the bit.
fn smooth_bits(primitive: &Primitive, features: &VertexFeatures, vertex: usize) -> [u32; 10] {
    let normal = primitive.normals.as_ref().filter(|_| features.normal).map_or([0.0; 3], |n| n[vertex].to_array());
    let color = primitive.colors.as_ref().filter(|_| features.color).map_or([0.0; 4], |c| c[vertex].to_array());
    let [x, y, z] = primitive.positions[vertex].to_array();
    let [nx, ny, nz] = normal;
    let [r, g, b, a] = color;
    // Zero has two signs.
    [x, y, z, nx, ny, nz, r, g, b, a].map(|float| (float + 0.0).to_bits())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Topology;
    use glam::Vec3;

    fn primitive(positions: Vec<Vec3>, normals: Vec<Vec3>, indices: Vec<u32>) -> Primitive {
        Primitive {
            topology: Topology::Triangles,
            positions,
            normals: Some(normals),
            tangents: None,
            uvs: Vec::new(),
            colors: None,
            indices,
            material: 0,
        }
    }

    const NORMALS: VertexFeatures = VertexFeatures { normal: true, tangent: false, color: false, uv_sets: 0 };

    fn corner(code: u32) -> u32 {
        code / CORNER_COPIES
    }

    #[test]
    fn vertices_of_a_seam_are_one_corner_and_those_of_an_edge_two() {
        let places = vec![Vec3::ZERO, Vec3::X, Vec3::Y, -Vec3::ZERO, Vec3::X];
        let normals = vec![Vec3::Z, Vec3::Z, Vec3::Z, Vec3::Z, Vec3::Y];
        let primitive = primitive(places, normals, vec![0, 1, 2, 3, 2, 4]);
        let corners = Corners::of(&primitive, &NORMALS);
        let triangles: Vec<_> = corners.triangles(&primitive).collect();
        assert_eq!(corner(triangles[0][0]), corner(triangles[1][0]), "a seam");
        assert_ne!(triangles[0][0], triangles[1][0], "whose vertices are still two");
        assert_eq!(triangles[0][2], triangles[1][1], "the same vertex");
        assert_ne!(corner(triangles[0][1]), corner(triangles[1][2]), "an edge");
    }

    #[test]
    fn every_code_leads_to_its_vertex() {
        // More copies of one vertex than a corner has numbers for.
        let count = 3 * CORNER_COPIES + 5;
        let places: Vec<Vec3> = (0..count).map(|i| Vec3::splat((i % 2) as f32)).collect();
        let primitive = primitive(places, vec![Vec3::Z; count as usize], vec![0; 3]);
        let corners = Corners::of(&primitive, &NORMALS);
        for (vertex, code) in (0..).zip(&corners.codes) {
            let place = code / CORNER_COPIES + code % CORNER_COPIES;
            assert_eq!(corners.order[place as usize], vertex);
        }
        assert_eq!(corners.order.len(), count as usize);
    }
}
