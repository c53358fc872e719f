//! What is not drawn would not have been seen, and what has not changed is not drawn again.

use crate::support::{Numbers, add_light, front_view, gpu, import, sphere_scene, submission_number};
use glam::{DMat4, DQuat, DVec3, UVec2, Vec3, Vec4};
use specula::bake::environment::{BakeOptions, bake};
use specula::capture::{CaptureOptions, CaptureTarget, CapturedFrame, Wanted, redraw, submit};
use specula::frame::Culling;
use specula::gpu::Gpu;
use specula::gpu::formats::Precision;
use specula::gpu_scene::GpuScene;
use specula::progress::Silent;
use specula::renderer::{FrameStats, Renderer};
use specula::scene::{
    AlphaMode, Background, Camera, Environment, LightKind, Material, Mesh, Node, Primitive, Projection, Scene,
    Topology, View, shapes,
};
use std::path::Path;

/// A sphere as triangles, and its vertices as lines and points, of different materials.
fn meshes() -> (Vec<Mesh>, Vec<Material>) {
    let sphere = shapes::sphere(0.5, 8, 0);
    let bare = |topology, material| Primitive { topology, normals: None, material, ..sphere.clone() };
    let even = sphere.indices.len() / 2 * 2;
    let lines = Primitive { indices: sphere.indices[..even].to_vec(), ..bare(Topology::Lines, 3) };
    let primitives = [
        sphere.clone(),
        Primitive { material: 1, ..sphere.clone() },
        Primitive { material: 2, ..sphere.clone() },
        lines,
        bare(Topology::Points, 4),
    ];
    let color = |r, g, b, a| Vec4::new(r, g, b, a);
    let materials = vec![
        Material { base_color: color(0.9, 0.5, 0.2, 1.0), metallic: 0.0, ..Default::default() },
        Material { base_color: color(0.2, 0.6, 0.9, 1.0), double_sided: true, ..Default::default() },
        Material { base_color: color(0.4, 0.9, 0.3, 0.5), alpha_mode: AlphaMode::Blend, ..Default::default() },
        Material { base_color: color(1.0, 0.3, 0.7, 1.0), ..Default::default() },
        Material { base_color: color(0.8, 0.8, 0.1, 1.0), ..Default::default() },
    ];
    (primitives.into_iter().map(|primitive| Mesh { name: None, primitives: vec![primitive] }).collect(), materials)
}

/// Objects of all sizes and handednesses around the eye and on all sides of the picture, some flat, some of no size, some
/// beyond what float32 can hold.
fn crowd() -> Scene {
    let (meshes, materials) = meshes();
    let mut numbers = Numbers(7);
    let mut scene = Scene { materials, ..Default::default() };
    for index in 0..1500 {
        let size = 10.0_f64.powf(1.5 * numbers.between(-1.0, 1.0) - 1.5);
        let stretch = match index % 10 {
            0 => DVec3::new(-1.0, 1.0, 1.0),
            1 => DVec3::new(1.0, 0.0, 1.0),
            2 => DVec3::new(0.3, -2.0, 1.0),
            3 if index % 50 == 3 => DVec3::ZERO,
            _ => DVec3::ONE,
        };
        let axis = numbers.vector(-1.0, 1.0).normalize_or(DVec3::X);
        let rotation = DQuat::from_axis_angle(axis, numbers.between(-1.0, 1.0) * 3.0);
        let place = numbers.vector(-1.0, 1.0) * DVec3::new(9.0, 6.0, 14.0);
        let parent_from_node = DMat4::from_scale_rotation_translation(size * stretch, rotation, place);
        scene.nodes.push(Node { parent_from_node, mesh: Some(index % meshes.len()), ..Default::default() });
    }
    // Too large for the squares, the numbers and the picture; too small for any of them; and far away.
    for (scale, place) in [
        (1e25, DVec3::ZERO),
        (1e39, DVec3::X),
        (1e-30, DVec3::new(0.1, 0.1, 0.0)),
        (1.0, DVec3::NEG_Z * 1e9),
        (1e8, DVec3::NEG_Z * 1e9),
    ] {
        let parent_from_node = DMat4::from_translation(place) * DMat4::from_scale(DVec3::splat(scale));
        scene.nodes.push(Node { parent_from_node, mesh: Some(0), ..Default::default() });
    }
    scene.meshes = meshes;
    scene.roots = (0..scene.nodes.len()).collect();
    add_light(&mut scene, LightKind::Directional, 3.0, DVec3::ZERO);
    add_light(&mut scene, LightKind::Point { range_m: None }, 60.0, DVec3::new(1.0, 2.0, 4.0));
    scene
}

