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
    AlphaMode, Background, Disney, Environment, EnvironmentImage, Image, LightKind, Material, Node, Pixels,
    RadianceImage, Sampler, Scene, Texture, TextureRef, TextureSlot, Topology, UvTransform, View,
};

const SIDE_PX: u32 = 96;

/// Spheres that hide and touch each other, one of them mirrored and squeezed, each of another material, lit by a lamp and
/// an uneven sky.
fn scene() -> Scene {
    let metal = Material { base_color: Vec4::new(0.9, 0.6, 0.3, 1.0), perceptual_roughness: 0.4, ..Default::default() };
    let mut scene = sphere_scene(metal.clone());
    let disney = Disney { clearcoat: 1.0, clearcoat_gloss: 0.0, ..Disney::default() };
    let squeezed = DMat4::from_scale(DVec3::new(-0.6, 0.4, 0.5));
    let painted = Material { disney: Some(disney), metallic: 0.2, ..metal.clone() };
    add_sphere(&mut scene, painted, DMat4::from_translation(DVec3::new(0.7, 0.3, 0.5)) * squeezed);
    let lamp = Material { metallic: 0.0, double_sided: true, emissive_nits: Vec3::new(0.0, 0.1, 0.3), ..metal };
    add_sphere(&mut scene, lamp, at(-0.6, -0.5, 0.4, 0.5));
    add_light(&mut scene, LightKind::Point { range_m: None }, 30.0, DVec3::new(2.0, 3.0, 3.0));
    let texels = (0..32 * 16).map(|i| Vec3::new(0.3, 0.5, (i % 32) as f32 / 32.0)).collect();
    scene.environment = Some(Environment::new(EnvironmentImage { width: 32, height: 16, texels }));
    scene
}

fn at(x: f64, y: f64, z: f64, scale: f64) -> DMat4 {
    DMat4::from_translation(DVec3::new(x, y, z)) * DMat4::from_scale(DVec3::splat(scale))
}

/// Adds the first sphere once more, of another material.
fn add_sphere(scene: &mut Scene, material: Material, parent_from_node: DMat4) {
    let mut mesh = scene.meshes[0].clone();
    mesh.primitives[0].material = scene.materials.len();
    scene.materials.push(material);
    scene.roots.push(scene.nodes.len());
    scene.nodes.push(Node { parent_from_node, mesh: Some(scene.meshes.len()), ..Default::default() });
    scene.meshes.push(mesh);
}

/// The same with blended spheres: before edges of others and the background, half hidden by another, on the very surface of
/// one, and one that lets nothing through.
fn glazed() -> Scene {
    let mut scene = scene();
    let glass = |r, g, b, alpha| Material {
        base_color: Vec4::new(r, g, b, alpha),
        alpha_mode: AlphaMode::Blend,
        metallic: 0.0,
        ..Default::default()
    };
    add_sphere(&mut scene, glass(0.3, 0.8, 0.5, 0.4), at(0.6, 0.7, 0.9, 0.3));
    add_sphere(&mut scene, glass(0.8, 0.3, 0.2, 0.7), at(-0.7, 0.6, -0.4, 0.5));
    add_sphere(&mut scene, glass(0.1, 0.2, 0.9, 0.2), DMat4::IDENTITY);
    add_sphere(&mut scene, glass(0.9, 0.9, 0.9, 1.0), at(0.5, -0.7, 0.7, 0.25));
    scene
}

/// The same with a sphere at two places, and with what else is drawn forward: one with holes, one that is there twice, and
/// lines; and blended ones over that.
fn with_holes() -> Scene {
    let mut scene = glazed();
    let texture = TextureRef { texture: 0, uv_set: 0, transform: UvTransform::IDENTITY };
    let mut grille = Material { alpha_mode: AlphaMode::Mask { cutoff: 0.5 }, double_sided: true, ..Default::default() };
    grille.set_texture(TextureSlot::BaseColor, Some(texture));
    let texels = (0..16 * 16).flat_map(|i| [200, 120, 40, if (i / 4 + i / 64) % 2 == 0 { 255 } else { 0 }]);
    let pixels = Pixels::Rgba8(texels.collect::<Vec<u8>>().into());
    scene.images.push(Image { name: None, width: 16, height: 16, pixels });
    scene.textures.push(Texture { image: 0, sampler: Sampler::default() });
    add_sphere(&mut scene, grille, at(0.1, 0.2, 1.0, 0.35));
    let copied = scene.meshes.len();
    add_sphere(&mut scene, Material { perceptual_roughness: 0.7, ..Default::default() }, at(-0.2, -0.9, 0.5, 0.2));
    scene.roots.push(scene.nodes.len());
    let parent_from_node = at(0.9, -0.1, -0.2, 0.4);
    scene.nodes.push(Node { parent_from_node, mesh: Some(copied), ..Default::default() });
    add_sphere(&mut scene, Material { perceptual_roughness: 0.2, ..Default::default() }, at(-0.8, 0.8, 0.3, 0.15));
    let mesh = scene.meshes.last_mut().unwrap();
    let again = mesh.primitives[0].clone();
    mesh.primitives.push(again);
    add_sphere(&mut scene, Material::default(), at(0.0, 0.0, 0.3, 0.9));
    scene.meshes.last_mut().unwrap().primitives[0].topology = Topology::Lines;
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
    let mut renderer = Renderer::new(&gpu.device, &gpu.queue).with_paths(choice);
    drawn_by(gpu, &mut renderer, scene, (view, options), expected)
}

