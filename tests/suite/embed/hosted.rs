//! Textures of a host as inputs of a scene.

use super::edits::{Stage, textured};
use super::encoder;
use crate::support::add_light;
use glam::{DVec3, UVec2};
use specula::embed::{EmbedError, EnvironmentDownload, LiveScene};
use specula::gpu::formats;
use specula::gpu_scene::UploadError;
use specula::renderer::RenderError;
use specula::scene::{LightKind, Pixels, Sampler, Scene, TextureSlot};

const SIDE: u32 = 4;

/// A sphere whose texture has texels of its own, and the same with a host's.
fn spheres() -> [Scene; 2] {
    let mut own = textured(0.0, [0; 4]);
    own.meshes[0].primitives[0].uvs =
        vec![own.meshes[0].primitives[0].positions.iter().map(|at| at.truncate()).collect()];
    own.textures[0].sampler = Sampler { mip_linear: None, ..Default::default() };
    add_light(&mut own, LightKind::Directional, 3.0, DVec3::ZERO);
    let image = &mut own.images[0];
    (image.width, image.height) = (SIDE, SIDE);
    image.pixels = Pixels::Rgba8(texels().into());
    let mut of_host = own.clone();
    of_host.images[0].pixels = Pixels::OfHost;
    [own, of_host]
}

fn texels() -> Vec<u8> {
    (0..SIDE * SIDE).flat_map(|i| [(i * 16) as u8, (255 - i * 9) as u8, (i % 4 * 60) as u8, 255]).collect()
}

fn texture(stage: &Stage, format: wgpu::TextureFormat, samples: u32) -> wgpu::Texture {
    let mut usage = wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST;
    if samples > 1 {
        usage = wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::RENDER_ATTACHMENT;
    }
    stage.gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { width: SIDE, height: SIDE, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: samples,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage,
        view_formats: &[],
    })
}

/// A view of those texels on the device of a stage.
fn uploaded(stage: &Stage) -> wgpu::TextureView {
    let texture = texture(stage, formats::COLOR_TEXTURE, 1);
    let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(4 * SIDE), rows_per_image: None };
    stage.gpu.queue.write_texture(texture.as_image_copy(), &texels(), layout, texture.size());
    texture.create_view(&Default::default())
}

fn missing(image: usize) -> EmbedError {
    EmbedError::Render(RenderError::Upload(UploadError::NoHostTexture { image }))
}

fn update(stage: &Stage, scene: &mut LiveScene) -> Result<(), EmbedError> {
    scene.update(&stage.renderer, (&stage.gpu.device, &stage.gpu.queue)).map(|_| ())
}

#[test]
fn a_host_s_texture_looks_like_the_same_texels_of_ours() {
    let mut stage = Stage::new(UVec2::new(80, 60));
    let [own, of_host] = spheres();
    let mut scene = LiveScene::new();
    scene.insert(&own).unwrap();
    let expected = stage.draw(&mut scene);
    assert!(expected.iter().any(|&byte| byte != 0));

    let mut scene = LiveScene::new();
    // Before it in the scene, and taken out later, so that its image moves up.
    let before = scene.insert(&textured(40.0, [9; 4])).unwrap();
    let id = scene.insert(&of_host).unwrap();
    assert_eq!(update(&stage, &mut scene), Err(missing(1)));
    scene.set_image(&stage.renderer, id, 0, uploaded(&stage)).unwrap();
    scene.remove(before).unwrap();
    assert!(stage.draw(&mut scene) == expected);

    // The next device needs a view of its own.
    stage.gpu.device.destroy();
    let fresh = Stage::new(UVec2::new(80, 60));
    let renderer = stage.renderer.restore(&fresh.gpu.device, &fresh.gpu.queue);
    let mut stage = Stage { renderer, ..fresh };
    assert_eq!(update(&stage, &mut scene), Err(missing(0)));
    scene.set_image(&stage.renderer, id, 0, uploaded(&stage)).unwrap();
    assert!(stage.draw(&mut scene) == expected);
    assert_eq!(stage.gpu.check(), Ok(()));
}

