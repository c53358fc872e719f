//! Prints what instances cost: those outside of the picture beside those in it, and many small meshes beside one large
//! mesh of the same triangles. Figures are ratios of processor time, of frames drawn in turn; the camera moves between
//! frames, so that every frame is planned anew.
//!
//! `cargo run --release --example instances [-- ROUNDS]`

#![expect(clippy::print_stdout, reason = "the figures are the output")]

mod clock;

use clock::{cpu_seconds, median};
use glam::DVec3;
use specula::capture::{CaptureOptions, CaptureTarget, record};
use specula::frame::{Culling, PlanOptions, Planner};
use specula::gpu::formats::Precision;
use specula::gpu::{Gpu, GpuOptions, GpuRequest};
use specula::gpu_scene::GpuScene;
use specula::renderer::Renderer;
use specula::scene::patches::{Kind, Order, Sight, crowd, field, hull, mixture, sheets, view};
use specula::scene::{Scene, View};
use std::time::Instant;

type Result<T> = std::result::Result<T, Box<dyn std::error::Error>>;

fn main() -> Result<()> {
    let rounds = std::env::args().nth(1).map_or(Ok(15), |text| text.parse())?;
    let gpu = Gpu::open(&GpuRequest::default(), GpuOptions::default())?;
    println!("{}, medians of {rounds} rounds\n", gpu.description());
    println!("| frame | size, samples | CPU ms | of the first |\n|---|---|---|---|");
    for (side, samples) in [(1024, 4), (256, 1)] {
        let wanted = Wanted { side, samples, rounds };
        compare(
            &gpu,
            wanted,
            Sight::Near,
            &[
                ("100 in the picture", crowd(100, 0, Kind::Copies)),
                ("and 10 000 beside it, copies", crowd(100, 10_000, Kind::Copies)),
                ("and 10 000 beside it, each a mesh", crowd(100, 10_000, Kind::Meshes)),
            ],
        )?;
    }
    let wanted = Wanted { side: 1024, samples: 1, rounds };
    compare(
        &gpu,
        wanted,
        Sight::Near,
        &[
            ("32 sheets, listed front to back", sheets(Order::FrontToBack, 1)),
            ("32 sheets, listed back to front", sheets(Order::BackToFront, 1)),
            ("the same, of 32 materials with 6 pipelines", sheets(Order::BackToFront, 32)),
        ],
    )?;
    hidden(&gpu, wanted)?;
    let small = [("1 000 meshes of one material", mixture(1)), ("1 000 meshes of 6 pipelines", mixture(6))];
    compare(&gpu, wanted, Sight::Near, &small)?;
    for count in [10_000, 100_000] {
        let wanted = Wanted { side: 1024, samples: 1, rounds: rounds.min(9) };
        let name = format!("{count} instances of 100 triangles");
        compare(
            &gpu,
            wanted,
            Sight::Far,
            &[("one mesh of all triangles", field(count, true)), (&name, field(count, false))],
        )?;
    }
    plan_times(rounds)
}

/// What a frame is measured with.
#[derive(Clone, Copy)]
struct Wanted {
    side: u32,
    samples: u32,
    rounds: usize,
}

/// Draws the scenes in turn and prints a row for each.
fn compare(gpu: &Gpu, wanted: Wanted, sight: Sight, scenes: &[(&str, Scene)]) -> Result<()> {
    let all: Vec<_> = scenes.iter().map(|(name, scene)| (*name, scene, Culling::On)).collect();
    compare_culling(gpu, wanted, sight, &all)
}

/// What is hidden, drawn and left out.
fn hidden(gpu: &Gpu, wanted: Wanted) -> Result<()> {
    let [empty, full] = [hull(0), hull(10_000)];
    let all = [
        ("a closed sphere of 16 128 triangles", &empty, Culling::On),
        ("and 10 000 patches inside of it", &full, Culling::On),
        ("the same, what is hidden drawn too", &full, Culling::NotHidden),
    ];
    compare_culling(gpu, wanted, Sight::Near, &all)?;
    // Not one of them hides another.
    let side_by_side = field(10_000, false);
    let all = [
        ("10 000 instances of 100 triangles, none looked for behind others", &side_by_side, Culling::NotHidden),
        ("the same, all looked for", &side_by_side, Culling::On),
    ];
    compare_culling(gpu, wanted, Sight::Far, &all)
}

