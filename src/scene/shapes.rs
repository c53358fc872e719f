//! Simple geometry made in code.

use super::{Primitive, Topology};
use glam::{Vec2, Vec3, Vec4};
use std::f32::consts::PI;

/// A sphere about the origin: `rings` rows of quads from pole to pole, twice as many around; counter-clockwise from
/// outside. u runs eastward from +X toward -Z, v from the top down; tangents follow u.
pub fn sphere(radius: f32, rings: u32, material: usize) -> Primitive {
    let segments = 2 * rings;
    let vertices = (0..=rings).flat_map(|row| (0..=segments).map(move |column| (row, column)));
    let uvs: Vec<Vec2> =
        vertices.map(|(row, column)| Vec2::new(column as f32 / segments as f32, row as f32 / rings as f32)).collect();
    let point = |uv: &Vec2| {
        let (sin_phi, cos_phi) = (uv.x * 2.0 * PI).sin_cos();
        let (sin_theta, cos_theta) = (uv.y * PI).sin_cos();
        Vec3::new(sin_theta * cos_phi, cos_theta, -sin_theta * sin_phi)
    };
    let tangent = |uv: &Vec2| {
        let (sin_phi, cos_phi) = (uv.x * 2.0 * PI).sin_cos();
        Vec4::new(-sin_phi, 0.0, -cos_phi, 1.0)
    };
    let normals: Vec<Vec3> = uvs.iter().map(point).collect();
    let quad = |row: u32, column: u32| {
        let a = row * (segments + 1) + column;
        let b = a + segments + 1;
        [a, b, b + 1, a, b + 1, a + 1]
    };
    Primitive {
        topology: Topology::Triangles,
        positions: normals.iter().map(|n| *n * radius).collect(),
        tangents: Some(uvs.iter().map(tangent).collect()),
        normals: Some(normals),
        uvs: vec![uvs],
        colors: None,
        indices: (0..rings).flat_map(|row| (0..segments).flat_map(move |column| quad(row, column))).collect(),
        material,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sphere_is_closed_outward_and_framed() {
        let sphere = sphere(2.0, 16, 0);
        let normals = sphere.normals.as_ref().unwrap();
        let mut area = 0.0;
        for triangle in sphere.indices.chunks(3) {
            let [a, b, c] = [0, 1, 2].map(|corner| sphere.positions[triangle[corner] as usize]);
            let face = (b - a).cross(c - a);
            assert!(face.dot(a + b + c) >= -1e-6, "a triangle faces inward");
            area += 0.5 * face.length();
        }
        assert!((area / (16.0 * PI) - 1.0).abs() < 0.02, "area {area}");
        for (n, t) in normals.iter().zip(sphere.tangents.as_ref().unwrap()) {
            assert!(n.dot(t.truncate()).abs() < 1e-6);
        }
    }
}
