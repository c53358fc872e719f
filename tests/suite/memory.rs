//! What is held in memory on the way to the device, counted by wgpu's allocator.

use crate::support::{add_light, gpu, program, sphere_scene};
use glam::{DVec3, Vec2};
use specula::gpu::formats::{self, Precision};
use specula::gpu::{Gpu, Staging, Uploads};
use specula::renderer::Renderer;
use specula::scene::{
    Image, LightKind, Material, Pixels, Sampler, Scene, Texture, TextureRef, TextureSlot, UvTransform,
};

/// A level of 4 MiB.
const SIDE: u32 = 1024;
const BYTES: u64 = (SIDE * SIDE * 4) as u64;

/// None where the backend does not count.
fn allocated_bytes(gpu: &Gpu) -> Option<u64> {
    gpu.device.generate_allocator_report().map(|report| report.total_allocated_bytes)
}

#[test]
fn textures_are_staged_a_few_at_a_time() {
    let gpu = gpu(Precision::Half);
    let levels = 3 * Staging::LIMIT_BYTES / BYTES;
    let textures: Vec<wgpu::Texture> = (0..levels).map(|_| texture(&gpu)).collect();
    let Some(before) = allocated_bytes(&gpu) else { return println!("this backend does not count memory") };
    let texels = vec![7; BYTES as usize];
    let mut staging = Staging::new(&gpu.device, &gpu.queue, Uploads::Bounded);
    let mut most = 0;
    for texture in &textures {
        staging.write(texture, 0, &texels);
        most = allocated_bytes(&gpu).unwrap_or(u64::MAX).saturating_sub(before).max(most);
    }
    // At least one, or else staging is not what is counted.
    assert!((BYTES..=Staging::LIMIT_BYTES).contains(&most), "{most} bytes were staged at a time");
    staging.finish();
    let after = allocated_bytes(&gpu).unwrap();
    // What was staged before is gone too.
    assert!(after <= before, "{after} bytes are held after {before}");
}

#[test]
fn an_upload_leaves_nothing_but_the_scene() {
    let gpu = gpu(Precision::Half);
    let renderer = Renderer::new(&gpu.device, &gpu.queue).with_uploads(Uploads::Bounded);
    let scene = five_textures();
    gpu.queue.submit([]);
    gpu.wait().unwrap();
    let Some(before) = allocated_bytes(&gpu) else { return println!("this backend does not count memory") };
    let uploaded = renderer.upload(&gpu.device, &gpu.queue, &scene, None).unwrap();
    let held = allocated_bytes(&gpu).unwrap() - before;
    assert!(uploaded.bytes.textures > 5 * BYTES);
    // Textures without their alignment, and what is not counted beside them: uniforms and instances.
    let expected = uploaded.bytes.textures + uploaded.bytes.geometry;
    assert!((expected..expected + BYTES).contains(&held), "{held} bytes are held for {expected}");
}

/// llvmpipe compiled uniforms that end loops into the shader, once more for every draw, and kept that.
#[cfg(target_os = "linux")]
#[test]
fn frames_of_many_draws_leave_nothing_behind() {
    let folder = tempfile::tempdir().unwrap();
    let most = |model: &str, frames: u32| {
        let light = |x: u32| ["--light".to_owned(), format!("point:intensity=20cd,at={x},2,3")];
        let mut command = program();
        command.args(["render", model, "--path", "deferred", "--size", "32x32", "--quiet", "-o"]);
        command.arg(folder.path().join(frames.to_string())).args(["--frames", &format!("0..{frames}")]);
        let mut child = command.args((0..7).flat_map(light)).spawn().unwrap();
        let mut most_kb = 0;
        while child.try_wait().unwrap().is_none() {
            let status = std::fs::read_to_string(format!("/proc/{}/status", child.id())).unwrap_or_default();
            let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
            most_kb = line.and_then(|line| line.trim().trim_end_matches(" kB").parse().ok()).unwrap_or(most_kb);
            std::thread::sleep(std::time::Duration::from_millis(5));
        }
        assert!(child.wait().unwrap().success());
        most_kb
    };
    // The showcase has a blended draw and a masked one.
    for model in ["assets/spheres.glb", "assets/showcase.glb"] {
        let (few, many): (u64, u64) = (most(model, 2), most(model, 12));
        println!("{model}: {few} kB for two frames, {many} for twelve");
        // It was 18 draws of 2.6 MB for each of ten frames.
        assert!(many < few + 100_000, "{model}: {few} kB for two frames, {many} for twelve");
    }
}

fn texture(gpu: &Gpu) -> wgpu::Texture {
    gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { width: SIDE, height: SIDE, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: formats::DATA_TEXTURE,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    })
}

/// A lit sphere with a texture of its own in each of five slots.
pub(crate) fn five_textures() -> Scene {
    use TextureSlot::{BaseColor, Emissive, MetallicRoughness, Normal, Occlusion};
    let mut material = Material { emissive_nits: glam::Vec3::ONE, ..Default::default() };
    for (texture, slot) in [BaseColor, Emissive, MetallicRoughness, Normal, Occlusion].into_iter().enumerate() {
        material.set_texture(slot, Some(TextureRef { texture, uv_set: 0, transform: UvTransform::IDENTITY }));
    }
    let mut scene = sphere_scene(material);
    for primitive in &mut scene.meshes[0].primitives {
        primitive.uvs = vec![vec![Vec2::ZERO; primitive.positions.len()]];
    }
    add_light(&mut scene, LightKind::Point { range_m: None }, 1.0, DVec3::Z * 3.0);
    let image =
        || Image { name: None, width: SIDE, height: SIDE, pixels: Pixels::Rgba8(vec![128; BYTES as usize].into()) };
    scene.images = (0..5).map(|_| image()).collect();
    scene.textures = (0..5).map(|image| Texture { image, sampler: Sampler::default() }).collect();
    scene
}
