//! Devices that go and come, and memory that stays what it was.

use super::edits::Stage;
use super::model;
use crate::support::gpu;
use glam::{DMat4, UVec2};
use specula::embed::{EmbedError, LiveScene, Requirements};
use specula::frame::Culling;
use specula::gpu::GpuRequest;
use specula::gpu::formats::Precision;
use specula::renderer::{FrameState, HostTarget, HostView, PassFormat, Prepared, Renderer};

const fn shared_between_threads<T: Send + Sync>() {}
const _: () = {
    shared_between_threads::<Renderer>();
    shared_between_threads::<FrameState>();
    shared_between_threads::<LiveScene>();
    shared_between_threads::<Prepared<'_>>();
    shared_between_threads::<PassFormat>();
    shared_between_threads::<HostTarget<'_>>();
    shared_between_threads::<HostView<'_>>();
    shared_between_threads::<Requirements>();
    shared_between_threads::<EmbedError>();
    shared_between_threads::<specula::gpu_scene::GpuScene>();
    shared_between_threads::<specula::scene::Scene>();
};

#[test]
fn a_scene_survives_a_hundred_devices() {
    let mut stage = Stage::new(UVec2::new(40, 30));
    stage.renderer.culling = Culling::Off;
    let mut scene = LiveScene::new();
    let id = scene.insert(&model()).unwrap();
    let golden = stage.draw(&mut scene);
    assert!(golden.iter().any(|&byte| byte != 0));
    for round in 0..100_u32 {
        // Before a frame, after one was recorded, and after it was submitted.
        let recorded = (round % 3 > 0).then(|| stage.record(&mut scene));
        if let (Some(encoder), 2) = (recorded, round % 3) {
            stage.gpu.queue.submit([encoder.finish()]);
        }
        stage.gpu.device.destroy();
        let _ = stage.gpu.wait();
        // What is changed meanwhile is not lost.
        scene.set_transform(id, DMat4::IDENTITY).unwrap();
        let fresh = Stage::new(UVec2::new(40, 30));
        let renderer = stage.renderer.restore(&fresh.gpu.device, &fresh.gpu.queue);
        assert_eq!(renderer.culling, Culling::Off);
        // The state of the picture is the old one.
        stage = Stage { renderer, state: stage.state, ..fresh };
        assert!(stage.draw(&mut scene) == golden, "round {round}");
        assert_eq!(scene.uploads(), u64::from(round) + 2);
        stage.gpu.check().unwrap();
    }
}

/// Resident memory of this process in bytes, where the system tells.
fn resident_bytes() -> Option<i64> {
    let text = std::fs::read_to_string("/proc/self/statm").ok()?;
    Some(text.split_whitespace().nth(1)?.parse::<i64>().ok()? * 4096)
}

/// Bytes on the heap of the device, where the backend counts them.
fn allocated_bytes(stage: &Stage) -> Option<u64> {
    Some(stage.gpu.device.generate_allocator_report()?.total_allocated_bytes)
}

/// Draws moving frames. Returns the growth of resident memory in bytes per thousand frames, measured over their second half.
fn growth(frames: u32) -> Option<f64> {
    let mut stage = Stage::new(UVec2::splat(16));
    let mut scene = LiveScene::new();
    let id = scene.insert(&model()).unwrap();
    let mut draw = |frame: u32| {
        scene.set_transform(id, DMat4::from_rotation_y(f64::from(frame) * 0.01)).unwrap();
        let encoder = stage.record(&mut scene);
        stage.gpu.queue.submit([encoder.finish()]);
        stage.gpu.wait().unwrap();
    };
    (0..frames / 2).for_each(&mut draw);
    let before = resident_bytes()?;
    (frames / 2..frames).for_each(&mut draw);
    let grown = (resident_bytes()? - before) as f64;
    let rate = grown / f64::from(frames - frames / 2) * 1000.0;
    println!("{grown} bytes more after {} frames: {rate:.0} a thousand", frames - frames / 2);
    assert_eq!(scene.uploads(), 1);
    Some(rate)
}

/// Other tests allocate beside it: it can only be run alone.
#[test]
#[ignore = "minutes, and alone"]
fn memory_is_flat_over_a_hundred_thousand_frames() {
    let Some(rate) = growth(100_000) else { return println!("this system does not tell") };
    assert!(rate < 1024.0, "{rate} bytes a thousand frames");
}

#[test]
fn frames_leave_nothing_on_the_device() {
    let mut stage = Stage::new(UVec2::splat(16));
    let mut scene = LiveScene::new();
    let id = scene.insert(&model()).unwrap();
    let mut sizes = Vec::new();
    for frame in 0..600 {
        scene.set_transform(id, DMat4::from_rotation_y(f64::from(frame) * 0.01)).unwrap();
        let encoder = stage.record(&mut scene);
        stage.gpu.queue.submit([encoder.finish()]);
        stage.gpu.wait().unwrap();
        if frame % 100 == 99 {
            sizes.push((allocated_bytes(&stage), stage.state.resources_made()));
        }
    }
    println!("{sizes:?}");
    assert!(sizes[1..].iter().all(|size| *size == sizes[1]), "{sizes:?}");
}

#[test]
fn scenes_that_come_and_go_leave_nothing_on_the_device() {
    let mut stage = Stage::new(UVec2::splat(16));
    let mut scene = LiveScene::new();
    let mut sizes = Vec::new();
    for round in 0..60 {
        let ids = [0; 3].map(|_| scene.insert(&model()).unwrap());
        let encoder = stage.record(&mut scene);
        stage.gpu.queue.submit([encoder.finish()]);
        ids.into_iter().for_each(|id| scene.remove(id).unwrap());
        let encoder = stage.record(&mut scene);
        stage.gpu.queue.submit([encoder.finish()]);
        stage.gpu.wait().unwrap();
        if round % 20 == 19 {
            sizes.push(allocated_bytes(&stage));
        }
    }
    println!("{sizes:?}");
    // A few bytes come and go with what the device frees when; a buffer left every round would be 16 bytes each at least.
    let least = sizes.iter().flatten().min().copied().unwrap();
    assert!(sizes.iter().all(|size| size.is_some_and(|size| size < least + 20 * 16)), "{sizes:?}");
}

#[test]
fn requirements_are_what_our_own_device_has() {
    let gpu = gpu(Precision::Half);
    let adapter = specula::gpu::adapters(&GpuRequest::default()).unwrap().remove(0);
    let requirements = Requirements::for_adapter(&adapter, Precision::Half).unwrap();
    assert_eq!((requirements.features, &requirements.limits), (gpu.device.features(), &gpu.device.limits()));
    assert_eq!(requirements.device_descriptor().required_features, requirements.features);
    assert_eq!(Requirements::check(&gpu.device), Ok(()));
    println!("{:?}", requirements.degraded);
}
