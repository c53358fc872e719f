//! Suns where grazing pixels of a smooth sphere mirror them. There the taps of a lobe are much narrower than it is, but
//! must not read the mirror level, which holds the suns that are shaded already.

use crate::support::{draw, front_view, gpu, sphere_scene};
use crate::tiers::{SIDE_PX, Sphere, Tiers, placed, two_suns};
use glam::{DVec2, DVec3, Vec2, Vec4};
use specula::capture::CaptureOptions;
use specula::gpu::formats::Precision;
use specula::math::spaces::direction_from_equirect;
use specula::reference::geometry::Ray;
use specula::reference::surface::World;
use specula::scene::{
    Channel, Disney, Environment, EnvironmentImage, Material, Primitive, Projection, Scene, Topology, View,
};
use specula::shader::ShaderSources;

/// The mirror level ends at 0.088: taps narrower than 5/8 of the lobe would read it.
const PERCEPTUAL_ROUGHNESS: f32 = 0.14;

fn metal(disney: Option<Disney>) -> Material {
    let perceptual_roughness = PERCEPTUAL_ROUGHNESS;
    Material { base_color: Vec4::ONE, metallic: 1.0, perceptual_roughness, disney, ..Default::default() }
}

/// The mirror directions, in the panorama's frame, of all pixels that look at the sphere from the side.
fn grazing_mirrors() -> Vec<DVec3> {
    let (scene, view) = (sphere_scene(metal(None)), front_view(SIDE_PX));
    let environment = placed(&EnvironmentImage::constant(glam::Vec3::ZERO));
    let world = World::new(&scene, &view);
    let mirror = |i: u32| {
        let center = DVec2::new(f64::from(i % SIDE_PX), f64::from(i / SIDE_PX)) + 0.5;
        let (origin, direction) = view.camera.ray(center, view.size_px);
        let layers = world.layers(&Ray { origin, direction, t_min: 0.0, t_max: f64::INFINITY });
        let n = world.surface(&layers.first()?.hit).normal_in_world;
        let mirror = direction.reflect(n);
        (0.15..0.35).contains(&-n.dot(direction)).then(|| environment.environment_from_world(mirror))
    };
    (0..SIDE_PX * SIDE_PX).filter_map(mirror).collect()
}

/// Four suns in an even sky.
fn sky() -> EnvironmentImage {
    let (width, height) = (512, 256);
    let mirrors = grazing_mirrors();
    assert!(mirrors.len() >= 8, "{}", mirrors.len());
    let suns = [0, 1, 2, 3].map(|i| mirrors[i * mirrors.len() / 4]);
    let texel = |i: u32| {
        let uv = DVec2::new(f64::from(i % width) + 0.5, f64::from(i / width) + 0.5);
        let direction = direction_from_equirect(uv / DVec2::new(f64::from(width), f64::from(height)));
        let lit = suns.iter().any(|sun| direction.dot(*sun) > f64::cos(0.014));
        DVec3::splat(if lit { 2000.0 } else { 0.3 }).as_vec3()
    };
    EnvironmentImage { width, height, texels: (0..width * height).map(texel).collect() }
}

pub(crate) fn grazing_tiers() -> Tiers {
    let image = sky();
    assert_eq!(specula::bake::sun::extract(&image).suns.len(), 4);
    let sphere = |material| Sphere::new(material, &image);
    // Errors measured on llvmpipe, times 1.1. Disney lobes are widened for a
    // sun's disc, which is coarse here; taps that may read the mirror level make it half as much again.
    let spheres = vec![
        ("metal", sphere(metal(None)), [0.084; 3]),
        ("disney metal", sphere(metal(Some(Disney::default()))), [0.518; 3]),
    ];
    Tiers::new(&image, spheres)
}

#[test]
fn suns_are_not_seen_twice_at_grazing_angles() {
    assert_eq!(grazing_tiers().rejecting(&gpu(Precision::Float), &ShaderSources::default()), None);
}

/// A square toward the camera whose normals lie across both the line of sight and the sun's light, and turn through the
/// sun's horizon from left to right.
fn between_sight_and_sun(material: Material, toward_sun: DVec3) -> Scene {
    let across = toward_sun.cross(DVec3::Z).normalize();
    let normal = |x: f32| (across + 1e-3 * f64::from(x) * toward_sun).normalize().as_vec3();
    let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
    let mut scene = sphere_scene(material);
    scene.meshes[0].primitives = vec![Primitive {
        topology: Topology::Triangles,
        positions: corners.map(|(x, y)| glam::Vec3::new(x, y, 0.0)).into(),
        normals: Some(corners.map(|(x, _)| normal(x)).into()),
        tangents: None,
        uvs: vec![vec![Vec2::ZERO; 4]],
        colors: None,
        indices: vec![0, 1, 2, 0, 2, 3],
        material: 0,
    }];
    scene
}

#[test]
fn half_vectors_across_the_normal_make_no_nan() {
    let (gpu, image) = (gpu(Precision::Float), two_suns());
    let suns = specula::bake::sun::extract(&image).suns;
    let material = Material { perceptual_roughness: 0.3, ..Material::default() };
    let base = front_view(256);
    for sun in suns {
        let scene = Scene {
            environment: Some(Environment::new(image.clone())),
            ..between_sight_and_sun(material.clone(), sun.direction)
        };
        // Lines of sight that are parallel, so that all lie across the normals.
        let mut view = View { channel: Some(Channel::Nan), ..base.clone() };
        view.camera.projection = Projection::Orthographic { height_m: 1.9 };
        let options = CaptureOptions { samples: 1, precision: Precision::Float };
        let faults = draw(&gpu, &scene, &view, options).radiance.unwrap();
        assert!(faults.texels.iter().all(|texel| texel.w == 1.0), "the square does not fill the picture");
        let nan = faults.texels.iter().filter(|texel| texel.x > 0.0 || texel.y > 0.0).count();
        assert_eq!(nan, 0, "pixels without a number, under a sun at {}", sun.direction);
    }
}
