//! Tangents where a normal texture needs them: MikkTSpace (Mikkelsen 2008), the space that bakers assume.

use super::limits::guarded;
use super::normals::unit;
use super::vertices::Vertices;
use bevy_mikktspace::{Geometry, StdOps, TangentSpace, generate_tangents};
use glam::{Vec2, Vec3, Vec4};
use std::collections::HashMap;

/// Corners that may share one vertex before MikkTSpace is passed over: its time is quadratic in them and its stack
/// linear, so a fan of a million triangles would take the process down. Meshes that are not hostile stay below 100.
const MAX_CORNERS_PER_VERTEX: usize = 256;

/// MikkTSpace forms products of lengths in f32; coordinates outside this range are scaled into it, which leaves
/// directions as they are.
const SAFE_RANGE: std::ops::RangeInclusive<f32> = 1e-8..=1e8;

/// Tangents of a list of triangles, one for each corner. `corners` has normals, and the texture coordinates `uv_set`.
pub(super) fn generate(corners: &Vertices, uv_set: usize) -> Vec<Vec4> {
    let Some(normals) = &corners.normals else { return Vec::new() };
    let mut job = Job::new(&corners.positions, normals, &corners.uvs[uv_set]);
    let welded = job.weld();
    let shared_by_few = welded.values().all(|vertex| vertex.corners <= MAX_CORNERS_PER_VERTEX);
    if !shared_by_few || guarded(|| generate_tangents::<_, StdOps>(&mut job)).is_none_or(|result| result.is_err()) {
        job.use_gradients();
    }
    job.fill_degenerate(&welded);
    let mut tangents = job.tangents;
    repair(&mut tangents, normals);
    tangents
}

/// Makes supplied tangents unit vectors with a sign. Those of no length get any direction across the normal.
pub(super) fn repair(tangents: &mut [Vec4], normals: &[Vec3]) {
    for (tangent, normal) in tangents.iter_mut().zip(normals) {
        let sign = if tangent.w < 0.0 { -1.0 } else { 1.0 };
        let direction = unit(tangent.truncate());
        let direction = if direction == Vec3::ZERO { normal.any_orthonormal_vector() } else { direction };
        *tangent = direction.extend(sign);
    }
}

fn scale_into_range(magnitudes: impl Iterator<Item = f32>) -> f32 {
    let largest = magnitudes.fold(0.0, f32::max);
    if largest == 0.0 || SAFE_RANGE.contains(&largest) {
        1.0
    } else {
        largest.recip().clamp(f32::MIN_POSITIVE, f32::MAX)
    }
}

/// What MikkTSpace takes for one vertex: the bits of position, normal and texture coordinates.
type Key = [u32; 8];

struct WeldedVertex {
    /// How many corners of triangles it is.
    corners: usize,
    first_corner: usize,
}

struct Job<'a> {
    positions: &'a [Vec3],
    normals: &'a [Vec3],
    uvs: &'a [Vec2],
    position_scale: f32,
    uv_scale: f32,
    /// First corners of the triangles whose corners are three different points. MikkTSpace skips the others, at a
    /// cost that is quadratic in their number, so they are kept from it.
    faces: Vec<usize>,
    tangents: Vec<Vec4>,
}

impl<'a> Job<'a> {
    fn new(positions: &'a [Vec3], normals: &'a [Vec3], uvs: &'a [Vec2]) -> Self {
        let position_scale = scale_into_range(positions.iter().map(|position| position.abs().max_element()));
        let uv_scale = scale_into_range(uvs.iter().map(|uv| uv.abs().max_element()));
        let tangents = vec![Vec4::ZERO; positions.len()];
        let mut job = Self { positions, normals, uvs, position_scale, uv_scale, faces: Vec::new(), tangents };
        let differ = |&first: &usize| {
            let [a, b, c] = [0, 1, 2].map(|corner| job.position_of(first + corner));
            a != b && b != c && c != a
        };
        job.faces = (0..positions.len()).step_by(3).filter(differ).collect();
        job
    }

    fn position_of(&self, corner: usize) -> Vec3 {
        self.positions[corner] * self.position_scale
    }

    /// v turned upward: glTF counts it downward, while normal textures have their green axis up.
    fn uv_of(&self, corner: usize) -> Vec2 {
        self.uvs[corner] * Vec2::new(self.uv_scale, -self.uv_scale)
    }

    fn key(&self, corner: usize) -> Key {
        let (position, normal, uv) = (self.position_of(corner), self.normals[corner], self.uv_of(corner));
        let numbers = [position.x, position.y, position.z, normal.x, normal.y, normal.z, uv.x, uv.y];
        // Adding 0 makes the two zeros one.
        numbers.map(|x| (x + 0.0).to_bits())
    }

    fn weld(&self) -> HashMap<Key, WeldedVertex> {
        let mut welded = HashMap::with_capacity(self.faces.len());
        for corner in self.faces.iter().flat_map(|&first| first..first + 3) {
            let vertex = welded.entry(self.key(corner)).or_insert(WeldedVertex { corners: 0, first_corner: corner });
            vertex.corners += 1;
        }
        welded
    }

    /// Triangles without area take over the tangents of the vertices that they share with others.
    fn fill_degenerate(&mut self, welded: &HashMap<Key, WeldedVertex>) {
        let mut faces = self.faces.iter().copied().peekable();
        for first in (0..self.positions.len()).step_by(3) {
            if faces.next_if_eq(&first).is_some() {
                continue;
            }
            for corner in first..first + 3 {
                if let Some(vertex) = welded.get(&self.key(corner)) {
                    self.tangents[corner] = self.tangents[vertex.first_corner];
                }
            }
        }
    }

    /// Each triangle's own gradient of u, without smoothing.
    fn use_gradients(&mut self) {
        for &first in &self.faces {
            let [a, b, c] = [0, 1, 2].map(|corner| first + corner);
            let (edge1, edge2) = (self.position_of(b) - self.position_of(a), self.position_of(c) - self.position_of(a));
            let (uv1, uv2) = (self.uv_of(b) - self.uv_of(a), self.uv_of(c) - self.uv_of(a));
            let sign = if uv1.perp_dot(uv2) < 0.0 { -1.0 } else { 1.0 };
            let along_u = unit((edge1 * uv2.y - edge2 * uv1.y) * sign);
            for corner in [a, b, c] {
                let normal = self.normals[corner];
                self.tangents[corner] = unit(along_u - normal * normal.dot(along_u)).extend(sign);
            }
        }
    }
}

impl Geometry for Job<'_> {
    fn num_faces(&self) -> usize {
        self.faces.len()
    }

    fn num_vertices_of_face(&self, _face: usize) -> usize {
        3
    }

    fn position(&self, face: usize, vertex: usize) -> [f32; 3] {
        self.position_of(self.faces[face] + vertex).to_array()
    }

    fn normal(&self, face: usize, vertex: usize) -> [f32; 3] {
        self.normals[self.faces[face] + vertex].to_array()
    }

    fn tex_coord(&self, face: usize, vertex: usize) -> [f32; 2] {
        self.uv_of(self.faces[face] + vertex).to_array()
    }

    fn set_tangent(&mut self, space: Option<TangentSpace>, face: usize, vertex: usize) {
        // Without a space, as in a triangle of no area without neighbours, `repair` finds a direction.
        let tangent = space.map_or(Vec4::ZERO, |space| Vec4::from_array(space.tangent_encoded()));
        let corner = self.faces[face] + vertex;
        self.tangents[corner] = if tangent.is_finite() { tangent } else { Vec4::ZERO };
    }
}
