//! The deferred path shows what the forward path shows: the same but for rounding with one sample, and at edges with
//! several, where it is nearer to the truth.

use crate::support::{add_light, front_view, gpu, import, leave_pictures, relative_rms, samples, sphere_scene, trace};
use crate::tiers::two_suns;
use glam::{DMat4, DVec3, Vec3, Vec4};
use specula::bake::environment::{self, BakeOptions};
use specula::capture::{CaptureOptions, CaptureTarget, Wanted, submit};
use specula::frame::RenderPath;
use specula::gpu::Gpu;
use specula::gpu::formats::Precision;
use specula::passes::ForwardTarget;
use specula::progress::Silent;
use specula::renderer::{PathChoice, Renderer};
use specula::scene::framing::default_view;
use specula::scene::{
    AlphaMode, Background, Disney, Environment, EnvironmentImage, LightKind, Material, Node, RadianceImage, Scene, View,
};

const SIDE_PX: u32 = 96;

/// Spheres that hide and touch each other, one of them mirrored and squeezed, each of another material, lit by a lamp and
/// an uneven sky.
fn scene() -> Scene {
    let metal = Material { base_color: Vec4::new(0.9, 0.6, 0.3, 1.0), perceptual_roughness: 0.4, ..Default::default() };
    let mut scene = sphere_scene(metal.clone());
    scene.materials.extend([
        Material {
            disney: Some(Disney { clearcoat: 1.0, clearcoat_gloss: 0.0, ..Disney::default() }),
            metallic: 0.2,
            ..metal.clone()
        },
        Material { metallic: 0.0, double_sided: true, emissive_nits: Vec3::new(0.0, 0.1, 0.3), ..metal },
    ]);
    let places = [
        DMat4::from_translation(DVec3::new(0.7, 0.3, 0.5)) * DMat4::from_scale(DVec3::new(-0.6, 0.4, 0.5)),
        DMat4::from_translation(DVec3::new(-0.6, -0.5, 0.4)) * DMat4::from_scale(DVec3::splat(0.5)),
    ];
    for (i, parent_from_node) in places.into_iter().enumerate() {
        let mut mesh = scene.meshes[0].clone();
        mesh.primitives[0].material = i + 1;
        scene.roots.push(scene.nodes.len());
        scene.nodes.push(Node { parent_from_node, mesh: Some(scene.meshes.len()), ..Default::default() });
        scene.meshes.push(mesh);
    }
    add_light(&mut scene, LightKind::Point { range_m: None }, 30.0, DVec3::new(2.0, 3.0, 3.0));
    let texels = (0..32 * 16).map(|i| Vec3::new(0.3, 0.5, (i % 32) as f32 / 32.0)).collect();
    scene.environment = Some(Environment::new(EnvironmentImage { width: 32, height: 16, texels }));
    scene
}

/// The radiance by the path that `choice` leads to, which has to be `expected`.
fn drawn(
    gpu: &Gpu,
    scene: &Scene,
    view: &View,
    options: CaptureOptions,
    (choice, expected): (PathChoice, RenderPath),
) -> RadianceImage {
    let bake = BakeOptions { suns: view.quality.parts_suns(), ..Default::default() };
    let maps = scene.environment.as_ref().map(|e| environment::bake(&e.image, &bake, &Silent));
    let mut renderer = Renderer::new(&gpu.device, &gpu.queue).with_paths(choice);
    let mut uploaded = renderer.upload(&gpu.device, &gpu.queue, scene, maps.as_ref()).unwrap();
    let target = CaptureTarget::new(gpu, view, options).unwrap();
    let wanted = Wanted { radiance: true, display: true };
    let frame = submit(gpu, &mut renderer, &mut uploaded, view, &target, wanted).unwrap();
    assert_eq!(frame.stats.path, expected);
    frame.wait(gpu).unwrap().radiance.unwrap()
}

fn both(gpu: &Gpu, scene: &Scene, view: &View, options: CaptureOptions) -> [RadianceImage; 2] {
    [(PathChoice::Forward, RenderPath::Forward), (PathChoice::Deferred, RenderPath::Deferred)]
        .map(|path| drawn(gpu, scene, view, options, path))
}

/// Root mean square of the difference in radiance and coverage, over that of what is expected, and the largest
/// difference in coverage.
fn difference(actual: &RadianceImage, expected: &RadianceImage) -> (f64, f32) {
    let pairs = || actual.texels.iter().zip(&expected.texels);
    let squares: f64 = pairs().map(|(a, b)| f64::from((*a - *b).length_squared())).sum();
    let power: f64 = expected.texels.iter().map(|texel| f64::from(texel.length_squared())).sum();
    let coverage = pairs().map(|(a, b)| (a.w - b.w).abs()).fold(0.0, f32::max);
    ((squares / power).sqrt(), coverage)
}

