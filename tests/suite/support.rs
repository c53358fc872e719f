//! Scenes, a device and comparisons for the tests.

use glam::{DMat4, DVec3, UVec2, Vec3};
use specula::bake::environment;
use specula::capture::{CaptureOptions, CaptureTarget, CapturedFrame, Wanted, submit};
use specula::gpu::formats::Precision;
use specula::gpu::{Gpu, GpuOptions, GpuRequest};
use specula::progress::Silent;
use specula::renderer::Renderer;
use specula::scene::{
    Background, Camera, Environment, EnvironmentMaps, Light, LightKind, Material, Mesh, Node, Projection, Scene,
    ToneMap, View, shapes,
};
use specula::shader::ShaderSources;

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
        energy_compensation: true,
    }
}

pub(crate) fn white_environment() -> Environment {
    Environment::new(specula::scene::EnvironmentImage::constant(Vec3::ONE))
}

/// Uploads, draws and reads back; fails on any message of the driver or of wgpu.
pub(crate) fn draw(gpu: &Gpu, scene: &Scene, view: &View, options: CaptureOptions) -> CapturedFrame {
    let maps = scene.environment.as_ref().map(|e| environment::bake(&e.image, &Default::default(), &Silent));
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