#[test]
fn textures_that_cannot_be_sampled_are_refused() {
    let stage = Stage::new(UVec2::new(16, 16));
    let [own, of_host] = spheres();
    let mut scene = LiveScene::new();
    let [with_texels, id] = [&own, &of_host].map(|asset| scene.insert(asset).unwrap());
    let mut set = |id, image, texture: wgpu::Texture| {
        let view = texture.create_view(&Default::default());
        scene.set_image(&stage.renderer, id, image, view)
    };
    let good = || texture(&stage, formats::COLOR_TEXTURE, 1);
    for (result, expected) in [
        (set(with_texels, 0, good()), "texels of its own"),
        (set(id, 1, good()), "no image 1"),
        (set(id, 0, texture(&stage, wgpu::TextureFormat::Rgba8Uint, 1)), "cannot be filtered"),
        (set(id, 0, texture(&stage, formats::COLOR_TEXTURE, 4)), "several samples"),
    ] {
        let error = result.unwrap_err().to_string();
        assert!(error.contains(expected), "{error}");
    }
    set(id, 0, texture(&stage, wgpu::TextureFormat::Rgba32Float, 1)).unwrap();
    let error = update(&stage, &mut scene).unwrap_err().to_string();
    assert!(error.contains("a texture that this device filters"), "{error}");

    let mut bumpy = of_host;
    let texture = bumpy.materials[0].texture(TextureSlot::BaseColor).copied();
    bumpy.materials[0].set_texture(TextureSlot::Normal, texture);
    bumpy.meshes[0].primitives[0].tangents = Some(vec![glam::Vec4::X; bumpy.meshes[0].primitives[0].positions.len()]);
    let mut scene = LiveScene::new();
    let id = scene.insert(&bumpy).unwrap();
    scene.set_image(&stage.renderer, id, 0, uploaded(&stage)).unwrap();
    let error = update(&stage, &mut scene).unwrap_err().to_string();
    assert!(error.contains("a normal map"), "{error}");
    assert_eq!(stage.gpu.check(), Ok(()));
}

#[test]
fn a_panorama_comes_back_from_the_device_without_waiting() {
    let stage = Stage::new(UVec2::new(16, 16));
    let device = &stage.gpu.device;
    let make = |format, usage| {
        device.create_texture(&wgpu::TextureDescriptor {
            label: None,
            size: wgpu::Extent3d { width: 8, height: 4, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage,
            view_formats: &[],
        })
    };
    let usage = wgpu::TextureUsages::COPY_DST | wgpu::TextureUsages::COPY_SRC;
    let panorama = make(formats::ENVIRONMENT, usage);
    let texels: Vec<[half::f16; 4]> =
        (0..32_u8).map(|i| [f32::from(i), -1.0, f32::NAN, 1.0].map(half::f16::from_f32)).collect();
    let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(64), rows_per_image: None };
    stage.gpu.queue.write_texture(panorama.as_image_copy(), bytemuck::cast_slice(&texels), layout, panorama.size());
    let mut encoder = encoder(&stage.gpu);
    let download = EnvironmentDownload::record(device, &mut encoder, &panorama).unwrap();
    assert!(download.try_image().is_none());
    stage.gpu.queue.submit([encoder.finish()]);
    stage.gpu.wait().unwrap();
    let image = download.try_image().unwrap().unwrap();
    assert_eq!((image.width, image.height), (8, 4));
    assert!((0..32_u8).all(|i| image.texels[usize::from(i)] == glam::Vec3::new(f32::from(i), 0.0, 0.0)));

    let mut encoder = super::encoder(&stage.gpu);
    for (texture, expected) in [
        (make(formats::COLOR_TEXTURE, usage), "four floats"),
        (make(formats::ENVIRONMENT, wgpu::TextureUsages::COPY_DST), "copied from"),
    ] {
        let error = EnvironmentDownload::record(device, &mut encoder, &texture).unwrap_err().to_string();
        assert!(error.contains(expected), "{error}");
    }
    assert_eq!(stage.gpu.check(), Ok(()));
}
