//! Models side by side in one [`Scene`].

use crate::scene::{Material, Mesh, Node, Scene, Texture, TextureRef, TextureSlot};
use std::ops::Range;

/// How many of each there are.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) struct Counts {
    pub(super) nodes: usize,
    pub(super) meshes: usize,
    pub(super) materials: usize,
    pub(super) textures: usize,
    pub(super) images: usize,
    pub(super) lights: usize,
}

/// What of a scene is one model's. Its first node is its root.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Model {
    pub(super) first: Counts,
    pub(super) count: Counts,
}

/// Which way indices are moved.
#[derive(Clone, Copy)]
enum Shift {
    Up(Counts),
    Down(Counts),
}

impl Shift {
    fn by(self, index: &mut usize, of: impl Fn(&Counts) -> usize) {
        match self {
            Self::Up(counts) => *index += of(&counts),
            Self::Down(counts) => *index -= of(&counts),
        }
    }
}

impl Counts {
    fn of(scene: &Scene) -> Self {
        Self {
            nodes: scene.nodes.len(),
            meshes: scene.meshes.len(),
            materials: scene.materials.len(),
            textures: scene.textures.len(),
            images: scene.images.len(),
            lights: scene.lights.len(),
        }
    }

    fn less(self, other: Self) -> Self {
        Self {
            nodes: self.nodes - other.nodes,
            meshes: self.meshes - other.meshes,
            materials: self.materials - other.materials,
            textures: self.textures - other.textures,
            images: self.images - other.images,
            lights: self.lights - other.lights,
        }
    }
}

/// Adds what is drawn of `asset` under a root of its own; cameras and the environment are left out.
pub(super) fn append(scene: &mut Scene, asset: &Scene) -> Model {
    let first = Counts::of(scene);
    scene.roots.push(scene.nodes.len());
    scene.nodes.push(Node { children: asset.roots.clone(), ..Default::default() });
    scene.nodes.extend(asset.nodes.iter().map(|node| Node { camera: None, ..node.clone() }));
    scene.meshes.extend_from_slice(&asset.meshes);
    scene.materials.extend_from_slice(&asset.materials);
    scene.textures.extend_from_slice(&asset.textures);
    scene.images.extend_from_slice(&asset.images);
    scene.lights.extend_from_slice(&asset.lights);
    shift(scene, first, Shift::Up(first));
    // Behind the root, which the asset does not have.
    for node in &mut scene.nodes[first.nodes..] {
        node.children.iter_mut().for_each(|child| *child += 1);
    }
    Model { first, count: Counts::of(scene).less(first) }
}

/// Takes a model out. Those behind it move up, see [`moved_up`].
pub(super) fn remove(scene: &mut Scene, model: &Model) {
    let Model { first, count } = *model;
    let range = |of: fn(&Counts) -> usize| -> Range<usize> { of(&first)..of(&first) + of(&count) };
    scene.nodes.drain(range(|c| c.nodes));
    scene.meshes.drain(range(|c| c.meshes));
    scene.materials.drain(range(|c| c.materials));
    scene.textures.drain(range(|c| c.textures));
    scene.images.drain(range(|c| c.images));
    scene.lights.drain(range(|c| c.lights));
    shift(scene, first, Shift::Down(count));
    scene.roots.retain(|&root| root != first.nodes);
    scene.roots.iter_mut().filter(|root| **root > first.nodes).for_each(|root| *root -= count.nodes);
}

/// Where a model is after `removed` was taken out before it.
pub(super) fn moved_up(model: &Model, removed: &Model) -> Model {
    if model.first.nodes < removed.first.nodes {
        return *model;
    }
    Model { first: model.first.less(removed.count), count: model.count }
}

/// Moves the indices of all that lies behind `first`, which refers to nothing before it.
fn shift(scene: &mut Scene, first: Counts, shift: Shift) {
    for Node { children, mesh, light, .. } in &mut scene.nodes[first.nodes..] {
        children.iter_mut().for_each(|child| shift.by(child, |c| c.nodes));
        mesh.iter_mut().for_each(|mesh| shift.by(mesh, |c| c.meshes));
        light.iter_mut().for_each(|light| shift.by(light, |c| c.lights));
    }
    for Mesh { primitives, .. } in &mut scene.meshes[first.meshes..] {
        primitives.iter_mut().for_each(|primitive| shift.by(&mut primitive.material, |c| c.materials));
    }
    scene.materials[first.materials..].iter_mut().for_each(|material| shift_textures(material, shift));
    for Texture { image, .. } in &mut scene.textures[first.textures..] {
        shift.by(image, |c| c.images);
    }
}

/// The material of an asset as that of its model.
pub(super) fn of_model(mut material: Material, model: &Model) -> Material {
    shift_textures(&mut material, Shift::Up(model.first));
    material
}

fn shift_textures(material: &mut Material, shift: Shift) {
    for slot in TextureSlot::ALL {
        let Some(&TextureRef { mut texture, uv_set, transform }) = material.texture(slot) else { continue };
        shift.by(&mut texture, |c| c.textures);
        material.set_texture(slot, Some(TextureRef { texture, uv_set, transform }));
    }
}
