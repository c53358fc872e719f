//! Normals where a file has none, or has some that cannot be used.

use glam::{DVec3, Vec3};

/// Shown where the geometry says nothing; such triangles have no area.
const ANY_NORMAL: Vec3 = Vec3::Z;

/// Normal times twice the area, in float64: products of the largest f32 stay finite there.
fn area_vector(corners: [Vec3; 3]) -> DVec3 {
    let [a, b, c] = corners.map(Vec3::as_dvec3);
    (b - a).cross(c - a)
}

/// The normal of each triangle on its three corners; `corners` are the positions of a list of triangles.
pub(super) fn flat(corners: &[Vec3]) -> Vec<Vec3> {
    let normal = |corners: &[Vec3]| area_vector([corners[0], corners[1], corners[2]]).normalize_or_zero().as_vec3();
    corners.chunks_exact(3).flat_map(|triangle| [normal(triangle).normalize_or(ANY_NORMAL); 3]).collect()
}

/// Makes all normals unit vectors. Those of no length get the area-weighted mean of the triangles around them.
/// Returns how many those were.
pub(super) fn repair(normals: &mut [Vec3], positions: &[Vec3], triangles: &[u32]) -> usize {
    let mut lost = Vec::new();
    for (vertex, normal) in normals.iter_mut().enumerate() {
        *normal = unit(*normal);
        if *normal == Vec3::ZERO {
            lost.push(vertex);
        }
    }
    if lost.is_empty() {
        return 0;
    }
    let mut sums = vec![DVec3::ZERO; normals.len()];
    for triangle in triangles.chunks_exact(3) {
        let corners = [triangle[0], triangle[1], triangle[2]].map(|index| index as usize);
        let area = area_vector(corners.map(|corner| positions[corner]));
        corners.into_iter().for_each(|corner| sums[corner] += area);
    }
    for &vertex in &lost {
        normals[vertex] = sums[vertex].normalize_or_zero().as_vec3().normalize_or(ANY_NORMAL);
    }
    lost.len()
}

/// A unit vector in the same direction, or zero. A vector that is one already, to the precision of the f32 and 16-bit
/// formats that normals are stored in, keeps its bits.
pub(super) fn unit(vector: Vec3) -> Vec3 {
    if (vector.length_squared() - 1.0).abs() < 1e-6 { vector } else { vector.as_dvec3().normalize_or_zero().as_vec3() }
}
