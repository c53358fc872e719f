//! Scenes, a device and comparisons for the tests.

use glam::{DMat4, DVec3, UVec2, Vec3};
use specula::bake::environment::{self, BakeOptions};
use specula::capture::{CaptureOptions, CaptureTarget, CapturedFrame, Wanted, submit};
use specula::gpu::formats::Precision;
use specula::gpu::{Gpu, GpuOptions, GpuRequest};
use specula::import::model_from_path;
use specula::progress::Silent;
use specula::reference::color::to_srgb8;
use specula::reference::{ReferenceOptions, render};
use specula::renderer::Renderer;
use specula::scene::{
    Background, Camera, Environment, EnvironmentMaps, Light, LightKind, Material, Mesh, Node, Projection,
    RadianceImage, Scene, ToneMap, View, shapes,
};
use specula::shader::ShaderSources;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The program as its users start it, with no use of their cache: below a file none can be, so every run bakes.
pub(crate) fn program() -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_specula"));
    command.env("SPECULA_CACHE_DIR", concat!(env!("CARGO_MANIFEST_DIR"), "/Cargo.toml"));
    command
}

/// A device for a test; every test opens its own, so that an error belongs to it.
pub(crate) fn gpu(precision: Precision) -> Gpu {
    Gpu::open(&GpuRequest::default(), GpuOptions { precision }).expect("tests need a Vulkan driver: scripts/setup.sh")
}

/// A unit sphere about the origin.
pub(crate) fn sphere_scene(material: Material) -> Scene {
    Scene {
        nodes: vec![Node { parent_from_node: DMat4::IDENTITY, mesh: Some(0), ..Default::default() }],
        roots: vec![0],
        meshes: vec![Mesh { name: None, primitives: vec![shapes::sphere(1.0, 96, 0)] }],
        materials: vec![material],
        ..Default::default()
    }
}

/// Adds a light at a place.
pub(crate) fn add_light(scene: &mut Scene, kind: LightKind, intensity: f64, position: DVec3) {
    scene.roots.push(scene.nodes.len());
    scene.nodes.push(Node {
        parent_from_node: DMat4::from_translation(position),
        light: Some(scene.lights.len()),
        ..Default::default()
    });
    scene.lights.push(Light { name: None, kind, color: DVec3::ONE, intensity });
}

/// Looks at the origin from +Z.
pub(crate) fn front_view(side_px: u32) -> View {
    let projection = Projection::Perspective { fov_y_rad: 0.6 };
    View {
        camera: Camera::look_at(DVec3::new(0.0, 0.0, 4.0), DVec3::ZERO, DVec3::Y, projection, 0.1, 100.0),
        size_px: UVec2::splat(side_px),
        exposure_ev: 0.0,
        tone_map: ToneMap::Neutral,
        background: Background::Transparent,
        background_blur: 0.0,
        energy_compensation: true,
        geometry: Default::default(),
        quality: Default::default(),
        term: None,
        channel: None,
    }
}

pub(crate) fn white_environment() -> Environment {
    Environment::new(specula::scene::EnvironmentImage::constant(Vec3::ONE))
}

/// The CPU reference of the same picture.
pub(crate) fn trace(scene: &Scene, view: &View, samples: u32) -> RadianceImage {
    render(scene, view, &ReferenceOptions { samples, seed: 0, progress: &Silent })
}

/// Root mean square difference over root mean square of `expected`, in linear radiance, where both cover the pixel
/// fully. Fails when that is nowhere.
pub(crate) fn relative_rms(actual: &RadianceImage, expected: &RadianceImage) -> f64 {
    assert_eq!((actual.width, actual.height), (expected.width, expected.height));
    let both = actual.texels.iter().zip(&expected.texels).filter(|(a, b)| a.w > 0.999 && b.w > 0.999);
    let (mut difference, mut power, mut count) = (0.0, 0.0, 0);
    for (a, b) in both {
        let (a, b) = (a.truncate().as_dvec3(), b.truncate().as_dvec3());
        difference += (a - b).length_squared();
        power += b.length_squared();
        count += 1;
    }
    assert!(count > 500, "only {count} pixels are covered");
    assert!(power > 0.0, "the expected picture is black");
    (difference / power).sqrt()
}