/// Draws with and without culling; the pictures must have the same bits.
fn assert_same(gpu: &Gpu, (renderer, scene): (&mut Renderer, &mut GpuScene), view: &View, samples: u32) -> FrameStats {
    let options = CaptureOptions { samples, precision: Precision::Half };
    let mut draw = |culling| -> (CapturedFrame, FrameStats) {
        renderer.culling = culling;
        let target = CaptureTarget::new(gpu, view, options).unwrap();
        let frame = submit(gpu, renderer, scene, view, &target, Wanted { radiance: true, display: true }).unwrap();
        let stats = frame.stats.clone();
        (frame.wait(gpu).unwrap(), stats)
    };
    let (all, stats_of_all) = draw(Culling::Off);
    let (culled, stats) = draw(Culling::On);
    assert_eq!(stats_of_all.placements.drawn(), stats.placements.all);
    let bits = |frame: CapturedFrame| -> Vec<[u32; 4]> {
        frame.radiance.unwrap().texels.iter().map(|texel| texel.to_array().map(f32::to_bits)).collect()
    };
    let (all, culled) = (bits(all), bits(culled));
    let covered = all.iter().filter(|texel| texel[3] != 0).count();
    assert!(covered > 100, "only {covered} pixels of {} show anything", all.len());
    let differing: Vec<usize> = (0..all.len()).filter(|&i| all[i] != culled[i]).collect();
    assert!(
        differing.is_empty(),
        "{samples} samples: {} pixels differ, the first is {:?}",
        differing.len(),
        differing.first()
    );
    stats
}

fn looking(eye: DVec3, target: DVec3, projection: Projection) -> View {
    // From afar all of the crowd is before the far plane, else a part of it.
    let far_m = f64::max(12.0, 1.5 * eye.distance(target));
    let camera = Camera::look_at(eye, target, DVec3::Y, projection, 0.5, far_m);
    View { camera, size_px: UVec2::new(200, 120), background: Background::Transparent, ..front_view(1) }
}

#[test]
fn culling_changes_no_bit() {
    let gpu = gpu(Precision::Half);
    let scene = crowd();
    let mut renderer = Renderer::new(&gpu.device, &gpu.queue);
    let mut uploaded = renderer.upload(&gpu.device, &gpu.queue, &scene, None).unwrap();
    let (mut outside, mut between_samples) = (0, 0);
    for projection in [
        Projection::Perspective { fov_y_rad: 0.7 },
        Projection::Perspective { fov_y_rad: 2.2 },
        Projection::Orthographic { height_m: 6.0 },
    ] {
        for (eye, target) in [
            (DVec3::new(0.0, 0.0, 4.0), DVec3::ZERO),
            (DVec3::new(3.0, 4.0, 1.0), DVec3::new(0.0, 0.0, -2.0)),
            (DVec3::new(-30.0, 1.0, 0.0), DVec3::ZERO),
        ] {
            for samples in [1, 4] {
                let view = looking(eye, target, projection);
                let stats = assert_same(&gpu, (&mut renderer, &mut uploaded), &view, samples);
                println!("{projection:?} from {eye}, {samples} samples: {}", stats.placements);
                outside += stats.placements.outside;
                between_samples += stats.placements.between_samples;
            }
        }
    }
    assert!(outside > 10_000 && between_samples > 1000, "{outside} outside, {between_samples} between samples");
}

#[test]
fn a_scene_around_a_far_origin_is_culled_alike() {
    let gpu = gpu(Precision::Half);
    let mut scene = crowd();
    scene.nodes.truncate(1500);
    scene.roots.truncate(1500);
    let far = DVec3::new(3e6, -2e5, 7e6);
    scene
        .nodes
        .iter_mut()
        .for_each(|node| node.parent_from_node = DMat4::from_translation(far) * node.parent_from_node);
    add_light(&mut scene, LightKind::Directional, 3.0, DVec3::ZERO);
    let mut renderer = Renderer::new(&gpu.device, &gpu.queue);
    let mut uploaded = renderer.upload(&gpu.device, &gpu.queue, &scene, None).unwrap();
    let view = looking(far + DVec3::new(0.0, 0.0, 4.0), far, Projection::Perspective { fov_y_rad: 0.7 });
    let stats = assert_same(&gpu, (&mut renderer, &mut uploaded), &view, 1);
    assert!(stats.placements.outside > 500, "{}", stats.placements);
}

#[test]
fn instances_are_one_call_and_look_like_meshes_of_their_own() {
    let gpu = gpu(Precision::Half);
    let mut separate = sphere_scene(Material::default());
    let mut shared = separate.clone();
    let places: Vec<DMat4> = (0..40)
        .map(|i| DVec3::new(f64::from(i % 8) - 3.5, f64::from(i / 8) - 2.0, f64::from(i % 3)) * 0.3)
        .map(|place| DMat4::from_translation(place) * DMat4::from_scale(DVec3::splat(0.1)))
        .collect();
    let sphere = separate.meshes[0].clone();
    separate.meshes = vec![sphere; places.len()];
    separate.nodes = (places.iter().enumerate())
        .map(|(mesh, &parent_from_node)| Node { parent_from_node, mesh: Some(mesh), ..Default::default() })
        .collect();
    separate.roots = (0..places.len()).collect();
    shared.nodes[0].node_from_objects = Some(places);
    let mut frames = Vec::new();
    for mut scene in [separate, shared] {
        add_light(&mut scene, LightKind::Point { range_m: None }, 30.0, DVec3::new(2.0, 2.0, 3.0));
        let mut renderer = Renderer::new(&gpu.device, &gpu.queue);
        let mut uploaded = renderer.upload(&gpu.device, &gpu.queue, &scene, None).unwrap();
        let target = CaptureTarget::new(&gpu, &front_view(96), CaptureOptions::default()).unwrap();
        let wanted = Wanted { radiance: true, display: false };
        let frame = submit(&gpu, &mut renderer, &mut uploaded, &front_view(96), &target, wanted).unwrap();
        assert_eq!((frame.stats.draws, frame.stats.placements.drawn()), (1, 40));
        frames.push((uploaded.bytes.geometry, frame.wait(&gpu).unwrap()));
    }
    assert!(frames[0] == frames[1]);
}

