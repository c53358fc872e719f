//! One pixel taken apart, by the shaders and by the reference, and `specula inspect` as its users start it.

use crate::support::{add_light, front_view, gpu, program, sphere_scene};
use glam::{DVec3, UVec2, Vec3, Vec4};
use serde_json::Value;
use specula::bake::environment::{self, BakeOptions};
use specula::capture::{CaptureTarget, PIXEL_OPTIONS, capture_pixel};
use specula::gpu::Gpu;
use specula::gpu::formats::Precision;
use specula::gpu_scene::GpuScene;
use specula::progress::Silent;
use specula::reference::inspect::Inspector;
use specula::renderer::Renderer;
use specula::scene::{
    Channel, Component, Components, Disney, Environment, EnvironmentImage, Input, LightKind, LightSource, Material,
    Scene, View,
};
use specula::shader::ShaderSources;
use std::process::Output;

/// A scene on the device, of whose pictures single pixels are drawn.
struct Pixels<'a> {
    gpu: &'a Gpu,
    renderer: Renderer,
    scene: GpuScene,
    target: CaptureTarget,
    view: View,
    suns: u32,
}

impl<'a> Pixels<'a> {
    fn new(gpu: &'a Gpu, scene: &Scene, view: &View) -> Self {
        Self::with_shaders(gpu, ShaderSources::default(), scene, view)
    }

    fn with_shaders(gpu: &'a Gpu, shaders: ShaderSources, scene: &Scene, view: &View) -> Self {
        let bake = |of: &Environment| environment::bake(&of.image, &BakeOptions::default(), &Silent);
        let maps = scene.environment.as_ref().map(bake);
        let renderer = Renderer::with_shaders(&gpu.device, &gpu.queue, shaders);
        let uploaded = renderer.upload(&gpu.device, &gpu.queue, scene, maps.as_ref()).unwrap();
        let target = CaptureTarget::new(gpu, view, PIXEL_OPTIONS).unwrap();
        let suns = maps.map_or(0, |maps| maps.suns.len() as u32);
        Self { gpu, renderer, scene: uploaded, target, view: view.clone(), suns }
    }

    fn texel(&mut self, channel: Option<Channel>, pixel: UVec2) -> Vec4 {
        self.view.channel = channel;
        let Self { gpu, renderer, scene, target, view, .. } = self;
        capture_pixel(gpu, renderer, scene, view, target, pixel).unwrap().radiance
    }

    fn radiance(&mut self, source: LightSource, components: Components, pixel: UVec2) -> DVec3 {
        self.texel(Some(Channel::Radiance { source, components }), pixel).truncate().as_dvec3()
    }
}

/// Largest difference of a channel over the largest channel.
fn apart(actual: DVec3, expected: DVec3) -> f64 {
    let difference = (actual - expected).abs().max_element();
    if difference == 0.0 { 0.0 } else { difference / expected.abs().max_element() }
}

/// What the reference says of an input that it has under another name.
fn reference_input(input: Input, inspector: &Inspector<'_>, pixel: UVec2) -> DVec3 {
    let (ray, layers) = inspector.layers(pixel);
    let details = inspector.details(&layers[0].hit, &ray);
    let (surface, material) = (&details.surface, details.surface.material);
    let inputs = inspector.inputs(surface, &ray);
    match input {
        Input::BaseColor => material.base_color,
        Input::Metallic => DVec3::splat(material.metallic),
        Input::PerceptualRoughness => DVec3::splat(material.perceptual_roughness),
        Input::Alphas => inputs.alphas.extend(0.0),
        Input::F0 => inputs.f0,
        Input::Occlusion => DVec3::splat(surface.occlusion),
        Input::Emissive => surface.emissive_nits,
        Input::Alpha => DVec3::splat(details.base_color_alpha),
        Input::Normal => surface.normal_in_world,
        Input::VertexNormal => details.vertex_normal_in_world,
        Input::GeometricNormal => details.geometric_normal_in_world.unwrap(),
        Input::Tangent => inputs.tangent_in_world,
        Input::Uv => DVec3::ZERO,
        // The sphere's centre is the origin.
        Input::Position => surface.position_in_world,
        // Reversed: near plane over distance along the line of sight, and that distance.
        Input::Depth => DVec3::new(0.1, 4.0 - surface.position_in_world.z, 0.0),
        Input::NoV => DVec3::splat(inputs.n_dot_v),
    }
}