/// Writes both pictures and eight times their difference to `target/failures`, for a person to look at.
pub(crate) fn leave_pictures(name: &str, view: &View, actual: &RadianceImage, expected: &RadianceImage) {
    let [a, b] = [actual, expected].map(|image| to_srgb8(image, view));
    let difference: Vec<u8> = a
        .chunks_exact(4)
        .zip(b.chunks_exact(4))
        .flat_map(|(a, b)| [0, 1, 2].map(|c| a[c].abs_diff(b[c]).saturating_mul(8)).into_iter().chain([255]))
        .collect();
    std::fs::create_dir_all("target/failures").unwrap();
    for (kind, pixels) in [("actual", a), ("expected", b), ("difference", difference)] {
        let picture = image::RgbaImage::from_raw(actual.width, actual.height, pixels).unwrap();
        picture.save(format!("target/failures/{name}-{kind}.png")).unwrap();
    }
    println!("{name}: see target/failures/{name}-*.png");
}

/// The sample models, or `None` (printed) where they are not; under CI=true they must be there.
pub(crate) fn samples() -> Option<PathBuf> {
    let root = std::env::var_os("SPECULA_SAMPLES").map_or_else(|| PathBuf::from("../shared/samples"), PathBuf::from);
    if root.join("models").is_dir() {
        return Some(root);
    }
    assert!(std::env::var_os("CI").is_none_or(|ci| ci != "true"), "{} has no sample models", root.display());
    println!("skipped: no sample models at {}", root.display());
    None
}

/// Numbers in [0, 1) that look random and are always the same.
pub(crate) struct Numbers(pub(crate) u64);

impl Numbers {
    pub(crate) fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub(crate) fn between(&mut self, least: f64, most: f64) -> f64 {
        least + (most - least) * self.next()
    }

    pub(crate) fn vector(&mut self, least: f64, most: f64) -> DVec3 {
        DVec3::new(self.between(least, most), self.between(least, most), self.between(least, most))
    }
}

/// Imports a model; warnings are fine.
pub(crate) fn import(path: &Path) -> Scene {
    model_from_path(path, &Default::default()).unwrap().scene
}

/// Uploads, draws and reads back; fails on any message of the driver or of wgpu.
pub(crate) fn draw(gpu: &Gpu, scene: &Scene, view: &View, options: CaptureOptions) -> CapturedFrame {
    let bake = BakeOptions { suns: view.quality.parts_suns(), ..Default::default() };
    let maps = scene.environment.as_ref().map(|e| environment::bake(&e.image, &bake, &Silent));
    draw_with(gpu, ShaderSources::default(), scene, maps.as_ref(), view, options)
}

/// [`draw`] with shaders of one's own and an environment that was baked before.
pub(crate) fn draw_with(
    gpu: &Gpu,
    shaders: ShaderSources,
    scene: &Scene,
    maps: Option<&EnvironmentMaps>,
    view: &View,
    options: CaptureOptions,
) -> CapturedFrame {
    let mut renderer = Renderer::with_shaders(&gpu.device, &gpu.queue, shaders);
    let mut uploaded = renderer.upload(&gpu.device, &gpu.queue, scene, maps).unwrap();
    let target = CaptureTarget::new(gpu, view, options).unwrap();
    let wanted = Wanted { radiance: true, display: true };
    let frame = submit(gpu, &mut renderer, &mut uploaded, view, &target, wanted).unwrap();
    frame.wait(gpu).unwrap()
}

/// The number that the queue gives to a submission of nothing: each submission counts it up.
pub(crate) fn submission_number(gpu: &Gpu) -> u64 {
    let index = format!("{:?}", gpu.queue.submit([]));
    index.chars().filter(char::is_ascii_digit).collect::<String>().parse().unwrap()
}
