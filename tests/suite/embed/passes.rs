//! One frame through a pass of our own, the host's pass, and the host's encoder.

use super::host::{Attachments, read};
use super::{SIZE_PX, differing, encoder, model, view};
use crate::support::gpu;
use glam::UVec2;
use specula::bake::environment::{BakeOptions, bake};
use specula::capture::{CaptureOptions, CaptureTarget, Wanted, submit};
use specula::gpu::Gpu;
use specula::gpu::formats::{self, Precision};
use specula::gpu::pipeline::DepthTarget;
use specula::gpu_scene::GpuScene;
use specula::progress::Silent;
use specula::renderer::{FrameState, HostTarget, HostView, Output, PassFormat, RenderError, Renderer};
use specula::scene::{Background, Environment, Scene, View};

fn upload(gpu: &Gpu, renderer: &Renderer, scene: &Scene) -> GpuScene {
    let maps = scene.environment.as_ref().map(|e| bake(&e.image, &BakeOptions::default(), &Silent));
    renderer.upload(&gpu.device, &gpu.queue, scene, maps.as_ref()).unwrap()
}

/// The model under the studio.
fn in_studio() -> Scene {
    Scene { environment: Some(Environment::new(specula::bake::studio::studio())), ..model() }
}

/// As a host's pass is painted in.
fn painted(gpu: &Gpu, renderer: &mut Renderer, scene: &mut GpuScene, view: &View, pass: &PassFormat) -> Vec<u8> {
    let device = (&gpu.device, &gpu.queue);
    let attachments = Attachments::new(&gpu.device, pass, view.size_px);
    let (mut encoder, mut state) = (encoder(gpu), FrameState::default());
    let prepared = renderer.prepare_frame(device, scene, (view, UVec2::ZERO), pass, &mut state).unwrap();
    prepared.paint(&mut attachments.begin(&mut encoder, pass, wgpu::Color::TRANSPARENT));
    read(gpu, encoder, attachments.picture()).unwrap()
}

/// As a host's encoder is recorded into.
fn encoded(gpu: &Gpu, renderer: &mut Renderer, scene: &mut GpuScene, view: &View, pass: &PassFormat) -> Vec<u8> {
    let device = (&gpu.device, &gpu.queue);
    let attachments = Attachments::new(&gpu.device, pass, view.size_px);
    let (mut encoder, mut state) = (encoder(gpu), FrameState::default());
    let target = HostTarget {
        color: &attachments.color,
        resolve: attachments.resolve.as_ref(),
        load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
        depth: attachments.depth.as_ref(),
        depth_load: wgpu::LoadOp::Clear(pass.depth.map_or(0.0, DepthTarget::farthest)),
    };
    let mut views = [HostView { view, at_px: UVec2::ZERO, state: &mut state }];
    let stats = renderer.encode(device, &mut encoder, scene, &mut views, (pass, &target)).unwrap();
    assert!(stats.draws >= 2 && stats.triangles > 1000);
    read(gpu, encoder, attachments.picture()).unwrap()
}

/// As the command line captures it: radiance and display light.
fn captured(gpu: &Gpu, renderer: &mut Renderer, scene: &mut GpuScene, view: &View, samples: u32) -> [Vec<u8>; 2] {
    let options = CaptureOptions { samples, precision: Precision::Half };
    let target = CaptureTarget::new(gpu, view, options).unwrap();
    let frame = submit(gpu, renderer, scene, view, &target, Wanted { radiance: true, display: true }).unwrap();
    let frame = frame.wait(gpu).unwrap();
    let halves = |texel: &glam::Vec4| texel.to_array().map(|c| half::f16::from_f32(c).to_bits());
    let texels: Vec<[u16; 4]> = frame.radiance.unwrap().texels.iter().map(halves).collect();
    [bytemuck::cast_slice(&texels).to_vec(), frame.display.unwrap()]
}

#[test]
fn one_frame_has_the_same_bits_through_every_door() {
    let gpu = gpu(Precision::Half);
    let mut renderer = Renderer::new(&gpu.device, &gpu.queue);
    for scene in [model(), in_studio()] {
        let mut uploaded = upload(&gpu, &renderer, &scene);
        let background = if scene.environment.is_some() { Background::Environment } else { Background::Transparent };
        let view = View { background, ..view() };
        for samples in [1, 4] {
            let [radiance, _] = captured(&gpu, &mut renderer, &mut uploaded, &view, samples);
            let pass = PassFormat::own(samples);
            assert!(painted(&gpu, &mut renderer, &mut uploaded, &view, &pass) == radiance, "paint, {samples} samples");
            assert!(encoded(&gpu, &mut renderer, &mut uploaded, &view, &pass) == radiance, "encode, {samples} samples");
            let without_depth = PassFormat { depth: None, ..pass };
            let own_depth = encoded(&gpu, &mut renderer, &mut uploaded, &view, &without_depth);
            assert!(own_depth == radiance, "a depth buffer of our own, {samples} samples");
        }
    }
}

