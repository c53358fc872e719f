//! The draws that a scene can need, before any view is known.

use super::boxes::Boxes;
use super::identity::{PrimitivePlace, first_of_same};
use super::occlusion::Occluders;
use crate::scene::{Bounds, Instance, Primitive, Scene, Topology};
use crate::shader::{Alpha, MaterialFeatures, SceneFeatures, VertexFeatures};
use glam::{DMat4, DVec3, Vec3};
use std::ops::Range;

/// A mesh instance, with whether its transform mirrors it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlacedInstance {
    pub instance: Instance,
    pub mirrored: bool,
}

/// One primitive wherever it is placed with one handedness: what can be drawn in one call.
#[derive(Debug, Clone, PartialEq)]
pub struct Drawable {
    /// The mesh and the primitive in it that the data are of: the first of those that are the same.
    pub mesh: usize,
    pub primitive: usize,
    pub material: usize,
    pub material_features: MaterialFeatures,
    pub vertex_features: VertexFeatures,
    pub topology: Topology,
    pub mirrored: bool,
    /// Around the vertices, in object space.
    pub object: Bounds,
    /// Range in [`Drawables::placements`].
    pub placements: Range<usize>,
    /// Centre and half extent of the box around all placements, around the scene's origin.
    pub bounds: (Vec3, Vec3),
}

/// A primitive at each of its places, side by side: the instance that gives the transform, and the box.
#[derive(Debug, Clone, Default)]
pub struct Placements {
    /// Indices into [`Drawables::instances`].
    pub instances: Vec<u32>,
    pub boxes: Boxes,
}

/// Everything that can be drawn of a scene.
#[derive(Debug, Clone, Default)]
pub struct Drawables {
    /// In the order of the scene.
    pub instances: Vec<PlacedInstance>,
    /// By mesh, primitive and handedness.
    pub draws: Vec<Drawable>,
    /// By drawable, then in the order of the scene.
    pub placements: Placements,
    /// Subtracted from every position before it becomes f32.
    pub origin_in_world: DVec3,
    /// What may hide the rest, once [`Self::find_occluders`] was called.
    pub occluders: Occluders,
    first_of_same: Vec<Vec<PrimitivePlace>>,
}

/// A primitive that is drawn at an instance.
#[derive(Clone, Copy)]
struct Use {
    place: PrimitivePlace,
    mirrored: bool,
    instance: u32,
}

impl Drawables {
    pub fn new(scene: &Scene, features: SceneFeatures) -> Self {
        let instances: Vec<PlacedInstance> = scene.instances().into_iter().map(place).collect();
        let bounds = scene.bounds();
        let origin_in_world = if bounds.is_empty() { DVec3::ZERO } else { bounds.center() };
        let first_of_same = first_of_same(scene);
        let uses = uses(scene, &instances, &first_of_same);
        let mut drawables = Self { instances, origin_in_world, first_of_same, ..Default::default() };
        for same in uses.chunk_by(|a, b| (a.place, a.mirrored) == (b.place, b.mirrored)) {
            drawables.add(scene, features, same);
        }
        drawables
    }

    /// Keeps those surfaces of `scene`, of which these are, that may hide others.
    pub fn find_occluders(&mut self, scene: &Scene) {
        self.occluders = Occluders::new(scene, self);
    }

    /// What a primitive of a mesh is drawn as.
    pub fn find(&self, (mesh, primitive): PrimitivePlace) -> Option<&Drawable> {
        let first = *self.first_of_same.get(mesh)?.get(primitive)?;
        self.draws.iter().find(|drawable| (drawable.mesh, drawable.primitive) == first)
    }

    /// The primitive of a mesh that is drawn as `drawable`; the first, if the mesh has several of the same.
    pub fn primitive_of(&self, mesh: usize, drawable: &Drawable) -> usize {
        let place = (drawable.mesh, drawable.primitive);
        self.first_of_same[mesh].iter().position(|first| *first == place).unwrap_or(drawable.primitive)
    }

