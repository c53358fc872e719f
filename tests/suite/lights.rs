//! Lights given by flux, intensity, lux and nits: from the typed quantity to the pixel.

use crate::support::{draw, front_view, gpu, sphere_scene};
use glam::{DVec3, Vec3, Vec4};
use specula::capture::CaptureOptions;
use specula::gpu::formats::Precision;
use specula::math::color::luminance;
use specula::math::quadrature::GaussLegendre;
use specula::progress::Silent;
use specula::radiometry::{Illuminance, Luminance, LuminousFlux, LuminousIntensity};
use specula::reference::lights::incidence;
use specula::reference::{ReferenceOptions, render};
use specula::scene::{Light, LightKind, Material, Mesh, Primitive, RadianceImage, Scene, SpotCone, Topology, View};
use std::f64::consts::{PI, TAU};

fn lumens(value: f64) -> LuminousFlux {
    LuminousFlux::from_lumens(value).unwrap()
}

fn cone(inner_degrees: f64, outer_degrees: f64) -> SpotCone {
    SpotCone::new(inner_degrees.to_radians(), outer_degrees.to_radians()).unwrap()
}

/// What the reference's light sends through a sphere of 3 m around it, lm: a goniophotometer.
fn emitted_lumens(light: Light) -> f64 {
    let radius_m = 3.0;
    let mut scene = Scene::default();
    scene.add_light(light, DVec3::new(1.0, 2.0, -3.0), DVec3::new(0.6, 0.0, -0.8));
    let light = &scene.lights_in_world()[0];
    let side = light.direction_in_world.any_orthonormal_vector();
    let illuminance = |angle_rad: f64| {
        let direction = angle_rad.cos() * light.direction_in_world + angle_rad.sin() * side;
        let arriving = incidence(light, light.position_in_world + radius_m * direction).unwrap();
        luminance(arriving.illuminance_lux) * TAU * angle_rad.sin() * radius_m * radius_m
    };
    // The edge by itself, which is 1e-3 wide at least in the cosine: no rule finds what lies between its nodes.
    let cuts = match light.kind {
        LightKind::Spot { inner_cone_rad, outer_cone_rad, .. } => {
            let full_rad = inner_cone_rad.cos().max(outer_cone_rad.cos() + 1e-3).min(1.0).acos();
            [0.0, full_rad, outer_cone_rad, PI]
        }
        LightKind::Point { .. } | LightKind::Directional => [0.0, 1.0, 2.0, PI],
    };
    let rule = GaussLegendre::new(8);
    cuts.windows(2).map(|cut| rule.integrate_adaptively(cut[0], cut[1], 1e-12, illuminance).0).sum()
}

#[test]
fn a_light_of_given_flux_emits_it() {
    let point = Light::point_from_flux(lumens(1200.0)).unwrap();
    let error = emitted_lumens(point.clone()) / 1200.0 - 1.0;
    assert!(error.abs() < 1e-12, "point: {error:e}");
    let tinted = point.with_color(DVec3::new(1.0, 0.3, 0.05)).unwrap();
    let error = emitted_lumens(tinted) / 1200.0 - 1.0;
    assert!(error.abs() < 1e-12, "tinted point: {error:e}");
    // The last two are narrower than the fall-off's least width: one ends in a step, one never gets to full intensity.
    for (inner, outer) in [(0.0, 45.0), (20.0, 30.0), (0.0, 90.0), (89.0, 90.0), (30.0, 30.0), (1.0, 1.5)] {
        let spot = Light::spot_from_flux(lumens(800.0), cone(inner, outer)).unwrap();
        let error = emitted_lumens(spot) / 800.0 - 1.0;
        // Measured 5.5e-13 for the last, where cos loses digits, and 4e-16 for the others; margin 4.
        assert!(error.abs() < 2e-12, "spot {inner} to {outer}: {error:e}");
    }
}

#[test]
fn lights_that_cannot_be_are_refused_by_name() {
    let name = |result: Result<Light, specula::radiometry::RadiometryError>| result.unwrap_err().parameter;
    let lamp = Light::point_from_flux(lumens(1.0)).unwrap();
    assert_eq!(name(Light::point_from_flux(lumens(1e40))), "strength of the light");
    assert_eq!(name(Light::spot_from_flux(lumens(1.0), cone(0.0, 1e-100))), "strength of the light");
    assert_eq!(name(lamp.clone().with_color(DVec3::new(1.0, -1.0, 0.0))), "color");
    assert_eq!(name(lamp.clone().with_color(DVec3::ZERO)), "color");
    assert_eq!(name(lamp.with_range(f64::NAN)), "range");
    let luminance = Luminance::from_nits(1.0).unwrap();
    let lamp = Light::directional_from_luminance(luminance, 1.0).unwrap();
    assert_eq!(name(lamp.with_range(2.0)), "range");
    assert_eq!(name(Light::directional_from_luminance(luminance, 0.0)), "angular diameter");
    assert_eq!(SpotCone::new(0.0, 2.0).unwrap_err().parameter, "outer cone angle");
    assert_eq!(SpotCone::new(0.5, 0.4).unwrap_err().parameter, "inner cone angle");
    assert_eq!(SpotCone::new(f64::NAN, 0.4).unwrap_err().parameter, "inner cone angle");
}