#[test]
fn every_kind_of_depth_buffer_shows_the_same() {
    let gpu = gpu(Precision::Half);
    let mut renderer = Renderer::new(&gpu.device, &gpu.queue);
    let mut scene = upload(&gpu, &renderer, &in_studio());
    let view = View { background: Background::Environment, ..view() };
    let expected = painted(&gpu, &mut renderer, &mut scene, &view, &PassFormat::own(1));
    for format in [
        wgpu::TextureFormat::Depth32Float,
        wgpu::TextureFormat::Depth24Plus,
        wgpu::TextureFormat::Depth24PlusStencil8,
        wgpu::TextureFormat::Depth16Unorm,
    ] {
        for (reversed, far_m) in [(true, None), (true, Some(50.0)), (false, None), (false, Some(50.0))] {
            let pass = PassFormat { depth: Some(DepthTarget { format, reversed }), far_m, ..PassFormat::own(1) };
            let actual = painted(&gpu, &mut renderer, &mut scene, &view, &pass);
            // Where surfaces cut each other, another rounding of the depth moves the cut.
            let moved = differing(&actual, &expected, 8, 0);
            println!("{format:?}, reversed: {reversed}, far plane: {far_m:?}: {moved} pixels");
            assert!(moved <= 12, "{format:?}, reversed: {reversed}, far plane: {far_m:?}: {moved} pixels");
        }
    }
}

#[test]
fn display_light_in_the_host_s_pass_is_that_of_the_display_pass() {
    let gpu = gpu(Precision::Half);
    let mut renderer = Renderer::new(&gpu.device, &gpu.queue);
    // Blended surfaces are mixed after the tone map here, and before it there.
    let opaque =
        Scene { roots: in_studio().roots.into_iter().filter(|root| ![1, 2].contains(root)).collect(), ..in_studio() };
    let mut scene = upload(&gpu, &renderer, &opaque);
    for tone_map in [specula::scene::ToneMap::Neutral, specula::scene::ToneMap::AgX] {
        let view = View { background: Background::Environment, exposure_ev: -1.0, tone_map, ..view() };
        let [_, display] = captured(&gpu, &mut renderer, &mut scene, &view, 1);
        for color in [formats::CAPTURED_DISPLAY, formats::COLOR_TEXTURE] {
            let pass = PassFormat { color, output: Output::Display, ..PassFormat::own(1) };
            let actual = painted(&gpu, &mut renderer, &mut scene, &view, &pass);
            let far = differing(&actual, &display, 4, 1);
            let near = differing(&actual, &display, 4, 0);
            println!("{color:?}, {tone_map:?}: {near} of {} pixels differ by a step", SIZE_PX.element_product());
            assert_eq!(far, 0, "{color:?}, {tone_map:?}");
            assert!(display.iter().any(|&code| code > 100 && code < 250));
        }
    }
}

