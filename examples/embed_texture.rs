//! A host's textures in a scene of ours: what its own renderer draws is on a screen, frame by frame and without an upload,
//! and its sky lights the balls before it.
//!
//! `cargo run --release --example embed_texture` writes `docs/pictures/embed_texture.png`.

mod host;

use host::{Attachments, Block, Host, clip_from_world, read, save};
use specula::bake::environment::bake;
use specula::embed::{EnvironmentDownload, LiveScene};
use specula::glam::{DMat4, DVec3, UVec2, Vec2, Vec3, Vec4};
use specula::gpu::{Gpu, GpuOptions, GpuRequest, formats};
use specula::progress::Silent;
use specula::renderer::{FrameState, HostTarget, HostView, Output, PassFormat, Renderer};
use specula::scene::{
    Background, Environment, Image, Material, Mesh, Node, Pixels, Primitive, Sampler, Scene, Texture, TextureRef,
    TextureSlot, Topology, UvTransform, View, framing::default_view, shapes,
};
use specula::wgpu;
use std::sync::Arc;

type Failure = Box<dyn std::error::Error>;

pub(crate) const SIZE_PX: UVec2 = UVec2::new(480, 270);
const SCREEN_PX: UVec2 = UVec2::new(320, 180);
const SKY_PX: UVec2 = UVec2::new(128, 64);

#[allow(dead_code, reason = "tests take the picture alone")]
fn main() -> Result<(), Failure> {
    let gpu = Gpu::open(&GpuRequest::default(), GpuOptions::default())?;
    save("embed_texture", SIZE_PX, &Room::new(&gpu)?.picture(&gpu, 0.5)?)
}

/// Display light, as a window has it.
fn pass() -> PassFormat {
    PassFormat { color: formats::CAPTURED_DISPLAY, depth: None, output: Output::Display, ..PassFormat::own(4) }
}

/// What the host's renderer draws the screen's picture with: it makes no mipmaps.
fn screen_pass() -> PassFormat {
    PassFormat { color: formats::COLOR_TEXTURE, ..PassFormat::own(1) }
}

/// The host's renderer, and ours.
pub(crate) struct Room {
    host: Host,
    screen: Attachments,
    window: Attachments,
    renderer: Renderer,
    pub(crate) scene: LiveScene,
    view: View,
    state: FrameState,
}

impl Room {
    pub(crate) fn new(gpu: &Gpu) -> Result<Self, Failure> {
        let (device, queue) = (&gpu.device, &gpu.queue);
        let block = |x: f32, color| Block { center: Vec3::new(x, 0.0, 0.0), half: Vec3::new(0.3, 0.8, 0.3), color };
        let blocks = [
            block(-1.2, Vec3::new(0.8, 0.2, 0.1)),
            block(0.0, Vec3::new(0.1, 0.6, 0.2)),
            block(1.2, Vec3::new(0.1, 0.2, 0.8)),
        ];
        let screen = Attachments::new(device, &screen_pass(), SCREEN_PX);
        let renderer = Renderer::new(device, queue);
        let mut scene = LiveScene::new();
        let asset = asset();
        let model = scene.insert(&asset)?;
        scene.set_image(&renderer, model, 0, screen.color.clone())?;

        // The host's sky comes back when the host's queue and device get to it; a host would go on with its frames.
        let mut encoder = device.create_command_encoder(&Default::default());
        let sky = EnvironmentDownload::record(device, &mut encoder, &sky(gpu))?;
        queue.submit([encoder.finish()]);
        gpu.wait()?;
        let sky = Environment::new(sky.try_image().ok_or("the sky has not come")??);
        let maps = bake(&sky.image, &Default::default(), &Silent);
        scene.set_environment(Some((sky, Arc::new(maps))));

        let camera = host::camera_at(DVec3::new(-1.2, 0.6, 6.6), 0.1);
        Ok(Self {
            host: Host::new(device, &screen_pass(), &blocks),
            screen,
            window: Attachments::new(device, &pass(), SIZE_PX),
            renderer,
            scene,
            view: View { camera, background: Background::Environment, ..default_view(&asset, SIZE_PX) },
            state: FrameState::default(),
        })
    }

