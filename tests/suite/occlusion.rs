//! What is hidden behind other things is not drawn, and the picture has the same bits.

use crate::support::{Numbers, add_light, front_view, gpu};
use glam::{DMat4, DQuat, DVec3, UVec2, Vec2, Vec3, Vec4};
use specula::capture::{CaptureOptions, CaptureTarget, Wanted, submit};
use specula::frame::Culling;
use specula::gpu::Gpu;
use specula::gpu::formats::Precision;
use specula::gpu_scene::GpuScene;
use specula::renderer::{FrameStats, Renderer};
use specula::scene::{
    AlphaMode, Background, Camera, LightKind, Material, Mesh, Node, Primitive, Projection, Scene, Topology, View,
    shapes,
};

fn flat(positions: Vec<Vec3>, indices: Vec<u32>, material: usize) -> Primitive {
    let count = positions.len();
    Primitive {
        topology: Topology::Triangles,
        normals: Some(vec![Vec3::Z; count]),
        uvs: vec![vec![Vec2::ZERO; count]],
        tangents: None,
        colors: None,
        positions,
        indices,
        material,
    }
}

/// A wall of 2 x 2 m that looks along +z, cut into `n` x `n` squares that stand `gap` m apart.
fn wall(n: u32, gap: f32, material: usize) -> Primitive {
    let side = 2.0 / n as f32;
    let (mut positions, mut indices) = (Vec::new(), Vec::new());
    for (row, column) in (0..n).flat_map(|row| (0..n).map(move |column| (row, column))) {
        let low = Vec2::new(column as f32, row as f32) * side - 1.0 + 0.5 * gap;
        let high = low + side - gap;
        let first = positions.len() as u32;
        positions.extend([low, Vec2::new(high.x, low.y), high, Vec2::new(low.x, high.y)].map(|at| at.extend(0.0)));
        indices.extend([0, 1, 2, 0, 2, 3].map(|corner| first + corner));
    }
    flat(positions, indices, material)
}

/// The same with joints at which vertices meet edges, and a hill of `height` m in the middle.
fn rough_wall(height: f32, material: usize) -> Primitive {
    let mut wall = wall(16, 0.0, material);
    for position in &mut wall.positions {
        position.z = height * (-4.0 * position.length_squared()).exp();
    }
    wall.indices.truncate(wall.indices.len() - 6);
    wall
}

fn cube(material: usize) -> Primitive {
    let faces = [DVec3::X, DVec3::NEG_X, DVec3::Y, DVec3::NEG_Y, DVec3::Z, DVec3::NEG_Z];
    let square = wall(1, 0.0, 0);
    let (mut positions, mut indices) = (Vec::new(), Vec::new());
    for face in faces {
        let turn = DQuat::from_rotation_arc(DVec3::Z, face).as_quat();
        indices.extend(square.indices.iter().map(|index| positions.len() as u32 + index));
        positions.extend(square.positions.iter().map(|at| (turn * (*at + Vec3::Z)).round()));
    }
    flat(positions, indices, material)
}

/// What may hide things, and what may not although it looks so.
fn meshes() -> (Vec<Mesh>, Vec<Material>) {
    let primitives = [
        wall(1, 0.0, 0),
        wall(4, 0.0, 0),
        // Gaps far below a pixel, and of about one.
        wall(3, 1e-4, 0),
        wall(5, 0.02, 0),
        rough_wall(0.4, 0),
        cube(0),
        shapes::sphere(1.0, 24, 0),
        wall(1, 0.0, 1),
        // Blended and masked ones.
        wall(1, 0.0, 2),
        wall(1, 0.0, 3),
        // What is behind.
        shapes::sphere(1.0, 4, 4),
        Primitive { topology: Topology::Points, normals: None, ..shapes::sphere(1.0, 4, 5) },
        shapes::sphere(1.0, 4, 2),
    ];
    let color = |r, g, b, a| Vec4::new(r, g, b, a);
    let materials = vec![
        Material { base_color: color(0.8, 0.7, 0.6, 1.0), ..Default::default() },
        Material { base_color: color(0.5, 0.7, 0.9, 1.0), double_sided: true, ..Default::default() },
        Material { base_color: color(0.4, 0.9, 0.3, 0.5), alpha_mode: AlphaMode::Blend, ..Default::default() },
        Material {
            base_color: color(0.4, 0.9, 0.3, 0.1),
            alpha_mode: AlphaMode::Mask { cutoff: 0.5 },
            ..Default::default()
        },
        Material { emissive_nits: Vec3::new(9.0, 3.0, 1.0), ..Default::default() },
        Material { base_color: color(0.2, 0.3, 1.0, 1.0), ..Default::default() },
    ];
    (primitives.into_iter().map(|primitive| Mesh { name: None, primitives: vec![primitive] }).collect(), materials)
}

const HIDING: usize = 10;

