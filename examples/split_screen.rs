//! One scene from four sides, in one pass.
//!
//! `cargo run --release --example split_screen` writes `docs/pictures/split_screen.png`.

mod host;

use host::{Attachments, read, save};
use specula::bake::environment::bake;
use specula::glam::{DVec3, UVec2};
use specula::gpu::{Gpu, GpuOptions, GpuRequest, formats};
use specula::progress::Silent;
use specula::renderer::{FrameState, HostTarget, HostView, Output, PassFormat, Renderer};
use specula::scene::{Background, Camera, Environment, View, framing::default_view};
use specula::{import, wgpu};

type Failure = Box<dyn std::error::Error>;

pub(crate) const SIZE_PX: UVec2 = UVec2::new(482, 272);
/// Each of the four, with a gap of two pixels between them.
pub(crate) const PART_PX: UVec2 = UVec2::new(240, 135);

#[allow(dead_code, reason = "tests take the picture alone")]
fn main() -> Result<(), Failure> {
    let gpu = Gpu::open(&GpuRequest::default(), GpuOptions::default())?;
    save("split_screen", SIZE_PX, &picture(&gpu)?)
}

pub(crate) fn picture(gpu: &Gpu) -> Result<Vec<u8>, Failure> {
    let (device, queue) = (&gpu.device, &gpu.queue);
    let mut model = import::model_from_path("assets/showcase.glb".as_ref(), &Default::default())?.scene;
    let environment = model.environment.insert(Environment::new(specula::bake::studio::studio()));
    let maps = bake(&environment.image, &Default::default(), &Silent);
    let mut renderer = Renderer::new(device, queue);
    let mut scene = renderer.upload(device, queue, &model, Some(&maps))?;

    let pass =
        PassFormat { color: formats::CAPTURED_DISPLAY, depth: None, output: Output::Display, ..PassFormat::own(4) };
    let attachments = Attachments::new(device, &pass, SIZE_PX);
    // Around what the file's own camera sees, on the axis of the scene.
    let framed = model.cameras_in_world().into_iter().next().ok_or("the showcase has no camera")?;
    let (eye, forward) = (framed.position_in_world(), framed.forward_in_world());
    let distance = eye.x.hypot(eye.z);
    let center = eye + distance / forward.x.hypot(forward.z) * forward;
    let view = |(theta, phi): (f64, f64)| {
        let out = DVec3::new(phi.cos() * theta.sin(), phi.sin(), phi.cos() * theta.cos());
        let Camera { projection, near_m, far_m, .. } = framed;
        let camera = Camera::look_at(center + distance * out, center, DVec3::Y, projection, near_m, far_m);
        View { camera, background: Background::Environment, ..default_view(&model, PART_PX) }
    };
    let views = [(0.0, 0.15), (0.8, 0.3), (-0.9, 0.5), (0.3, 1.3)].map(view);
    let mut states: [FrameState; 4] = Default::default();
    let mut parts: Vec<HostView<'_>> = (0..)
        .zip(views.iter().zip(&mut states))
        .map(|(i, (view, state))| HostView { view, at_px: UVec2::new(i % 2, i / 2) * (PART_PX + 2), state })
        .collect();
    let target = HostTarget {
        color: &attachments.color,
        resolve: attachments.resolve.as_ref(),
        load: wgpu::LoadOp::Clear(wgpu::Color::BLACK),
        depth: None,
        depth_load: wgpu::LoadOp::Load,
    };
    let mut encoder = device.create_command_encoder(&Default::default());
    renderer.encode((device, queue), &mut encoder, &mut scene, &mut parts, (&pass, &target))?;
    Ok(read(gpu, encoder, attachments.picture())?)
}
