//! All triangles of a scene in world space, and the rays through them.

use super::strokes;
use crate::scene::{Instance, Material, Primitive, Scene, Topology, View};
use glam::{DMat3, DVec3, Vec3A};
use obvhs::BvhBuildParams;
use obvhs::aabb::Aabb;
use obvhs::bvh2::{Bvh2, builder::build_bvh2};
use std::time::Duration;

/// A ray; only hits with `t_min <= t <= t_max` count, in units of `direction`, which is a unit vector.
#[derive(Debug, Clone, Copy)]
pub struct Ray {
    pub origin: DVec3,
    pub direction: DVec3,
    pub t_min: f64,
    pub t_max: f64,
}

/// Where a ray meets a triangle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hit {
    /// Index into the triangles of the [`Geometry`].
    pub triangle: usize,
    pub t: f64,
    /// Weights of the corners; their sum is 1.
    pub barycentric: DVec3,
    /// Whether the front is seen: counter-clockwise, or clockwise in a mirrored instance (glTF 2.0, 3.7.4).
    pub front: bool,
}

/// One primitive of one instance.
#[derive(Debug)]
pub struct Draw<'a> {
    pub primitive: &'a Primitive,
    pub material: &'a Material,
    /// The node and the mesh that it is of.
    pub instance: Instance,
    /// Of the mesh.
    pub primitive_index: usize,
    pub world_from_object: DMat3,
    /// Takes object-space normals to the world, but for their length. Also for singular matrices.
    pub normal_from_object: DMat3,
    /// -1 when the instance is mirrored, else 1.
    pub handedness: f64,
}

impl Draw<'_> {
    /// Whether only the front of this draw is there. Points and lines have no back.
    fn single_sided(&self) -> bool {
        self.primitive.topology == Topology::Triangles && !self.material.double_sided
    }
}

/// A triangle in world space.
#[derive(Debug, Clone, Copy)]
pub struct Triangle {
    pub corners: [DVec3; 3],
    /// Vertices of the primitive that give the corners their attributes.
    pub vertices: [u32; 3],
    pub draw: usize,
}

impl Triangle {
    /// Not normalised; toward the side from which the corners run counter-clockwise.
    pub fn normal(&self) -> DVec3 {
        let [a, b, c] = self.corners;
        (b - a).cross(c - a)
    }

    /// `(t, barycentric)` of the ray's crossing with the triangle. The edge tests of two triangles that share an edge are
    /// exact negatives of each other, so no ray slips through between them (after Woop, Benthin and Wald 2013).
    fn intersect(&self, ray: &Ray) -> Option<(f64, DVec3)> {
        let [a, b, c] = self.corners.map(|corner| corner - ray.origin);
        let d = ray.direction;
        let edges = DVec3::new(d.dot(b.cross(c)), d.dot(c.cross(a)), d.dot(a.cross(b)));
        if edges.min_element() < 0.0 && edges.max_element() > 0.0 {
            return None;
        }
        let sum = edges.element_sum();
        if sum == 0.0 {
            return None;
        }
        let barycentric = edges / sum;
        let t = d.dot(a * barycentric.x + b * barycentric.y + c * barycentric.z);
        (t >= ray.t_min && t <= ray.t_max).then_some((t, barycentric))
    }
}

/// A scene's triangles with a bounding volume hierarchy over them.
pub struct Geometry<'a> {
    pub draws: Vec<Draw<'a>>,
    pub triangles: Vec<Triangle>,
    hierarchy: Option<Hierarchy>,
}

/// The hierarchy works in float32 on coordinates of the unit cube around the origin; hits are found in float64.
struct Hierarchy {
    bvh: Bvh2,
    center: DVec3,
    scale: f64,
}

/// Enlarges boxes and ray ends in the hierarchy's coordinates: a hundred times the rounding of float32 in there.
const PADDING: f32 = 1e-5;

impl std::fmt::Debug for Geometry<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Geometry")
            .field("draws", &self.draws.len())
            .field("triangles", &self.triangles.len())
            .finish_non_exhaustive()
    }
}

