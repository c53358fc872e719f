//! Small pictures that must not change by accident.
//!
//! `tests/goldens/NAME.png` are written only by `SPECULA_BLESS=1 cargo test goldens`, on llvmpipe. A golden that is
//! missing fails. A picture that differs leaves NAME-actual.png and NAME-difference.png in `target/goldens`.

use crate::support::{draw, front_view, gpu, import};
use glam::{UVec2, Vec3};
use specula::capture::CaptureOptions;
use specula::gpu::Gpu;
use specula::gpu::formats::Precision;
use specula::scene::{Background, Environment, Projection, Quality, Scene, ToneMap, View};
use std::path::Path;

/// Steps of 255 by which a channel may differ, and the share of channels that may differ at all. Other CPUs run other
/// code on the same driver (one pixel by one step was seen between SSE and AVX), other adapters filter differently.
fn allowance(gpu: &Gpu) -> (u8, f64) {
    if gpu.info.name.contains("llvmpipe") { (2, 0.005) } else { (48, 0.05) }
}

fn case(name: &str) -> (Scene, View) {
    let mut scene = import(Path::new("assets/showcase.glb"));
    scene.environment = Some(Environment::new(specula::bake::studio::studio()));
    let camera = scene.cameras_in_world().remove(0);
    // Of the baseline: the other tiers have a truth (tests/suite/tiers.rs).
    let base = View { camera, size_px: UVec2::new(96, 72), quality: Quality::SplitSum, ..front_view(1) };
    let view = match name {
        "neutral" => View { background: Background::Color(Vec3::splat(0.16)), ..base },
        "panorama" => {
            // The backdrop would hide it.
            let mut camera = base.camera.clone();
            camera.projection = Projection::Perspective { fov_y_rad: 1.2 };
            camera.world_from_view = glam::DMat4::from_rotation_y(2.0);
            View { camera, background: Background::Environment, ..base }
        }
        "single-scatter" => View { energy_compensation: false, ..base },
        "aces" => View { tone_map: ToneMap::Aces, exposure_ev: 1.0, ..base },
        "agx" => View { tone_map: ToneMap::AgX, exposure_ev: 1.0, ..base },
        "orthographic" => {
            let mut camera = base.camera.clone();
            camera.projection = Projection::Orthographic { height_m: 3.0 };
            (camera.near_m, camera.far_m) = (0.1, 50.0);
            View { camera, ..base }
        }
        other => panic!("no case {other}"),
    };
    (scene, view)
}

#[test]
fn goldens() {
    let gpu = gpu(Precision::Half);
    let mut failures = Vec::new();
    for name in ["neutral", "panorama", "single-scatter", "aces", "agx", "orthographic"] {
        let (scene, view) = case(name);
        let actual = draw(&gpu, &scene, &view, CaptureOptions::default()).display.unwrap();
        if let Err(failure) = check(&gpu, name, view.size_px, actual) {
            failures.push(failure);
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

fn check(gpu: &Gpu, name: &str, size: UVec2, actual: Vec<u8>) -> Result<(), String> {
    let distinct = actual.chunks_exact(4).collect::<std::collections::HashSet<_>>().len();
    if distinct < 100 {
        return Err(format!("{name}: only {distinct} distinct pixels; a blank frame is no golden"));
    }
    let actual = image::RgbaImage::from_raw(size.x, size.y, actual).unwrap();
    let path = format!("tests/goldens/{name}.png");
    if std::env::var_os("SPECULA_BLESS").is_some() {
        if !gpu.info.name.contains("llvmpipe") {
            return Err(format!("goldens are blessed on llvmpipe only, this is {}", gpu.info.name));
        }
        actual.save(&path).unwrap();
        return Ok(());
    }
    let Ok(golden) = image::open(&path) else {
        return Err(format!("{path} is missing; look at the picture, then SPECULA_BLESS=1 cargo test goldens"));
    };
    let golden = golden.to_rgba8();
    let steps: Vec<u8> = golden.iter().zip(actual.iter()).map(|(a, b)| a.abs_diff(*b)).collect();
    let worst = steps.iter().copied().max().unwrap_or(255);
    let share = steps.iter().filter(|&&step| step > 0).count() as f64 / steps.len() as f64;
    let (allowed, allowed_share) = allowance(gpu);
    if golden.dimensions() == actual.dimensions() && worst <= allowed && share <= allowed_share {
        return Ok(());
    }
    std::fs::create_dir_all("target/goldens").unwrap();
    actual.save(format!("target/goldens/{name}-actual.png")).unwrap();
    let difference: Vec<u8> = steps
        .chunks(4)
        .flat_map(|s| [s[0], s[1], s[2]].map(|s| s.saturating_mul(16)).into_iter().chain([255]))
        .collect();
    image::RgbaImage::from_raw(size.x, size.y, difference)
        .unwrap()
        .save(format!("target/goldens/{name}-difference.png"))
        .unwrap();
    Err(format!(
        "{name}: worst channel differs by {worst} (allowed {allowed}), {share:.4} of them at all (allowed \
         {allowed_share}); see target/goldens/{name}-actual.png, {path} and target/goldens/{name}-difference.png; \
         if the change is right: SPECULA_BLESS=1 cargo test goldens"
    ))
}
