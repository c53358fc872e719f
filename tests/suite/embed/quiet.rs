//! What a host's queue sees of us: writes, and no submission.

use super::edits::Stage;
use crate::memory::five_textures;
use crate::support::submission_number;
use glam::{DMat4, UVec2};
use specula::bake::environment::bake;
use specula::embed::LiveScene;
use specula::gpu::{Staging, Uploads};
use specula::progress::Silent;
use specula::scene::{Environment, EnvironmentImage};
use std::sync::Arc;

/// A panorama that is larger than what a bounded upload submits.
fn sky() -> Environment {
    let (width, height) = (2048, 1024);
    let texels = (0..width * height).map(|i| glam::Vec3::new(1.0, 0.5, (i % width) as f32 / 2048.0)).collect();
    Environment::new(EnvironmentImage { width, height, texels })
}

#[test]
fn uploads_and_frames_submit_nothing() {
    let mut pictures = Vec::new();
    let environment = sky();
    let maps = Arc::new(bake(&environment.image, &Default::default(), &Silent));
    for uploads in [Uploads::Queued, Uploads::Bounded] {
        let mut stage = Stage::new(UVec2::new(80, 60));
        stage.renderer = stage.renderer.with_uploads(uploads);
        // Two are more than is staged at a time.
        let mut scene = LiveScene::new();
        let [id, _] = [0; 2].map(|_| scene.insert(&five_textures()).unwrap());
        scene.set_environment(Some((environment.clone(), Arc::clone(&maps))));
        let before = submission_number(&stage.gpu);
        let encoder = stage.record(&mut scene);
        let staged = scene.uploaded().unwrap().bytes;
        assert!(staged.textures + staged.environment > Staging::LIMIT_BYTES, "{staged:?}");
        scene.set_transform(id, DMat4::from_rotation_y(0.5)).unwrap();
        drop(encoder);
        let encoder = stage.record(&mut scene);
        let submitted = submission_number(&stage.gpu) - before - 1;
        assert_eq!(submitted > 0, uploads == Uploads::Bounded, "{submitted} submissions");
        pictures.push(super::host::read(&stage.gpu, encoder, stage.attachments.picture()).unwrap());
        stage.gpu.check().unwrap();
    }
    assert!(pictures[0] == pictures[1]);
    assert!(pictures[0].iter().any(|&byte| byte != 0));
}