    /// The room while the host looks at its blocks from an angle, rad.
    pub(crate) fn picture(&mut self, gpu: &Gpu, angle_rad: f64) -> Result<Vec<u8>, Failure> {
        let device = (&gpu.device, &gpu.queue);
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        // The host's own picture.
        let eye = DVec3::new(6.0 * angle_rad.sin(), 1.5, 6.0 * angle_rad.cos());
        self.host.look(&gpu.queue, clip_from_world(&host::camera_at(eye, 0.1), SCREEN_PX, &screen_pass()));
        let clear = wgpu::Color { r: 0.02, g: 0.03, b: 0.05, a: 1.0 };
        self.host.draw(&mut self.screen.begin(&mut encoder, &screen_pass(), clear));
        // Ours, in which that one is seen.
        let scene = self.scene.update(&self.renderer, device)?;
        let target = HostTarget {
            color: &self.window.color,
            resolve: self.window.resolve.as_ref(),
            load: wgpu::LoadOp::Clear(wgpu::Color::BLACK),
            depth: None,
            depth_load: wgpu::LoadOp::Load,
        };
        let mut views = [HostView { view: &self.view, at_px: UVec2::ZERO, state: &mut self.state }];
        self.renderer.encode(device, &mut encoder, scene, &mut views, (&pass(), &target))?;
        Ok(read(gpu, encoder, self.window.picture())?)
    }
}

/// Warm light from the left, cool from the right, and dark ground: half floats on the host's device.
fn sky(gpu: &Gpu) -> wgpu::Texture {
    let texel = |i: u32| {
        let (x, y) = (i % SKY_PX.x, i / SKY_PX.x);
        let side = (x as f32 / SKY_PX.x as f32 * std::f32::consts::TAU).sin();
        let up = (1.0 - 2.0 * y as f32 / SKY_PX.y as f32).max(-0.2) + 0.25;
        let light = Vec3::new(0.9, 0.6, 0.4).lerp(Vec3::new(0.3, 0.5, 0.9), 0.5 + 0.5 * side) * up;
        light.extend(1.0).to_array().map(half::f16::from_f32)
    };
    let texels: Vec<[half::f16; 4]> = (0..SKY_PX.element_product()).map(texel).collect();
    let size = wgpu::Extent3d { width: SKY_PX.x, height: SKY_PX.y, depth_or_array_layers: 1 };
    let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some("the host's sky"),
        size,
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: formats::ENVIRONMENT,
        usage: wgpu::TextureUsages::COPY_DST | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    });
    let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(8 * SKY_PX.x), rows_per_image: None };
    gpu.queue.write_texture(texture.as_image_copy(), bytemuck::cast_slice(&texels), layout, size);
    texture
}

/// A screen that shows what the host has drawn, a steel ball and a white one.
fn asset() -> Scene {
    let mut screen = Material { unlit: true, ..Default::default() };
    let texture = TextureRef { texture: 0, uv_set: 0, transform: UvTransform::IDENTITY };
    screen.set_texture(TextureSlot::BaseColor, Some(texture));
    let ball = |metallic, perceptual_roughness| Material {
        base_color: Vec4::new(0.8, 0.8, 0.8, 1.0),
        metallic,
        perceptual_roughness,
        ..Default::default()
    };
    let corners = [Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y];
    let quad = Primitive {
        topology: Topology::Triangles,
        positions: corners.map(|at| Vec3::new(3.2 * at.x - 1.6, 0.9 - 1.8 * at.y, 0.0)).to_vec(),
        normals: Some(vec![Vec3::Z; 4]),
        tangents: None,
        uvs: vec![corners.to_vec()],
        colors: None,
        indices: vec![0, 3, 2, 0, 2, 1],
        material: 0,
    };
    let mesh = |primitive| Mesh { name: None, primitives: vec![primitive] };
    let node = |(mesh, place): (usize, DVec3)| Node {
        parent_from_node: DMat4::from_translation(place),
        mesh: Some(mesh),
        ..Default::default()
    };
    let places = [DVec3::ZERO, DVec3::new(-1.5, -0.6, 1.2), DVec3::new(0.9, -0.7, 1.0)];
    Scene {
        nodes: places.into_iter().enumerate().map(node).collect(),
        roots: vec![0, 1, 2],
        meshes: vec![mesh(quad), mesh(shapes::sphere(0.5, 48, 1)), mesh(shapes::sphere(0.4, 48, 2))],
        materials: vec![screen, ball(1.0, 0.15), ball(0.0, 0.6)],
        images: vec![Image { name: None, width: SCREEN_PX.x, height: SCREEN_PX.y, pixels: Pixels::OfHost }],
        textures: vec![Texture { image: 0, sampler: Sampler { mip_linear: None, ..Default::default() } }],
        ..Default::default()
    }
}
