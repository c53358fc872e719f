//! Light from the environment in every tier, against the BRDF summed over all texels in float64: no noise, no sampling.

use crate::support::{draw_with, front_view, gpu, samples, sphere_scene};
use glam::{DVec2, DVec3, Vec4};
use rayon::prelude::*;
use specula::bake::environment::{self, BakeOptions};
use specula::bake::sun;
use specula::capture::CaptureOptions;
use specula::gpu::Gpu;
use specula::gpu::formats::Precision;
use specula::import::environment_from_path;
use specula::math::color::luminance;
use specula::math::spaces::direction_from_equirect;
use specula::progress::Silent;
use specula::reference::albedo::DirectionalAlbedo;
use specula::reference::bsdf::{Bsdf, ModelChoices, lift_view};
use specula::reference::disney::bsdf::{DisneyBsdf, DisneyMaterial, TangentFrame};
use specula::reference::geometry::Ray;
use specula::reference::surface::{Surface, World};
use specula::scene::{Environment, EnvironmentImage, EnvironmentMaps, Material, Quality, Scene};
use specula::shader::ShaderSources;
use std::f64::consts::PI;

pub(crate) const SIDE_PX: u32 = 24;

/// A sphere under a panorama, and what its pixels show.
pub(crate) struct Sphere {
    scene: Scene,
    /// Its picture is taken away from that of the scene: what is left is one lobe.
    without: Option<Scene>,
    /// Where the sphere covers the pixel's centre.
    truth: Vec<Option<DVec3>>,
}

/// Maps of a panorama with its suns parted and with them inside.
pub(crate) struct Maps {
    parted: EnvironmentMaps,
    whole: EnvironmentMaps,
}

impl Maps {
    pub(crate) fn new(image: &EnvironmentImage) -> Self {
        let bake = |suns| environment::bake(image, &BakeOptions { suns, ..Default::default() }, &Silent);
        Self { parted: bake(true), whole: bake(false) }
    }

    pub(crate) fn of(&self, quality: Quality) -> &EnvironmentMaps {
        if quality.parts_suns() { &self.parted } else { &self.whole }
    }
}

impl Sphere {
    pub(crate) fn new(material: Material, image: &EnvironmentImage) -> Self {
        // Lobes of alpha 0.04 take cells of two texels, narrower ones the texels themselves.
        let cell = match material.perceptual_roughness {
            ..0.15 => 1,
            ..0.3 => 2,
            _ => 4,
        };
        let environment = placed(image);
        let cells = cells(&environment, cell);
        let scene = Scene { environment: Some(environment), ..sphere_scene(material) };
        let truth = truth(&scene, &cells);
        Self { scene, without: None, truth }
    }

    /// What `material` has more than `without`.
    pub(crate) fn of_lobe(material: Material, without: Material, image: &EnvironmentImage) -> Self {
        let (mut with, without) = (Self::new(material, image), Self::new(without, image));
        for (more, less) in with.truth.iter_mut().zip(without.truth) {
            *more = more.zip(less).map(|(more, less)| more - less);
        }
        Self { without: Some(without.scene), ..with }
    }

    /// RMS of the error over that of the truth.
    pub(crate) fn error(&self, gpu: &Gpu, shaders: &ShaderSources, maps: &Maps, quality: Quality) -> f64 {
        let view = specula::scene::View { quality, ..front_view(SIDE_PX) };
        let options = CaptureOptions { samples: 1, precision: Precision::Float };
        let draw = |scene| {
            let frame = draw_with(gpu, shaders.clone(), scene, Some(maps.of(quality)), &view, options);
            frame.radiance.unwrap().texels
        };
        let mut texels = draw(&self.scene);
        if let Some(without) = &self.without {
            texels.iter_mut().zip(draw(without)).for_each(|(more, less)| *more -= less.with_w(0.0));
        }
        let (mut difference, mut power, mut count) = (0.0, 0.0, 0);
        for (texel, truth) in texels.iter().zip(&self.truth) {
            let (Some(truth), true) = (truth, texel.w > 0.5) else { continue };
            difference += (texel.truncate().as_dvec3() - truth).length_squared();
            power += truth.length_squared();
            count += 1;
        }
        assert!(count > 300, "only {count} pixels are covered");
        let error: f64 = difference / power;
        if error.is_finite() { error.sqrt() } else { f64::INFINITY }
    }
}