fn materials() -> [(&'static str, Material); 3] {
    let plain = Material {
        base_color: Vec4::new(0.8, 0.35, 0.15, 1.0),
        metallic: 0.4,
        perceptual_roughness: 0.45,
        emissive_nits: Vec3::new(0.1, 0.0, 0.3),
        ..Default::default()
    };
    let disney = Disney {
        sheen: 0.6,
        clearcoat: 1.0,
        clearcoat_gloss: 0.3,
        subsurface: 0.4,
        specular_tint: 0.5,
        ..Disney::default()
    };
    let brushed = Material { anisotropy_strength: 0.8, ..plain.clone() };
    [("standard", plain.clone()), ("anisotropic", brushed), ("Disney", Material { disney: Some(disney), ..plain })]
}

const SIDE_PX: u32 = 64;
const PLACES: [UVec2; 3] = [UVec2::new(32, 31), UVec2::new(41, 20), UVec2::new(17, 29)];

#[test]
fn shaders_and_reference_agree_on_what_they_read() {
    let gpu = gpu(Precision::Float);
    let view = front_view(SIDE_PX);
    for (name, material) in materials() {
        let has_direction = material.anisotropy_strength > 0.0;
        let mut scene = sphere_scene(material);
        add_light(&mut scene, LightKind::Point { range_m: None }, 30.0, DVec3::new(2.0, 2.0, 3.0));
        let inspector = Inspector::new(&scene, &view);
        let mut pixels = Pixels::new(&gpu, &scene, &view);
        for input in Input::ALL {
            // Neither is read without a texture or a direction along the surface.
            let skipped = input == Input::Uv || (input == Input::Tangent && !has_direction);
            // A derivative over one pixel of f32 positions; the rest is interpolation.
            let limit = if input == Input::GeometricNormal { 1e-3 } else { 1e-5 };
            for pixel in PLACES.into_iter().filter(|_| !skipped) {
                let texel = pixels.texel(Some(Channel::Input(input)), pixel);
                let expected = reference_input(input, &inspector, pixel);
                let apart = match input {
                    Input::Depth => (f64::from(texel.y) / expected.y - 1.0).abs(),
                    _ => apart(texel.truncate().as_dvec3(), expected),
                };
                assert!(apart < limit && texel.w == 1.0, "{name}, {input:?} at {pixel}: {texel} and {expected}");
            }
        }
    }
}

#[test]
fn lobes_and_lights_are_the_references_and_sum_to_the_picture() {
    let gpu = gpu(Precision::Float);
    let view = front_view(SIDE_PX);
    for (name, material) in materials() {
        let mut scene = sphere_scene(material);
        add_light(&mut scene, LightKind::Point { range_m: None }, 30.0, DVec3::new(2.0, 2.0, 3.0));
        add_light(&mut scene, LightKind::Point { range_m: Some(9.0) }, 90.0, DVec3::new(-4.0, 0.5, 3.0));
        let inspector = Inspector::new(&scene, &view);
        let mut pixels = Pixels::new(&gpu, &scene, &view);
        for pixel in PLACES {
            let (ray, layers) = inspector.layers(pixel);
            let details = inspector.details(&layers[0].hit, &ray);
            let leaving = inspector.leaving(&details.surface, &ray, 1);
            let mut sum = details.surface.emissive_nits;
            let mut lit = 0;
            for (light, by_component) in leaving.lights.iter().enumerate() {
                for component in Component::ALL {
                    let source = LightSource::Light(light as u32);
                    let value = pixels.radiance(source, Components::of(&[component]), pixel);
                    let expected = by_component[component as usize];
                    let apart = apart(value, expected);
                    assert!(apart < 1e-3, "{name}, light {light}, {component:?} at {pixel}: {value} and {expected}");
                    lit += u32::from(expected != DVec3::ZERO);
                    sum += value;
                }
            }
            assert!(lit >= 3, "{name} at {pixel}: only {lit} parts are not black");
            let picture = pixels.texel(None, pixel).truncate().as_dvec3();
            assert!(apart(sum, picture) < 1e-5, "{name} at {pixel}: {sum} and {picture}");
            assert!(apart(leaving.sum(), picture) < 1e-3, "{name} at {pixel}: {} and {picture}", leaving.sum());
            let halves = [Components::DIFFUSE, Components::SPECULAR]
                .map(|components| pixels.radiance(LightSource::Punctual, components, pixel));
            let both = halves[0] + halves[1] + details.surface.emissive_nits;
            assert!(apart(both, picture) < 1e-5, "{name} at {pixel}: {both} and {picture}");
        }
    }
}

#[test]
fn a_fault_shows_in_the_row_that_has_it() {
    const FILE: &str = "lighting/lobes.wgsl";
    let (gpu, view, pixel) = (gpu(Precision::Float), front_view(SIDE_PX), PLACES[1]);
    let mut scene = sphere_scene(materials()[0].1.clone());
    add_light(&mut scene, LightKind::Point { range_m: None }, 30.0, DVec3::new(2.0, 2.0, 3.0));
    let inspector = Inspector::new(&scene, &view);
    let (ray, layers) = inspector.layers(pixel);
    let expected = inspector.leaving(&inspector.details(&layers[0].hit, &ray).surface, &ray, 1).lights[0];
    for (from, to, faulty) in [
        ("(lobes.diffuse_norm * passed)", "lobes.diffuse_norm", Component::Diffuse),
        ("F * DV", "DV", Component::Specular),
        ("(lobes.multiscatter_norm * loss)", "lobes.multiscatter_norm", Component::MultipleScattering),
    ] {
        let mut shaders = ShaderSources::default();
        let text = shaders.get(FILE).unwrap().to_owned();
        assert_eq!(text.matches(from).count(), 1, "`{from}` has to stand there once");
        shaders.insert(FILE, text.replacen(from, to, 1));
        let mut pixels = Pixels::with_shaders(&gpu, shaders, &scene, &view);
        for component in [Component::Diffuse, Component::Specular, Component::MultipleScattering] {
            let value = pixels.radiance(LightSource::Light(0), Components::of(&[component]), pixel);
            let differs = apart(value, expected[component as usize]) > 1e-3;
            assert_eq!(
                differs,
                component == faulty,
                "`{to}`, {component:?}: {value}, {}",
                expected[component as usize]
            );
        }
    }
}

#[test]
fn parts_of_the_environment_sum_to_the_picture() {
    let mut texels = vec![Vec3::new(0.3, 0.4, 0.5); 256 * 128];
    for texel in [40 * 256 + 190, 40 * 256 + 191] {
        texels[texel] = Vec3::splat(9e3);
    }
    let sky = Environment::new(EnvironmentImage { width: 256, height: 128, texels });
    let gpu = gpu(Precision::Float);
    let view = front_view(SIDE_PX);
    for (name, material) in materials() {
        let emitted = material.emissive_nits.as_dvec3();
        let scene = Scene { environment: Some(sky.clone()), ..sphere_scene(material) };
        let mut pixels = Pixels::new(&gpu, &scene, &view);
        assert_eq!(pixels.suns, 1, "the sky has one sun");
        for pixel in PLACES {
            let picture = pixels.texel(None, pixel).truncate().as_dvec3();
            let sum = |pixels: &mut Pixels<'_>, sources: &[LightSource]| -> DVec3 {
                let parts = sources.iter().flat_map(|source| Component::ALL.map(|part| (*source, part)));
                parts.map(|(source, part)| pixels.radiance(source, Components::of(&[part]), pixel)).sum()
            };
            let whole = sum(&mut pixels, &[LightSource::Environment]) + emitted;
            assert!(apart(whole, picture) < 1e-5, "{name} at {pixel}: {whole} and {picture}");
            let apart_from_sun = sum(&mut pixels, &[LightSource::Sky, LightSource::Sun(0)]) + emitted;
            assert!(apart(apart_from_sun, picture) < 1e-5, "{name} at {pixel}: {apart_from_sun} and {picture}");
        }
        let sun = pixels.radiance(LightSource::Sun(0), Components::ALL, UVec2::new(41, 20));
        assert!(sun.min_element() > 0.0, "{name}: the sun gives {sun}");
    }
}

