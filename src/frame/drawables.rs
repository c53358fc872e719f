//! The draws that a scene can need, before any view is known.

use crate::scene::{Bounds, Instance, Primitive, Scene, Topology};
use crate::shader::{Alpha, MaterialFeatures, SceneFeatures, VertexFeatures};
use glam::DVec3;
use std::ops::Range;

/// A mesh instance, with whether its transform mirrors it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlacedInstance {
    pub instance: Instance,
    pub mirrored: bool,
}

/// One primitive with the instances that can be drawn in one call.
#[derive(Debug, Clone, PartialEq)]
pub struct Drawable {
    pub mesh: usize,
    pub primitive: usize,
    pub material: usize,
    pub material_features: MaterialFeatures,
    pub vertex_features: VertexFeatures,
    pub topology: Topology,
    pub mirrored: bool,
    /// Range in [`Drawables::instances`].
    pub instances: Range<u32>,
    /// Centre of the first instance's bounds, in world space: the key for sorting by depth.
    pub center_in_world: DVec3,
}

/// Everything that can be drawn of a scene.
#[derive(Debug, Clone, Default)]
pub struct Drawables {
    /// Grouped by mesh and handedness, so that a drawable's instances are a range.
    pub instances: Vec<PlacedInstance>,
    pub draws: Vec<Drawable>,
}

impl Drawables {
    /// Opaque primitives get one draw for all instances of a mesh; blended ones a draw each, to be sorted.
    pub fn new(scene: &Scene, features: SceneFeatures) -> Self {
        let mut instances: Vec<PlacedInstance> = scene.instances().into_iter().map(place).collect();
        instances.sort_by_key(|placed| (placed.instance.mesh, placed.mirrored));
        let mut draws = Vec::new();
        let mut start = 0;
        for group in instances.chunk_by(|a, b| (a.instance.mesh, a.mirrored) == (b.instance.mesh, b.mirrored)) {
            let range = start as u32..(start + group.len()) as u32;
            start += group.len();
            let mesh = group[0].instance.mesh;
            for (index, primitive) in scene.meshes[mesh].primitives.iter().enumerate() {
                if primitive.indices.is_empty() {
                    continue;
                }
                let drawable = drawable(scene, features, mesh, index, primitive, group, range.clone());
                if drawable.material_features.alpha == Alpha::Blend {
                    draws.extend(one_by_one(&drawable, primitive, group));
                } else {
                    draws.push(drawable);
                }
            }
        }
        Self { instances, draws }
    }
}

fn place(instance: Instance) -> PlacedInstance {
    PlacedInstance { instance, mirrored: instance.world_from_object.determinant() < 0.0 }
}

fn drawable(
    scene: &Scene,
    features: SceneFeatures,
    mesh: usize,
    index: usize,
    primitive: &Primitive,
    group: &[PlacedInstance],
    instances: Range<u32>,
) -> Drawable {
    let material = &scene.materials[primitive.material];
    let material_features = MaterialFeatures::of(material, primitive, scene, features);
    Drawable {
        mesh,
        primitive: index,
        material: primitive.material,
        material_features,
        vertex_features: VertexFeatures::of(&material_features, primitive),
        topology: primitive.topology,
        mirrored: group[0].mirrored,
        instances,
        center_in_world: center_in_world(primitive, &group[0].instance),
    }
}

fn one_by_one<'a>(
    drawable: &'a Drawable,
    primitive: &'a Primitive,
    group: &'a [PlacedInstance],
) -> impl Iterator<Item = Drawable> + 'a {
    drawable.instances.clone().zip(group).map(|(index, placed)| Drawable {
        instances: index..index + 1,
        center_in_world: center_in_world(primitive, &placed.instance),
        ..drawable.clone()
    })
}

fn center_in_world(primitive: &Primitive, instance: &Instance) -> DVec3 {
    let mut bounds = Bounds::EMPTY;
    for position in &primitive.positions {
        bounds.grow(position.as_dvec3());
    }
    instance.world_from_object.transform_point3(bounds.center())
}