/// A panorama as it stands around every sphere.
pub(crate) fn placed(image: &EnvironmentImage) -> Environment {
    Environment { rotation_rad: 0.5, intensity: 1.3, ..Environment::new(image.clone()) }
}

/// Squares of `side` texels as directions in the world with radiance times solid angle. The direction is the mean by
/// light, so that a sun stays where it is.
fn cells(environment: &Environment, side: usize) -> Vec<(DVec3, DVec3)> {
    let image = &environment.image;
    let (width, height) = (image.width as usize, image.height as usize);
    let cosine = |row: usize| (row as f64 * PI / height as f64).cos();
    let cell = |x: usize, y: usize| {
        let (mut toward, mut light) = (DVec3::ZERO, DVec3::ZERO);
        for (row, column) in (y..y + side).flat_map(|row| (x..x + side).map(move |column| (row, column))) {
            let solid_angle = 2.0 * PI / width as f64 * (cosine(row) - cosine(row + 1));
            let texel = image.texels[row * width + column].as_dvec3() * solid_angle;
            let uv = DVec2::new(column as f64 + 0.5, row as f64 + 0.5) / DVec2::new(width as f64, height as f64);
            toward += direction_from_equirect(uv) * (luminance(texel) + 1e-12);
            light += texel;
        }
        (environment.world_from_environment(toward.normalize()), light * environment.intensity)
    };
    let rows = (0..height).step_by(side);
    rows.flat_map(|y| (0..width).step_by(side).map(move |x| (x, y))).map(|(x, y)| cell(x, y)).collect()
}

fn truth(scene: &Scene, cells: &[(DVec3, DVec3)]) -> Vec<Option<DVec3>> {
    let view = front_view(SIDE_PX);
    let (world, albedo) = (World::new(scene, &view), DirectionalAlbedo::default());
    let pixel = |i: u32| {
        let center = DVec2::new(f64::from(i % SIDE_PX), f64::from(i / SIDE_PX)) + 0.5;
        let (origin, direction) = view.camera.ray(center, view.size_px);
        let layers = world.layers(&Ray { origin, direction, t_min: 0.0, t_max: f64::INFINITY });
        Some(reflected(&world.surface(&layers.first()?.hit), -direction, &albedo, cells))
    };
    (0..SIDE_PX * SIDE_PX).into_par_iter().map(pixel).collect()
}

/// The sum over all cells above the horizon.
fn reflected(surface: &Surface, toward_viewer: DVec3, albedo: &DirectionalAlbedo, cells: &[(DVec3, DVec3)]) -> DVec3 {
    let (n, material) = (surface.normal_in_world, surface.material);
    let sum = |brdf: &dyn Fn(DVec3) -> DVec3| {
        cells.iter().filter(|(l, _)| n.dot(*l) > 0.0).map(|(l, light)| brdf(*l) * *light * n.dot(*l)).sum()
    };
    let Some(parameters) = surface.disney else {
        let bsdf = Bsdf::new(albedo, material, n, toward_viewer, ModelChoices::default());
        return sum(&|l| bsdf.evaluate(l));
    };
    let material = DisneyMaterial {
        base_color: material.base_color,
        metallic: material.metallic,
        perceptual_roughness: material.perceptual_roughness,
        parameters,
    };
    let frame = TangentFrame::new(n, surface.tangent_in_world);
    let bsdf = DisneyBsdf::new(&material, frame, lift_view(n, toward_viewer));
    sum(&|l| bsdf.evaluate(l))
}

