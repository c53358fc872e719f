//! A device that is lost is an error before anything is recorded, however it is found out.

use super::edits::Stage;
use super::{encoder, model};
use glam::{DMat4, UVec2};
use specula::embed::{EmbedError, LiveScene, ModelId};
use specula::gpu::{DeviceLost, LostFlag};
use specula::renderer::{FrameState, PassFormat, RenderError};
use specula::scene::{Environment, Material, View};
use std::sync::Arc;

const LOST: EmbedError = EmbedError::Render(RenderError::DeviceLost(DeviceLost));

/// A stage with a scene on it.
fn shown() -> (Stage, LiveScene, ModelId) {
    let (mut stage, mut scene) = (Stage::new(UVec2::new(40, 30)), LiveScene::new());
    let id = scene.insert(&model()).unwrap();
    stage.draw(&mut scene);
    (stage, scene, id)
}

fn prepare(stage: &mut Stage, scene: &mut LiveScene, view: &View, state: &mut FrameState) -> Result<(), EmbedError> {
    let gpu = (&stage.gpu.device, &stage.gpu.queue);
    let scene = scene.update(&stage.renderer, gpu)?;
    stage.renderer.prepare_frame(gpu, scene, (view, UVec2::ZERO), &PassFormat::own(1), state)?;
    Ok(())
}

/// Every kind of change to a scene, none of which shows in the first frame.
fn changes() -> Vec<fn(&mut LiveScene, ModelId)> {
    vec![
        |scene, id| scene.set_transform(id, DMat4::from_rotation_y(0.3)).unwrap(),
        |scene, id| {
            let material = Material { perceptual_roughness: 0.7, ..model().materials[0].clone() };
            scene.set_material(id, 0, material).unwrap();
        },
        |scene, id| {
            let lamp = specula::scene::Light { intensity: 7.0, ..model().lights[1].clone() };
            scene.set_light(id, 1, lamp).unwrap();
        },
        |scene, _| {
            let environment = Environment::new(specula::bake::studio::studio());
            let maps =
                specula::bake::environment::bake(&environment.image, &Default::default(), &specula::progress::Silent);
            scene.set_environment(Some((environment, Arc::new(maps))));
        },
        |scene, _| assert!(scene.insert(&model()).is_ok()),
    ]
}

#[test]
fn without_a_flag_whatever_is_made_or_written_tells() {
    for (index, change) in changes().into_iter().enumerate() {
        let (mut stage, mut scene, id) = shown();
        stage.gpu.device.destroy();
        change(&mut scene, id);
        let view = stage.view.clone();
        let mut state = std::mem::take(&mut stage.state);
        let first = prepare(&mut stage, &mut scene, &view, &mut state);
        assert_eq!(first, Err(LOST), "change {index}");
        // And again: nothing is taken for done.
        assert_eq!(prepare(&mut stage, &mut scene, &view, &mut state), Err(LOST), "change {index}");
        // What was changed is on the next device.
        let fresh = Stage::new(UVec2::new(40, 30));
        let renderer = stage.renderer.restore(&fresh.gpu.device, &fresh.gpu.queue);
        let mut stage = Stage { renderer, state, ..fresh };
        let (restored, anew) = (stage.draw(&mut scene), stage.draw_anew(&scene));
        assert!(restored == anew, "change {index}");
        assert_eq!(stage.gpu.check(), Ok(()));
    }
}

#[test]
fn a_frame_that_is_another_tells_too() {
    let (mut stage, mut scene, _) = shown();
    stage.gpu.device.destroy();
    let mut turned = stage.view.clone();
    turned.camera = super::camera_at(glam::DVec3::new(-2.0, 1.0, 4.0), 0.1);
    let (view, mut state) = (stage.view.clone(), std::mem::take(&mut stage.state));
    for round in 0..2 {
        assert_eq!(prepare(&mut stage, &mut scene, &turned, &mut state), Err(LOST), "another view, round {round}");
    }
    assert_eq!(prepare(&mut stage, &mut scene, &view, &mut FrameState::default()), Err(LOST), "another picture");
    let (device, attachments) = ((&stage.gpu.device, &stage.gpu.queue), &stage.attachments);
    let format = specula::gpu::formats::CAPTURED_DISPLAY;
    let into = (&attachments.color, format);
    let mut encoder = encoder(&stage.gpu);
    let displayed =
        stage.renderer.encode_display(device, &mut encoder, &view, &attachments.color, into, &mut Default::default());
    assert_eq!(displayed, Err(RenderError::DeviceLost(DeviceLost)));
}

#[test]
fn with_a_flag_every_frame_tells() {
    // wgpu's callback raises one, and a host that has that callback the other.
    for is_host_s in [false, true] {
        let (mut stage, mut scene, _) = shown();
        let flag = if is_host_s { LostFlag::default() } else { stage.gpu.lost_flag().clone() };
        stage.renderer = stage.renderer.restore(&stage.gpu.device, &stage.gpu.queue).with_lost_flag(flag.clone());
        let (view, mut state) = (stage.view.clone(), std::mem::take(&mut stage.state));
        assert_eq!(prepare(&mut stage, &mut scene, &view, &mut state), Ok(()));
        assert!(!stage.renderer.is_lost());
        stage.gpu.device.destroy();
        assert_eq!(prepare(&mut stage, &mut scene, &view, &mut state), Ok(()), "nothing is written");
        let _ = stage.gpu.wait();
        assert_eq!(stage.renderer.is_lost(), !is_host_s);
        flag.raise();
        assert_eq!(prepare(&mut stage, &mut scene, &view, &mut state), Err(LOST));
        let uploaded = stage.renderer.upload(&stage.gpu.device, &stage.gpu.queue, &model(), None);
        assert_eq!(uploaded.err(), Some(RenderError::DeviceLost(DeviceLost)));
        let fresh = Stage::new(UVec2::new(40, 30));
        let renderer = stage.renderer.restore(&fresh.gpu.device, &fresh.gpu.queue);
        assert!(!renderer.is_lost());
        stage = Stage { renderer, state, ..fresh };
        let restored = stage.draw(&mut scene);
        assert!(restored == stage.draw_anew(&scene));
    }
}