/// A square of side 2 in the plane z = 0 that faces +Z; diffuse, with an albedo of 0.5 and no interface.
fn lambertian_square() -> Scene {
    let material = Material {
        base_color: Vec4::new(0.5, 0.5, 0.5, 1.0),
        metallic: 0.0,
        perceptual_roughness: 1.0,
        specular: 0.0,
        ..Default::default()
    };
    let square = Primitive {
        topology: Topology::Triangles,
        positions: [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, y)| Vec3::new(x, y, 0.0)).to_vec(),
        normals: Some(vec![Vec3::Z; 4]),
        tangents: None,
        uvs: Vec::new(),
        colors: None,
        indices: vec![0, 1, 2, 0, 2, 3],
        material: 0,
    };
    Scene { meshes: vec![Mesh { name: None, primitives: vec![square] }], ..sphere_scene(material) }
}

fn draw_radiance(scene: &Scene, view: &View) -> RadianceImage {
    let gpu = gpu(Precision::Float);
    let options = CaptureOptions { precision: Precision::Float, ..Default::default() };
    draw(&gpu, scene, view, options).radiance.unwrap()
}

#[test]
fn lumens_and_lux_arrive_at_the_pixel() {
    // L = rho E / pi in the middle of the picture, by each way to give a light.
    let (facing, aslant) = (DVec3::NEG_Z, DVec3::new(0.6, 0.0, -0.8));
    let at = -2.0 * aslant;
    let candelas = LuminousIntensity::from_candelas(100.0).unwrap();
    let cases = [
        ("point, lm", Light::point_from_flux(lumens(1200.0)), 1200.0 / (4.0 * PI) / 4.0),
        ("point, cd", Light::point_from_intensity(candelas), 25.0),
        ("spot, lm", Light::spot_from_flux(lumens(800.0), cone(0.0, 90.0)), 800.0 * 3.0 / TAU / 4.0),
        ("spot, cd", Light::spot_from_intensity(candelas, cone(20.0, 30.0)), 25.0),
        ("lux", Light::directional_from_illuminance(Illuminance::from_lux(300.0).unwrap()), 300.0),
        ("nits", Light::directional_from_luminance(Luminance::from_nits(300.0).unwrap(), PI), 300.0 * PI),
    ];
    for (name, light, facing_lux) in cases {
        for (direction, cosine) in [(aslant, 0.8), (facing, 1.0)] {
            let mut scene = lambertian_square();
            let place = if direction == facing { DVec3::new(0.0, 0.0, 2.0) } else { at };
            scene.add_light(light.clone().unwrap(), place, direction);
            let frame = draw_radiance(&scene, &front_view(33));
            let middle = frame.texels[16 * 33 + 16];
            let expected = 0.5 * facing_lux * cosine / PI;
            let error = f64::from(middle.x) / expected - 1.0;
            // Measured 2.8e-7 at most; margin 4.
            assert!(error.abs() < 1.2e-6, "{name}: {middle} instead of {expected}, {error:e}");
        }
    }
}

#[test]
fn the_gpu_draws_these_lights_as_the_reference_does() {
    let material = Material {
        base_color: Vec4::new(0.8, 0.4, 0.2, 1.0),
        metallic: 0.3,
        perceptual_roughness: 0.5,
        ..Default::default()
    };
    let warm = Light::point_from_flux(lumens(400.0)).unwrap().with_color(DVec3::new(1.0, 0.6, 0.3)).unwrap();
    let spot = Light::spot_from_flux(lumens(40.0), cone(2.0, 8.0)).unwrap();
    let sun = Light::directional_from_luminance(Luminance::from_nits(5e5).unwrap(), 0.53_f64.to_radians()).unwrap();
    let eye = DVec3::new(1.0, 2.0, 4.0);
    let cases = [
        ("point", warm.with_range(6.0).unwrap(), DVec3::new(-2.0, 0.5, 1.5), DVec3::NEG_Y),
        ("spot", spot, eye, -eye.normalize()),
        ("sun", sun, DVec3::ZERO, DVec3::new(-1.0, 1.0, -1.0).normalize()),
    ];
    let view = front_view(96);
    for (name, light, position, direction) in cases {
        let mut scene = sphere_scene(material.clone());
        scene.add_light(light, position, direction);
        let frame = draw_radiance(&scene, &view);
        let truth = render(&scene, &view, &ReferenceOptions { samples: 64, seed: 1, progress: &Silent });
        // Edges are a matter of sampling, not of light.
        let covered = frame.texels.iter().zip(&truth.texels).filter(|(drawn, expected)| drawn.w * expected.w == 1.0);
        let (mut error, mut total, mut count) = (0.0, 0.0, 0);
        for (drawn, expected) in covered {
            error += (*drawn - *expected).truncate().abs().element_sum();
            total += expected.truncate().element_sum();
            count += 1;
        }
        assert!(count > 4000 && total > 0.0, "{name}: {count} pixels, {total}");
        // Measured 1.0e-3, 1.3e-3 and 4.9e-4: the reference averages over a pixel what the GPU samples. Margin 2.
        assert!(error / total < 2.6e-3, "{name}: {:e}", error / total);
    }
}