fn metal(perceptual_roughness: f32) -> Material {
    Material { base_color: Vec4::ONE, metallic: 1.0, perceptual_roughness, ..Default::default() }
}

/// Black below its interface, so that only the specular lobe shows.
fn dielectric(perceptual_roughness: f32) -> Material {
    Material { base_color: Vec4::W, metallic: 0.0, perceptual_roughness, ..Default::default() }
}

const PERCEPTUAL_ROUGHNESS: [f32; 5] = [0.2, 0.4, 0.6, 0.8, 1.0];

/// Errors of every tier, for each perceptual roughness.
fn errors(gpu: &Gpu, image: &EnvironmentImage, material: fn(f32) -> Material) -> Vec<[f64; 4]> {
    let maps = Maps::new(image);
    let of_roughness = |r: f32| {
        let sphere = Sphere::new(material(r), image);
        Quality::ALL.map(|quality| sphere.error(gpu, &ShaderSources::default(), &maps, quality))
    };
    PERCEPTUAL_ROUGHNESS.map(of_roughness).into()
}

fn print(name: &str, errors: &[[f64; 4]]) {
    println!("{name}: r, split-sum, draft, standard, high");
    for (r, row) in PERCEPTUAL_ROUGHNESS.iter().zip(errors) {
        println!("  {r:.1} {}", row.map(|error| format!("{:6.2} %", 100.0 * error)).join(" "));
    }
}

#[test]
fn tiers_follow_the_brdf_summed_over_the_sky() {
    let Some(samples) = samples() else { return };
    let gpu = gpu(Precision::Float);
    for file in ["chinese_garden_1k.hdr", "spiaggia_di_mondello_1k.hdr"] {
        let image = environment_from_path(&samples.join("env").join(file)).unwrap();
        let of_metal = errors(&gpu, &image, metal);
        print(&format!("{file}, metal"), &of_metal);
        print(&format!("{file}, dielectric"), &errors(&gpu, &image, dielectric));
        let overcast = errors(&gpu, &sun::extract(&image).residual, metal);
        print(&format!("{file} without its sun, metal"), &overcast);
        // Measured 0.34 % and 0.28 % at most.
        for [_, _, standard, high] in of_metal {
            assert!(standard <= 0.004 && high <= 0.0033, "{file}: {standard}, {high}");
        }
        // Without suns a quarter of the split sum's error; of the narrowest lobe, two taps leave a little more.
        for (r, [split_sum, _, standard, _]) in PERCEPTUAL_ROUGHNESS.into_iter().zip(overcast) {
            let share = if r < 0.3 { 1.0 / 3.4 } else { 0.25 };
            assert!(standard <= share * split_sum, "{file} without its sun, {r}: {standard} of {split_sum}");
        }
    }
}

/// A sky of our own with two suns of different colour and a window.
pub(crate) fn two_suns() -> EnvironmentImage {
    let (width, height) = (512, 256);
    let discs = [
        (DVec3::new(0.5, 0.6, 0.5).normalize(), 0.035, DVec3::new(900.0, 500.0, 200.0)),
        (DVec3::new(-0.7, -0.1, 0.6).normalize(), 0.035, DVec3::new(100.0, 300.0, 600.0)),
        (DVec3::new(0.2, 0.9, 0.1).normalize(), 0.5, DVec3::new(4.0, 3.0, 5.0)),
    ];
    let texel = |i: u32| {
        let uv = DVec2::new(f64::from(i % width) + 0.5, f64::from(i / width) + 0.5);
        let direction = direction_from_equirect(uv / DVec2::new(f64::from(width), f64::from(height)));
        let lit = discs.iter().filter(|(center, radius, _)| direction.dot(*center) > f64::cos(*radius));
        let light: DVec3 = lit.map(|(_, _, radiance)| *radiance).sum();
        (DVec3::new(0.2, 0.3, 0.4) * (1.2 + direction.y) + light).as_vec3()
    };
    EnvironmentImage { width, height, texels: (0..width * height).map(texel).collect() }
}

