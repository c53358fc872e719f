//! Pictures of many models through one device: what a model takes is given back with it, and pipelines are shared by all
//! that need the same.
//!
//! `cargo run --release --example offscreen_server` writes `docs/pictures/offscreen_server.png`, a sheet of the pictures.

mod host;

use host::{Attachments, read, save};
use specula::embed::LiveScene;
use specula::glam::{DMat4, DVec3, UVec2, Vec4};
use specula::gpu::{Gpu, GpuOptions, GpuRequest, formats};
use specula::renderer::{FrameState, HostTarget, HostView, Output, PassFormat, Renderer};
use specula::scene::{Background, Light, LightKind, Material, Mesh, Node, Scene, View, framing::default_view, shapes};
use specula::wgpu;

type Failure = Box<dyn std::error::Error>;

pub(crate) const PART_PX: UVec2 = UVec2::new(60, 60);
const COLUMNS: u32 = 8;

#[allow(dead_code, clippy::print_stdout, reason = "tests take the pictures alone; figures are output")]
fn main() -> Result<(), Failure> {
    let gpu = Gpu::open(&GpuRequest::default(), GpuOptions::default())?;
    let mut server = Server::new(&gpu);
    let rows = 4;
    let size_px = UVec2::new(COLUMNS, rows) * PART_PX;
    let mut sheet = vec![0; 4 * size_px.element_product() as usize];
    for job in 0..COLUMNS * rows {
        let picture = server.picture(&gpu, job)?;
        let corner = UVec2::new(job % COLUMNS, job / COLUMNS) * PART_PX;
        for (y, row) in (corner.y..).zip(picture.chunks_exact(4 * PART_PX.x as usize)) {
            let at = 4 * (y * size_px.x + corner.x) as usize;
            sheet[at..at + row.len()].copy_from_slice(row);
        }
        if job % COLUMNS == COLUMNS - 1 {
            println!("{} pictures: {} bytes on the device", job + 1, allocated_bytes(&gpu).unwrap_or_default());
        }
    }
    save("offscreen_server", size_px, &sheet)
}

/// What the device holds, where its backend counts.
pub(crate) fn allocated_bytes(gpu: &Gpu) -> Option<u64> {
    Some(gpu.device.generate_allocator_report()?.total_allocated_bytes)
}

/// One renderer and one target for all jobs.
#[derive(Debug)]
pub(crate) struct Server {
    renderer: Renderer,
    attachments: Attachments,
    pass: PassFormat,
}

impl Server {
    pub(crate) fn new(gpu: &Gpu) -> Self {
        let pass =
            PassFormat { color: formats::CAPTURED_DISPLAY, depth: None, output: Output::Display, ..PassFormat::own(4) };
        Self {
            renderer: Renderer::new(&gpu.device, &gpu.queue),
            attachments: Attachments::new(&gpu.device, &pass, PART_PX),
            pass,
        }
    }

    /// Draws the model of a job and lets go of it.
    pub(crate) fn picture(&mut self, gpu: &Gpu, job: u32) -> Result<Vec<u8>, Failure> {
        let (device, model) = ((&gpu.device, &gpu.queue), model(job));
        let (mut scene, mut state) = (LiveScene::new(), FrameState::default());
        scene.insert(&model)?;
        let view = View { background: Background::Transparent, ..default_view(&model, PART_PX) };
        let target = HostTarget {
            color: &self.attachments.color,
            resolve: self.attachments.resolve.as_ref(),
            load: wgpu::LoadOp::Clear(wgpu::Color { r: 0.1, g: 0.1, b: 0.12, a: 1.0 }),
            depth: None,
            depth_load: wgpu::LoadOp::Load,
        };
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let mut views = [HostView { view: &view, at_px: UVec2::ZERO, state: &mut state }];
        let uploaded = scene.update(&self.renderer, device)?;
        self.renderer.encode(device, &mut encoder, uploaded, &mut views, (&self.pass, &target))?;
        Ok(read(gpu, encoder, self.attachments.picture())?)
    }
}

/// A few balls around each other, others for each job.
fn model(job: u32) -> Scene {
    let number = |salt: u32| f64::from((job * 31 + salt + 1).wrapping_mul(2_654_435_761) >> 8) / f64::from(1_u32 << 24);
    let count = 2 + job as usize % 4;
    let node = |i: u32| {
        let place = DVec3::new(number(3 * i), number(3 * i + 1), number(3 * i + 2)) * 2.0;
        let parent_from_node =
            DMat4::from_translation(place) * DMat4::from_scale(DVec3::splat(0.4 + 0.5 * number(i + 20)));
        Node { parent_from_node, mesh: Some(0), ..Default::default() }
    };
    let mut scene = Scene {
        nodes: (0..count as u32).map(node).collect(),
        roots: (0..count).collect(),
        meshes: vec![Mesh { name: None, primitives: vec![shapes::sphere(1.0, 32, 0)] }],
        materials: vec![Material {
            base_color: Vec4::new(number(40) as f32, number(41) as f32, number(42) as f32, 1.0),
            metallic: (job % 2) as f32,
            perceptual_roughness: 0.3,
            ..Default::default()
        }],
        ..Default::default()
    };
    let sun = Light { name: None, kind: LightKind::Directional, color: DVec3::ONE, intensity: 4.0 };
    scene.add_light(sun, DVec3::ZERO, DVec3::new(-0.5, -0.8, -0.6).normalize());
    scene
}
