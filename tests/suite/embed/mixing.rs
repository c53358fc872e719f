//! A model among the host's geometry: each hides the other where it is nearer.

use super::host::{Attachments, Host, clip_from_world, read};
use super::{SIZE_PX, beam, differing, encoder, model, model_and, view};
use crate::support::gpu;
use glam::UVec2;
use specula::gpu::Gpu;
use specula::gpu::formats::Precision;
use specula::gpu::pipeline::DepthTarget;
use specula::renderer::{FrameState, PassFormat, Renderer};
use specula::scene::Scene;

/// Our scene in a pass in which the host draws, if it has something, before us.
fn frame(gpu: &Gpu, scene: &Scene, host: Option<&Host>, pass: &PassFormat) -> Vec<u8> {
    let device = (&gpu.device, &gpu.queue);
    let mut renderer = Renderer::new(&gpu.device, &gpu.queue);
    let mut uploaded = renderer.upload(&gpu.device, &gpu.queue, scene, None).unwrap();
    let (view, attachments) = (view(), Attachments::new(&gpu.device, pass, SIZE_PX));
    let (mut encoder, mut state) = (encoder(gpu), FrameState::default());
    let prepared = renderer.prepare_frame(device, &mut uploaded, (&view, UVec2::ZERO), pass, &mut state).unwrap();
    let mut recording = attachments.begin(&mut encoder, pass, wgpu::Color::TRANSPARENT);
    if let Some(host) = host {
        host.look(&gpu.queue, clip_from_world(&view.camera, SIZE_PX, pass));
        host.draw(&mut recording);
    }
    prepared.paint(&mut recording);
    drop(recording);
    read(gpu, encoder, attachments.picture()).unwrap()
}

#[test]
fn host_and_model_hide_each_other_as_if_one_renderer_had_drawn_both() {
    let gpu = gpu(Precision::Half);
    for (reversed, far_m) in [(true, None), (false, None), (false, Some(100.0)), (true, Some(100.0))] {
        for samples in [1, 4] {
            let depth = Some(DepthTarget { reversed, ..DepthTarget::OWN });
            let pass = PassFormat { depth, far_m, ..PassFormat::own(samples) };
            let host = Host::new(&gpu.device, &pass, &[beam()]);
            let mixed = frame(&gpu, &model(), Some(&host), &pass);
            let one = frame(&gpu, &model_and(&beam()), None, &pass);
            let differ = differing(&mixed, &one, 8, 0);
            println!("reversed: {reversed}, far plane: {far_m:?}, {samples} samples: {differ} pixels differ");
            // Where the beam leaves the sphere, the two matrices round the depth differently.
            assert!(differ <= 8, "reversed: {reversed}, {samples} samples: {differ} pixels differ");
            // Both are seen, and each is hidden in places.
            let [alone, empty] = [frame(&gpu, &model(), None, &pass), vec![0; mixed.len()]];
            let of_host = differing(&mixed, &alone, 8, 0);
            assert!(of_host > 300, "{of_host} pixels show the host's geometry");
            let host_alone = frame(&gpu, &Scene::default(), Some(&host), &pass);
            let hidden = differing(&host_alone, &empty, 8, 0) - of_host;
            assert!(hidden > 300, "{hidden} pixels of the host's geometry are hidden");
        }
    }
}