/// Spheres whose tiers show a fault in how suns and taps are shaded, with the error that each tier may have.
pub(crate) struct Tiers {
    maps: Maps,
    spheres: Vec<(&'static str, Sphere, [f64; 3])>,
}

const TIERS: [Quality; 3] = [Quality::Draft, Quality::Standard, Quality::High];

impl Tiers {
    /// Round lobes under two suns.
    pub(crate) fn round() -> Self {
        let image = two_suns();
        let sphere = |material| Sphere::new(material, &image);
        // Errors measured on llvmpipe, times 1.1. The smooth one shows how a sun is handed over from the mirror level.
        let spheres = vec![
            ("smooth metal", sphere(metal(0.075)), [0.097; 3]),
            ("metal", sphere(metal(0.1)), [0.0243; 3]),
            ("rough metal", sphere(metal(0.2)), [0.0088, 0.0085, 0.0084]),
            ("rougher metal", sphere(metal(0.5)), [0.0159, 0.0074, 0.0071]),
            ("dielectric", sphere(dielectric(0.6)), [0.0172, 0.0099, 0.0086]),
            ("rough dielectric", sphere(dielectric(1.0)), [0.0374, 0.0319, 0.0319]),
        ];
        Self::new(&image, spheres)
    }

    pub(crate) fn new(image: &EnvironmentImage, spheres: Vec<(&'static str, Sphere, [f64; 3])>) -> Self {
        Self { maps: Maps::new(image), spheres }
    }

    /// The first sphere and tier that has a larger error than it may.
    pub(crate) fn rejecting(&self, gpu: &Gpu, shaders: &ShaderSources) -> Option<String> {
        let pairs = self.spheres.iter().flat_map(|(name, sphere, limits)| {
            TIERS.into_iter().zip(limits).map(move |(tier, limit)| (name, sphere, tier, limit))
        });
        pairs
            .map(|(name, sphere, tier, limit)| {
                let error = sphere.error(gpu, shaders, &self.maps, tier);
                println!("  {name}, {}: {:.2} % of {:.2} %", tier.name(), 100.0 * error, 100.0 * limit);
                (error > *limit, format!("{name}, {}", tier.name()))
            })
            .find_map(|(rejected, name)| rejected.then_some(name))
    }
}

#[test]
fn spheres_under_two_suns_are_lit_as_the_sky_says() {
    assert_eq!(Tiers::round().rejecting(&gpu(Precision::Float), &ShaderSources::default()), None);
}

#[test]
fn the_white_furnace_is_white_in_every_tier() {
    let gpu = gpu(Precision::Float);
    let image = EnvironmentImage::constant(glam::Vec3::ONE);
    let maps = Maps::new(&image);
    let mut worst: f32 = 0.0;
    for (quality, step) in Quality::ALL.into_iter().flat_map(|quality| (0..=8).map(move |step| (quality, step))) {
        let mut scene = sphere_scene(metal(step as f32 / 8.0));
        scene.environment = Some(Environment::new(image.clone()));
        let view = specula::scene::View { quality, ..front_view(SIDE_PX) };
        let options = CaptureOptions { samples: 1, precision: Precision::Float };
        let frame = draw_with(&gpu, ShaderSources::default(), &scene, Some(maps.of(quality)), &view, options);
        let covered = frame.radiance.unwrap().texels.into_iter().filter(|texel| texel.w > 0.5);
        for texel in covered {
            worst = worst.max((texel.truncate() - 1.0).abs().max_element());
        }
    }
    // Measured 1.2e-7; a hundred times that is allowed for other drivers' filters.
    assert!(worst <= 1.2e-5, "{worst}");
}
