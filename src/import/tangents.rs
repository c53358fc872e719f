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
    let mut job = Job {
        positions: &corners.positions,
        normals,
        uvs: &corners.uvs[uv_set],
        position_scale: scale_into_range(corners.positions.iter().map(|position| position.abs().max_element())),
        uv_scale: scale_into_range(corners.uvs[uv_set].iter().map(|uv| uv.abs().max_element())),
        tangents: vec![Vec4::ZERO; corners.positions.len()],
    };
    let shared_by_few = job.most_corners_per_vertex() <= MAX_CORNERS_PER_VERTEX;
    if !shared_by_few || guarded(|| generate_tangents::<_, StdOps>(&mut job)).is_none_or(|result| result.is_err()) {
        job.use_gradients();
    }
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

struct Job<'a> {
    positions: &'a [Vec3],
    normals: &'a [Vec3],
    uvs: &'a [Vec2],
    position_scale: f32,
    uv_scale: f32,
    tangents: Vec<Vec4>,
}

impl Job<'_> {
    fn position_of(&self, corner: usize) -> Vec3 {
        self.positions[corner] * self.position_scale
    }

    /// v turned upward: glTF counts it downward, while normal textures have their green axis up.
    fn uv_of(&self, corner: usize) -> Vec2 {
        self.uvs[corner] * Vec2::new(self.uv_scale, -self.uv_scale)
    }

    fn most_corners_per_vertex(&self) -> usize {
        let mut counts = HashMap::new();
        for corner in 0..self.positions.len() {
            let (position, normal, uv) = (self.position_of(corner), self.normals[corner], self.uv_of(corner));
            let key = [position.x, position.y, position.z, normal.x, normal.y, normal.z, uv.x, uv.y];
            // Adding 0 makes the two zeros one.
            *counts.entry(key.map(|x| (x + 0.0).to_bits())).or_insert(0) += 1;
        }
        counts.into_values().max().unwrap_or(0)
    }

    /// Each triangle's own gradient of u, without smoothing.
    fn use_gradients(&mut self) {
        for triangle in (0..self.positions.len()).step_by(3) {
            let [a, b, c] = [0, 1, 2].map(|corner| triangle + corner);
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
        self.positions.len() / 3
    }

    fn num_vertices_of_face(&self, _face: usize) -> usize {
        3
    }

    fn position(&self, face: usize, vertex: usize) -> [f32; 3] {
        self.position_of(3 * face + vertex).to_array()
    }

    fn normal(&self, face: usize, vertex: usize) -> [f32; 3] {
        self.normals[3 * face + vertex].to_array()
    }

    fn tex_coord(&self, face: usize, vertex: usize) -> [f32; 2] {
        self.uv_of(3 * face + vertex).to_array()
    }

    fn set_tangent(&mut self, space: Option<TangentSpace>, face: usize, vertex: usize) {
        // Without a space, as in a triangle of no area without neighbours, `repair` finds a direction.
        let tangent = space.map_or(Vec4::ZERO, |space| Vec4::from_array(space.tangent_encoded()));
        self.tangents[3 * face + vertex] = if tangent.is_finite() { tangent } else { Vec4::ZERO };
    }
}
