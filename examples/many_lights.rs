//! Prints what lights cost: frames of a floor under many lights, by how many there are and how many reach a pixel. The
//! camera moves, so that lights are sorted anew for every frame.
//!
//! `cargo run --release --example many_lights -- [ROUNDS [SIDE_PX [PICTURE.png]]]`; the picture is of a thousand lights.

#![expect(clippy::print_stdout, reason = "the figures are the output")]

use specula::capture::{CaptureOptions, CaptureTarget, Wanted, record, submit};
use specula::frame::{Reach, clusters};
use specula::glam::{DVec3, Vec3};
use specula::gpu::formats::Precision;
use specula::gpu::{Gpu, GpuOptions, GpuRequest};
use specula::gpu_scene::GpuScene;
use specula::renderer::Renderer;
use specula::scene::light_field::{LightField, view};
use specula::scene::{Background, Channel, Input, Scene, View};

type Failure = Box<dyn std::error::Error>;

/// Lights, how many of them reach a pixel on average, and every so many is a spot.
const CASES: [(u32, f64, u32); 14] = [
    (0, 0.0, 0),
    (1, 1.0, 0),
    (4, 2.0, 0),
    (4, 4.0, 0),
    (9, 4.5, 0),
    (9, 9.0, 0),
    (16, 8.0, 0),
    (16, 16.0, 0),
    (64, 8.0, 0),
    (256, 8.0, 0),
    (1024, 8.0, 0),
    (4096, 8.0, 0),
    (4096, 0.5, 1),
    (16384, 8.0, 0),
];
/// Frames that are drawn and forgotten.
const WARM_UP: u32 = 3;

/// A scene that is measured.
struct Case {
    name: String,
    scene: GpuScene,
    reaches: Vec<Reach>,
    lights: u32,
    reaching: f64,
    times_ms: Vec<f64>,
    sorting_ms: Vec<f64>,
}

fn main() -> Result<(), Failure> {
    let argument = |at: usize, default| std::env::args().nth(at).map_or(Ok(default), |text| text.parse::<u32>());
    let (rounds, side_px) = (argument(1, 15)?, argument(2, 512)?);
    let gpu = Gpu::open(&GpuRequest::default(), GpuOptions { precision: Precision::Float })?;
    println!("{}, {side_px} x {side_px}, one sample, medians of {rounds}\n", gpu.description());
    let mut renderer = Renderer::new(&gpu.device, &gpu.queue);
    let options = CaptureOptions { samples: 1, precision: Precision::Half };
    let target = CaptureTarget::new(&gpu, &view(side_px, 0), options)?;
    let points = points(&gpu, side_px)?;
    let mut cases = Vec::new();
    for case in CASES {
        cases.push(Case::new(&gpu, &renderer, &points, case)?);
    }
    for round in 0..rounds + WARM_UP {
        let view = view(side_px, round);
        for index in 0..cases.len() {
            let index = if round % 2 == 0 { index } else { cases.len() - 1 - index };
            let case = &mut cases[index];
            let time_ms = frame_ms(&gpu, &mut renderer, &mut case.scene, &view, &target)?;
            if round >= WARM_UP {
                case.times_ms.push(time_ms);
                case.sorting_ms.push(case.sorting_ms(&view));
            }
        }
    }
    print(&cases);
    std::env::args().nth(3).map_or(Ok(()), |path| picture(&gpu, side_px, &path))
}

/// A thousand lights, every third of them a spot.
fn picture(gpu: &Gpu, side_px: u32, path: &str) -> Result<(), Failure> {
    let scene = LightField { lights: 1024, range_m: Some(4.0), spot_every: 3 }.scene();
    let mut renderer = Renderer::new(&gpu.device, &gpu.queue);
    let mut uploaded = renderer.upload(&gpu.device, &gpu.queue, &scene, None)?;
    let view = View { background: Background::Color(Vec3::ZERO), ..view(side_px, 0) };
    let target = CaptureTarget::new(gpu, &view, CaptureOptions::default())?;
    let wanted = Wanted { radiance: false, display: true };
    let frame = submit(gpu, &mut renderer, &mut uploaded, &view, &target, wanted)?.wait(gpu)?;
    let picture = image::RgbaImage::from_raw(side_px, side_px, frame.display.unwrap_or_default());
    Ok(picture.ok_or("the picture has another size")?.save(path)?)
}

