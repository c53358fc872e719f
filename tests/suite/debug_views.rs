//! Views that are not of one input or one part of the light: the furnace, layers, edges, charts.

use crate::support::{add_light, draw, front_view, gpu, import, program, sphere_scene, white_environment};
use glam::{DMat4, DVec3, UVec2, Vec2, Vec3, Vec4};
use specula::capture::{CaptureOptions, CaptureTarget, Wanted, submit};
use specula::gpu::formats::Precision;
use specula::renderer::{RenderError, Renderer};
use specula::scene::framing::default_view;
use specula::scene::{
    AlphaMode, Camera, Channel, Disney, Image, LightKind, Material, Mesh, Node, Pixels, Primitive, Projection, Quality,
    RadianceImage, Sampler, Scene, Texture, TextureRef, TextureSlot, Topology, UvTransform, View,
};

const SIDE_PX: u32 = 64;
/// Half the side of what a picture shows, metres.
const HALF_M: f32 = 1.0;

/// Parallel lines toward -Z: the picture is the square from (-1, -1) to (1, 1).
fn flat_view(name: &str) -> View {
    let projection = Projection::Orthographic { height_m: 2.0 * f64::from(HALF_M) };
    let eye = DVec3::new(0.0, 0.0, 4.0);
    View {
        camera: Camera::look_at(eye, DVec3::ZERO, DVec3::Y, projection, 0.1, 100.0),
        size_px: UVec2::splat(SIDE_PX),
        channel: Some(Channel::by_name(name).unwrap()),
        ..front_view(SIDE_PX)
    }
}

/// A square about the z axis that faces +Z, u to the right and v down, of two triangles that meet on the diagonal from the
/// lower left to the upper right.
fn square(half_m: f32, z: f32, material: usize) -> Primitive {
    let corners = [Vec2::new(-1.0, -1.0), Vec2::new(1.0, -1.0), Vec2::new(1.0, 1.0), Vec2::new(-1.0, 1.0)];
    Primitive {
        topology: Topology::Triangles,
        positions: corners.iter().map(|corner| (half_m * *corner).extend(z)).collect(),
        normals: Some(vec![Vec3::Z; 4]),
        tangents: None,
        uvs: vec![corners.iter().map(|corner| 0.5 + 0.5 * *corner * Vec2::new(1.0, -1.0)).collect()],
        colors: None,
        indices: vec![0, 1, 2, 0, 2, 3],
        material,
    }
}

fn scene_of(primitives: Vec<Primitive>, materials: Vec<Material>) -> Scene {
    Scene {
        nodes: vec![Node { parent_from_node: DMat4::IDENTITY, mesh: Some(0), ..Default::default() }],
        roots: vec![0],
        meshes: vec![Mesh { name: None, primitives }],
        materials,
        environment: Some(white_environment()),
        ..Default::default()
    }
}

fn drawn(scene: &Scene, view: &View, options: CaptureOptions) -> RadianceImage {
    draw(&gpu(options.precision), scene, view, options).radiance.unwrap()
}

/// What is seen at a place of a flat view.
fn at(image: &RadianceImage, place: Vec2) -> Vec4 {
    let pixel = ((0.5 + 0.5 * place / HALF_M * Vec2::new(1.0, -1.0)) * SIDE_PX as f32).floor().as_uvec2();
    image.texels[(pixel.y * SIDE_PX + pixel.x) as usize]
}

const ONE_SAMPLE: CaptureOptions = CaptureOptions { samples: 1, precision: Precision::Half };

