//! A plane under lamps or a panorama, pixel by pixel against docs/model.md in float64.
//!
//! A plane is the same geometry to a rasteriser and to a ray, so what remains is the lighting.
#![expect(non_snake_case, reason = "equations keep the symbols of their papers")]

use crate::support::{add_light, draw_with, gpu};
use glam::{DMat4, DVec2, DVec3, DVec4, UVec2, Vec3, Vec4, vec2, vec3};
use specula::bake::environment;
use specula::capture::CaptureOptions;
use specula::gpu::Gpu;
use specula::gpu::formats::Precision;
use specula::progress::Silent;
use specula::reference::albedo::DirectionalAlbedo;
use specula::reference::brdf::{F_KullaConty, F_Schlick_average};
use specula::reference::disney::albedo::DisneyAlbedo;
use specula::reference::disney::bsdf::TangentFrame;
use specula::reference::surface::{Surface, World};
use specula::reference::{disney, integrator::Lighting};
use specula::scene::{
    Background, Camera, Disney, Environment, EnvironmentImage, EnvironmentMaps, LightKind, Material, Mesh, Node,
    Primitive, Projection, Scene, ToneMap, Topology, View,
};
use specula::shader::ShaderSources;

/// A scene, what its pixels should be, and how far off they may be.
pub(crate) struct Plane {
    pub(crate) name: &'static str,
    scene: Scene,
    maps: Option<EnvironmentMaps>,
    truth: Vec<DVec3>,
    /// Largest error of a channel relative to the pixel's brightest one.
    pub(crate) limit: f64,
}

const SIDE_PX: u32 = 24;

impl Plane {
    /// Draws with the given shaders; the largest error of any pixel, infinite where a pixel is no number.
    pub(crate) fn error(&self, gpu: &Gpu, shaders: ShaderSources) -> f64 {
        let options = CaptureOptions { samples: 1, precision: Precision::Float };
        let frame = draw_with(gpu, shaders, &self.scene, self.maps.as_ref(), &view(), options);
        let error = |(got, truth): (Vec4, &DVec3)| {
            let got = got.truncate().as_dvec3();
            let error = (got - truth).abs().max_element() / truth.max_element();
            if got.is_finite() { error } else { f64::INFINITY }
        };
        frame.radiance.unwrap().texels.into_iter().zip(&self.truth).map(error).fold(0.0, f64::max)
    }
}

/// A smooth dielectric, a tinted half metal and a rough metal, each under lamps and under a panorama.
pub(crate) fn planes() -> Vec<Plane> {
    let dielectric = Material {
        base_color: Vec4::new(0.8, 0.5, 0.2, 1.0),
        metallic: 0.0,
        perceptual_roughness: 0.4,
        specular: 0.9,
        specular_color: vec3(1.0, 0.6, 0.8),
        ..Default::default()
    };
    let half_metal = Material { metallic: 0.6, perceptual_roughness: 0.3, ..dielectric.clone() };
    let rough = Material { metallic: 1.0, perceptual_roughness: 0.95, ..dielectric.clone() };
    // Measured 2.1e-5, margin 3: the 16-bit table of the split sum.
    let lamps = |name, material: &Material| under_lamps(name, material.clone(), 7e-5);
    // Measured 2.5e-4, margin 3: texels of the prefiltered panorama, read with weights of 8 bits.
    let panorama = |name, material: &Material| under_panorama(name, material.clone(), 8e-4);
    vec![
        lamps("dielectric under lamps", &dielectric),
        lamps("half metal under lamps", &half_metal),
        lamps("rough metal under lamps", &rough),
        panorama("dielectric under a panorama", &dielectric),
        panorama("half metal under a panorama", &half_metal),
        panorama("rough metal under a panorama", &rough),
    ]
}

/// A Disney material with every lobe under lamps and under a panorama, with and without metal.
pub(crate) fn disney_planes() -> Vec<Plane> {
    let disney = Disney {
        subsurface: 0.4,
        specular: 0.9,
        specular_tint: 0.6,
        anisotropic: 0.95,
        sheen: 0.8,
        sheen_tint: 0.3,
        clearcoat: 1.0,
        clearcoat_gloss: 0.3,
    };
    let material = Material {
        base_color: Vec4::new(0.8, 0.5, 0.2, 1.0),
        metallic: 0.3,
        perceptual_roughness: 0.4,
        disney: Some(disney),
        ..Default::default()
    };
    let smooth = Material { metallic: 0.0, perceptual_roughness: 0.05, ..material.clone() };
    vec![
        // Measured 3.6e-6, margin 2.5.
        under_lamps("disney under lamps", material.clone(), 1e-5),
        // Measured 1.8e-5, margin 2.5: alpha is at its floor.
        under_lamps("smooth disney under lamps", smooth, 5e-5),
        // Measured 6.2e-4, margin 2.5: the table, and texels read with weights of 8 bits.
        under_panorama("disney under a panorama", material, 1.5e-3),
    ]
}

