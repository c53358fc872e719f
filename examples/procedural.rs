//! A scene made by code: 10 000 bodies that move in every frame, as one draw call, and nothing is uploaded but where they
//! are.
//!
//! `cargo run --release --example procedural` prints what a frame costs and writes `docs/pictures/procedural.png`.

mod host;

use host::{Attachments, read, save};
use specula::embed::{LiveScene, ModelId};
use specula::glam::{DMat4, DVec3, UVec2, Vec4};
use specula::gpu::{Gpu, GpuOptions, GpuRequest, formats};
use specula::renderer::{FrameState, FrameStats, HostTarget, HostView, Output, PassFormat, Renderer};
use specula::scene::{Background, Light, LightKind, Material, Mesh, Node, Scene, View, framing::default_view, shapes};
use specula::wgpu;
use std::time::Instant;

type Failure = Box<dyn std::error::Error>;

const SIDE: usize = 100;
pub(crate) const SIZE_PX: UVec2 = UVec2::new(480, 270);

#[allow(dead_code, clippy::print_stdout, reason = "tests take the picture alone; figures are output")]
fn main() -> Result<(), Failure> {
    let gpu = Gpu::open(&GpuRequest::default(), GpuOptions::default())?;
    let mut field = Field::new(&gpu)?;
    let (mut placing, mut recording) = (Vec::new(), Vec::new());
    for frame in 0..60 {
        let start = Instant::now();
        field.place(f64::from(frame) / 30.0)?;
        let placed = Instant::now();
        let encoder = field.record(&gpu)?.0;
        placing.push((placed - start).as_secs_f64() * 1e3);
        recording.push(placed.elapsed().as_secs_f64() * 1e3);
        gpu.queue.submit([encoder.finish()]);
        gpu.wait()?;
    }
    for (what, mut times) in [("place by the host", placing), ("update and encode", recording)] {
        times.sort_by(f64::total_cmp);
        println!(
            "{what}: {:.2} ms, median of {} frames, at most {:.2}",
            times[times.len() / 2],
            times.len(),
            times[times.len() - 1]
        );
    }
    save("procedural", SIZE_PX, &field.picture(&gpu)?)
}

/// A field of bodies in waves, in a target of display light.
#[derive(Debug)]
pub(crate) struct Field {
    renderer: Renderer,
    pub(crate) scene: LiveScene,
    bodies: ModelId,
    view: View,
    attachments: Attachments,
    state: FrameState,
}

impl Field {
    pub(crate) fn new(gpu: &Gpu) -> Result<Self, Failure> {
        let asset = bodies();
        let mut scene = LiveScene::new();
        let bodies = scene.insert(&asset)?;
        let camera = host::camera_at(DVec3::new(0.0, 9.0, 22.0), 0.1);
        Ok(Self {
            renderer: Renderer::new(&gpu.device, &gpu.queue),
            scene,
            bodies,
            view: View { camera, background: Background::Transparent, ..default_view(&asset, SIZE_PX) },
            attachments: Attachments::new(&gpu.device, &pass(), SIZE_PX),
            state: FrameState::default(),
        })
    }

    /// Where everything is after a time in seconds.
    pub(crate) fn place(&mut self, seconds: f64) -> Result<(), Failure> {
        let place = |i: usize| {
            let (x, z) = ((i % SIDE) as f64 / 5.0 - 9.9, (i / SIDE) as f64 / 5.0 - 9.9);
            let phase = 0.9 * x.hypot(z) - 2.0 * seconds;
            let up = DVec3::new(x, 0.9 * phase.sin(), z);
            (
                i,
                DMat4::from_translation(up)
                    * DMat4::from_rotation_z(phase)
                    * DMat4::from_scale(DVec3::new(0.14, 0.06, 0.09)),
            )
        };
        Ok(self.scene.set_nodes(self.bodies, (0..SIDE * SIDE).map(place))?)
    }

    /// Records a frame into an encoder of its own.
    pub(crate) fn record(&mut self, gpu: &Gpu) -> Result<(wgpu::CommandEncoder, FrameStats), Failure> {
        let device = (&gpu.device, &gpu.queue);
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let scene = self.scene.update(&self.renderer, device)?;
        let target = HostTarget {
            color: &self.attachments.color,
            resolve: self.attachments.resolve.as_ref(),
            load: wgpu::LoadOp::Clear(wgpu::Color { r: 0.05, g: 0.06, b: 0.08, a: 1.0 }),
            depth: None,
            depth_load: wgpu::LoadOp::Load,
        };
        let mut views = [HostView { view: &self.view, at_px: UVec2::ZERO, state: &mut self.state }];
        let stats = self.renderer.encode(device, &mut encoder, scene, &mut views, (&pass(), &target))?;
        Ok((encoder, stats))
    }

    pub(crate) fn picture(&mut self, gpu: &Gpu) -> Result<Vec<u8>, Failure> {
        let encoder = self.record(gpu)?.0;
        Ok(read(gpu, encoder, self.attachments.picture())?)
    }
}

/// Display light as bytes, without a depth buffer of the host's.
fn pass() -> PassFormat {
    PassFormat { color: formats::CAPTURED_DISPLAY, depth: None, output: Output::Display, ..PassFormat::own(4) }
}

/// One mesh, many nodes, two suns.
fn bodies() -> Scene {
    let material = Material {
        base_color: Vec4::new(0.95, 0.45, 0.15, 1.0),
        metallic: 0.0,
        perceptual_roughness: 0.35,
        ..Default::default()
    };
    let count = SIDE * SIDE;
    let mut scene = Scene {
        // Where they begin is where the scene's bounds are taken.
        nodes: (0..count)
            .map(|i| Node {
                parent_from_node: DMat4::from_translation(
                    DVec3::new((i % SIDE) as f64 - 49.5, 0.0, (i / SIDE) as f64 - 49.5) / 5.0,
                ),
                mesh: Some(0),
                ..Default::default()
            })
            .collect(),
        roots: (0..count).collect(),
        meshes: vec![Mesh { name: None, primitives: vec![shapes::sphere(1.0, 6, 0)] }],
        materials: vec![material],
        ..Default::default()
    };
    let sun = |color, intensity| Light { name: None, kind: LightKind::Directional, color, intensity };
    scene.add_light(sun(DVec3::ONE, 3.0), DVec3::ZERO, DVec3::new(-0.6, -0.6, -0.5).normalize());
    scene.add_light(sun(DVec3::new(0.4, 0.6, 1.0), 1.0), DVec3::ZERO, DVec3::new(0.8, -0.5, 0.2).normalize());
    scene
}
