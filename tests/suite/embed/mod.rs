//! Frames in other people's passes.

mod api;
mod counts;
mod crates;
mod edits;
#[path = "../../../examples/embed_cost.rs"]
mod embed_cost;
mod examples;
#[path = "../../../examples/host/mod.rs"]
mod host;
mod hosted;
mod lifetime;
mod lost;
mod mixing;
mod passes;
mod picking;
mod quiet;
mod steady;

use crate::support::{add_light, front_view, sphere_scene};
use glam::{DVec3, UVec2, Vec3, Vec4};
use host::{Block, camera_at};
use specula::gpu::Gpu;
use specula::scene::{AlphaMode, LightKind, Material, Mesh, Node, Primitive, Scene, Topology, View};

const SIZE_PX: UVec2 = UVec2::new(160, 120);

/// A lit sphere about the origin, and a smaller one of glass on either side, so that everything is around the origin.
fn model() -> Scene {
    let mut scene = sphere_scene(Material {
        base_color: Vec4::new(0.9, 0.5, 0.2, 1.0),
        metallic: 0.0,
        perceptual_roughness: 0.4,
        ..Default::default()
    });
    scene.materials.push(Material {
        base_color: Vec4::new(0.3, 0.6, 0.9, 0.5),
        alpha_mode: AlphaMode::Blend,
        ..Default::default()
    });
    scene.meshes.push(Mesh { name: None, primitives: vec![specula::scene::shapes::sphere(0.5, 32, 1)] });
    for x in [-1.1, 1.1] {
        let parent_from_node = glam::DMat4::from_translation(DVec3::new(x, 0.0, x));
        scene.roots.push(scene.nodes.len());
        scene.nodes.push(Node { parent_from_node, mesh: Some(1), ..Default::default() });
    }
    add_light(&mut scene, LightKind::Directional, 3.0, DVec3::ZERO);
    add_light(&mut scene, LightKind::Point { range_m: None }, 60.0, DVec3::new(2.0, 3.0, 4.0));
    scene
}

/// A beam through the sphere: before it on one side, hidden in and behind it on the other.
fn beam() -> Block {
    Block { center: Vec3::ZERO, half: Vec3::new(0.2, 0.3, 2.0), color: Vec3::new(0.2, 0.7, 0.3) }
}

/// The model and the block, which shows its colour without light.
fn model_and(block: &Block) -> Scene {
    let mut scene = model();
    let (positions, indices) = block.triangles();
    let material = scene.materials.len();
    scene.materials.push(Material { base_color: block.color.extend(1.0), unlit: true, ..Default::default() });
    let primitive = Primitive {
        topology: Topology::Triangles,
        normals: Some(vec![Vec3::Z; positions.len()]),
        positions,
        tangents: None,
        uvs: Vec::new(),
        colors: None,
        indices,
        material,
    };
    scene.roots.push(scene.nodes.len());
    scene.nodes.push(Node { mesh: Some(scene.meshes.len()), ..Default::default() });
    scene.meshes.push(Mesh { name: None, primitives: vec![primitive] });
    scene
}

fn view() -> View {
    View { camera: camera_at(DVec3::new(2.5, 1.5, 4.0), 0.1), size_px: SIZE_PX, ..front_view(1) }
}

fn encoder(gpu: &Gpu) -> wgpu::CommandEncoder {
    encoder_of(&gpu.device)
}

fn encoder_of(device: &wgpu::Device) -> wgpu::CommandEncoder {
    device.create_command_encoder(&Default::default())
}

/// How many texels of two pictures differ by more than `by` in any byte.
fn differing(a: &[u8], b: &[u8], texel_bytes: usize, by: u8) -> usize {
    assert_eq!(a.len(), b.len());
    let differs = |(a, b): (&[u8], &[u8])| a.iter().zip(b).any(|(a, b)| a.abs_diff(*b) > by);
    a.chunks_exact(texel_bytes).zip(b.chunks_exact(texel_bytes)).filter(|pair| differs(*pair)).count()
}
