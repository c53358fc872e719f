//! All that is known of a point where a ray hits, for people to look at.

use super::super::geometry::{Hit, Ray};
use super::{Surface, World};
use glam::{DVec2, DVec3};

/// A point of a surface, and how it came about.
#[derive(Debug, Clone, PartialEq)]
pub struct Details {
    pub node: usize,
    pub mesh: usize,
    /// Of the mesh.
    pub primitive: usize,
    pub material: usize,
    /// Of the primitive, as its indices list them.
    pub triangle: usize,
    /// The vertices of the primitive that are its corners.
    pub vertices: [u32; 3],
    pub surface: Surface,
    /// Alpha of the base colour, whatever the alpha mode makes of it.
    pub base_color_alpha: f64,
    /// Unit normal without the normal map, on the viewer's side like the next.
    pub vertex_normal_in_world: DVec3,
    /// Unit normal of the triangle; `None` for points and lines.
    pub geometric_normal_in_world: Option<DVec3>,
}

impl World<'_> {
    /// What is known of a hit of `ray`.
    pub fn details(&self, hit: &Hit, ray: &Ray) -> Details {
        let point = self.point(hit);
        let (draw, vertices) = (point.draw, point.triangle().vertices);
        let shapes = draw.primitive.indices.chunks_exact(draw.primitive.topology.indices_per_shape());
        // Points and lines repeat their vertices to make triangles of them.
        let is_it = |shape: &[u32]| shape.iter().all(|index| vertices.contains(index));
        let exactly = shapes.clone().position(|shape| *shape == vertices);
        Details {
            node: draw.instance.node,
            mesh: draw.instance.mesh,
            primitive: draw.primitive_index,
            material: draw.primitive.material,
            triangle: exactly.or_else(|| shapes.into_iter().position(is_it)).unwrap_or(0),
            vertices,
            surface: self.surface(hit),
            base_color_alpha: point.base_color().w,
            vertex_normal_in_world: point.facing_viewer(point.vertex_normal().1),
            geometric_normal_in_world: self.facet_normal(hit, ray),
        }
    }

    /// Index of the material of a hit, in [`crate::scene::Scene::materials`].
    pub fn material(&self, hit: &Hit) -> usize {
        self.point(hit).draw.primitive.material
    }

    /// Texture coordinates of a hit in one of the sets of its primitive, before any transform.
    pub fn uv(&self, hit: &Hit, set: usize) -> Option<DVec2> {
        let point = self.point(hit);
        let uvs = point.draw.primitive.uvs.get(set)?;
        Some(point.interpolate(|vertex| uvs[vertex].as_dvec2()))
    }
}
