//! Occlusion in the metallic-roughness texture: the picture of two textures, to the bit, with one lookup and less memory.

use crate::support::{add_light, draw, front_view, gpu, sphere_scene, white_environment};
use glam::{DVec3, Vec2, Vec4};
use specula::capture::{CaptureOptions, CapturedFrame};
use specula::gpu::Gpu;
use specula::gpu::formats::Precision;
use specula::gpu_scene::{GpuScene, TextureLevels};
use specula::renderer::Renderer;
use specula::scene::{
    Channel, Image, Input, LightKind, Material, Pixels, Sampler, Scene, Texture, TextureRef, TextureSlot, UvTransform,
    View,
};
use std::sync::Arc;

/// Noise, another one for each seed.
fn noise(side: u32, seed: u32) -> Arc<Vec<u8>> {
    Arc::new((0..side * side * 4).map(|i| ((i ^ seed).wrapping_mul(2_654_435_761) >> 24) as u8).collect())
}

fn image(side: u32, pixels: Pixels) -> Image {
    Image { name: None, width: side, height: side, pixels }
}

fn bytes(side: u32, seed: u32) -> Image {
    image(side, Pixels::Rgba8(noise(side, seed)))
}

fn words(side: u32, seed: u32) -> Image {
    image(side, Pixels::Rgba16(Arc::new(noise(side, seed).iter().map(|&byte| u16::from(byte) * 251).collect())))
}

/// A sphere with these images for metallic-roughness and occlusion, or one for both. Both sets of its texture
/// coordinates are the same; of the second one, the renderer does not know that.
fn scene(images: Vec<Image>, occlusion_uv_set: u32) -> Scene {
    let mut scene = sphere_scene(Material { base_color: Vec4::new(0.9, 0.6, 0.3, 1.0), ..Default::default() });
    scene.environment = Some(white_environment());
    let uvs = &mut scene.meshes[0].primitives[0].uvs;
    uvs[0].iter_mut().for_each(|uv: &mut Vec2| *uv *= 3.0);
    uvs.push(uvs[0].clone());
    let reference = |texture, uv_set| TextureRef { texture, uv_set, transform: UvTransform::IDENTITY };
    let last = images.len() - 1;
    scene.textures = (0..images.len()).map(|image| Texture { image, sampler: Sampler::default() }).collect();
    scene.images = images;
    let material = &mut scene.materials[0];
    material.set_texture(TextureSlot::MetallicRoughness, Some(reference(0, 0)));
    material.set_texture(TextureSlot::Occlusion, Some(reference(last, occlusion_uv_set)));
    scene
}

fn uploaded(gpu: &Gpu, scene: &Scene) -> GpuScene {
    // Under a lamp, so that there is something to shade.
    let mut lit = Scene { environment: None, ..scene.clone() };
    add_light(&mut lit, LightKind::Directional, 1.0, DVec3::ZERO);
    let renderer = Renderer::new(&gpu.device, &gpu.queue);
    let levels = TextureLevels::of(&lit, 4096);
    renderer.upload_with(&gpu.device, &gpu.queue, &lit, levels, None).unwrap()
}

fn is_packed(scene: &GpuScene) -> bool {
    scene.drawables.draws[0].material_features.packed_occlusion
}

/// Radiance and occlusion as drawn.
fn drawn(gpu: &Gpu, scene: &Scene) -> [CapturedFrame; 2] {
    let view = front_view(128);
    let occlusion = View { channel: Some(Channel::Input(Input::Occlusion)), ..view.clone() };
    [view, occlusion].map(|view| draw(gpu, scene, &view, CaptureOptions::default()))
}

#[test]
fn packed_occlusion_changes_no_bit_and_saves_a_texture() {
    let gpu = gpu(Precision::Float);
    let one_image = vec![bytes(64, 1)];
    for images in [vec![bytes(64, 1), bytes(64, 2)], vec![words(64, 1), words(64, 2)], one_image] {
        let (together, apart) = (scene(images.clone(), 0), scene(images.clone(), 1));
        let [with, without] = [&together, &apart].map(|scene| uploaded(&gpu, scene));
        assert_eq!((is_packed(&with), is_packed(&without)), (true, false));
        assert_eq!(with.bytes.textures * images.len() as u64, without.bytes.textures);
        for (with, without) in drawn(&gpu, &together).iter().zip(drawn(&gpu, &apart)) {
            let (with, without) = (with.radiance.as_ref().unwrap(), without.radiance.unwrap());
            let distinct: std::collections::HashSet<u32> = with.texels.iter().map(|texel| texel.x.to_bits()).collect();
            assert!(distinct.len() > 200, "only {} values", distinct.len());
            let differing = with.texels.iter().zip(&without.texels).filter(|(a, b)| a != b).count();
            assert_eq!(differing, 0);
        }
    }
}

#[test]
fn images_that_do_not_fit_each_other_stay_apart() {
    let gpu = gpu(Precision::Half);
    let others_side = scene(vec![bytes(64, 1), bytes(32, 2)], 0);
    let others_kind = scene(vec![bytes(64, 1), words(64, 2)], 0);
    let mut others_sampler = scene(vec![bytes(64, 1), bytes(64, 2)], 0);
    others_sampler.textures[1].sampler.mag_linear = false;
    let mut others_place = scene(vec![bytes(64, 1), bytes(64, 2)], 0);
    let moved = others_place.materials[0].texture_slots[TextureSlot::Occlusion as usize].as_mut().unwrap();
    moved.transform.offset.x = 0.25;
    let mut unused = scene(vec![bytes(64, 1), bytes(64, 2)], 0);
    unused.materials[0].occlusion_strength = 0.0;
    for scene in [others_side, others_kind, others_sampler, others_place, unused] {
        assert!(!is_packed(&uploaded(&gpu, &scene)));
    }
}
