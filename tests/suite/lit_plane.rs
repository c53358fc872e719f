//! A plane under lamps or a panorama, pixel by pixel against docs/model.md in float64.
//!
//! A plane is the same geometry to a rasteriser and to a ray, so what remains is the lighting.
#![expect(non_snake_case, reason = "equations keep the symbols of their papers")]

use crate::support::{add_light, draw_with, gpu};
use glam::{DMat4, DVec2, DVec3, UVec2, Vec2, Vec3, Vec4, vec2, vec3};
use specula::bake::environment;
use specula::capture::CaptureOptions;
use specula::gpu::Gpu;
use specula::gpu::formats::Precision;
use specula::progress::Silent;
use specula::reference::albedo::{DfgIntegrator, DirectionalAlbedo};
use specula::reference::brdf::{F_Schlick_average, F_multiscatter};
use specula::reference::bsdf::ModelChoices;
use specula::reference::disney::albedo::DisneyAlbedo;
use specula::reference::disney::bsdf::TangentFrame;
use specula::reference::microfacet::Metal;
use specula::reference::surface::{Surface, World};
use specula::reference::{disney, integrator::Lighting};
use specula::scene::{
    Background, Camera, Disney, Environment, EnvironmentImage, EnvironmentMaps, Geometry, Image, LightKind, Material,
    Mesh, MetalFresnel, Node, Pixels, Primitive, Projection, Quality, Sampler, Scene, Texture, TextureRef, TextureSlot,
    ToneMap, Topology, UvTransform, View,
};
use specula::shader::ShaderSources;

/// A scene, what its pixels should be, and how far off they may be.
pub(crate) struct Plane {
    pub(crate) name: &'static str,
    scene: Scene,
    geometry: Geometry,
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
        let frame = draw_with(gpu, shaders, &self.scene, self.maps.as_ref(), &view(self.geometry), options);
        let error = |(got, truth): (Vec4, &DVec3)| {
            let got = got.truncate().as_dvec3();
            let error = (got - truth).abs().max_element() / truth.max_element();
            if got.is_finite() { error } else { f64::INFINITY }
        };
        frame.radiance.unwrap().texels.into_iter().zip(&self.truth).map(error).fold(0.0, f64::max)
    }
}

/// Smooth and rough, dielectric and metal, textured and seen from behind, under lamps and under a panorama.
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
    let plane = |material: &Material| plane_scene(material.clone(), Vec3::Z);
    let leaning = plane_scene(rough.clone(), vec3(0.0, 0.96, 0.28));
    vec![
        // Measured 2.1e-5, margin 3: the 16-bit table of the split sum.
        under_lamps("dielectric under lamps", plane(&dielectric), 7e-5),
        under_lamps("half metal under lamps", plane(&half_metal), 7e-5),
        under_lamps("rough metal under lamps", plane(&rough), 7e-5),
        // Measured 4.7e-5, margin 3: the same at the horizon.
        under_lamps("normal that leans away under lamps", leaning, 1.5e-4),
        // Measured 1.8e-3, margin 2: llvmpipe's decoding of sRGB texels. White ones, exact, leave 8e-6.
        under_lamps("textures under lamps", textured_back(half_metal.clone()), 3.6e-3),
        // Measured 2.5e-4, margin 3: texels of the prefiltered panorama, read with weights of 8 bits.
        under_panorama("dielectric under a panorama", plane(&dielectric), 8e-4),
        under_panorama("half metal under a panorama", plane(&half_metal), 8e-4),
        under_panorama("rough metal under a panorama", plane(&rough), 8e-4),
        under_panorama("textures under a panorama", textured_back(half_metal.clone()), 3.6e-3),
    ]
    .into_iter()
    .chain(other_microfacets(&half_metal))
    .collect()
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
        under_lamps("disney under lamps", plane_scene(material.clone(), Vec3::Z), 1e-5),
        // Measured 1.8e-5, margin 2.5: alpha is at its floor.
        under_lamps("smooth disney under lamps", plane_scene(smooth, Vec3::Z), 5e-5),
        // Measured 6.2e-4, margin 2.5: the table, and texels read with weights of 8 bits.
        under_panorama("disney under a panorama", plane_scene(material, Vec3::Z), 1.5e-3),
    ]
}