fn print(cases: &[Case]) {
    let base = cases.iter().find(|case| case.lights == 16).map_or(f64::NAN, |case| median(&case.times_ms));
    println!(
        "| lights | list | reach a pixel on average | CPU ms a frame | to 16 lights with 8 | of it sorting, CPU ms |"
    );
    println!("|---|---|---|---|---|---|");
    for case in cases {
        let Case { name, reaching, .. } = case;
        let list = case.scene.features.light_list;
        let (ms, sorting) = (median(&case.times_ms), median(&case.sorting_ms));
        println!("| {name} | {list:?} | {reaching:.2} | {ms:.1} | {:.2} | {sorting:.2} |", ms / base);
    }
}

impl Case {
    fn new(
        gpu: &Gpu,
        renderer: &Renderer,
        points: &[DVec3],
        (lights, reaching, spot_every): (u32, f64, u32),
    ) -> Result<Self, Failure> {
        let field = |range_m| LightField { lights, range_m: Some(range_m), spot_every }.scene();
        let mut scene = field(range_where(reaching, |range_m| mean_reaching(&field(range_m), points)));
        if lights == 0 {
            scene.lights.iter_mut().for_each(|light| light.intensity = 0.0);
        }
        let center = scene.bounds().center();
        Ok(Self {
            name: format!("{lights}{}", if spot_every > 0 { " spots" } else { "" }),
            lights,
            reaching: if lights == 0 { 0.0 } else { mean_reaching(&scene, points) },
            reaches: scene.lights_in_world().iter().filter_map(|light| Reach::new(light, center)).collect(),
            scene: renderer.upload(&gpu.device, &gpu.queue, &scene, None)?,
            times_ms: Vec::new(),
            sorting_ms: Vec::new(),
        })
    }

    /// What of a frame goes into sorting the lights, measured apart from it.
    fn sorting_ms(&self, view: &View) -> f64 {
        if !self.scene.features.light_list.is_clustered() {
            return 0.0;
        }
        let start = process_ms();
        std::hint::black_box(clusters(&self.reaches, 0, DVec3::ZERO, &view.camera, view.size_px));
        process_ms() - start
    }
}

fn median(times_ms: &[f64]) -> f64 {
    let mut times = times_ms.to_vec();
    times.sort_by(f64::total_cmp);
    times.get(times.len() / 2).copied().unwrap_or(f64::NAN)
}

/// The points that are seen, every sixty-first of them, in the world.
fn points(gpu: &Gpu, side_px: u32) -> Result<Vec<DVec3>, Failure> {
    let scene = LightField { lights: 1, range_m: None, spot_every: 0 }.scene();
    let mut renderer = Renderer::new(&gpu.device, &gpu.queue);
    let mut uploaded = renderer.upload(&gpu.device, &gpu.queue, &scene, None)?;
    let view = View { channel: Some(Channel::Input(Input::Position)), ..view(side_px, 0) };
    let target = CaptureTarget::new(gpu, &view, CaptureOptions { samples: 1, precision: Precision::Float })?;
    let wanted = Wanted { radiance: true, display: false };
    let frame = submit(gpu, &mut renderer, &mut uploaded, &view, &target, wanted)?.wait(gpu)?;
    let texels = frame.radiance.map(|image| image.texels).unwrap_or_default();
    let center = scene.bounds().center();
    let seen = texels.iter().step_by(61).filter(|texel| texel.w > 0.0);
    Ok(seen.map(|texel| texel.truncate().as_dvec3() + center).collect())
}

fn mean_reaching(scene: &Scene, points: &[DVec3]) -> f64 {
    let lights = scene.lights_in_world();
    let reaching = points.iter().map(|point| lights.iter().filter(|light| light.reaches(*point)).count());
    reaching.sum::<usize>() as f64 / points.len() as f64
}

/// Where a growing function of the range, in metres, is `wanted`.
fn range_where(wanted: f64, of: impl Fn(f64) -> f64) -> f64 {
    let (mut low, mut high) = (0.0, 200.0);
    for _ in 0..24 {
        let middle = 0.5 * (low + high);
        if of(middle) < wanted { low = middle } else { high = middle }
    }
    high
}

fn frame_ms(
    gpu: &Gpu,
    renderer: &mut Renderer,
    scene: &mut GpuScene,
    view: &View,
    target: &CaptureTarget,
) -> Result<f64, Failure> {
    let start = process_ms();
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    record(gpu, renderer, &mut encoder, scene, view, target, false)?;
    gpu.queue.submit([encoder.finish()]);
    gpu.wait()?;
    Ok(process_ms() - start)
}

/// Processor time of this process, ms.
fn process_ms() -> f64 {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ProcessCPUTime);
    time.tv_sec as f64 * 1e3 + time.tv_nsec as f64 * 1e-6
}