impl<'a> Geometry<'a> {
    /// Places every instance of `scene`. Points and lines become quads that face the camera of `view`, one pixel wide.
    pub fn new(scene: &'a Scene, view: &View) -> Self {
        let (mut draws, mut triangles) = (Vec::new(), Vec::new());
        for instance in scene.instances() {
            for (index, primitive) in scene.meshes[instance.mesh].primitives.iter().enumerate() {
                place(primitive, &instance, view, draws.len(), &mut triangles);
                draws.push(draw((index, primitive), &scene.materials[primitive.material], &instance));
            }
        }
        triangles.retain(|triangle| triangle.corners.iter().all(|corner| corner.is_finite()));
        let hierarchy = Hierarchy::new(&triangles);
        Self { draws, triangles, hierarchy }
    }

    /// Calls `visit` with the hits along `ray`, in no order. When it returns a distance, hits farther than that need not
    /// be visited any more.
    pub fn visit_hits(&self, ray: &Ray, mut visit: impl FnMut(Hit) -> Option<f64>) {
        let Some(hierarchy) = &self.hierarchy else { return };
        hierarchy.traverse(ray, |index| {
            let triangle = &self.triangles[index];
            let (t, barycentric) = triangle.intersect(ray)?;
            let draw = &self.draws[triangle.draw];
            let front = triangle.normal().dot(ray.direction) * draw.handedness < 0.0;
            if draw.single_sided() && !front {
                return None;
            }
            visit(Hit { triangle: index, t, barycentric, front })
        });
    }

    /// The draw that a hit belongs to.
    pub fn draw(&self, hit: &Hit) -> &Draw<'a> {
        &self.draws[self.triangles[hit.triangle].draw]
    }
}

fn draw<'a>(
    (primitive_index, primitive): (usize, &'a Primitive),
    material: &'a Material,
    instance: &Instance,
) -> Draw<'a> {
    let world_from_object = DMat3::from_mat4(instance.world_from_object);
    let handedness = if world_from_object.determinant() < 0.0 { -1.0 } else { 1.0 };
    // The cofactor matrix: the inverse transpose without its division by the determinant, but for whose sign it is used.
    let DMat3 { x_axis: x, y_axis: y, z_axis: z } = world_from_object;
    let normal_from_object = DMat3::from_cols(y.cross(z), z.cross(x), x.cross(y)) * handedness;
    Draw {
        primitive,
        material,
        instance: *instance,
        primitive_index,
        world_from_object,
        normal_from_object,
        handedness,
    }
}

fn place(primitive: &Primitive, instance: &Instance, view: &View, draw: usize, triangles: &mut Vec<Triangle>) {
    let world =
        |index: u32| instance.world_from_object.transform_point3(primitive.positions[index as usize].as_dvec3());
    for shape in primitive.indices.chunks_exact(primitive.topology.indices_per_shape()) {
        match *shape {
            [a, b, c] => {
                let corners = [world(a), world(b), world(c)];
                triangles.push(Triangle { corners, vertices: [a, b, c], draw });
            }
            [a, b] => triangles.extend(strokes::line(view, draw, [(world(a), a), (world(b), b)])),
            [a] => triangles.extend(strokes::point(view, draw, (world(a), a))),
            _ => {}
        }
    }
}

impl Hierarchy {
    fn new(triangles: &[Triangle]) -> Option<Self> {
        let mut bounds = crate::scene::Bounds::EMPTY;
        triangles.iter().flat_map(|triangle| triangle.corners).for_each(|corner| bounds.grow(corner));
        if bounds.is_empty() {
            return None;
        }
        let (center, scale) = (bounds.center(), bounds.diagonal().max(f64::MIN_POSITIVE));
        let boxes: Vec<Aabb> = triangles
            .iter()
            .map(|triangle| {
                let corners = triangle.corners.map(|corner| ((corner - center) / scale).as_vec3a());
                let padding = Vec3A::splat(PADDING);
                let [a, b, c] = corners;
                Aabb::new(a.min(b).min(c) - padding, a.max(b).max(c) + padding)
            })
            .collect();
        let bvh = build_bvh2(&boxes, BvhBuildParams::medium_build(), &mut Duration::default());
        Some(Self { bvh, center, scale })
    }

