//! The panorama behind the scene, sharp and blurred.

use crate::support::{draw, front_view, gpu, program, relative_rms};
use glam::{DVec3, Vec3};
use specula::capture::CaptureOptions;
use specula::gpu::formats::Precision;
use specula::math::spaces::direction_from_equirect;
use specula::progress::Silent;
use specula::reference::{ReferenceOptions, render};
use specula::scene::{
    Background, Camera, Environment, EnvironmentImage, Projection, Quality, RadianceImage, Scene, View,
};

/// A sky that is brighter above, a lamp, and a sun that the maps are parted from.
fn panorama() -> EnvironmentImage {
    let (width, height) = (512_u32, 256_u32);
    let sun = DVec3::new(0.3, 0.35, -0.9).normalize();
    let lamp = DVec3::new(-0.5, 0.1, -0.8).normalize();
    let texel = |index: u32| {
        let uv = glam::DVec2::new(f64::from(index % width) + 0.5, f64::from(index / width) + 0.5);
        let direction = direction_from_equirect(uv / glam::DVec2::new(f64::from(width), f64::from(height)));
        let sky = Vec3::new(0.4, 0.6, 1.0) * (1.0 + direction.y as f32);
        let of = |toward: DVec3, cosine: f64, radiance: Vec3| {
            if direction.dot(toward) > cosine { radiance } else { Vec3::ZERO }
        };
        sky + of(lamp, 0.97, Vec3::new(6.0, 4.0, 2.0)) + of(sun, 0.9998, Vec3::splat(4000.0))
    };
    EnvironmentImage { width, height, texels: (0..width * height).map(texel).collect() }
}

fn scene() -> Scene {
    let rotation_rad = 0.2;
    Scene { environment: Some(Environment { rotation_rad, ..Environment::new(panorama()) }), ..Default::default() }
}

/// Toward -Z, wide.
fn view(background_blur: f32, quality: Quality) -> View {
    let projection = Projection::Perspective { fov_y_rad: 1.4 };
    View {
        camera: Camera::look_at(DVec3::new(0.0, 0.0, 4.0), DVec3::ZERO, DVec3::Y, projection, 0.1, 100.0),
        background: Background::Environment,
        background_blur,
        quality,
        ..front_view(64)
    }
}

fn drawn(view: &View) -> RadianceImage {
    let options = CaptureOptions { samples: 1, precision: Precision::Float };
    draw(&gpu(Precision::Float), &scene(), view, options).radiance.unwrap()
}

#[test]
fn a_blurred_background_is_the_references() {
    // Measured on llvmpipe 0.043, 0.0031, 0.0004 and 0.067 (4096 samples; the noise was 0.009 in the first and below 0.001
    // in the others). A narrow lobe and a sun of 0.02 rad are of one size; the split sum's maps hold the sun.
    for (blur, quality, limit) in [
        (0.15, Quality::Standard, 0.06),
        (0.4, Quality::Standard, 0.005),
        (1.0, Quality::Standard, 0.002),
        (0.4, Quality::SplitSum, 0.1),
    ] {
        let view = view(blur, quality);
        let options = ReferenceOptions { samples: 1024, seed: 0, progress: &Silent };
        let error = relative_rms(&drawn(&view), &render(&scene(), &view, &options));
        println!("blur {blur}, {quality:?}: {error:.4}");
        assert!(error < limit, "blur {blur}, {quality:?}: {error}");
    }
}

#[test]
fn blur_begins_where_the_background_is_sharp() {
    let [sharp, hardly, more] = [0.0, 1e-3, 0.3].map(|blur| drawn(&view(blur, Quality::SplitSum)));
    let apart = [relative_rms(&hardly, &sharp), relative_rms(&more, &sharp)];
    println!("apart {apart:?}");
    assert!(apart[0] < 0.5 * apart[1], "{apart:?}");
}

#[test]
fn the_program_blurs_and_refuses() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("a.png").display().to_string();
    let render = |more: &[&str]| {
        let arguments = ["render", "assets/spheres.glb", "-q", "-o", &out, "--size", "48x48", "--background", "env"];
        program().args(arguments).args(more).output().unwrap()
    };
    let picture = |more: &[&str]| {
        let output = render(more);
        assert!(output.status.success(), "{more:?}: {}", String::from_utf8_lossy(&output.stderr));
        image::open(&out).unwrap().to_rgba8()
    };
    let [without, zero, some] = [&[][..], &["--background-blur", "0"], &["--background-blur", "0.5"]].map(picture);
    assert!(without == zero && without != some);
    for bad in ["1.5", "-0.1", "much"] {
        let output = render(&[&format!("--background-blur={bad}")]);
        let error = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.status.code() == Some(2) && error.contains("expected a number from 0 to 1"), "{bad}: {error}");
    }
}
