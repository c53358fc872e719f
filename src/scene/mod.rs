//! What is to be drawn, as plain data that has been checked: no file, no GPU.
//!
//! Importers produce a [`Scene`]; the renderer and the CPU reference both take it together with a [`View`].
//! World space is right-handed, +Y up, in metres. Every index held here is valid: importers check, readers index.

mod camera;
mod channel;
mod disney;
pub mod disney_grid;
mod environment;
pub mod framing;
mod image;
mod light;
pub mod light_field;
mod material;
mod mesh;
pub mod patches;
mod placed;
pub mod shapes;
mod spot_cone;
mod view;

pub use camera::{Camera, Projection};
pub use channel::{Channel, Component, Components, Input, LightSource, Number, from_digits};
pub use disney::Disney;
pub use environment::{Environment, EnvironmentImage, EnvironmentMaps, MAX_SUNS, SpecularTile, Sun};
pub use image::{Encoding, Image, Picture, Pixels, RadianceImage, Sampler, Texture, Wrap};
pub use light::{Light, LightInWorld, LightKind};
pub use material::{AlphaMode, Material, MetalFresnel, TextureRef, TextureSlot, UvTransform};
pub use mesh::{Mesh, Primitive, Topology};
pub use placed::Placed;
pub use spot_cone::SpotCone;
pub use view::{Background, Geometry, Quality, Term, ToneMap, View};

use glam::{DMat4, DVec3};

/// A node of the scene graph: a local transform, children, and what hangs on it.
#[derive(Debug, Clone, Default)]
pub struct Node {
    pub name: Option<String>,
    pub parent_from_node: DMat4,
    pub children: Vec<usize>,
    pub mesh: Option<usize>,
    /// Where the mesh is placed around the node, if not once and at the node itself (EXT_mesh_gpu_instancing).
    pub node_from_objects: Option<Vec<DMat4>>,
    pub camera: Option<usize>,
    pub light: Option<usize>,
}

/// A scene: geometry, materials, textures, lights, cameras and the environment around them.
#[derive(Debug, Clone, Default)]
pub struct Scene {
    pub name: Option<String>,
    /// All nodes; each is the child of at most one other, and there is no cycle.
    pub nodes: Vec<Node>,
    /// Nodes without a parent that belong to this scene.
    pub roots: Vec<usize>,
    pub meshes: Vec<Mesh>,
    pub materials: Vec<Material>,
    pub textures: Vec<Texture>,
    pub images: Vec<Image>,
    pub cameras: Vec<Camera>,
    pub lights: Vec<Light>,
    /// Light from infinitely far away, and what is seen there; `None` is black.
    pub environment: Option<Environment>,
}

/// A mesh placed in the world.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Instance {
    pub node: usize,
    pub mesh: usize,
    pub world_from_object: DMat4,
}

/// An axis-aligned box; empty when `min > max`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    pub min: DVec3,
    pub max: DVec3,
}

impl Bounds {
    pub const EMPTY: Self = Self { min: DVec3::INFINITY, max: DVec3::NEG_INFINITY };

    pub fn is_empty(&self) -> bool {
        !self.min.cmple(self.max).all()
    }

    pub fn grow(&mut self, point: DVec3) {
        self.min = self.min.min(point);
        self.max = self.max.max(point);
    }

    pub fn center(&self) -> DVec3 {
        0.5 * (self.min + self.max)
    }

    pub fn diagonal(&self) -> f64 {
        if self.is_empty() { 0.0 } else { (self.max - self.min).length() }
    }

    pub fn corners(&self) -> [DVec3; 8] {
        std::array::from_fn(|i| {
            DVec3::new(
                if i & 1 == 0 { self.min.x } else { self.max.x },
                if i & 2 == 0 { self.min.y } else { self.max.y },
                if i & 4 == 0 { self.min.z } else { self.max.z },
            )
        })
    }
}

impl Scene {
    /// The environment, unless it is as dark as none.
    pub fn lit_environment(&self) -> Option<&Environment> {
        self.environment.as_ref().filter(|environment| environment.intensity > 0.0)
    }

    /// Every camera of the scene where its node puts it; scale and shear of the node have no effect.
    pub fn cameras_in_world(&self) -> Vec<Camera> {
        let place = |(node, world_from_node): (usize, DMat4)| {
            let camera = &self.cameras[self.nodes[node].camera?];
            let eye = world_from_node.transform_point3(DVec3::ZERO);
            let [backward, up] = [DVec3::Z, DVec3::Y].map(|axis| world_from_node.transform_vector3(axis));
            let target = eye - backward.normalize_or(DVec3::Z);
            let rigid = Camera::look_at(eye, target, up, camera.projection, camera.near_m, camera.far_m);
            Some(Camera { name: camera.name.clone(), ..rigid })
        };
        self.world_transforms().into_iter().filter_map(place).collect()
    }

    /// Bounds of all placed vertices, in world space. Empty when nothing is placed.
    pub fn bounds(&self) -> Bounds {
        let mut bounds = Bounds::EMPTY;
        for instance in self.instances() {
            for primitive in &self.meshes[instance.mesh].primitives {
                for position in &primitive.positions {
                    let point = instance.world_from_object.transform_point3(position.as_dvec3());
                    if point.is_finite() {
                        bounds.grow(point);
                    }
                }
            }
        }
        bounds
    }
}