    /// Calls `visit` with the triangles whose boxes the ray meets; what it returns shortens the ray.
    fn traverse(&self, ray: &Ray, mut visit: impl FnMut(usize) -> Option<f64>) {
        // Start where the ray enters the sphere around everything: far origins would not fit into float32.
        let entry = (self.center - ray.origin).dot(ray.direction) - self.scale;
        let start = entry.max(ray.t_min);
        let origin = (ray.origin + start * ray.direction - self.center) / self.scale;
        let local = |t: f64| ((t - start) / self.scale) as f32 + PADDING;
        if !origin.is_finite() || origin.abs().max_element() > 2.0 || local(ray.t_max) < 0.0 {
            return;
        }
        let direction = ray.direction.as_vec3a();
        let local_ray = obvhs::ray::Ray::new(origin.as_vec3a(), direction, 0.0, local(ray.t_max));
        self.bvh.ray_traverse(local_ray, &mut obvhs::ray::RayHit::none(), |_, slot| {
            visit(self.bvh.primitive_indices[slot] as usize).map_or(f32::INFINITY, local)
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reference::tests::{scene_of, sphere, view};
    use glam::DMat4;

    fn hits(geometry: &Geometry, origin: DVec3, direction: DVec3) -> Vec<Hit> {
        let ray = Ray { origin, direction, t_min: 0.0, t_max: f64::INFINITY };
        let mut hits = Vec::new();
        geometry.visit_hits(&ray, |hit| {
            hits.push(hit);
            None
        });
        hits.sort_by(|a, b| a.t.total_cmp(&b.t));
        hits
    }

    #[test]
    fn single_sided_surfaces_are_there_from_the_front_only() {
        let mut scene = scene_of(sphere(24), Material::default());
        let count = |scene: &Scene| hits(&Geometry::new(scene, &view()), DVec3::new(0.1, 0.2, 9.0), DVec3::NEG_Z).len();
        assert_eq!(count(&scene), 1);
        scene.materials[0].double_sided = true;
        assert_eq!(count(&scene), 2);
    }

    #[test]
    fn mirrored_instances_keep_their_outside_outside() {
        let mut scene = scene_of(sphere(24), Material::default());
        scene.nodes[0].parent_from_node = DMat4::from_scale(DVec3::new(-1.0, 1.0, 1.0));
        let geometry = Geometry::new(&scene, &view());
        let hits = hits(&geometry, DVec3::new(0.1, 0.2, 9.0), DVec3::NEG_Z);
        assert_eq!(hits.len(), 1);
        assert!(hits[0].front && (hits[0].t - 8.0).abs() < 0.1, "{hits:?}");
        let normal = geometry.draws[0].normal_from_object * DVec3::X;
        assert!((normal.normalize() - DVec3::NEG_X).length() < 1e-12);
    }

    #[test]
    fn rays_find_the_sphere_from_afar_and_only_inside_their_range() {
        let scene = scene_of(sphere(64), Material::default());
        let geometry = Geometry::new(&scene, &view());
        for distance in [2.0, 1e4, 1e7] {
            for i in 0..200 {
                let y = (f64::from(i) + 0.5) / 200.0 * 0.9;
                let hits = hits(&geometry, DVec3::new(0.013, y, distance), DVec3::NEG_Z);
                assert_eq!(hits.len(), 1, "height {y}, distance {distance}");
                let expected = distance - (1.0 - y * y - 0.013 * 0.013).sqrt();
                assert!((hits[0].t - expected).abs() < 5e-3, "{} instead of {expected}", hits[0].t);
            }
        }
        let mut found = false;
        let short = Ray { origin: DVec3::Z * 3.0, direction: DVec3::NEG_Z, t_min: 0.0, t_max: 1.5 };
        geometry.visit_hits(&short, |_| {
            found = true;
            None
        });
        assert!(!found);
    }

    #[test]
    fn no_ray_slips_through_an_edge() {
        let scene = scene_of(sphere(16), Material::default());
        let geometry = Geometry::new(&scene, &view());
        let primitive = &scene.meshes[0].primitives[0];
        for shape in primitive.indices.chunks_exact(3) {
            let [a, b] = [shape[0], shape[1]].map(|i| primitive.positions[i as usize].as_dvec3());
            let target = a.lerp(b, 0.37);
            let origin = DVec3::new(0.01, 0.02, 0.03);
            let direction = (target - origin).normalize();
            let outside = origin + 5.0 * direction;
            assert!(!hits(&geometry, outside, -direction).is_empty(), "edge at {target}");
        }
    }
}
