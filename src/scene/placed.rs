//! What the nodes of a scene place in the world.

use super::{Instance, LightInWorld, Node, Scene};
use glam::DMat4;

/// Nodes, mesh instances and lights at their places. Kept from one placing to the next, it allocates nothing once it has
/// seen the largest scene.
#[derive(Debug, Clone, Default)]
pub struct Placed {
    pending: Vec<(usize, DMat4)>,
    nodes: Vec<(usize, DMat4)>,
    instances: Vec<Instance>,
    lights: Vec<LightInWorld>,
}

impl Placed {
    /// Everything of a scene as it is now.
    pub fn place(&mut self, scene: &Scene) {
        self.place_nodes(scene);
        self.instances.clear();
        self.lights.clear();
        for &(index, world_from_node) in &self.nodes {
            let node = &scene.nodes[index];
            place_instances(index, node, world_from_node, &mut self.instances);
            self.lights.extend(node.light.map(|light| scene.lights[light].in_world(&world_from_node)));
        }
    }

    /// Every mesh instance, in depth-first order of the node tree and in the order of each node.
    pub fn instances(&self) -> &[Instance] {
        &self.instances
    }

    /// Every light, in that order.
    pub fn lights(&self) -> &[LightInWorld] {
        &self.lights
    }

    /// Iterative, so that a chain of a hundred thousand nodes costs memory and not stack.
    fn place_nodes(&mut self, scene: &Scene) {
        let Self { pending, nodes, .. } = self;
        nodes.clear();
        pending.clear();
        pending.extend(scene.roots.iter().rev().map(|&root| (root, DMat4::IDENTITY)));
        while let Some((index, world_from_parent)) = pending.pop() {
            let node = &scene.nodes[index];
            let world_from_node = world_from_parent * node.parent_from_node;
            nodes.push((index, world_from_node));
            pending.extend(node.children.iter().rev().map(|&child| (child, world_from_node)));
        }
    }
}

impl Scene {
    /// `world_from_node` of every node reachable from the roots, parents before children; `(node, matrix)` pairs.
    pub fn world_transforms(&self) -> Vec<(usize, DMat4)> {
        let mut placed = Placed::default();
        placed.place_nodes(self);
        placed.nodes
    }

    /// Every mesh instance of the scene, see [`Placed::instances`].
    pub fn instances(&self) -> Vec<Instance> {
        let mut instances = Vec::new();
        for (index, world_from_node) in self.world_transforms() {
            place_instances(index, &self.nodes[index], world_from_node, &mut instances);
        }
        instances
    }

    /// Every light of the scene with its place and direction in the world.
    pub fn lights_in_world(&self) -> Vec<LightInWorld> {
        let place = |(node, world_from_node): (usize, DMat4)| {
            let light = self.nodes[node].light?;
            Some(self.lights[light].in_world(&world_from_node))
        };
        self.world_transforms().into_iter().filter_map(place).collect()
    }
}

fn place_instances(index: usize, node: &Node, world_from_node: DMat4, instances: &mut Vec<Instance>) {
    let Some(mesh) = node.mesh else { return };
    match &node.node_from_objects {
        None => instances.push(Instance { node: index, mesh, world_from_object: world_from_node }),
        Some(placed) => instances.extend(placed.iter().map(|node_from_object| {
            let world_from_object = world_from_node * *node_from_object;
            Instance { node: index, mesh, world_from_object }
        })),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Light, LightKind, Mesh};
    use glam::DVec3;

    #[test]
    fn placing_once_more_is_placing_anew() {
        let mut scene = Scene { meshes: vec![Mesh { name: None, primitives: vec![] }], ..Default::default() };
        let moved = DMat4::from_translation(DVec3::Y);
        let child = Node { mesh: Some(0), node_from_objects: Some(vec![moved, DMat4::IDENTITY]), ..Default::default() };
        let root = Node { parent_from_node: moved, mesh: Some(0), children: vec![1], ..Default::default() };
        (scene.nodes, scene.roots) = (vec![root, child], vec![0]);
        let lamp = Light { name: None, kind: LightKind::Directional, color: DVec3::ONE, intensity: 2.0 };
        scene.add_light(lamp, DVec3::ZERO, DVec3::NEG_Y);
        let mut placed = Placed::default();
        for height in [1.0, 3.0] {
            scene.nodes[0].parent_from_node = DMat4::from_translation(DVec3::Y * height);
            placed.place(&scene);
            assert_eq!(placed.instances(), scene.instances());
            assert_eq!(placed.lights(), scene.lights_in_world());
            let heights = placed.instances().iter().map(|placed| placed.world_from_object.w_axis.y);
            assert!(heights.eq([height, height + 1.0, height]));
        }
    }
}