/// Every geometry, Fresnel curve and spread that is not the default.
fn other_microfacets(half_metal: &Material) -> Vec<Plane> {
    let gold = Metal::by_symbol("Au").expect("gold is in the table").conductor();
    let a = vec3(3.0, 0.5, -0.4);
    let with = |metal_fresnel| Material { metal_fresnel, ..half_metal.clone() };
    let anisotropic = Material { anisotropy_strength: 0.8, anisotropy_rotation_rad: 0.6, ..half_metal.clone() };
    let stretched = || {
        let mut scene = plane_scene(anisotropic.clone(), Vec3::Z);
        scene.meshes[0].primitives[0].tangents = Some(vec![Vec4::new(0.8, 0.6, 0.0, -1.0); 4]);
        scene
    };
    let mut planes = vec![
        // Measured 4.5e-5 or less, margin 2.
        under_lamps("Lazanyi under lamps", plane_scene(with(MetalFresnel::Lazanyi { a }), Vec3::Z), 9e-5),
        under_lamps("conductor under lamps", plane_scene(with(gold), Vec3::Z), 9e-5),
        under_lamps("anisotropic under lamps", stretched(), 9e-5),
        under_panorama("Lazanyi under a panorama", plane_scene(with(MetalFresnel::Lazanyi { a }), Vec3::Z), 8e-4),
        under_panorama("conductor under a panorama", plane_scene(with(gold), Vec3::Z), 8e-4),
        // Measured 2e-3, margin 2: directions in texels of 8 bits.
        under_lamps("anisotropic textures under lamps", textured_back(anisotropic.clone()), 4e-3),
    ];
    for geometry in Geometry::ALL {
        planes.push(with_geometry(geometry.name(), plane_scene(half_metal.clone(), Vec3::Z), geometry, 9e-5));
        planes.push(with_geometry("anisotropic with another geometry", stretched(), geometry, 9e-5));
    }
    planes
}

fn under_lamps(name: &'static str, scene: Scene, limit: f64) -> Plane {
    with_geometry(name, scene, Geometry::default(), limit)
}

fn with_geometry(name: &'static str, mut scene: Scene, geometry: Geometry, limit: f64) -> Plane {
    add_light(&mut scene, LightKind::Point { range_m: Some(3.0) }, 6.0, DVec3::new(-0.8, 0.3, 0.9));
    let spot = LightKind::Spot { range_m: None, inner_cone_rad: 0.2, outer_cone_rad: 0.7 };
    // A lamp shines along -Z, at the plane.
    add_light(&mut scene, spot, 9.0, DVec3::new(0.5, -0.2, 1.5));
    add_light(&mut scene, LightKind::Directional, 2.0, DVec3::new(5.0, 5.0, 5.0));
    let lighting = Lighting::new(&scene, ModelChoices { geometry, ..Default::default() });
    let truth = pixels(&scene, |surface, v| lighting.radiance(surface, v, &[DVec2::ZERO; 3]));
    Plane { name, truth, geometry, maps: None, limit, scene }
}

