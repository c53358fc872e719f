//! Prints what instances cost: those outside of the picture beside those in it, and many small meshes beside one large
//! mesh of the same triangles. Figures are ratios of processor time, of frames drawn in turn; the camera moves between
//! frames, so that every frame is planned anew.
//!
//! `cargo run --release --example instances [-- ROUNDS]`

#![expect(clippy::print_stdout, reason = "the figures are the output")]

mod clock;

use clock::{cpu_seconds, median};
use glam::{DMat4, DVec3, UVec2, Vec3};
use specula::capture::{CaptureOptions, CaptureTarget, record};
use specula::frame::{Culling, PlanOptions, Planner};
use specula::gpu::formats::Precision;
use specula::gpu::{Gpu, GpuOptions, GpuRequest};
use specula::gpu_scene::GpuScene;
use specula::renderer::Renderer;
use specula::scene::{
    Background, Camera, Light, LightKind, Material, Mesh, MetalFresnel, Node, Primitive, Projection, Scene, Topology,
    View, framing,
};
use std::time::Instant;

type Result<T> = std::result::Result<T, Box<dyn std::error::Error>>;

/// Quads across and down a patch: 100 triangles.
const QUADS: (u32, u32) = (10, 5);

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

/// Where the camera stands.
#[derive(Clone, Copy)]
enum Sight {
    /// Before ten by ten patches.
    Near,
    /// Before a field of patches one unit wide.
    Far,
}