fn under_lamps(name: &'static str, material: Material, limit: f64) -> Plane {
    let mut scene = plane_scene(material);
    add_light(&mut scene, LightKind::Point { range_m: Some(3.0) }, 6.0, DVec3::new(-0.8, 0.3, 0.9));
    let spot = LightKind::Spot { range_m: None, inner_cone_rad: 0.2, outer_cone_rad: 0.7 };
    // A lamp shines along -Z, at the plane.
    add_light(&mut scene, spot, 9.0, DVec3::new(0.5, -0.2, 1.5));
    add_light(&mut scene, LightKind::Directional, 2.0, DVec3::new(5.0, 5.0, 5.0));
    let lighting = Lighting::new(&scene, true);
    let truth = pixels(&scene, |surface, v| lighting.radiance(surface, v, &[DVec2::ZERO; 3]));
    Plane { name, truth, maps: None, limit, scene }
}

fn under_panorama(name: &'static str, material: Material, limit: f64) -> Plane {
    let mut scene = plane_scene(material);
    let (width, height) = (16, 8);
    let radiance = |i: u32| {
        let (x, y) = (f32::from((i % width) as u16), f32::from((i / width) as u16));
        vec3(1.5 + (x * 0.4).sin(), 1.2 + (x * 0.39 + y * 0.3).cos(), 0.3 + 0.2 * y)
    };
    let image = EnvironmentImage { width, height, texels: (0..width * height).map(radiance).collect() };
    let maps = environment::bake(&image, &Default::default(), &Silent);
    let panorama = Environment { rotation_rad: 0.7, intensity: 1.7, ..Environment::new(image) };
    let albedo = DirectionalAlbedo::default();
    let quadrature = DisneyAlbedo::default();
    let truth = pixels(&scene, |surface, v| match surface.disney {
        None => split_sum(surface, v, &panorama, &maps, &albedo),
        Some(disney) => disney_split_sum(surface, &disney, v, &panorama, &maps, &quadrature),
    });
    scene.environment = Some(panorama);
    Plane { name, truth, maps: Some(maps), limit, scene }
}

/// The real-time path of docs/model.md, "Environment".
fn split_sum(
    surface: &Surface,
    v: DVec3,
    panorama: &Environment,
    maps: &EnvironmentMaps,
    albedo: &DirectionalAlbedo,
) -> DVec3 {
    let (material, n) = (surface.material, surface.normal_in_world);
    let r = material.perceptual_roughness;
    let (dfg, average) = (albedo.dfg(r, n.dot(v)), albedo.average(r));
    let mirror = panorama.environment_from_world(2.0 * n.dot(v) * n - v);
    let specular_radiance = maps.specular(mirror, r);
    let E_over_pi = maps.irradiance_over_pi(panorama.environment_from_world(n));
    let lobe = |F0: DVec3, F90: f64| {
        let F_ms = F_KullaConty(F_Schlick_average(F0, F90), average.albedo());
        (dfg.with_fresnel(F0, F90), F_ms * (1.0 - dfg.albedo()))
    };
    let radiance = |(single, multiple): (DVec3, DVec3)| specular_radiance * single + E_over_pi * multiple;

    let coat = lobe(DVec3::splat(material.dielectric_f0.max_element()), material.dielectric_f90);
    let diffuse = material.base_color * (1.0 - coat.0.x - coat.1.x) * E_over_pi;
    let dielectric = radiance(lobe(material.dielectric_f0, material.dielectric_f90)) + diffuse;
    let metal = radiance(lobe(material.base_color, 1.0));
    dielectric.lerp(metal, material.metallic) * panorama.intensity
}