fn drawn_by(
    gpu: &Gpu,
    renderer: &mut Renderer,
    scene: &Scene,
    (view, options): (&View, CaptureOptions),
    expected: RenderPath,
) -> RadianceImage {
    let bake = BakeOptions { suns: view.quality.parts_suns(), ..Default::default() };
    let maps = scene.environment.as_ref().map(|e| environment::bake(&e.image, &bake, &Silent));
    let mut uploaded = renderer.upload(&gpu.device, &gpu.queue, scene, maps.as_ref()).unwrap();
    let target = CaptureTarget::new(gpu, view, options).unwrap();
    let wanted = Wanted { radiance: true, display: true };
    let frame = submit(gpu, renderer, &mut uploaded, view, &target, wanted).unwrap();
    assert_eq!(frame.stats.path, expected);
    frame.wait(gpu).unwrap().radiance.unwrap()
}

/// By the forward path and by the other, which has to be `expected`.
fn both(gpu: &Gpu, scene: &Scene, view: &View, options: CaptureOptions, expected: RenderPath) -> [RadianceImage; 2] {
    [(PathChoice::Forward, RenderPath::Forward), (PathChoice::Deferred, expected)]
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
    let (glazed, with_holes) = (glazed(), with_holes());
    let deferred = [("lit", &lit), ("dark", &dark)].map(|scene| (scene, RenderPath::Deferred));
    let mixed = [("glazed", &glazed), ("with holes", &with_holes)].map(|scene| (scene, RenderPath::Mixed));
    for ((name, scene), path) in deferred.into_iter().chain(mixed) {
        for background in
            [Background::Environment, Background::Transparent, Background::Color(Vec3::new(0.2, 0.4, 0.6))]
        {
            let view = View { background, ..front_view(SIDE_PX) };
            let [forward, deferred] = both(&gpu, scene, &view, options, path);
            let (error, coverage) = difference(&deferred, &forward);
            println!("{name}, {background:?}: {error:e}, coverage {coverage:e}");
            // Measured 4.0e-7: interpolation rounds otherwise. Margin 4. What is seen through and what it is seen through
            // need not be 1 to the bit.
            let rounding = if path == RenderPath::Mixed { f32::EPSILON } else { 0.0 };
            let is_right = error < 1.6e-6 && coverage <= rounding;
            assert!(is_right, "{name}, {background:?}: {error:e}, coverage {coverage:e}");
        }
    }
}

#[test]
fn with_four_samples_both_cover_alike_and_the_deferred_path_is_nearer_to_the_truth() {
    let gpu = gpu(Precision::Float);
    let options = CaptureOptions { samples: 4, precision: Precision::Float };
    for (name, scene, path) in [("paths", scene(), RenderPath::Deferred), ("paths-glazed", glazed(), RenderPath::Mixed)]
    {
        let view = View { background: Background::Environment, ..front_view(SIDE_PX) };
        let [forward, deferred] = both(&gpu, &scene, &view, options, path);
        let transparent = View { background: Background::Transparent, ..view.clone() };
        let [sharp, soft] = both(&gpu, &scene, &transparent, options, path);
        let (_, coverage) = difference(&soft, &sharp);
        let truth = trace(&scene, &view, 64);
        let [of_forward, of_deferred] = [&forward, &deferred].map(|image| relative_rms(image, &truth));
        println!("{name}: forward {of_forward:.5}, deferred {of_deferred:.5}, coverage {coverage:e}");
        if of_deferred > of_forward || coverage > 1e-6 {
            leave_pictures(name, &view, &deferred, &forward);
            panic!("{name}: forward {of_forward:.5}, deferred {of_deferred:.5}, coverage {coverage:e}");
        }
    }
}

/// The paths shade in other places of a pixel. Of surfaces that look the same from everywhere that is no difference, so all
/// samples have to be those of the forward path, at the edges of whatever lies over or under whatever.
#[test]
fn with_four_samples_both_paths_draw_the_same_of_even_surfaces() {
    for (precision, limit) in [(Precision::Float, 1e-6), (Precision::Half, 1e-3)] {
        let gpu = gpu(precision);
        let options = CaptureOptions { samples: 4, precision };
        for (name, mut scene) in [("glazed", glazed()), ("with holes", with_holes())] {
            scene.materials.iter_mut().for_each(|material| material.unlit = true);
            for background in [Background::Environment, Background::Transparent] {
                let view = View { background, ..front_view(SIDE_PX) };
                let [forward, mixed] = both(&gpu, &scene, &view, options, RenderPath::Mixed);
                let (error, coverage) = difference(&mixed, &forward);
                println!("{name}, {background:?}, {precision:?}: {error:e}, coverage {coverage:e}");
                if error > limit || f64::from(coverage) > limit {
                    leave_pictures("paths-even", &view, &mixed, &forward);
                    panic!("{name}, {background:?}, {precision:?}: {error:e}, coverage {coverage:e}");
                }
            }
        }
    }
}

