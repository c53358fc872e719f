//! A model in somebody else's frame: the host draws a floor and pillars in its own forward pass, with a depth buffer that
//! is not reversed and ends at 60 m; then three balls are recorded into its encoder. Pillars hide balls and balls hide
//! pillars.
//!
//! `cargo run --release --example embed_encode` writes `docs/pictures/embed_encode.png`.

mod host;

use host::{Attachments, Block, Host, clip_from_world, read, save};
use specula::bake::environment::bake;
use specula::glam::{DMat4, DVec3, UVec2, Vec3, Vec4};
use specula::gpu::pipeline::DepthTarget;
use specula::gpu::{Gpu, GpuOptions, GpuRequest, formats};
use specula::progress::Silent;
use specula::renderer::{FrameState, HostTarget, HostView, PassFormat, Renderer};
use specula::scene::{Background, Environment, Material, Mesh, Node, Scene, View, framing::default_view, shapes};
use specula::wgpu;

type Failure = Box<dyn std::error::Error>;

pub(crate) const SIZE_PX: UVec2 = UVec2::new(480, 270);

#[allow(dead_code, reason = "tests take the picture alone")]
fn main() -> Result<(), Failure> {
    let gpu = Gpu::open(&GpuRequest::default(), GpuOptions::default())?;
    save("embed_encode", SIZE_PX, &picture(&gpu, &balls())?)
}

/// Gold, red plastic and steel, one behind the other.
pub(crate) fn balls() -> Scene {
    let ball = |color: [f32; 3], metallic, perceptual_roughness| Material {
        base_color: Vec4::new(color[0], color[1], color[2], 1.0),
        metallic,
        perceptual_roughness,
        ..Default::default()
    };
    let materials =
        vec![ball([1.0, 0.77, 0.34], 1.0, 0.2), ball([0.8, 0.05, 0.04], 0.0, 0.3), ball([0.6; 3], 1.0, 0.1)];
    let places = [DVec3::new(-2.1, 0.0, 1.2), DVec3::ZERO, DVec3::new(2.1, 0.0, -1.2)];
    let node = |(mesh, place)| Node {
        parent_from_node: DMat4::from_translation(place),
        mesh: Some(mesh),
        ..Default::default()
    };
    let mesh = |material| Mesh { name: None, primitives: vec![shapes::sphere(1.0, 64, material)] };
    Scene {
        nodes: places.into_iter().enumerate().map(node).collect(),
        roots: vec![0, 1, 2],
        meshes: (0..3).map(mesh).collect(),
        materials,
        environment: Some(Environment::new(specula::bake::studio::studio())),
        ..Default::default()
    }
}

fn blocks() -> Vec<Block> {
    let pillar =
        |x: f32, z: f32, color| Block { center: Vec3::new(x, 0.5, z), half: Vec3::new(0.14, 1.5, 0.14), color };
    let floor = Block { center: Vec3::new(0.0, -1.1, 0.0), half: Vec3::new(4.0, 0.1, 3.0), color: Vec3::splat(0.12) };
    vec![
        floor,
        pillar(-2.6, 2.4, Vec3::new(0.1, 0.35, 0.6)),
        // Through the red ball.
        pillar(0.35, 0.7, Vec3::new(0.1, 0.5, 0.25)),
        pillar(1.5, -2.2, Vec3::new(0.6, 0.35, 0.05)),
    ]
}

/// The host's frame with a model in it.
pub(crate) fn picture(gpu: &Gpu, model: &Scene) -> Result<Vec<u8>, Failure> {
    let (device, queue) = (&gpu.device, &gpu.queue);
    // What the host has: it knows nothing of us.
    let pass = PassFormat {
        depth: Some(DepthTarget { format: wgpu::TextureFormat::Depth24Plus, reversed: false }),
        far_m: Some(60.0),
        ..PassFormat::own(4)
    };
    let camera = host::camera_at(DVec3::new(1.5, 2.5, 10.0), 0.1);
    let (hdr, host) = (Attachments::new(device, &pass, SIZE_PX), Host::new(device, &pass, &blocks()));
    let display = Attachments::new(
        device,
        &PassFormat { color: formats::CAPTURED_DISPLAY, depth: None, ..PassFormat::own(1) },
        SIZE_PX,
    );

    // What it keeps of us.
    let mut renderer = Renderer::new(device, queue);
    let maps = model.environment.as_ref().map(|environment| bake(&environment.image, &Default::default(), &Silent));
    let mut scene = renderer.upload(device, queue, model, maps.as_ref())?;
    let mut state = FrameState::default();

    // A frame.
    let mut encoder = device.create_command_encoder(&Default::default());
    host.look(queue, clip_from_world(&camera, SIZE_PX, &pass));
    host.draw(&mut hdr.begin(&mut encoder, &pass, wgpu::Color { r: 0.3, g: 0.45, b: 0.7, a: 1.0 }));
    let view = View { camera, background: Background::Transparent, ..default_view(model, SIZE_PX) };
    let target = HostTarget {
        color: &hdr.color,
        resolve: hdr.resolve.as_ref(),
        load: wgpu::LoadOp::Load,
        depth: hdr.depth.as_ref(),
        depth_load: wgpu::LoadOp::Load,
    };
    let mut views = [HostView { view: &view, at_px: UVec2::ZERO, state: &mut state }];
    renderer.encode((device, queue), &mut encoder, &mut scene, &mut views, (&pass, &target))?;

    // The host's own tone map would stand here.
    let radiance = hdr.resolve.as_ref().unwrap_or(&hdr.color);
    let shown = (&display.color, formats::CAPTURED_DISPLAY);
    renderer.encode_display((device, queue), &mut encoder, &view, radiance, shown, &mut state)?;
    Ok(read(gpu, encoder, display.picture())?)
}