/// The showcase under the studio, with the panorama in sight: every pass of a frame.
fn showcase(gpu: &Gpu) -> (Renderer, GpuScene, View) {
    let mut scene = import(Path::new("assets/showcase.glb"));
    scene.environment = Some(Environment::new(specula::bake::studio::studio()));
    let maps = scene.environment.as_ref().map(|e| bake(&e.image, &BakeOptions::default(), &Silent));
    let view = View {
        camera: scene.cameras_in_world().remove(0),
        size_px: UVec2::new(96, 72),
        background: Background::Environment,
        ..front_view(1)
    };
    let renderer = Renderer::new(&gpu.device, &gpu.queue);
    let uploaded = renderer.upload(&gpu.device, &gpu.queue, &scene, maps.as_ref()).unwrap();
    (renderer, uploaded, view)
}

#[test]
fn an_unchanged_view_is_not_drawn_again() {
    let gpu = gpu(Precision::Half);
    let (mut renderer, mut scene, mut view) = showcase(&gpu);
    let target = CaptureTarget::new(&gpu, &view, CaptureOptions::default()).unwrap();
    assert!(redraw(&gpu, &mut renderer, &mut scene, &view, &target).unwrap().is_some());
    gpu.wait().unwrap();
    let before = submission_number(&gpu);
    let mut drawn = 0;
    let allocations = allocation_counter::measure(|| {
        for _ in 0..1000 {
            drawn += u32::from(redraw(&gpu, &mut renderer, &mut scene, &view, &target).unwrap().is_some());
        }
    });
    assert_eq!((drawn, allocations.count_total, allocations.bytes_total), (0, 0, 0));
    assert_eq!(submission_number(&gpu), before + 1, "something was submitted");

    // Whatever the picture depends on is noticed.
    let mut is_drawn =
        |view: &View, target: &CaptureTarget| redraw(&gpu, &mut renderer, &mut scene, view, target).unwrap().is_some();
    view.exposure_ev += 1.0;
    assert!(is_drawn(&view, &target) && !is_drawn(&view, &target));
    view.camera.world_from_view *= DMat4::from_rotation_y(0.1);
    assert!(is_drawn(&view, &target) && !is_drawn(&view, &target));
    view.background = Background::Color(Vec3::ONE);
    assert!(is_drawn(&view, &target) && !is_drawn(&view, &target));
    target.state().forget();
    assert!(is_drawn(&view, &target) && !is_drawn(&view, &target));
    let other = CaptureTarget::new(&gpu, &view, CaptureOptions::default()).unwrap();
    assert!(is_drawn(&view, &other) && !is_drawn(&view, &target));
    let (_, mut other_scene, _) = showcase(&gpu);
    assert!(redraw(&gpu, &mut renderer, &mut other_scene, &view, &target).unwrap().is_some());
}

#[test]
fn a_turning_camera_makes_no_buffers_and_no_bind_groups() {
    let gpu = gpu(Precision::Half);
    let (mut renderer, mut scene, mut view) = showcase(&gpu);
    let target = CaptureTarget::new(&gpu, &view, CaptureOptions::default()).unwrap();
    redraw(&gpu, &mut renderer, &mut scene, &view, &target).unwrap();
    let made = target.state().resources_made();
    assert!(made > 0);
    let wanted = Wanted { radiance: true, display: true };
    for turn in 0..30 {
        view.camera.world_from_view *= DMat4::from_rotation_y(0.21);
        assert!(redraw(&gpu, &mut renderer, &mut scene, &view, &target).unwrap().is_some());
        if turn % 10 == 0 {
            let fresh = CaptureTarget::new(&gpu, &view, CaptureOptions::default()).unwrap();
            let [kept, fresh] = [&target, &fresh].map(|target| {
                submit(&gpu, &mut renderer, &mut scene, &view, target, wanted).unwrap().wait(&gpu).unwrap()
            });
            assert!(kept == fresh, "turn {turn}: what is kept of other frames shows");
        }
    }
    assert_eq!(target.state().resources_made(), made);
    gpu.check().unwrap();
}
