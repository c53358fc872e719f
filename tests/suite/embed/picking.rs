//! What is said to be at a pixel, against spheres that are solved for.

use super::edits::Stage;
use super::{encoder, model};
use crate::support::submission_number;
use glam::{DMat4, DVec3, UVec2};
use specula::embed::{EmbedError, Hit, LiveScene, ModelId, Pick};
use specula::gpu::DeviceLost;
use specula::renderer::RenderError;
use specula::scene::{Camera, Projection, Scene, View};

const SIZE_PX: UVec2 = UVec2::new(64, 48);

/// The model, and another of the same kind above it that is half as large.
fn two_models() -> (LiveScene, [(ModelId, DMat4); 2]) {
    let mut scene = LiveScene::new();
    let above = DMat4::from_translation(DVec3::new(0.3, 1.2, 0.5)) * DMat4::from_scale(DVec3::splat(0.5));
    let models = [DMat4::IDENTITY, above].map(|transform| {
        let id = scene.insert(&model()).unwrap();
        scene.set_transform(id, transform).unwrap();
        (id, transform)
    });
    (scene, models)
}

/// Centre and radius of the spheres of [`model`], with node, mesh and material.
const SPHERES: [(DVec3, f64, [usize; 3]); 3] = [
    (DVec3::ZERO, 1.0, [0, 0, 0]),
    (DVec3::new(-1.1, 0.0, -1.1), 0.5, [1, 1, 1]),
    (DVec3::new(1.1, 0.0, 1.1), 0.5, [2, 1, 1]),
];

/// What a pixel must show, or nothing where the ray passes near the edge of a sphere.
fn truth(view: &View, pixel: UVec2, models: &[(ModelId, DMat4)]) -> Option<Option<Hit>> {
    let (origin, direction) = view.camera.ray(pixel.as_dvec2() + 0.5, view.size_px);
    let mut nearest: Option<(f64, Hit)> = None;
    for (model, world_from_model) in models {
        let scale = world_from_model.x_axis.length();
        for (center, radius, [node, mesh, material]) in SPHERES {
            let (center, radius) = (world_from_model.transform_point3(center), radius * scale);
            let along = (center - origin).dot(direction);
            let off = (origin + along * direction - center).length() / radius;
            if (off - 1.0).abs() < 0.05 {
                return None;
            }
            let distance = along - radius * (1.0 - off * off).max(0.0).sqrt();
            if off > 1.0 || nearest.is_some_and(|(nearest, _)| nearest < distance) {
                continue;
            }
            let position_in_world = origin + distance * direction;
            let eye = view.camera.position_in_world();
            let depth_m = (position_in_world - eye).dot(view.camera.forward_in_world());
            let hit = Hit { model: *model, node, mesh, primitive: 0, material, position_in_world, depth_m };
            nearest = Some((distance, hit));
        }
    }
    Some(nearest.map(|(_, hit)| hit))
}

fn pick(
    stage: &mut Stage,
    scene: &mut LiveScene,
    encoder: &mut wgpu::CommandEncoder,
    (view, pixel): (&View, UVec2),
) -> Result<Pick, EmbedError> {
    scene.pick(&mut stage.renderer, (&stage.gpu.device, &stage.gpu.queue), encoder, (view, pixel))
}

#[test]
fn every_pixel_says_what_it_shows() {
    let mut stage = Stage::new(SIZE_PX);
    let (mut scene, models) = two_models();
    let perspective = View { size_px: SIZE_PX, ..super::view() };
    let orthographic = Projection::Orthographic { height_m: 3.0 };
    let camera = Camera::look_at(DVec3::new(2.0, 1.5, 4.0), DVec3::ZERO, DVec3::Y, orthographic, 0.5, 20.0);
    let flat = View { camera, size_px: SIZE_PX, ..super::view() };
    for view in [perspective, flat] {
        let mut encoder = encoder(&stage.gpu);
        let pixels = (0..SIZE_PX.y).step_by(5).flat_map(|y| (0..SIZE_PX.x).step_by(5).map(move |x| UVec2::new(x, y)));
        let picks: Vec<(UVec2, Pick)> =
            pixels.map(|pixel| (pixel, pick(&mut stage, &mut scene, &mut encoder, (&view, pixel)).unwrap())).collect();
        stage.gpu.queue.submit([encoder.finish()]);
        stage.gpu.wait().unwrap();
        let (mut seen, mut empty, mut worst) = (0, 0, 0.0_f64);
        for (pixel, pick) in picks {
            let Some(expected) = truth(&view, pixel, &models) else { continue };
            let actual = pick.try_get().unwrap().unwrap();
            let names = |hit: Hit| (hit.model, hit.node, hit.mesh, hit.primitive, hit.material);
            assert_eq!(actual.map(names), expected.map(names), "{pixel}");
            let Some((actual, expected)) = actual.zip(expected) else {
                empty += 1;
                continue;
            };
            seen += 1;
            worst = worst.max(actual.position_in_world.distance(expected.position_in_world));
            worst = worst.max((actual.depth_m - expected.depth_m).abs());
        }
        println!("{seen} surfaces, {empty} times none, {worst:.5} m off at most");
        // The spheres are made of triangles: 32 rings leave 1 - cos(pi / 64) of the radius, more where it is looked at flatly.
        assert!(seen > 20 && empty > 40 && worst < 0.005, "{seen}, {empty}, {worst} m");
    }
    assert_eq!(stage.gpu.check(), Ok(()));
}