/// Draws the scenes in turn and prints a row for each.
fn compare(gpu: &Gpu, wanted: Wanted, sight: Sight, scenes: &[(&str, Scene)]) -> Result<()> {
    let mut renderer = Renderer::new(&gpu.device, &gpu.queue);
    let options = CaptureOptions { samples: wanted.samples, precision: Precision::Half };
    let target = |_| CaptureTarget::new(gpu, &view(sight, wanted.side, 0), options);
    let targets: Vec<CaptureTarget> = scenes.iter().map(target).collect::<std::result::Result<_, _>>()?;
    let upload = |(_, scene): &(&str, Scene)| renderer.upload(&gpu.device, &gpu.queue, scene, None);
    let mut uploaded: Vec<GpuScene> = scenes.iter().map(upload).collect::<std::result::Result<_, _>>()?;
    let mut times = vec![Vec::new(); scenes.len()];
    for round in 0..wanted.rounds + 2 {
        for ((scene, target), times) in uploaded.iter_mut().zip(&targets).zip(&mut times) {
            let start = cpu_seconds();
            frame(gpu, &mut renderer, scene, &view(sight, wanted.side, round), target)?;
            times.push(cpu_seconds().zip(start).map(|(end, start)| 1e3 * (end - start)));
        }
    }
    // The first frames compile.
    times.iter_mut().for_each(|times| drop(times.drain(..2)));
    for ((name, _), of_scene) in scenes.iter().zip(&times) {
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

fn view(sight: Sight, side: u32, round: usize) -> View {
    let (distance, height_m) = match sight {
        Sight::Near => (12.0, 10.0),
        Sight::Far => (2.0, 1.0),
    };
    // Every frame is another.
    let eye = DVec3::new(1e-4 * (round % 7) as f64, 0.0, distance);
    let projection = Projection::Perspective { fov_y_rad: 2.0 * (0.5 * height_m / distance).atan() };
    let camera = Camera::look_at(eye, DVec3::ZERO, DVec3::Y, projection, 0.1, 100.0);
    let background = Background::Color(Vec3::splat(0.16));
    View { camera, background, ..framing::default_view(&Default::default(), UVec2::splat(side)) }
}

/// How those beside the picture are made.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Copies,
    /// No two are the same.
    Meshes,
}

/// Patches of half a unit: some in ten by ten units before the camera, others behind it and to the sides.
fn crowd(visible: usize, hidden: usize, kind: Kind) -> Scene {
    let mut scene = lit();
    for i in 0..visible {
        let place = DVec3::new((i % 10) as f64 - 4.5, (i / 10 % 10) as f64 - 4.5, 0.0) * 0.9;
        push(&mut scene, 0, place, 0.8);
    }
    for i in 0..hidden {
        let side = if i % 2 == 0 { 1.0 } else { -1.0 };
        let (row, column) = ((i / 2 % 100) as f64, (i / 200) as f64);
        let place = if i % 3 == 0 {
            DVec3::new(row - 50.0, column - 25.0, 30.0 + side)
        } else {
            DVec3::new(side * (20.0 + row), column - 25.0, -5.0)
        };
        let mesh = if kind == Kind::Meshes { scene.meshes.len() } else { 0 };
        if kind == Kind::Meshes {
            scene.meshes.push(Mesh { name: None, primitives: vec![patch(&[(1.0 + 1e-3 * i as f32, Vec3::ZERO)])] });
        }
        push(&mut scene, mesh, place, 0.8);
    }
    scene
}

#[derive(Clone, Copy, PartialEq)]
enum Order {
    FrontToBack,
    BackToFront,
}

/// Patches that fill the picture, one behind the other, of so many materials with as many pipelines as [`material`] has.
fn sheets(order: Order, materials: usize) -> Scene {
    let mut scene = Scene { meshes: Vec::new(), ..lit() };
    of_materials(&mut scene, materials);
    for i in 0..32 {
        let depth = if order == Order::FrontToBack { i } else { 31 - i };
        // Materials in an order of their own.
        push(&mut scene, i * 13 % materials, DVec3::NEG_Z * depth as f64, 50.0);
    }
    scene
}

/// A thousand small meshes beside each other, no two the same, of so many materials.
fn mixture(materials: usize) -> Scene {
    let mut scene = Scene { meshes: Vec::new(), ..lit() };
    of_materials(&mut scene, materials);
    for i in 0..1000 {
        let place = DVec3::new((i % 32) as f64 - 16.0, (i / 32) as f64 - 16.0, (i * 7 % 13) as f64 * 0.01) * 0.28;
        let shape = patch(&[(1.0 + 1e-4 * i as f32, Vec3::ZERO)]);
        let primitives = vec![Primitive { material: i % materials, ..shape }];
        let mesh = scene.meshes.len();
        scene.meshes.push(Mesh { name: None, primitives });
        push(&mut scene, mesh, place, 0.25);
    }
    scene
}

/// Replaces the materials by so many, with a mesh of one patch for each.
fn of_materials(scene: &mut Scene, count: usize) {
    scene.materials = (0..count).map(material).collect();
    let mesh = |material| vec![Primitive { material, ..patch(&[(1.0, Vec3::ZERO)]) }];
    scene.meshes = (0..count).map(|material| Mesh { name: None, primitives: mesh(material) }).collect();
}

/// Materials of six pipelines, in turn.
fn material(index: usize) -> Material {
    let (n, k, a) = (Vec3::ONE, Vec3::ONE, Vec3::ONE);
    let curves = [MetalFresnel::Schlick, MetalFresnel::Lazanyi { a }, MetalFresnel::Conductor { n, k, a }];
    let (metal_fresnel, double_sided) = (curves[index % 3], index / 3 % 2 == 1);
    Material { metallic: 0.5 + 0.01 * (index % 50) as f32, metal_fresnel, double_sided, ..Default::default() }
}

/// `count` patches that fill a square of one unit: each an instance, or all one mesh.
fn field(count: usize, one_mesh: bool) -> Scene {
    let mut scene = lit();
    let across = (count as f64).sqrt().ceil() as usize;
    let size = 0.9 / across as f64;
    let place = |i: usize| {
        let [x, y] = [i % across, i / across].map(|step| (step as f64 + 0.5) / across as f64 - 0.5);
        // Away from the camera, so that none leaves the picture.
        DVec3::new(x, y, -0.01 * (i % 17) as f64)
    };
    if one_mesh {
        let places: Vec<(f32, Vec3)> = (0..count).map(|i| (size as f32, place(i).as_vec3())).collect();
        scene.meshes = vec![Mesh { name: None, primitives: vec![patch(&places)] }];
        push(&mut scene, 0, DVec3::ZERO, 1.0);
    } else {
        (0..count).for_each(|i| push(&mut scene, 0, place(i), size));
    }
    scene
}

/// A mesh of one patch, and a light.
fn lit() -> Scene {
    let light = Light { name: None, kind: LightKind::Directional, color: DVec3::ONE, intensity: 3.0 };
    let toward = DMat4::from_rotation_x(-0.5);
    Scene {
        nodes: vec![Node { parent_from_node: toward, light: Some(0), ..Default::default() }],
        roots: vec![0],
        meshes: vec![Mesh { name: None, primitives: vec![patch(&[(1.0, Vec3::ZERO)])] }],
        materials: vec![Material { metallic: 0.0, ..Default::default() }],
        lights: vec![light],
        ..Default::default()
    }
}

fn push(scene: &mut Scene, mesh: usize, place: DVec3, size: f64) {
    let parent_from_node = DMat4::from_translation(place) * DMat4::from_scale(DVec3::splat(size));
    scene.roots.push(scene.nodes.len());
    scene.nodes.push(Node { parent_from_node, mesh: Some(mesh), ..Default::default() });
}

/// Bulging squares toward +Z, of these sizes at these places.
fn patch(places: &[(f32, Vec3)]) -> Primitive {
    let (across, down) = QUADS;
    let (mut positions, mut normals, mut indices) = (Vec::new(), Vec::new(), Vec::new());
    for &(size, place) in places {
        let first = positions.len() as u32;
        for i in 0..(across + 1) * (down + 1) {
            let [x, y] = [(i % (across + 1)) as f32 / across as f32, (i / (across + 1)) as f32 / down as f32]
                .map(|fraction| fraction - 0.5);
            let point = Vec3::new(x, y, (1.0 - x * x - y * y).sqrt() - 0.9);
            positions.push(place + point * size);
            normals.push((point + 0.9 * Vec3::Z).normalize());
        }
        for (row, column) in (0..down).flat_map(|row| (0..across).map(move |column| (row, column))) {
            let a = first + row * (across + 1) + column;
            let b = a + across + 1;
            indices.extend([a, a + 1, b + 1, a, b + 1, b]);
        }
    }
    Primitive {
        topology: Topology::Triangles,
        positions,
        normals: Some(normals),
        tangents: None,
        uvs: Vec::new(),
        colors: None,
        indices,
        material: 0,
    }
}

/// What the decision costs alone, without any device.
fn plan_times(rounds: usize) -> Result<()> {
    println!("\n| planned | in the picture | wall ms |\n|---|---|---|");
    for (name, scene, sight) in [
        ("10 100 copies", crowd(100, 10_000, Kind::Copies), Sight::Near),
        ("10 001 meshes", crowd(100, 10_000, Kind::Meshes), Sight::Near),
        ("100 000 copies", field(100_000, false), Sight::Far),
        ("100 000 copies, a quarter of them seen", field(100_000, false), Sight::Far),
    ] {
        let features = specula::shader::SceneFeatures::of(&scene);
        let drawables = specula::frame::Drawables::new(&scene, features);
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
