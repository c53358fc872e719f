//! Prints what the deferred path costs beside the forward path, for spheres of more and more triangles and for models.
//! Figures are ratios of processor time, of frames drawn in turn.
//!
//! `cargo run --release --example paths [-- MODEL PANORAMA]`

#![expect(clippy::print_stdout, reason = "the figures are the output")]

mod clock;

use clock::{cpu_seconds, median};
use glam::UVec2;
use specula::bake::environment::{self, BakeOptions};
use specula::bake::studio;
use specula::capture::{CaptureOptions, CaptureTarget, record};
use specula::gpu::formats::Precision;
use specula::gpu::{Gpu, GpuOptions, GpuRequest};
use specula::gpu_scene::GpuScene;
use specula::import::{environment_from_path, model_from_path};
use specula::progress::Silent;
use specula::renderer::{PathChoice, Renderer};
use specula::scene::{Environment, Material, Mesh, Node, Scene, framing, shapes};

type Result<T> = std::result::Result<T, Box<dyn std::error::Error>>;

const SIDE_PX: u32 = 1024;
const ROUNDS: usize = 11;

fn main() -> Result<()> {
    let gpu = Gpu::open(&GpuRequest::default(), GpuOptions::default())?;
    println!("{}, medians of {ROUNDS} rounds, {SIDE_PX} x {SIDE_PX}\n", gpu.description());
    println!("| scene | triangles | samples | forward, CPU ms | deferred, CPU ms | ratio |\n|---|---|---|---|---|---|");
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    if let [model, panorama] = &arguments[..] {
        let mut scene = model_from_path(model.as_ref(), &Default::default())?.scene;
        scene.environment = Some(Environment::new(environment_from_path(panorama.as_ref())?));
        return compare(&gpu, model, &scene);
    }
    for segments in [16, 32, 64, 128, 256] {
        compare(&gpu, "sphere", &sphere(segments))?;
    }
    Ok(())
}

fn sphere(segments: u32) -> Scene {
    Scene {
        nodes: vec![Node { mesh: Some(0), ..Default::default() }],
        roots: vec![0],
        meshes: vec![Mesh { name: None, primitives: vec![shapes::sphere(1.0, segments, 0)] }],
        materials: vec![Material { perceptual_roughness: 0.4, ..Default::default() }],
        environment: Some(Environment::new(studio::studio())),
        ..Default::default()
    }
}

/// Draws a scene by both paths in turn and prints a row for each number of samples.
fn compare(gpu: &Gpu, name: &str, scene: &Scene) -> Result<()> {
    let maps = scene.environment.as_ref().map(|e| environment::bake(&e.image, &BakeOptions::default(), &Silent));
    let mut renderer = Renderer::new(&gpu.device, &gpu.queue).with_paths(PathChoice::Deferred);
    let mut uploaded = renderer.upload(&gpu.device, &gpu.queue, scene, maps.as_ref())?;
    for samples in [1, 4] {
        let view = framing::default_view(scene, UVec2::splat(SIDE_PX));
        let options = CaptureOptions { samples, precision: Precision::Half };
        let target = CaptureTarget::new(gpu, &view, options)?;
        let (mut times, mut triangles) = ([Vec::new(), Vec::new()], 0);
        for round in 0..ROUNDS + 2 {
            for (path, times) in [PathChoice::Forward, PathChoice::Deferred].into_iter().zip(&mut times) {
                renderer.set_paths(path);
                let start = cpu_seconds();
                triangles = frame(gpu, &mut renderer, &mut uploaded, &view, &target)?;
                // The first frames compile.
                if round >= 2 {
                    times.push(cpu_seconds().zip(start).map(|(end, start)| 1e3 * (end - start)));
                }
            }
        }
        let ratios = times[1].iter().zip(&times[0]).map(|(deferred, forward)| Some((*deferred)? / (*forward)?));
        let ratio = median(ratios);
        let [forward, deferred] = times.map(|times| median(times.into_iter()));
        println!("| {name} | {triangles} | {samples} | {forward:.1} | {deferred:.1} | {ratio:.2} |");
    }
    Ok(())
}

fn frame(
    gpu: &Gpu,
    renderer: &mut Renderer,
    scene: &mut GpuScene,
    view: &specula::scene::View,
    target: &CaptureTarget,
) -> Result<u64> {
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let stats = record(gpu, renderer, &mut encoder, scene, view, target, true)?;
    gpu.queue.submit([encoder.finish()]);
    gpu.wait()?;
    Ok(stats.triangles)
}