    /// Moves every instance to its place in `moved`, which are those of the scene in its order. Returns the range of
    /// instances that are elsewhere now; `None`, and nothing has changed, where they are not the same meshes of the same
    /// handedness, so that other draws are needed.
    pub fn move_instances(&mut self, moved: &[Instance]) -> Option<Range<usize>> {
        let is_alike = |(placed, &instance): (&PlacedInstance, &Instance)| {
            (placed.instance.mesh, placed.mirrored) == (instance.mesh, is_mirrored(&instance))
        };
        if self.instances.len() != moved.len() || !self.instances.iter().zip(moved).all(is_alike) {
            return None;
        }
        let has_moved = |index: &usize| self.instances[*index].instance != moved[*index];
        let Some(first) = (0..moved.len()).find(has_moved) else { return Some(0..0) };
        let last = (first..moved.len()).rfind(has_moved).unwrap_or(first);
        for (placed, instance) in self.instances[first..=last].iter_mut().zip(&moved[first..=last]) {
            placed.instance = *instance;
        }
        let origin_from_world = DMat4::from_translation(-self.origin_in_world);
        let Placements { instances, boxes } = &mut self.placements;
        for drawable in &mut self.draws {
            let mut any = false;
            for placement in drawable.placements.clone() {
                let instance = instances[placement] as usize;
                if (first..=last).contains(&instance) {
                    boxes.set(placement, &drawable.object, &(origin_from_world * moved[instance].world_from_object));
                    any = true;
                }
            }
            if any {
                drawable.bounds = boxes.union(drawable.placements.clone());
            }
        }
        Some(first..last + 1)
    }

    /// Adds one drawable for all of `same`.
    fn add(&mut self, scene: &Scene, features: SceneFeatures, same: &[Use]) {
        let (mesh, index) = same[0].place;
        let primitive = &scene.meshes[mesh].primitives[index];
        let start = self.placements.instances.len();
        let object = object_bounds(primitive);
        let origin_from_world = DMat4::from_translation(-self.origin_in_world);
        for &Use { instance, .. } in same {
            let world_from_object = &self.instances[instance as usize].instance.world_from_object;
            self.placements.instances.push(instance);
            self.placements.boxes.push(&object, &(origin_from_world * *world_from_object));
        }
        let placements = start..self.placements.instances.len();
        let material_features = MaterialFeatures::of(&scene.materials[primitive.material], primitive, scene, features);
        self.draws.push(Drawable {
            mesh,
            primitive: index,
            material: primitive.material,
            material_features,
            vertex_features: VertexFeatures::of(&material_features, primitive),
            topology: primitive.topology,
            mirrored: same[0].mirrored,
            object,
            bounds: self.placements.boxes.union(placements.clone()),
            placements,
        });
    }
}

impl Drawable {
    /// Whether it is drawn back to front, over what is behind it.
    pub fn is_blended(&self) -> bool {
        self.material_features.alpha == Alpha::Blend
    }
}

fn place(instance: Instance) -> PlacedInstance {
    PlacedInstance { instance, mirrored: is_mirrored(&instance) }
}

fn is_mirrored(instance: &Instance) -> bool {
    instance.world_from_object.determinant() < 0.0
}

/// Every primitive at every instance that has something to draw, those that are drawn together side by side.
fn uses(scene: &Scene, instances: &[PlacedInstance], first_of_same: &[Vec<PrimitivePlace>]) -> Vec<Use> {
    let mut uses = Vec::new();
    for (index, placed) in (0..).zip(instances) {
        let mesh = placed.instance.mesh;
        let drawn = scene.meshes[mesh].primitives.iter().zip(&first_of_same[mesh]);
        let drawn = drawn.filter(|(primitive, _)| !primitive.indices.is_empty());
        uses.extend(drawn.map(|(_, &place)| Use { place, mirrored: placed.mirrored, instance: index }));
    }
    uses.sort_by_key(|found| (found.place, found.mirrored));
    uses
}

fn object_bounds(primitive: &Primitive) -> Bounds {
    let mut bounds = Bounds::EMPTY;
    for position in &primitive.positions {
        bounds.grow(position.as_dvec3());
    }
    bounds
}