/// The real-time path of docs/disney.md, "Environment".
fn disney_split_sum(
    surface: &Surface,
    disney: &Disney,
    v: DVec3,
    panorama: &Environment,
    maps: &EnvironmentMaps,
    quadrature: &DisneyAlbedo,
) -> DVec3 {
    let (material, n) = (surface.material, surface.normal_in_world);
    let frame = TangentFrame::new(n, surface.tangent_in_world);
    let (r, NoV) = (material.perceptual_roughness, n.dot(v));
    let [x, y] = [frame.tangent, frame.bitangent].map(|axis| axis.dot(v));
    let radiance_around =
        |facing: DVec3, r: f64| maps.specular(panorama.environment_from_world(2.0 * facing.dot(v) * facing - v), r);
    let (alpha_x, alpha_y) = disney::alphas(r, f64::from(disney.anisotropic));
    let excess = alpha_x * alpha_x - alpha_y * alpha_y;
    let tap = |i: u32| {
        let c: f64 = (2.0 * f64::from(i) + 1.0) / 15.0 - 1.0;
        // The slope below which lies the share (1 + c) / 2 of them.
        let facing = (n + frame.tangent * (excess.sqrt() * c.asin().tan())).normalize();
        let NoL = n.dot(2.0 * facing.dot(v) * facing - v).max(1e-9);
        let weight = facing.dot(v).max(0.0) * disney::G1_SmithGGX(disney::alpha_of_masking(r), NoL) / facing.dot(n);
        let alpha = (alpha_y * alpha_y + excess / 225.0).sqrt();
        (radiance_around(facing, alpha.sqrt().min(1.0)) * weight).extend(weight)
    };
    let taps: DVec4 = (0..15).map(tap).sum();
    let pair = quadrature.specular(r, f64::from(disney.anisotropic), NoV, y.atan2(x));
    let (specular, tint) = (f64::from(disney.specular), f64::from(disney.specular_tint));
    let F0 = disney::specular_f0(material.base_color, material.metallic, specular, tint);
    let gloss = f64::from(disney.clearcoat_gloss);
    let coat = radiance_around(n, disney::alpha_of_clearcoat(gloss).powf(0.25)) * quadrature.clearcoat(gloss, NoV);

    let smooth = quadrature.diffuse(r, NoV);
    let below = smooth.burley + (smooth.subsurface - smooth.burley) * f64::from(disney.subsurface);
    let sheen = DVec3::ONE.lerp(disney::tint(material.base_color), f64::from(disney.sheen_tint));
    let cloth = material.base_color * below + sheen * (f64::from(disney.sheen) * smooth.sheen);
    let E_over_pi = maps.irradiance_over_pi(panorama.environment_from_world(n));
    let radiance = taps.truncate() / taps.w * pair.with_fresnel(F0, 1.0)
        + coat * (0.25 * f64::from(disney.clearcoat))
        + cloth * E_over_pi * (1.0 - material.metallic);
    radiance * panorama.intensity
}

/// The truth for every pixel's centre, from the surface there and the direction toward the viewer.
fn pixels(scene: &Scene, radiance: impl Fn(&Surface, DVec3) -> DVec3) -> Vec<DVec3> {
    let view = view();
    let world = World::new(scene, &view);
    let pixel = |i: u32| {
        let center = DVec2::new(f64::from(i % SIDE_PX), f64::from(i / SIDE_PX)) + 0.5;
        let (origin, direction) = view.camera.ray(center, view.size_px);
        let ray = specula::reference::geometry::Ray { origin, direction, t_min: 0.0, t_max: f64::INFINITY };
        let layers = world.layers(&ray);
        radiance(&world.surface(&layers.first().expect("the plane fills the picture").hit), -direction)
    };
    (0..SIDE_PX * SIDE_PX).map(pixel).collect()
}

/// Seen at angles from 20 to 65 degrees.
fn view() -> View {
    let projection = Projection::Perspective { fov_y_rad: 0.8 };
    View {
        camera: Camera::look_at(DVec3::new(0.3, -1.5, 1.6), DVec3::ZERO, DVec3::Z, projection, 0.1, 100.0),
        size_px: UVec2::splat(SIDE_PX),
        exposure_ev: 0.0,
        tone_map: ToneMap::None,
        background: Background::Transparent,
        energy_compensation: true,
    }
}

/// A square in the plane z = 0 that faces +Z.
fn plane_scene(material: Material) -> Scene {
    let corners = [vec2(-8.0, -8.0), vec2(8.0, -8.0), vec2(8.0, 8.0), vec2(-8.0, 8.0)];
    let primitive = Primitive {
        topology: Topology::Triangles,
        positions: corners.map(|corner| corner.extend(0.0)).into(),
        normals: Some(vec![Vec3::Z; 4]),
        tangents: Some(vec![Vec4::new(0.8, 0.6, 0.0, 1.0); 4]),
        uvs: Vec::new(),
        colors: None,
        indices: vec![0, 1, 2, 0, 2, 3],
        material: 0,
    };
    Scene {
        nodes: vec![Node { parent_from_node: DMat4::IDENTITY, mesh: Some(0), ..Default::default() }],
        roots: vec![0],
        meshes: vec![Mesh { name: None, primitives: vec![primitive] }],
        materials: vec![material],
        ..Default::default()
    }
}

#[test]
fn a_plane_is_lit_as_the_model_says() {
    let gpu = gpu(Precision::Float);
    let errors: Vec<_> = planes().iter().map(|p| (p.name, p.error(&gpu, ShaderSources::default()), p.limit)).collect();
    for (name, error, limit) in &errors {
        println!("{name}: {error:.2e} of the pixel, {limit:.1e} allowed");
    }
    assert!(errors.iter().all(|(_, error, limit)| error <= limit), "on {}: {errors:?}", gpu.description());
}