#[test]
fn with_one_sample_both_paths_draw_the_same() {
    let gpu = gpu(Precision::Float);
    let lit = scene();
    let mut dark = Scene { environment: None, ..scene() };
    dark.nodes.iter_mut().for_each(|node| node.light = None);
    let options = CaptureOptions { samples: 1, precision: Precision::Float };
    for (name, scene) in [("lit", &lit), ("dark", &dark)] {
        for background in
            [Background::Environment, Background::Transparent, Background::Color(Vec3::new(0.2, 0.4, 0.6))]
        {
            let view = View { background, ..front_view(SIDE_PX) };
            let [forward, deferred] = both(&gpu, scene, &view, options);
            let (error, coverage) = difference(&deferred, &forward);
            println!("{name}, {background:?}: {error:e}, coverage {coverage:e}");
            // Measured 4.0e-7: interpolation rounds otherwise. Margin 4.
            assert!(error < 1.6e-6 && coverage == 0.0, "{name}, {background:?}: {error:e}, coverage {coverage:e}");
        }
    }
}

#[test]
fn with_four_samples_both_cover_alike_and_the_deferred_path_is_nearer_to_the_truth() {
    let gpu = gpu(Precision::Float);
    let scene = scene();
    let options = CaptureOptions { samples: 4, precision: Precision::Float };
    let view = View { background: Background::Environment, ..front_view(SIDE_PX) };
    let [forward, deferred] = both(&gpu, &scene, &view, options);
    let transparent = View { background: Background::Transparent, ..view.clone() };
    let [sharp, soft] = both(&gpu, &scene, &transparent, options);
    let (_, coverage) = difference(&soft, &sharp);
    let truth = trace(&scene, &view, 64);
    let [of_forward, of_deferred] = [&forward, &deferred].map(|image| relative_rms(image, &truth));
    println!("forward {of_forward:.5}, deferred {of_deferred:.5}, coverage {coverage:e}");
    if of_deferred > of_forward || coverage > 1e-6 {
        leave_pictures("paths", &view, &deferred, &forward);
        panic!("forward {of_forward:.5}, deferred {of_deferred:.5}, coverage {coverage:e}");
    }
}

#[test]
fn a_model_with_textures_looks_alike_on_both_paths() {
    let Some(root) = samples() else { return };
    let gpu = gpu(Precision::Half);
    let mut scene = import(&root.join("models/DamagedHelmet.glb"));
    add_light(&mut scene, LightKind::Directional, 3.0, DVec3::ZERO);
    let view = View { background: Background::Transparent, ..default_view(&scene, glam::UVec2::splat(256)) };
    let [forward, deferred] = both(&gpu, &scene, &view, CaptureOptions { samples: 1, precision: Precision::Half });
    let (error, coverage) = difference(&deferred, &forward);
    println!("{error:e}, coverage {coverage:e}");
    if error > HELMET_DIFFERENCE || coverage > 0.0 {
        leave_pictures("paths-helmet", &view, &deferred, &forward);
        panic!("{error:e}, coverage {coverage:e}");
    }
}

/// Mipmap levels are chosen pixel by pixel on one path and for four pixels together on the other: measured 2.9e-4.
const HELMET_DIFFERENCE: f64 = 6e-4;

/// Mesa 22.3 compiles uniforms into a shader that decide in it, and crashed on a sun that did.
#[test]
fn suns_are_drawn_by_both_paths() {
    let gpu = gpu(Precision::Float);
    let plain = Material { metallic: 0.0, perceptual_roughness: 0.6, ..Default::default() };
    let scene = Scene { environment: Some(Environment::new(two_suns())), ..sphere_scene(plain) };
    for (samples, precision) in [(1, Precision::Float), (4, Precision::Float), (4, Precision::Half)] {
        let [forward, deferred] = both(&gpu, &scene, &front_view(SIDE_PX), CaptureOptions { samples, precision });
        let (rms, _) = difference(&deferred, &forward);
        println!("{samples} samples: {rms:.2e}");
        assert!(rms < if samples == 1 { 1e-4 } else { 2e-2 }, "{samples} samples: {rms}");
    }
}

#[test]
fn the_deferred_path_is_taken_only_where_it_can_be_and_pays() {
    let gpu = gpu(Precision::Half);
    let small = front_view(SIDE_PX);
    let options = CaptureOptions { samples: 1, ..Default::default() };
    let mut blended = scene();
    blended.materials[2].alpha_mode = AlphaMode::Blend;
    let channel = specula::scene::Channel::Nan;
    let cases = [
        (sphere_scene(Material::default()), &small, PathChoice::Faster, RenderPath::Deferred),
        (scene(), &small, PathChoice::Faster, RenderPath::Deferred),
        (scene(), &small, PathChoice::Deferred, RenderPath::Deferred),
        (scene(), &small, PathChoice::Forward, RenderPath::Forward),
        (blended, &small, PathChoice::Deferred, RenderPath::Forward),
        (scene(), &View { channel: Some(channel), ..small.clone() }, PathChoice::Deferred, RenderPath::Forward),
    ];
    for (scene, view, choice, expected) in cases {
        drawn(&gpu, &scene, view, options, (choice, expected));
    }
    // The same triangles are large in a large picture.
    let scene = sphere_scene(Material::default());
    let renderer = Renderer::new(&gpu.device, &gpu.queue).with_paths(PathChoice::Faster);
    let uploaded = renderer.upload(&gpu.device, &gpu.queue, &scene, None).unwrap();
    let into = ForwardTarget::radiance(Precision::Half.hdr_format(), 1);
    assert_eq!(renderer.path(&uploaded, &front_view(128), into), RenderPath::Deferred);
    assert_eq!(renderer.path(&uploaded, &front_view(8192), into), RenderPath::Forward);
}
