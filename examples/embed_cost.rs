//! Prints what a frame of a thousand objects costs the processor, step by step: as a thousand draw calls and as one, while
//! nothing changes, while the camera turns, and while every object moves.
//!
//! `cargo run --release --example embed_cost -- [FRAMES]`

mod host;

use host::Attachments;
use specula::embed::{LiveScene, ModelId};
use specula::glam::{DMat4, DVec3, UVec2, Vec4};
use specula::gpu::{Gpu, GpuOptions, GpuRequest};
use specula::renderer::{FrameState, PassFormat, Renderer};
use specula::scene::{Background, Light, LightKind, Material, Mesh, Node, Scene, View, framing::default_view, shapes};
use specula::wgpu;
use std::time::Instant;

type Failure = Box<dyn std::error::Error>;

pub(crate) const OBJECTS: usize = 1000;
const COLUMNS: usize = 40;
const SIZE_PX: UVec2 = UVec2::new(64, 36);
/// Frames before the first that counts.
const WARM_UP: u32 = 5;

/// What a host changes from frame to frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Change {
    Nothing,
    Camera,
    Objects,
}

#[allow(dead_code, clippy::print_stdout, reason = "tests count allocations alone; figures are output")]
fn main() -> Result<(), Failure> {
    let frames: u32 = std::env::args().nth(1).map_or(Ok(101), |text| text.parse())?;
    let gpu = Gpu::open(&GpuRequest::default(), GpuOptions::default())?;
    println!("{}, {OBJECTS} objects, microseconds: median of {frames} frames, and the least\n", gpu.description());
    println!("| draw calls | changes | `update` | `prepare_frame` | `paint` | the pass's end and `finish` |");
    println!("|---|---|---|---|---|---|");
    for is_distinct in [true, false] {
        for change in [Change::Nothing, Change::Camera, Change::Objects] {
            let mut crowd = Crowd::new(&gpu, is_distinct)?;
            let mut times: [Vec<f64>; 4] = Default::default();
            for frame in 0..frames + WARM_UP {
                crowd.change(change, frame)?;
                let of_frame = crowd.frame(&gpu)?;
                for (times, time) in times.iter_mut().zip(of_frame).filter(|_| frame >= WARM_UP) {
                    times.push(time);
                }
            }
            let median = times.map(|mut times| {
                times.sort_by(f64::total_cmp);
                format!("{:.0} ({:.0})", times[times.len() / 2] * 1e6, times[0] * 1e6)
            });
            let draws = if is_distinct { OBJECTS } else { 1 };
            println!("| {draws} | {} | {} |", format!("{change:?}").to_lowercase(), median.join(" | "));
        }
    }
    Ok(())
}

/// A field of small balls.
pub(crate) struct Crowd {
    renderer: Renderer,
    scene: LiveScene,
    balls: ModelId,
    view: View,
    attachments: Attachments,
    state: FrameState,
}

impl Crowd {
    /// Each with a mesh and a material of its own, or all with the same.
    pub(crate) fn new(gpu: &Gpu, is_distinct: bool) -> Result<Self, Failure> {
        let asset = balls(is_distinct);
        let mut scene = LiveScene::new();
        let balls = scene.insert(&asset)?;
        let camera = host::camera_at(DVec3::new(0.0, 14.0, 30.0), 0.1);
        Ok(Self {
            renderer: Renderer::new(&gpu.device, &gpu.queue),
            scene,
            balls,
            view: View { camera, background: Background::Transparent, ..default_view(&asset, SIZE_PX) },
            attachments: Attachments::new(&gpu.device, &PassFormat::own(1), SIZE_PX),
            state: FrameState::default(),
        })
    }

    pub(crate) fn change(&mut self, change: Change, frame: u32) -> Result<(), Failure> {
        let angle = f64::from(frame) * 0.01;
        match change {
            Change::Nothing => {}
            Change::Camera => {
                self.view.camera = host::camera_at(DVec3::new(30.0 * angle.sin(), 14.0, 30.0 * angle.cos()), 0.1);
            }
            Change::Objects => {
                let moved = |i: usize| (i, place(i) * DMat4::from_translation(DVec3::Y * (angle + i as f64).sin()));
                self.scene.set_nodes(self.balls, (0..OBJECTS).map(moved))?;
            }
        }
        Ok(())
    }

    /// What comes before the pass.
    pub(crate) fn prepare(&mut self, gpu: &Gpu) -> Result<[f64; 2], Failure> {
        let (device, start) = ((&gpu.device, &gpu.queue), Instant::now());
        let scene = self.scene.update(&self.renderer, device)?;
        let updated = Instant::now();
        let pass = PassFormat::own(1);
        self.renderer.prepare_frame(device, scene, (&self.view, UVec2::ZERO), &pass, &mut self.state)?;
        Ok([(updated - start).as_secs_f64(), updated.elapsed().as_secs_f64()])
    }

    /// What is recorded in it.
    pub(crate) fn paint(&self, pass: &mut wgpu::RenderPass<'_>) -> u32 {
        let Some(prepared) = self.scene.uploaded().and_then(|scene| self.state.prepared(scene)) else { return 0 };
        prepared.paint(pass);
        prepared.stats().draws
    }

    pub(crate) fn begin<'e>(&self, encoder: &'e mut wgpu::CommandEncoder) -> wgpu::RenderPass<'e> {
        self.attachments.begin(encoder, &PassFormat::own(1), wgpu::Color::BLACK)
    }

    /// Draws a frame. Returns the seconds of its steps.
    fn frame(&mut self, gpu: &Gpu) -> Result<[f64; 4], Failure> {
        let [update, prepare] = self.prepare(gpu)?;
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let mut pass = self.begin(&mut encoder);
        let start = Instant::now();
        self.paint(&mut pass);
        let painted = Instant::now();
        drop(pass);
        let commands = encoder.finish();
        let finished = painted.elapsed().as_secs_f64();
        gpu.queue.submit([commands]);
        gpu.wait()?;
        Ok([update, prepare, (painted - start).as_secs_f64(), finished])
    }
}

fn place(i: usize) -> DMat4 {
    DMat4::from_translation(DVec3::new((i % COLUMNS) as f64 * 0.5 - 9.75, 0.0, (i / COLUMNS) as f64 * 0.5 - 6.0))
}

fn balls(is_distinct: bool) -> Scene {
    let kinds = if is_distinct { OBJECTS } else { 1 };
    let material = |i: usize| Material {
        base_color: Vec4::new(0.9, 0.3 + 0.5 * (i as f32 / OBJECTS as f32), 0.2, 1.0),
        metallic: 0.0,
        ..Default::default()
    };
    let node = |i| Node { parent_from_node: place(i), mesh: Some(i % kinds), ..Default::default() };
    let mut scene = Scene {
        nodes: (0..OBJECTS).map(node).collect(),
        roots: (0..OBJECTS).collect(),
        meshes: (0..kinds)
            .map(|material| Mesh { name: None, primitives: vec![shapes::sphere(0.4, 4, material)] })
            .collect(),
        materials: (0..kinds).map(material).collect(),
        ..Default::default()
    };
    let sun = Light { name: None, kind: LightKind::Directional, color: DVec3::ONE, intensity: 3.0 };
    scene.add_light(sun, DVec3::ZERO, DVec3::new(-0.5, -0.8, -0.6).normalize());
    scene
}