fn under_panorama(name: &'static str, mut scene: Scene, limit: f64) -> Plane {
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
    Plane { name, truth, geometry: Geometry::default(), maps: Some(maps), limit, scene }
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
    let tail = DfgIntegrator::default().fresnel_tail(r, n.dot(v));
    // `a` of Lazanyi's term, whose cosine average is 1/126.
    let dipped = |F0: DVec3, F90: f64, a: DVec3| {
        let F_ms = F_multiscatter(F_Schlick_average(F0, F90) - a / 126.0, average.albedo());
        (dfg.with_fresnel(F0, F90) - a * tail, F_ms * (1.0 - dfg.albedo()))
    };
    let lobe = |F0, F90| dipped(F0, F90, DVec3::ZERO);
    let a = match material.metal_fresnel {
        MetalFresnel::Schlick => DVec3::ZERO,
        MetalFresnel::Lazanyi { a } | MetalFresnel::Conductor { a, .. } => a.as_dvec3(),
    };
    let radiance = |(single, multiple): (DVec3, DVec3)| specular_radiance * single + E_over_pi * multiple;

    let coat = lobe(DVec3::splat(material.dielectric_f0.max_element()), material.dielectric_f90);
    let diffuse = material.base_color * (1.0 - coat.0.x - coat.1.x) * E_over_pi;
    let dielectric = radiance(lobe(material.dielectric_f0, material.dielectric_f90)) + diffuse;
    let metal = radiance(dipped(material.base_color, 1.0, a));
    dielectric.lerp(metal, material.metallic) * panorama.intensity * surface.occlusion + surface.emissive_nits
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
    // Bent to the viewer's side of the plane across which the facets lean most.
    let contrast = (alpha_x.powi(2) - alpha_y.powi(2)) / (alpha_x.powi(2) + alpha_y.powi(2));
    let leaning = (v - frame.bitangent * y).normalize();
    let bent = n.lerp(leaning, 0.5 * contrast).normalize();
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
    let radiance = radiance_around(bent, r) * pair.with_fresnel(F0, 1.0)
        + coat * (0.25 * f64::from(disney.clearcoat))
        + cloth * E_over_pi * (1.0 - material.metallic);
    radiance * panorama.intensity
}

/// The truth for every pixel's centre, from the surface there and the direction toward the viewer.
fn pixels(scene: &Scene, radiance: impl Fn(&Surface, DVec3) -> DVec3) -> Vec<DVec3> {
    let view = view(Geometry::default());
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
fn view(geometry: Geometry) -> View {
    let projection = Projection::Perspective { fov_y_rad: 0.8 };
    View {
        camera: Camera::look_at(DVec3::new(0.3, -1.5, 1.6), DVec3::ZERO, DVec3::Z, projection, 0.1, 100.0),
        size_px: UVec2::splat(SIDE_PX),
        exposure_ev: 0.0,
        tone_map: ToneMap::None,
        background: Background::Transparent,
        background_blur: 0.0,
        energy_compensation: true,
        geometry,
        // The truth here is the split sum; tests/suite/tiers.rs has the others.
        quality: Quality::SplitSum,
        term: None,
        channel: None,
    }
}

/// A square in the plane z = 0 that faces +Z, with a shading normal of its own.
fn plane_scene(material: Material, normal: Vec3) -> Scene {
    let corners = [vec2(-8.0, -8.0), vec2(8.0, -8.0), vec2(8.0, 8.0), vec2(-8.0, 8.0)];
    let primitive = Primitive {
        topology: Topology::Triangles,
        positions: corners.map(|corner| corner.extend(0.0)).into(),
        normals: Some(vec![normal; 4]),
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

/// The back of a double-sided plane with a texture in every slot, a normal map in a mirrored frame among them, and
/// vertex colours. Each texture is one texel, so that no filter takes part.
fn textured_back(material: Material) -> Scene {
    let mut scene = plane_scene(material, Vec3::NEG_Z);
    let primitive = &mut scene.meshes[0].primitives[0];
    primitive.indices = vec![0, 2, 1, 0, 3, 2];
    primitive.tangents = Some(vec![Vec4::new(0.8, 0.6, 0.0, -1.0); 4]);
    primitive.colors = Some(vec![Vec4::new(0.7, 0.9, 0.5, 1.0); 4]);
    primitive.uvs = vec![vec![Vec2::ZERO; 4]];
    let texel = |rgba: [u8; 4]| Image { name: None, width: 1, height: 1, pixels: Pixels::Rgba8(rgba.to_vec().into()) };
    scene.images = vec![texel([200, 150, 110, 180]), texel([150, 170, 230, 99])];
    scene.textures = [0, 1].map(|image| Texture { image, sampler: Sampler::default() }).into();
    let material = &mut scene.materials[0];
    for slot in TextureSlot::ALL {
        let texture = usize::from(slot == TextureSlot::Normal);
        material.set_texture(slot, Some(TextureRef { texture, uv_set: 0, transform: UvTransform::IDENTITY }));
    }
    material.double_sided = true;
    material.normal_scale = 0.8;
    material.occlusion_strength = 0.6;
    material.emissive_nits = vec3(0.3, 0.1, 0.2);
    scene
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
