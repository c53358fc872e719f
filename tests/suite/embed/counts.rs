//! What is alive on a host's device after many scenes have come and gone, as wgpu counts it.

use super::edits::textured;
use super::encoder_of;
use super::host::Attachments;
use crate::support::{add_light, white_environment};
use glam::{DVec3, UVec2};
use specula::bake::environment::bake;
use specula::embed::{LiveScene, Requirements};
use specula::gpu::formats::Precision;
use specula::progress::Silent;
use specula::renderer::{FrameState, HostTarget, HostView, PassFormat, Renderer};
use specula::scene::{Background, LightKind, Scene, View, shapes};
use std::sync::Arc;

/// How many of each the host's handles keep alive, with what wgpu itself has not let go of yet.
fn alive(instance: &wgpu::Instance) -> Vec<(&'static str, usize, usize)> {
    let hub = instance.generate_report().unwrap().hub;
    [
        ("buffers", hub.buffers),
        ("textures", hub.textures),
        ("texture views", hub.texture_views),
        ("samplers", hub.samplers),
        ("bind groups", hub.bind_groups),
        ("bind group layouts", hub.bind_group_layouts),
        ("pipeline layouts", hub.pipeline_layouts),
        ("render pipelines", hub.render_pipelines),
        ("shader modules", hub.shader_modules),
        ("command buffers", hub.command_buffers),
    ]
    .map(|(name, report)| (name, report.num_kept_from_user, report.num_allocated))
    .to_vec()
}

/// A small ball with a texture and two lights.
fn small(round: u8) -> Scene {
    let mut scene = textured(0.0, [round, 255 - round, 90, 255]);
    scene.meshes[0].primitives = vec![shapes::sphere(1.0, 4, 0)];
    add_light(&mut scene, LightKind::Directional, 3.0, DVec3::ZERO);
    add_light(&mut scene, LightKind::Point { range_m: None }, 9.0, DVec3::new(1.0, 2.0, 3.0));
    scene
}

#[test]
fn a_thousand_scenes_leave_nothing() {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle_from_env());
    let adapter = pollster::block_on(instance.request_adapter(&Default::default())).unwrap();
    let requirements = Requirements::for_adapter(&adapter, Precision::Half).unwrap();
    let (device, queue) = pollster::block_on(adapter.request_device(&requirements.device_descriptor())).unwrap();
    let (size_px, format) = (UVec2::splat(16), PassFormat { depth: None, ..PassFormat::own(1) });
    let attachments = Attachments::new(&device, &format, size_px);
    let mut renderer = Renderer::new(&device, &queue);
    let sky = white_environment();
    let maps = Arc::new(bake(&sky.image, &Default::default(), &Silent));
    let allocated = || device.generate_allocator_report().map_or(0, |report| report.total_allocated_bytes);
    let (mut baseline, mut bytes) = (Vec::new(), 0);
    let mut drawn = 0;
    for round in 0..1000_u32 {
        let mut scene = LiveScene::new();
        let id = scene.insert(&small(round as u8)).unwrap();
        // Another picture, and other shaders, for some.
        if round % 25 == 0 {
            scene.set_environment(Some((sky.clone(), Arc::clone(&maps))));
        }
        let view = View { size_px, background: Background::Environment, ..super::view() };
        let target = HostTarget {
            color: &attachments.color,
            resolve: None,
            load: wgpu::LoadOp::Clear(wgpu::Color::BLACK),
            depth: None,
            depth_load: wgpu::LoadOp::Load,
        };
        let (mut encoder, mut state) = (encoder_of(&device), FrameState::default());
        let mut views = [HostView { view: &view, at_px: UVec2::ZERO, state: &mut state }];
        let uploaded = scene.update(&renderer, (&device, &queue)).unwrap();
        let stats = renderer.encode((&device, &queue), &mut encoder, uploaded, &mut views, (&format, &target)).unwrap();
        drawn += stats.draws;
        queue.submit([encoder.finish()]);
        if round % 2 == 0 {
            scene.remove(id).unwrap();
            scene.update(&renderer, (&device, &queue)).unwrap();
        }
        drop((scene, state));
        if round % 100 == 99 {
            device.poll(wgpu::PollType::wait_indefinitely()).unwrap();
            println!("after {}: {} bytes, {:?}", round + 1, allocated(), alive(&instance));
            if round == 99 {
                (baseline, bytes) = (alive(&instance), allocated());
            }
            // A buffer left by every scene would be 100 times 16 bytes at least.
            assert!(allocated() < bytes + 1600, "{} bytes after {bytes}", allocated());
            assert_eq!(alive(&instance), baseline, "after {} scenes", round + 1);
        }
    }
    assert_eq!(drawn, 1000);
    // It is counted at all.
    let kept: usize = baseline.iter().map(|(_, kept, _)| kept).sum();
    assert!(kept > 10, "{baseline:?}");
}