const SHOWCASE: &str = "assets/showcase.glb";

fn inspect(more: &[&str]) -> Output {
    let arguments = ["inspect", SHOWCASE, "-q", "--size", "96x72"];
    let camera: &[&str] = if more.contains(&"--orbit") { &[] } else { &["--camera", "front"] };
    program().args(arguments).args(camera).args(more).output().unwrap()
}

fn json(more: &[&str]) -> Value {
    let output = inspect(&[more, &["--json"]].concat());
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

fn row<'a>(report: &'a Value, name: &str) -> &'a Value {
    let mut rows = report["rows"].as_array().unwrap().iter();
    rows.find(|row| row["name"] == name).unwrap_or_else(|| panic!("no row {name} in {report}"))
}

#[test]
fn a_pixel_is_explained_row_by_row() {
    let light = ["--env", "black", "--light", "point:intensity=20cd,at=1,3,4"];
    let report = json(&[&light[..], &["--pixel", "48,60"]].concat());
    assert_eq!(report["schema"], "specula-inspect-pixel/1");
    assert_eq!(report["pixel"], serde_json::json!([48, 60]));
    for key in ["node", "mesh", "material"] {
        assert!(report["hit"][key]["name"].is_string() && report["hit"][key]["index"].is_u64(), "{report}");
    }
    let weights: f64 = report["hit"]["barycentric"].as_array().unwrap().iter().map(|w| w.as_f64().unwrap()).sum();
    assert!((weights - 1.0).abs() < 1e-9 && report["hit"]["distance_m"].as_f64() > Some(1.0), "{report}");
    assert!(report["adapter"].is_string() && report["ray"]["direction"].is_array());
    for name in ["sum", "light 0, point: diffuse", "light 0, point: specular", "normal, mapped", "radiance, cd/m2"] {
        let row = row(&report, name);
        assert!(row["relative_difference"].as_f64().unwrap() < 1e-2, "{row}");
        assert_eq!(row["gpu"].as_array().map(Vec::len), row["reference"].as_array().map(Vec::len), "{row}");
    }
    let shown = |name: &str, side: &str| row(&report, name)[side].as_array().unwrap()[0].as_f64().unwrap();
    let (sum, picture) = (shown("sum", "gpu"), shown("radiance, cd/m2", "gpu"));
    assert!(picture > 0.0 && (sum / picture - 1.0).abs() < 1e-5, "{sum} and {picture}");
    let display = shown("display, sRGB of 255", "gpu") - shown("display, sRGB of 255", "reference");
    assert!(display.abs() <= 2.0, "{report}");

    let text = inspect(&[&light[..], &["--pixel", "48,60"]].concat());
    let text = String::from_utf8(text.stdout).unwrap();
    for part in ["pixel 48,60 of 96 x 72", "material", "perceptual roughness", "light to the eye", "sum", "tone-mapped"]
    {
        assert!(text.contains(part), "{part} is missing in {text}");
    }
}

