//! Shadows and interreflection where the answer is known.

use super::*;

/// Without a specular lobe: Lambert's.
fn matt(albedo: f32) -> Material {
    let base_color = Vec4::new(albedo, albedo, albedo, 1.0);
    Material { base_color, metallic: 0.0, specular: 0.0, perceptual_roughness: 1.0, ..Material::default() }
}

fn paths(scene: &Scene, view: &View, bounces: u32, samples: u32) -> RadianceImage {
    estimate(scene, view, &EstimateOptions { bounces, samples, seed: 3, ..Default::default() }).radiance
}

/// The mean over a picture.
fn mean(image: &RadianceImage) -> DVec3 {
    image.texels.iter().map(|texel| texel.as_dvec4().truncate()).sum::<DVec3>() / image.texels.len() as f64
}

/// A few pixels that all see nearly the same point, the origin, from (3, 0, 1): past a square above it.
fn narrow_view() -> View {
    let eye = DVec3::new(3.0, 0.0, 1.0);
    let projection = Projection::Perspective { fov_y_rad: 1e-3 };
    View {
        camera: Camera::look_at(eye, DVec3::ZERO, DVec3::Y, projection, 0.01, 100.0),
        size_px: UVec2::splat(4),
        ..view()
    }
}

/// A white matt floor, and a black square of side 2 at a height above it that is seen from both sides.
fn covered_floor(height: f32, cover: Material) -> Scene {
    let mut scene = scene_of(square(0.0, 0), matt(1.0));
    scene.materials.push(Material { double_sided: true, ..cover });
    scene.meshes[0].primitives.push(square(height, 1));
    scene
}

fn unlit_black() -> Material {
    Material { base_color: Vec4::new(0.0, 0.0, 0.0, 1.0), unlit: true, ..Material::default() }
}

/// Form factor of a point to a parallel square of half side 1 that lies `height` above it, by midpoints.
fn form_factor(height: f64) -> f64 {
    const N: u32 = 400;
    let place = |i: u32| (f64::from(i) + 0.5) / f64::from(N) * 2.0 - 1.0;
    let mut sum = 0.0;
    for i in 0..N {
        for j in 0..N {
            sum += (height / (place(i).powi(2) + place(j).powi(2) + height * height)).powi(2);
        }
    }
    sum / PI * (2.0 / f64::from(N)).powi(2)
}

#[test]
fn a_square_hides_its_form_factor_of_the_sky() {
    let mut scene = covered_floor(1.0, unlit_black());
    scene.environment = Some(Environment::new(EnvironmentImage::constant(Vec3::ONE)));
    let seen = mean(&paths(&scene, &narrow_view(), 1, 1024)).x;
    let expected = 1.0 - form_factor(1.0);
    // Measured 1.1e-4 and less; margin 2.
    assert!((seen - expected).abs() < 2.5e-4, "{seen} instead of {expected}");
    let unshadowed = mean(&paths(&scene, &narrow_view(), 0, 64)).x;
    assert!((unshadowed - 1.0).abs() < 1e-3, "{unshadowed}");
}

#[test]
fn a_blended_square_hides_its_share() {
    let glass = Material { base_color: Vec4::new(0.0, 0.0, 0.0, 0.25), alpha_mode: AlphaMode::Blend, ..unlit_black() };
    let mut scene = covered_floor(1.0, glass);
    scene.environment = Some(Environment::new(EnvironmentImage::constant(Vec3::ONE)));
    let seen = mean(&paths(&scene, &narrow_view(), 1, 1024)).x;
    let expected = 1.0 - 0.25 * form_factor(1.0);
    // Measured 1.1e-4 and less; margin 2.
    assert!((seen - expected).abs() < 2.5e-4, "{seen} instead of {expected}");
}

#[test]
fn a_shining_square_lights_by_its_form_factor() {
    let lamp = Material { base_color: Vec4::ONE, ..unlit_black() };
    let scene = covered_floor(0.7, lamp);
    let seen = mean(&paths(&scene, &narrow_view(), 1, 4096)).x;
    let expected = form_factor(0.7);
    // Measured 1.1e-4 and less; margin 2.
    assert!((seen - expected).abs() < 2.5e-4, "{seen} instead of {expected}");
    assert_eq!(mean(&paths(&scene, &narrow_view(), 0, 16)).x, 0.0, "unshadowed light does not come from surfaces");
}

#[test]
fn a_point_light_throws_a_shadow_and_none_from_below_the_cover() {
    for (height, expected) in [(2.0, 0.0), (0.5, 1.0)] {
        let mut scene = covered_floor(1.0, unlit_black());
        add_light(&mut scene, LightKind::Point { range_m: None }, PI * height * height, DVec3::Z * height);
        let seen = mean(&paths(&scene, &narrow_view(), 1, 16)).x;
        assert!((seen - expected).abs() < 1e-4, "light at {height}: {seen} instead of {expected}");
    }
}

#[test]
fn inside_a_shining_ball_each_reflection_adds_its_power_of_the_albedo() {
    let albedo = 0.7;
    let ball = Material { emissive_nits: Vec3::ONE, double_sided: true, ..matt(albedo as f32) };
    let scene = scene_of(sphere(48), ball);
    let projection = Projection::Perspective { fov_y_rad: 1.0 };
    let camera = Camera::look_at(DVec3::ZERO, DVec3::NEG_Z, DVec3::Y, projection, 0.01, 100.0);
    let view = View { camera, size_px: UVec2::splat(4), ..view() };
    let mut worst: f64 = 0.0;
    for bounces in [1, 2, 5, 200] {
        let seen = mean(&paths(&scene, &view, bounces, 2048)).x;
        let expected = (1.0 - f64::powi(albedo, bounces as i32 + 1)) / (1.0 - albedo);
        worst = worst.max((seen / expected - 1.0).abs());
    }
    // Measured 4.5e-3, mostly noise; margin 2.
    assert!(worst < 9e-3, "{worst:e}");
}

#[test]
fn white_bodies_vanish_in_a_furnace_however_light_runs_between_them() {
    // Two white squares that face each other, open to a sky of 1: all light finds its way out in the end.
    let mut scene = scene_of(square(0.0, 0), Material { perceptual_roughness: 0.5, ..Material::default() });
    scene.materials.push(Material { double_sided: true, ..matt(1.0) });
    scene.materials[0].double_sided = true;
    scene.meshes[0].primitives.push(square(0.8, 1));
    scene.environment = Some(Environment::new(EnvironmentImage::constant(Vec3::ONE)));
    let seen = mean(&paths(&scene, &narrow_view(), 1000, 4096)).x;
    // Measured 1.0e-3; margin 3.
    assert!((seen - 1.0).abs() < 3e-3, "{seen}");
    let cut = mean(&paths(&scene, &narrow_view(), 1, 4096)).x;
    assert!(cut < 0.95, "{cut}");
}