fn compare_culling(gpu: &Gpu, wanted: Wanted, sight: Sight, scenes: &[(&str, &Scene, Culling)]) -> Result<()> {
    let mut renderer = Renderer::new(&gpu.device, &gpu.queue);
    let options = CaptureOptions { samples: wanted.samples, precision: Precision::Half };
    let target = |_| CaptureTarget::new(gpu, &view(sight, wanted.side, 0), options);
    let targets: Vec<CaptureTarget> = scenes.iter().map(target).collect::<std::result::Result<_, _>>()?;
    let upload = |(_, scene, _): &(&str, &Scene, Culling)| renderer.upload(&gpu.device, &gpu.queue, scene, None);
    let mut uploaded: Vec<GpuScene> = scenes.iter().map(upload).collect::<std::result::Result<_, _>>()?;
    let mut times = vec![Vec::new(); scenes.len()];
    for round in 0..wanted.rounds + 2 {
        let frames = uploaded.iter_mut().zip(&targets).zip(&mut times).zip(scenes);
        for (((scene, target), times), (.., culling)) in frames {
            renderer.culling = *culling;
            let start = cpu_seconds();
            frame(gpu, &mut renderer, scene, &view(sight, wanted.side, round), target)?;
            times.push(cpu_seconds().zip(start).map(|(end, start)| 1e3 * (end - start)));
        }
    }
    // The first frames compile.
    times.iter_mut().for_each(|times| drop(times.drain(..2)));
    for ((name, ..), of_scene) in scenes.iter().zip(&times) {
        let ratios = of_scene.iter().zip(&times[0]).map(|(time, first)| Some((*time)? / (*first)?));
        let (ms, ratio) = (median(of_scene.iter().copied()), median(ratios));
        println!("| {name} | {0} x {0}, {1} | {ms:.1} | {ratio:.2} |", wanted.side, wanted.samples);
    }
    Ok(())
}

fn frame(gpu: &Gpu, renderer: &mut Renderer, scene: &mut GpuScene, view: &View, target: &CaptureTarget) -> Result<()> {
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    record(gpu, renderer, &mut encoder, scene, view, target, true)?;
    gpu.queue.submit([encoder.finish()]);
    Ok(gpu.wait()?)
}

/// What the decision costs alone, without any device.
fn plan_times(rounds: usize) -> Result<()> {
    println!("\n| planned | in the picture | wall ms |\n|---|---|---|");
    for (name, scene, sight) in [
        ("10 100 copies", crowd(100, 10_000, Kind::Copies), Sight::Near),
        ("10 001 meshes", crowd(100, 10_000, Kind::Meshes), Sight::Near),
        ("10 000 patches inside of a sphere", hull(10_000), Sight::Near),
        ("100 000 copies", field(100_000, false), Sight::Far),
        ("100 000 copies, a quarter of them seen", field(100_000, false), Sight::Far),
    ] {
        let features = specula::shader::SceneFeatures::of(&scene);
        let mut drawables = specula::frame::Drawables::new(&scene, features);
        drawables.find_occluders(&scene);
        let (mut planner, mut plan) = (Planner::default(), Default::default());
        let mut times = Vec::new();
        for round in 0..rounds + 2 {
            let mut view = view(sight, 1024, round);
            if name.contains("quarter") {
                view.camera.world_from_view.w_axis += DVec3::new(0.5, 0.5, 0.0).extend(0.0);
            }
            let start = Instant::now();
            let options = PlanOptions { samples: 1, culling: Culling::On };
            planner.plan(&drawables, features, &view, options, &mut plan);
            times.push(Some(1e3 * start.elapsed().as_secs_f64()));
        }
        println!("| {name} | {} | {:.3} |", plan.placements.drawn(), median(times.into_iter().skip(2)));
    }
    Ok(())
}