#[test]
fn equal_primitives_of_several_meshes_are_told_apart() {
    let mut stage = Stage::new(SIZE_PX);
    let mut asset: Scene = model();
    // A mesh of its own for each small ball, and the large one's triangles twice in one.
    asset.meshes.push(asset.meshes[1].clone());
    asset.nodes[2].mesh = Some(2);
    let again = asset.meshes[1].primitives[0].clone();
    asset.meshes[0].primitives.insert(0, specula::scene::Primitive { material: 0, ..again });
    let mut scene = LiveScene::new();
    scene.insert(&asset).unwrap();
    let view = View { size_px: SIZE_PX, ..super::view() };
    let mut encoder = encoder(&stage.gpu);
    let clip = view.camera.clip_from_view(SIZE_PX).as_dmat4() * view.camera.world_from_view.inverse();
    let pixel = |at: DVec3| {
        let ndc = clip.project_point3(at);
        (SIZE_PX.as_dvec2() * glam::DVec2::new(0.5 + 0.5 * ndc.x, 0.5 - 0.5 * ndc.y)).as_uvec2()
    };
    let picks = SPHERES.map(|(center, ..)| {
        let toward = (view.camera.position_in_world() - center).normalize();
        pick(&mut stage, &mut scene, &mut encoder, (&view, pixel(center + 0.4 * toward))).unwrap()
    });
    stage.gpu.queue.submit([encoder.finish()]);
    stage.gpu.wait().unwrap();
    let hits = picks.map(|pick| pick.try_get().unwrap().unwrap().map(|hit| (hit.node, hit.mesh, hit.primitive)));
    // The small ball behind may be hidden by the large one.
    assert_eq!((hits[0], hits[2]), (Some((0, 0, 1)), Some((2, 2, 0))), "{hits:?}");
}

#[test]
fn a_pick_waits_for_the_host_and_is_about_its_moment() {
    let mut stage = Stage::new(SIZE_PX);
    let (mut scene, [(first, _), (second, _)]) = two_models();
    let view = View { size_px: SIZE_PX, ..super::view() };
    let middle = SIZE_PX / 2;
    let before = submission_number(&stage.gpu);
    let mut encoder = encoder(&stage.gpu);
    let pick_first = pick(&mut stage, &mut scene, &mut encoder, (&view, middle)).unwrap();
    assert_eq!(submission_number(&stage.gpu), before + 1);
    assert!(pick_first.try_get().is_none());
    // What is removed before the submission was there.
    scene.remove(first).unwrap();
    stage.gpu.queue.submit([encoder.finish()]);
    stage.gpu.wait().unwrap();
    assert_eq!(pick_first.try_get().unwrap().unwrap().map(|hit| hit.model), Some(first));
    let mut encoder = super::encoder(&stage.gpu);
    scene.set_transform(second, DMat4::IDENTITY).unwrap();
    let pick_second = pick(&mut stage, &mut scene, &mut encoder, (&view, middle)).unwrap();
    stage.gpu.queue.submit([encoder.finish()]);
    stage.gpu.wait().unwrap();
    assert_eq!(pick_second.try_get().unwrap().unwrap().map(|hit| hit.model), Some(second));

    let mut encoder = super::encoder(&stage.gpu);
    for outside in [UVec2::new(SIZE_PX.x, 0), UVec2::new(0, SIZE_PX.y), UVec2::MAX] {
        let error = pick(&mut stage, &mut scene, &mut encoder, (&view, outside)).unwrap_err();
        assert!(matches!(error, EmbedError::Render(RenderError::Pass(_))), "{error:?}");
    }
    stage.gpu.device.destroy();
    let lost = pick(&mut stage, &mut scene, &mut encoder, (&view, middle)).unwrap_err();
    assert_eq!(lost, EmbedError::Render(RenderError::DeviceLost(DeviceLost)));
}