#[test]
fn layers_are_counted_whichever_is_in_front() {
    let glass = Material { alpha_mode: AlphaMode::Blend, ..Material::default() };
    let materials = vec![Material::default(), glass];
    let squares = [square(0.8, 0.0, 0), square(0.4, 1.0, 0), square(0.2, -1.0, 1)];
    for order in [[0, 1, 2], [1, 0, 2], [2, 0, 1]] {
        let scene = scene_of(order.map(|index| squares[index].clone()).to_vec(), materials.clone());
        for options in
            [ONE_SAMPLE, CaptureOptions::default(), CaptureOptions { precision: Precision::Float, ..ONE_SAMPLE }]
        {
            let image = drawn(&scene, &flat_view("overdraw"), options);
            let layers = [0.9, 0.6, 0.3, 0.1].map(|x| at(&image, Vec2::new(x, 0.05)));
            assert_eq!(
                layers,
                [0.0, 1.0, 2.0, 3.0].map(|n: f32| Vec4::new(n, n, n, n.min(1.0))),
                "{order:?} {options:?}"
            );
        }
    }
    // What faces away is not drawn.
    let mut turned = squares[1].clone();
    turned.indices.reverse();
    let image = drawn(&scene_of(vec![squares[0].clone(), turned], materials), &flat_view("overdraw"), ONE_SAMPLE);
    assert_eq!(at(&image, Vec2::new(0.1, 0.05)), Vec4::ONE);
}

/// Least and greatest of what the furnace view has of a unit sphere, away from its edge.
fn furnace(material: Material, change: impl FnOnce(&mut Scene, &mut View)) -> (f32, f32) {
    let mut scene = sphere_scene(material);
    scene.environment = Some(white_environment());
    let mut view = View { channel: Some(Channel::Furnace), ..front_view(SIDE_PX) };
    change(&mut scene, &mut view);
    let image = drawn(&scene, &view, ONE_SAMPLE);
    let seen: Vec<Vec3> = image.texels.iter().filter(|texel| texel.w == 1.0).map(|texel| texel.truncate()).collect();
    assert!(seen.len() > 1000, "{}", seen.len());
    let least = seen.iter().map(|value| value.min_element()).fold(f32::INFINITY, f32::min);
    (least, seen.iter().map(|value| value.max_element()).fold(0.0, f32::max))
}

fn white(metallic: f32, perceptual_roughness: f32) -> Material {
    Material { base_color: Vec4::ONE, metallic, perceptual_roughness, ..Material::default() }
}

#[test]
fn the_furnace_returns_all_light_of_white_materials() {
    let returned = |quality: Quality, metallic: f32, perceptual_roughness: f32| {
        let (least, most) = furnace(white(metallic, perceptual_roughness), |_, view| view.quality = quality);
        let name = format!("{quality:?}, metallic {metallic}, perceptual roughness {perceptual_roughness}");
        assert!(least > 0.995 && most < 1.005, "{name}: {least} to {most}");
    };
    Quality::ALL.into_iter().for_each(|quality| returned(quality, 0.0, 0.5));
    [(0.0, 0.1), (0.0, 1.0), (1.0, 0.1), (1.0, 0.5), (1.0, 1.0)]
        .into_iter()
        .for_each(|(metallic, perceptual_roughness)| returned(Quality::Standard, metallic, perceptual_roughness));
    // A loss is seen.
    let (least, most) = furnace(white(1.0, 1.0), |_, view| view.energy_compensation = false);
    assert!(least < 0.35 && most < 0.9, "single scattering returns {least} to {most}");
    let grey = Material { base_color: Vec4::new(0.5, 0.5, 0.5, 1.0), ..white(1.0, 0.0) };
    let (least, _) = furnace(grey, |_, _| {});
    assert!((least - 0.5).abs() < 0.005, "{least}");
}

#[test]
fn the_furnace_does_not_depend_on_the_scenes_own_light() {
    let disney =
        Material { disney: Some(Disney { sheen: 1.0, clearcoat: 1.0, ..Disney::default() }), ..white(0.5, 0.4) };
    for material in [white(0.5, 0.4), disney] {
        let plain = furnace(material.clone(), |_, _| {});
        let material = Material { emissive_nits: Vec3::splat(3.0), ..material };
        let other = furnace(material, |scene, _| {
            let environment = scene.environment.as_mut().unwrap();
            (environment.intensity, environment.rotation_rad) = (7.0, 1.0);
            environment.image = std::sync::Arc::new(specula::bake::studio::studio());
            add_light(scene, LightKind::Directional, 5.0, DVec3::ZERO);
        });
        assert_eq!(plain, other);
    }
}