#[test]
fn estimates_state_their_standard_error() {
    let report = json(&["--pixel", "48,60", "--samples", "512"]);
    let row = row(&report, "environment: specular");
    let error = row["standard_error"][0].as_f64().unwrap();
    assert!(error > 0.0 && error < 0.1 * row["reference"][0].as_f64().unwrap(), "{row}");
}

#[test]
fn the_background_is_said_to_be_one() {
    let report = json(&["--orbit", "0,90,300%", "--pixel", "0,0", "--background", "env"]);
    assert!(report["hit"].is_null() && report["layers"].as_array().unwrap().is_empty(), "{report}");
    let direction: Vec<f64> =
        report["ray"]["direction"].as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect();
    assert!((DVec3::from_slice(&direction).length() - 1.0).abs() < 1e-9);
    let row = row(&report, "radiance, cd/m2");
    assert!(row["gpu"][0].as_f64() > Some(0.0) && row["relative_difference"].as_f64().unwrap() < 1e-2, "{row}");
    let text = inspect(&["--orbit", "0,90,300%", "--pixel", "0,0"]).stdout;
    assert!(String::from_utf8(text).unwrap().contains("background: no surface along ("));
}

#[test]
fn pixels_outside_of_the_picture_are_one_line() {
    for (pixel, expected) in [
        ("96,0", "the picture is 96 x 72; X goes from 0 to 95, Y from 0 to 71"),
        ("0,72", "the picture is 96 x 72"),
        ("-1,5", "the picture is 96 x 72"),
        ("99999999999,0", "the picture is 96 x 72"),
        ("12", "expected X,Y"),
        ("a,b", "expected X,Y"),
    ] {
        let output = inspect(&["--pixel", pixel]);
        let error = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{pixel}: {error}");
        assert!(error.lines().count() == 1 && error.contains(expected), "{pixel}: {error}");
        assert!(output.stdout.is_empty());
    }
}

