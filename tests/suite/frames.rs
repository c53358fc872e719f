//! Frames drawn on the GPU.

use crate::support::{add_light, draw, front_view, gpu, sphere_scene, white_environment};
use glam::{DVec3, Vec4};
use specula::capture::CaptureOptions;
use specula::gpu::formats::Precision;
use specula::scene::{LightKind, Material};

#[test]
fn a_white_furnace_returns_all_light() {
    let gpu = gpu(Precision::Half);
    for step in 0..=10 {
        let perceptual_roughness = step as f32 / 10.0;
        let mut scene = sphere_scene(Material { perceptual_roughness, ..Default::default() });
        scene.environment = Some(white_environment());
        let frame = draw(&gpu, &scene, &front_view(96), CaptureOptions::default());
        let covered: Vec<Vec4> = frame.radiance.unwrap().texels.into_iter().filter(|texel| texel.w == 1.0).collect();
        assert!(covered.len() > 1000, "only {} pixels are covered", covered.len());
        for texel in covered {
            let worst = (texel.truncate() - 1.0).abs().max_element();
            assert!(worst <= 0.005, "perceptual roughness {perceptual_roughness}: {texel}");
        }
    }
}

#[test]
fn dump() {
    let gpu = gpu(Precision::Half);
    let mut scene = sphere_scene(Material {
        metallic: 0.0,
        perceptual_roughness: 0.3,
        base_color: Vec4::new(0.8, 0.2, 0.1, 1.0),
        ..Default::default()
    });
    add_light(&mut scene, LightKind::Point { range_m: None }, 30.0, DVec3::new(2.0, 2.0, 3.0));
    let frame = draw(&gpu, &scene, &front_view(256), CaptureOptions::default());
    image::save_buffer("/tmp/dump.png", &frame.display.unwrap(), 256, 256, image::ColorType::Rgba8).unwrap();
}