#[test]
fn a_frame_after_the_furnace_is_lit_as_before() {
    let gpu = gpu(Precision::Half);
    let mut scene = sphere_scene(white(0.0, 0.4));
    let environment = specula::scene::EnvironmentImage::constant(Vec3::splat(0.25));
    scene.environment = Some(specula::scene::Environment::new(environment));
    let image = std::sync::Arc::clone(&scene.environment.as_ref().unwrap().image);
    let maps = specula::bake::environment::bake(&image, &Default::default(), &specula::progress::Silent);
    let mut renderer = Renderer::new(&gpu.device, &gpu.queue);
    let mut uploaded = renderer.upload(&gpu.device, &gpu.queue, &scene, Some(&maps)).unwrap();
    let view = front_view(SIDE_PX);
    let target = CaptureTarget::new(&gpu, &view, ONE_SAMPLE).unwrap();
    let middles = [None, Some(Channel::Furnace), None].map(|channel| {
        let (view, wanted) = (View { channel, ..view.clone() }, Wanted { radiance: true, display: false });
        let pending = submit(&gpu, &mut renderer, &mut uploaded, &view, &target, wanted).unwrap();
        at(&pending.wait(&gpu).unwrap().radiance.unwrap(), Vec2::ZERO).x
    });
    assert!((middles[0] - 0.25).abs() < 2e-3 && (middles[1] - 1.0).abs() < 5e-3, "{middles:?}");
    assert_eq!(middles[0], middles[2]);
}

#[test]
fn a_furnace_without_an_environment_is_refused() {
    let gpu = gpu(Precision::Half);
    let mut scene = sphere_scene(Material::default());
    add_light(&mut scene, LightKind::Directional, 1.0, DVec3::ZERO);
    let mut renderer = Renderer::new(&gpu.device, &gpu.queue);
    let mut uploaded = renderer.upload(&gpu.device, &gpu.queue, &scene, None).unwrap();
    let view = View { channel: Some(Channel::Furnace), ..front_view(SIDE_PX) };
    let target = CaptureTarget::new(&gpu, &view, ONE_SAMPLE).unwrap();
    let wanted = Wanted { radiance: true, display: false };
    let refused = submit(&gpu, &mut renderer, &mut uploaded, &view, &target, wanted).unwrap_err();
    assert_eq!(refused, RenderError::NoFurnace.into());
}

#[test]
fn edges_are_drawn_where_nothing_hides_them() {
    let scene = scene_of(vec![square(0.75, 0.0, 0), square(0.25, -0.5, 0)], vec![Material::default()]);
    let image = drawn(&scene, &flat_view("wireframe"), CaptureOptions::default());
    let of = |x: f32, y: f32| at(&image, Vec2::new(x, y));
    // Between edges, and before the smaller square's.
    for (x, y) in [(0.5, 0.2), (0.25, -0.1), (-0.5, 0.3), (0.1, 0.25)] {
        assert_eq!(of(x, y), Vec4::W, "{x} {y}");
    }
    // On the diagonal, the sides and outside.
    assert!(of(0.3, 0.3).x > 0.4 && of(-0.4, -0.4).x > 0.4, "{} {}", of(0.3, 0.3), of(-0.4, -0.4));
    let near_side = |y: f32| [0.735, 0.76].map(|x| of(x, y).x).into_iter().fold(0.0, f32::max);
    assert!(near_side(0.1) > 0.4 && near_side(-0.5) > 0.4, "{} {}", near_side(0.1), near_side(-0.5));
    assert_eq!(of(0.9, 0.0), Vec4::ZERO);
}