#[test]
fn views_lie_side_by_side_and_what_is_there_stays() {
    let gpu = gpu(Precision::Half);
    let mut renderer = Renderer::new(&gpu.device, &gpu.queue);
    let mut scene = upload(&gpu, &renderer, &model());
    let pass = PassFormat::own(1);
    let left = View { size_px: UVec2::new(64, 48), ..view() };
    let camera = super::camera_at(glam::DVec3::new(-2.0, 0.5, 3.0), 0.1);
    let right = View { camera, ..left.clone() };
    let alone = [&left, &right].map(|view| painted(&gpu, &mut renderer, &mut scene, view, &pass));
    let attachments = Attachments::new(&gpu.device, &pass, UVec2::new(150, 60));
    let mut encoder = encoder(&gpu);
    let clear = wgpu::Color { r: 0.25, g: 0.5, b: 0.75, a: 0.0 };
    drop(attachments.begin(&mut encoder, &pass, clear));
    let target = HostTarget {
        color: &attachments.color,
        resolve: None,
        load: wgpu::LoadOp::Load,
        depth: attachments.depth.as_ref(),
        depth_load: wgpu::LoadOp::Load,
    };
    let mut states = [FrameState::default(), FrameState::default()];
    let places = [UVec2::new(2, 5), UVec2::new(80, 9)];
    let mut views: Vec<HostView<'_>> = states
        .iter_mut()
        .zip([&left, &right].into_iter().zip(places))
        .map(|(state, (view, at_px))| HostView { view, at_px, state })
        .collect();
    renderer.encode((&gpu.device, &gpu.queue), &mut encoder, &mut scene, &mut views, (&pass, &target)).unwrap();
    let both = read(&gpu, encoder, attachments.picture()).unwrap();
    let texel = |picture: &[u8], width: u32, x: u32, y: u32| -> [half::f16; 4] {
        let at = 8 * (y * width + x) as usize;
        bytemuck::pod_read_unaligned(&picture[at..at + 8])
    };
    let cleared = [0.25, 0.5, 0.75, 0.0].map(half::f16::from_f32);
    assert_eq!(texel(&both, 150, 70, 20), cleared, "between the views");
    let mut covered = 0;
    for (alone, at) in alone.iter().zip(places) {
        for (x, y) in (0..48).flat_map(|y| (0..64).map(move |x| (x, y))) {
            let (here, there) = (texel(&both, 150, at.x + x, at.y + y), texel(alone, 64, x, y));
            match there[3].to_f32() {
                0.0 => assert_eq!(here, cleared, "{x}, {y}"),
                // At another place of the target, interpolation rounds in another way.
                1.0 => {
                    let apart = |(a, b): (half::f16, half::f16)| (a.to_f32() - b.to_f32()).abs() > 2e-3 * b.to_f32();
                    assert!(!here.into_iter().zip(there).any(apart), "{x}, {y}: {here:?} and {there:?}");
                }
                _ => continue,
            }
            covered += u32::from(there[3].to_f32() > 0.0);
        }
    }
    assert!(covered > 1000, "{covered}");
}

#[test]
fn preparing_a_frame_once_more_allocates_nothing() {
    let gpu = gpu(Precision::Half);
    let mut renderer = Renderer::new(&gpu.device, &gpu.queue);
    let mut scene = upload(&gpu, &renderer, &in_studio());
    let (view, pass) = (View { background: Background::Environment, ..view() }, PassFormat::own(4));
    let mut state = FrameState::default();
    let mut prepare = || {
        let device = (&gpu.device, &gpu.queue);
        renderer.prepare_frame(device, &mut scene, (&view, UVec2::ZERO), &pass, &mut state).unwrap().stats().draws
    };
    let draws = prepare();
    let allocations = allocation_counter::measure(|| assert_eq!((0..100).map(|_| prepare()).sum::<u32>(), 100 * draws));
    assert_eq!((allocations.count_total, allocations.bytes_total), (0, 0));
}

#[test]
fn channels_are_drawn_side_by_side_in_a_host_s_pass() {
    use specula::scene::{Channel, Input};
    let gpu = gpu(Precision::Half);
    let mut renderer = Renderer::new(&gpu.device, &gpu.queue);
    let mut scene = upload(&gpu, &renderer, &in_studio());
    let channels = [Input::Normal, Input::BaseColor, Input::Depth, Input::PerceptualRoughness].map(Channel::Input);
    let pass = PassFormat::own(1);
    let views = channels.map(|channel| View { channel: Some(channel), ..view() });
    let attachments = Attachments::new(&gpu.device, &pass, SIZE_PX * UVec2::new(4, 1));
    let mut states: [FrameState; 4] = Default::default();
    let mut parts: Vec<HostView<'_>> = (0..)
        .zip(views.iter().zip(&mut states))
        .map(|(i, (view, state))| HostView { view, at_px: UVec2::new(i * SIZE_PX.x, 0), state })
        .collect();
    let target = HostTarget {
        color: &attachments.color,
        resolve: None,
        load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
        depth: attachments.depth.as_ref(),
        depth_load: wgpu::LoadOp::Clear(0.0),
    };
    let mut encoder = encoder(&gpu);
    renderer.encode((&gpu.device, &gpu.queue), &mut encoder, &mut scene, &mut parts, (&pass, &target)).unwrap();
    let all = read(&gpu, encoder, attachments.picture()).unwrap();
    let texels = |picture: &[u8], i: u32, width: u32| -> Vec<glam::Vec4> {
        let texels = Precision::Half.texels(picture);
        let row = |y: u32| (y * width + i * SIZE_PX.x) as usize;
        (0..SIZE_PX.y).flat_map(|y| texels[row(y)..row(y) + SIZE_PX.x as usize].to_vec()).collect()
    };
    for (i, view) in (0..).zip(&views) {
        let [alone, _] = captured(&gpu, &mut renderer, &mut scene, view, 1);
        let (here, there) = (texels(&all, i, 4 * SIZE_PX.x), texels(&alone, 0, SIZE_PX.x));
        // At another place of the target, interpolation rounds in another way.
        let apart = here.iter().zip(&there).filter(|(a, b)| !a.abs_diff_eq(**b, 2e-3)).count();
        assert!(apart <= 8, "{apart} pixels of {:?} are others than in a picture of their own", view.channel);
        let covered: Vec<&glam::Vec4> = here.iter().filter(|texel| texel.w == 1.0).collect();
        assert!(covered.len() > 3000);
        if i == 0 {
            assert!(covered.iter().all(|n| (n.truncate().length() - 1.0).abs() < 2e-3));
        }
    }
    let shown = View { channel: views[0].channel, ..view() };
    let display = PassFormat { color: formats::CAPTURED_DISPLAY, output: Output::Display, ..pass };
    let mut state = FrameState::default();
    let device = (&gpu.device, &gpu.queue);
    let refused = renderer.prepare_frame(device, &mut scene, (&shown, UVec2::ZERO), &display, &mut state);
    assert!(matches!(refused.err(), Some(RenderError::Pass(_))));
}