/// A few large things between the eye and many small ones, at random.
fn scene(seed: u64) -> Scene {
    let (meshes, materials) = meshes();
    let mut numbers = Numbers(seed);
    let mut scene = Scene { materials, ..Default::default() };
    let mut place = |mesh: usize, scale: DVec3, rotation: DQuat, at: DVec3| {
        let parent_from_node = DMat4::from_scale_rotation_translation(scale, rotation, at);
        scene.nodes.push(Node { parent_from_node, mesh: Some(mesh), ..Default::default() });
    };
    for _ in 0..6 {
        let axis = numbers.vector(-1.0, 1.0).normalize_or(DVec3::X);
        // Some face the eye, some lean, some have turned away, some are seen in a mirror.
        let turn = [0.0, 0.3, 1.2, 3.1][(4.0 * numbers.next()) as usize];
        let mirror = if numbers.next() < 0.3 { DVec3::new(-1.0, 1.0, 1.0) } else { DVec3::ONE };
        let scale = mirror * DVec3::new(numbers.between(0.3, 3.0), numbers.between(0.3, 3.0), 1.0);
        let at = DVec3::new(numbers.between(-2.0, 2.0), numbers.between(-1.5, 1.5), numbers.between(-1.0, 3.0));
        place((HIDING as f64 * numbers.next()) as usize, scale, DQuat::from_axis_angle(axis, turn), at);
    }
    for index in 0..600 {
        let size = 10.0_f64.powf(numbers.between(-2.5, -0.7));
        let at = numbers.vector(-1.0, 1.0) * DVec3::new(4.0, 3.0, 4.0) + DVec3::NEG_Z * 3.0;
        place(HIDING + index % 3, DVec3::splat(size), DQuat::IDENTITY, at);
    }
    scene.meshes = meshes;
    scene.roots = (0..scene.nodes.len()).collect();
    add_light(&mut scene, LightKind::Directional, 3.0, DVec3::ZERO);
    scene
}

fn bits(
    gpu: &Gpu,
    (renderer, scene): (&mut Renderer, &mut GpuScene),
    view: &View,
    samples: u32,
) -> (Vec<u64>, FrameStats) {
    let target = CaptureTarget::new(gpu, view, CaptureOptions { samples, precision: Precision::Half }).unwrap();
    let pending = submit(gpu, renderer, scene, view, &target, Wanted { radiance: true, display: false }).unwrap();
    let stats = pending.stats.clone();
    let radiance = pending.wait(gpu).unwrap().radiance.unwrap();
    let texel = |texel: &Vec4| {
        texel.to_array().map(f32::to_bits).into_iter().fold(0, |all: u64, bits| all.rotate_left(17) ^ u64::from(bits))
    };
    (radiance.texels.iter().map(texel).collect(), stats)
}

fn view(numbers: &mut Numbers, projection: Projection) -> View {
    let eye = DVec3::new(numbers.between(-1.0, 1.0), numbers.between(-1.0, 1.0), numbers.between(1.0, 6.0));
    let target = DVec3::new(numbers.between(-1.0, 1.0), numbers.between(-1.0, 1.0), -1.0);
    let camera = Camera::look_at(eye, target, DVec3::Y, projection, 0.05, 40.0);
    let size_px = UVec2::new(numbers.between(60.0, 330.0) as u32, numbers.between(60.0, 230.0) as u32);
    View { camera, size_px, background: Background::Transparent, ..front_view(1) }
}

#[test]
fn leaving_out_what_is_hidden_changes_no_bit() {
    let gpu = gpu(Precision::Half);
    let mut renderer = Renderer::new(&gpu.device, &gpu.queue);
    let (mut hidden, mut all) = (0, 0);
    for seed in 0..40 {
        let mut uploaded = renderer.upload(&gpu.device, &gpu.queue, &scene(seed), None).unwrap();
        let mut numbers = Numbers(seed ^ 0xBEEF);
        for projection in [
            Projection::Perspective { fov_y_rad: 0.8 },
            Projection::Perspective { fov_y_rad: 1.9 },
            Projection::Orthographic { height_m: 5.0 },
        ] {
            let view = view(&mut numbers, projection);
            for samples in [1, 4] {
                let mut draw = |culling| {
                    renderer.culling = culling;
                    bits(&gpu, (&mut renderer, &mut uploaded), &view, samples)
                };
                let (expected, stats_of_all) = draw(Culling::NotHidden);
                let (found, stats) = draw(Culling::On);
                assert_eq!(stats_of_all.placements.hidden, 0);
                let differing = (0..expected.len()).filter(|&i| found[i] != expected[i]).count();
                assert_eq!(differing, 0, "scene {seed}, {projection:?}, {samples} samples: {}", stats.placements);
                hidden += stats.placements.hidden;
                all += stats_of_all.placements.drawn();
            }
        }
    }
    println!("{hidden} of {all} hidden");
    assert!(hidden > all / 5, "{hidden} of {all} hidden");
}