#[test]
fn layers_of_glass_are_listed() {
    let report = json(&["--pixel", "76,47", "--samples", "64"]);
    let layers = report["layers"].as_array().unwrap();
    assert_eq!(report["hit"]["material"]["name"], "glass", "{report}");
    assert!(layers.len() > 1 && layers[0]["alpha"].as_f64() < Some(1.0), "{report}");
    assert_eq!(layers.last().unwrap()["alpha"], 1.0);
}

#[test]
fn models_are_summed_up() {
    let report = json(&[]);
    assert_eq!(report["schema"], "specula-inspect-model/1");
    assert_eq!(report["counts"]["materials"], Value::Null);
    assert!(report["counts"]["triangles_drawn"].as_u64() > Some(10_000), "{}", report["counts"]);
    let glass = report["materials"].as_array().unwrap().iter().find(|material| material["name"] == "glass").unwrap();
    assert_eq!(glass["alpha_mode"], "blend");
    assert!((glass["parameters"]["ior"].as_f64().unwrap() - 1.8).abs() < 1e-6, "{glass}");
    assert_eq!(report["cameras"][0]["name"], "front");
    assert!(report["extensions_used"].as_array().unwrap().contains(&"KHR_materials_ior".into()));
    for key in ["scene", "bounds_m", "textures", "lights", "extensions_ignored", "warnings"] {
        assert!(!report[key].is_null(), "{key} is missing in {report}");
    }
    let text = String::from_utf8(inspect(&[]).stdout).unwrap();
    for part in ["57472 triangles drawn", "glass: standard, blend", "front: ", "KHR_materials_specular"] {
        assert!(text.contains(part), "{part} is missing in {text}");
    }
}

#[test]
fn debug_views_are_drawn() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("a.png").display().to_string();
    let render = |view: &str, more: &[&str]| {
        let arguments =
            ["render", SHOWCASE, "-q", "-o", &out, "--size", "96x72", "--camera", "front", "--debug-view", view];
        program().args(arguments).args(more).output().unwrap()
    };
    let pixel = |view: &str, x: u32, y: u32| {
        let output = render(view, &[]);
        assert!(output.status.success(), "{view}: {}", String::from_utf8_lossy(&output.stderr));
        image::open(&out).unwrap().to_rgba8().get_pixel(x, y).0
    };
    // The backdrop at the top of the picture faces +Z, is no metal and has a perceptual roughness of 0.75.
    let normal = pixel("normal", 4, 4);
    assert!(normal.iter().zip([128, 128, 255, 255]).all(|(a, b): (&u8, u8)| a.abs_diff(b) <= 1), "{normal:?}");
    assert_eq!(pixel("metallic", 4, 4), [0, 0, 0, 255]);
    assert_eq!(pixel("perceptual-roughness", 4, 4), [191, 191, 191, 255]);
    assert_eq!(pixel("nan", 4, 4), [0, 0, 0, 255]);
    assert!(pixel("depth", 4, 4)[0] < pixel("depth", 4, 70)[0]);
    for (view, more, code, expected) in [
        ("colour", &[][..], 2, "expected one of base-color, metallic"),
        ("normal", &["--renderer", "reference"][..], 2, "needs a GPU"),
    ] {
        let output = render(view, more);
        let error = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.status.code() == Some(code) && error.contains(expected), "{view}: {error}");
    }
}