#[test]
fn what_cannot_be_drawn_is_said_before_anything_is_recorded() {
    let gpu = gpu(Precision::Half);
    let mut renderer = Renderer::new(&gpu.device, &gpu.queue);
    let mut scene = upload(&gpu, &renderer, &model());
    let own = PassFormat::own(1);
    let mut error = |view: &View, pass: PassFormat| {
        let mut state = FrameState::default();
        let prepared =
            renderer.prepare_frame((&gpu.device, &gpu.queue), &mut scene, (view, UVec2::ZERO), &pass, &mut state);
        prepared.err().unwrap()
    };
    assert!(matches!(error(&view(), PassFormat { depth: None, ..own }), RenderError::NeedsOwnPass { .. }));
    let colored = View { background: Background::Color(glam::Vec3::ONE), ..view() };
    assert!(matches!(error(&colored, own), RenderError::NeedsOwnPass { feature: "a background colour" }));
    let depth = |format| PassFormat { depth: Some(DepthTarget { format, reversed: false }), ..own };
    let bad = [
        PassFormat { color: wgpu::TextureFormat::Rgba8Uint, ..own },
        PassFormat { color: wgpu::TextureFormat::Bc1RgbaUnorm, ..own },
        PassFormat { color: wgpu::TextureFormat::Depth32Float, ..own },
        PassFormat { samples: 3, ..own },
        depth(wgpu::TextureFormat::Depth32FloatStencil8),
        depth(wgpu::TextureFormat::Stencil8),
        depth(wgpu::TextureFormat::Rgba8Unorm),
        PassFormat { far_m: Some(0.05), ..own },
        PassFormat { far_m: Some(f64::NAN), ..own },
    ];
    for pass in bad {
        let error = error(&view(), pass);
        println!("{error}");
        assert!(matches!(error, RenderError::Pass(_)), "{pass:?}: {error:?}");
    }
    let empty = View { size_px: UVec2::new(0, 8), ..view() };
    assert!(matches!(error(&empty, own), RenderError::Size { .. }));
    assert_eq!(gpu.check(), Ok(()), "wgpu was asked for nothing that it refuses");
}

#[test]
fn attachments_that_do_not_fit_are_refused() {
    let gpu = gpu(Precision::Half);
    let mut renderer = Renderer::new(&gpu.device, &gpu.queue);
    let mut scene = upload(&gpu, &renderer, &model());
    let own = PassFormat::own(1);
    let [one, four] = [1, 4].map(|samples| Attachments::new(&gpu.device, &PassFormat::own(samples), SIZE_PX));
    let larger = Attachments::new(&gpu.device, &own, 2 * SIZE_PX);
    let load = wgpu::LoadOp::Clear(wgpu::Color::BLACK);
    let target = |color, depth| HostTarget { color, resolve: None, load, depth, depth_load: wgpu::LoadOp::Load };
    let (color, depth) = (&one.color, one.depth.as_ref());
    let cases = [
        (target(color, None), UVec2::ZERO),
        (target(&four.color, depth), UVec2::ZERO),
        (target(color, four.depth.as_ref()), UVec2::ZERO),
        (target(color, larger.depth.as_ref()), UVec2::ZERO),
        (target(color, depth), UVec2::X),
        (target(color, depth), UVec2::MAX),
    ];
    for (target, at_px) in cases {
        let (view, mut state) = (view(), FrameState::default());
        let mut views = [HostView { view: &view, at_px, state: &mut state }];
        let device = (&gpu.device, &gpu.queue);
        let error = renderer.encode(device, &mut encoder(&gpu), &mut scene, &mut views, (&own, &target)).unwrap_err();
        println!("{error}");
        assert!(matches!(error, RenderError::Pass(_)), "{error:?}");
    }
    assert_eq!(gpu.check(), Ok(()));
}