#[test]
fn charts_are_chequered() {
    let image = Image { name: None, width: 1, height: 1, pixels: Pixels::Rgba8(vec![255; 4].into()) };
    let mut material = Material::default();
    let texture = TextureRef { texture: 0, uv_set: 0, transform: UvTransform::IDENTITY };
    material.set_texture(TextureSlot::BaseColor, Some(texture));
    let mut scene = scene_of(vec![square(1.0, 0.0, 0)], vec![material]);
    scene.images = vec![image];
    scene.textures = vec![Texture { image: 0, sampler: Sampler::default() }];
    let image = drawn(&scene, &flat_view("uv-checker"), ONE_SAMPLE);
    for (row, column) in (0..8_u8).flat_map(|row| (0..8_u8).map(move |column| (row, column))) {
        let uv = (Vec2::new(f32::from(column), f32::from(row)) + 0.5) / 8.0;
        let hue = Vec3::new(uv.x, uv.y, 1.0 - 0.5 * (uv.x + uv.y));
        let expected = hue * if (row + column) % 2 == 1 { 1.0 } else { 0.35 };
        let got = at(&image, (2.0 * uv - 1.0) * Vec2::new(1.0, -1.0)).truncate();
        assert!(got.abs_diff_eq(expected, 2e-3), "{uv}: {got} for {expected}");
    }
    // Squares smaller than pixels are grey.
    scene.meshes[0].primitives[0].uvs[0].iter_mut().for_each(|uv| *uv *= 64.0);
    let image = drawn(&scene, &flat_view("uv-checker"), ONE_SAMPLE);
    let brightness: Vec<f32> = image.texels.iter().map(|texel| (texel.x + texel.y) / 2.0 + texel.z).collect();
    assert!(brightness.iter().all(|bright| (bright - 0.675).abs() < 0.01), "{brightness:?}");
    // A material that reads no coordinates has none on the device: stripes of two greys.
    scene.materials[0].set_texture(TextureSlot::BaseColor, None);
    let image = drawn(&scene, &flat_view("uv-checker"), ONE_SAMPLE);
    for (index, texel) in image.texels.iter().enumerate() {
        let (x, y) = (index % image.width as usize, index / image.width as usize);
        let grey = if (x + y + 1) % 8 < 4 { 0.5 } else { 0.35 };
        assert!(texel.abs_diff_eq(Vec4::new(grey, grey, grey, 1.0), 1e-3), "{x} {y}: {texel}");
    }
}

#[test]
fn the_program_draws_them() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("a.png").display().to_string();
    let render = |view: &str, more: &[&str]| {
        let arguments = ["render", "assets/showcase.glb", "-q", "-o", &out, "--size", "96x72", "--camera", "front"];
        let output = program().args(arguments).args(["--debug-view", view]).args(more).output().unwrap();
        assert!(output.status.success(), "{view}: {}", String::from_utf8_lossy(&output.stderr));
        image::open(&out).unwrap().to_rgba8()
    };
    let furnace = render("furnace", &[]);
    // Without light from around a white one is taken; lamps do not show.
    let dark = render("furnace", &["--env", "black", "--light", "point:flux=3000lm,at=1,3,4"]);
    let apart = |a: &image::RgbaImage, b: &image::RgbaImage| a.iter().zip(b.iter()).map(|(a, b)| a.abs_diff(*b)).max();
    assert!(apart(&furnace, &dark) <= Some(1), "{:?}", apart(&furnace, &dark));
    let distinct = |picture: &image::RgbaImage| {
        picture.pixels().map(|pixel| pixel.0).collect::<std::collections::BTreeSet<_>>().len()
    };
    for view in ["uv-checker", "overdraw", "wireframe"] {
        assert!(distinct(&render(view, &[])) > 3, "{view}");
    }
}

#[test]
fn edges_near_the_eye_show_what_was_asked_for_too() {
    // From here triangles end beside samples of pixels whose middles lie behind the eye on their planes.
    let scene = import(std::path::Path::new("assets/spheres.glb"));
    let target = scene.bounds().center();
    let projection = default_view(&scene, UVec2::splat(48)).camera.projection;
    let camera = Camera::look_at(target + DVec3::Z * 0.6, target, DVec3::Y, projection, 1e-3, 100.0);
    for side in [48, 96, 128] {
        let view = View {
            camera: camera.clone(),
            size_px: UVec2::splat(side),
            channel: Some(Channel::by_name("nan").unwrap()),
            ..front_view(side)
        };
        let options = CaptureOptions { samples: 4, precision: Precision::Half };
        let image = drawn(&scene, &view, options);
        assert!(image.texels.iter().any(|texel| texel.w > 0.0 && texel.w < 1.0), "no edges at {side}");
        let faults = image.texels.iter().filter(|texel| texel.truncate() != Vec3::ZERO).count();
        assert_eq!(faults, 0, "at {side}");
    }
}