#[test]
fn a_model_with_textures_looks_alike_on_both_paths() {
    let Some(root) = samples() else { return };
    let gpu = gpu(Precision::Half);
    let options = CaptureOptions { samples: 1, precision: Precision::Half };
    // Coverage behind glass is a sum of two half floats.
    let flight = ("models/FlightHelmet/FlightHelmet.gltf", RenderPath::Mixed, 1e-3);
    for (model, path, most_coverage) in [("models/DamagedHelmet.glb", RenderPath::Deferred, 0.0), flight] {
        let mut scene = import(&root.join(model));
        add_light(&mut scene, LightKind::Directional, 3.0, DVec3::ZERO);
        let view = View { background: Background::Transparent, ..default_view(&scene, glam::UVec2::splat(256)) };
        let [forward, deferred] = both(&gpu, &scene, &view, options, path);
        let (error, coverage) = difference(&deferred, &forward);
        println!("{model}: {error:e}, coverage {coverage:e}");
        if error > HELMET_DIFFERENCE || coverage > most_coverage {
            leave_pictures("paths-helmet", &view, &deferred, &forward);
            panic!("{model}: {error:e}, coverage {coverage:e}");
        }
    }
}

/// Mipmap levels are chosen pixel by pixel on one path and for four pixels together on the other: measured 2.9e-4.
const HELMET_DIFFERENCE: f64 = 6e-4;

/// Mesa 22.3 compiles uniforms into a shader that decide in it, and crashed on a sun that did.
#[test]
fn one_renderer_takes_the_deferred_path_for_scenes_of_other_lights() {
    let gpu = gpu(Precision::Float);
    let dark = Scene { environment: None, ..scene() };
    let mut without_lamp = scene();
    without_lamp.nodes.iter_mut().for_each(|node| node.light = None);
    let mut renderer = Renderer::new(&gpu.device, &gpu.queue).with_paths(PathChoice::Deferred);
    let options = CaptureOptions { samples: 1, precision: Precision::Float };
    let deferred = (PathChoice::Deferred, RenderPath::Deferred);
    for scene in [&without_lamp, &dark, &scene(), &dark] {
        let view = front_view(SIDE_PX);
        let shared = drawn_by(&gpu, &mut renderer, scene, (&view, options), RenderPath::Deferred);
        assert_eq!(shared.texels, drawn(&gpu, scene, &view, options, deferred).texels);
    }
}

#[test]
fn suns_are_drawn_by_both_paths() {
    let gpu = gpu(Precision::Float);
    let plain = Material { metallic: 0.0, perceptual_roughness: 0.6, ..Default::default() };
    let scene = Scene { environment: Some(Environment::new(two_suns())), ..sphere_scene(plain) };
    let view = front_view(SIDE_PX);
    for (samples, precision) in [(1, Precision::Float), (4, Precision::Float), (4, Precision::Half)] {
        let [forward, deferred] =
            both(&gpu, &scene, &view, CaptureOptions { samples, precision }, RenderPath::Deferred);
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
    blended.materials.iter_mut().for_each(|material| material.alpha_mode = AlphaMode::Blend);
    let mut beside = scene();
    add_sphere(&mut beside, Material { alpha_mode: AlphaMode::Blend, ..Default::default() }, at(9.0, 0.0, 0.0, 1.0));
    let many = |last: AlphaMode| {
        let mut scene = scene();
        for _ in 0..62 {
            add_sphere(&mut scene, Material { alpha_mode: last, ..Default::default() }, at(0.0, 0.0, 0.0, 0.1));
        }
        scene
    };
    let channel = specula::scene::Channel::Nan;
    let cases = [
        (sphere_scene(Material::default()), &small, PathChoice::Faster, RenderPath::Deferred),
        (scene(), &small, PathChoice::Faster, RenderPath::Deferred),
        (scene(), &small, PathChoice::Deferred, RenderPath::Deferred),
        (scene(), &small, PathChoice::Forward, RenderPath::Forward),
        (blended, &small, PathChoice::Deferred, RenderPath::Forward),
        (glazed(), &small, PathChoice::Faster, RenderPath::Mixed),
        (with_holes(), &small, PathChoice::Deferred, RenderPath::Mixed),
        // Out of sight.
        (beside, &small, PathChoice::Deferred, RenderPath::Deferred),
        (many(AlphaMode::Opaque), &small, PathChoice::Deferred, RenderPath::Forward),
        (many(AlphaMode::Blend), &small, PathChoice::Deferred, RenderPath::Mixed),
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
