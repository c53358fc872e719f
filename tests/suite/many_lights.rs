//! Lights sorted into clusters against a loop over all of them.

use crate::support::{gpu, relative_rms};
use glam::{DVec3, UVec2};
use specula::capture::{CaptureOptions, CaptureTarget, Wanted, submit};
use specula::gpu::Gpu;
use specula::gpu::formats::Precision;
use specula::renderer::Renderer;
use specula::scene::framing::default_view;
use specula::scene::light_field::{self, LightField};
use specula::scene::{
    Background, Camera, Channel, Components, Light, LightKind, LightSource, Projection, RadianceImage, Scene, View,
};
use specula::shader::{LightList, ShaderSources};

const CLUSTERED: &str = "lighting/punctual_clustered.wgsl";

/// The loop over all lights, in the order in which clusters list them.
const BRUTE_FORCE: &str = "lighting/punctual.wgsl";

fn view(scene: &Scene, camera: Camera, size_px: UVec2) -> View {
    View { camera, background: Background::Transparent, ..default_view(scene, size_px) }
}

/// The same scene in these views, one after the other.
fn draw_all(gpu: &Gpu, shaders: ShaderSources, scene: &Scene, views: &[View], samples: u32) -> Vec<RadianceImage> {
    let mut renderer = Renderer::with_shaders(&gpu.device, &gpu.queue, shaders);
    let mut uploaded = renderer.upload(&gpu.device, &gpu.queue, scene, None).unwrap();
    assert!(uploaded.features.light_list.is_clustered());
    let options = CaptureOptions { samples, precision: Precision::Float };
    let wanted = Wanted { radiance: true, display: false };
    let pending: Vec<_> = views
        .iter()
        .map(|view| {
            let target = CaptureTarget::new(gpu, view, options).unwrap();
            submit(gpu, &mut renderer, &mut uploaded, view, &target, wanted).unwrap()
        })
        .collect();
    pending.into_iter().map(|frame| frame.wait(gpu).unwrap().radiance.unwrap()).collect()
}

fn brute_force() -> ShaderSources {
    let mut shaders = ShaderSources::default();
    let brute_force = shaders.get(BRUTE_FORCE).unwrap().to_owned();
    shaders.insert(CLUSTERED, brute_force);
    shaders
}

/// With lights that reach everything: one along a direction, one without a range, and a dark one.
fn with_unbounded(mut scene: Scene) -> Scene {
    let light = |kind, intensity| Light { name: None, kind, color: DVec3::new(1.0, 0.9, 0.7), intensity };
    scene.add_light(light(LightKind::Directional, 0.3), DVec3::ZERO, DVec3::new(0.6, -0.8, 0.0));
    scene.add_light(light(LightKind::Point { range_m: None }, 40.0), DVec3::new(2.0, 9.0, 1.0), DVec3::NEG_Y);
    scene.add_light(light(LightKind::Point { range_m: Some(5.0) }, 0.0), DVec3::new(0.0, 1.0, 1.0), DVec3::NEG_Y);
    scene
}

fn cameras() -> [Camera; 3] {
    let (eye, target) = (DVec3::new(3.0, 1.2, 4.0), DVec3::new(-9.0, 0.0, -20.0));
    let look = |projection| Camera::look_at(eye, target, DVec3::Y, projection, 0.05, 90.0);
    [
        light_field::camera(),
        look(Projection::Perspective { fov_y_rad: 1.9 }),
        look(Projection::Orthographic { height_m: 12.0 }),
    ]
}

#[test]
fn sorting_lights_changes_no_bit_of_the_radiance() {
    let gpu = gpu(Precision::Float);
    let field = |lights, range_m, spot_every| LightField { lights, range_m: Some(range_m), spot_every }.scene();
    let cases = [
        ("points", field(1024, 3.0, 0), LightList::Clustered),
        ("spots", field(576, 7.0, 1), LightList::Clustered),
        ("few and wide", field(16, 40.0, 2), LightList::Clustered),
        ("with unbounded ones", with_unbounded(field(256, 6.0, 3)), LightList::ClusteredAndUnbounded),
    ];
    for (name, scene, list) in cases {
        assert_eq!(specula::shader::SceneFeatures::of(&scene).light_list, list, "{name}");
        for (size_px, samples) in [(UVec2::new(97, 61), 4), (UVec2::new(160, 160), 1)] {
            // All in flight at once: none may see another's clusters.
            let views: Vec<View> = cameras().into_iter().map(|camera| view(&scene, camera, size_px)).collect();
            let sorted = draw_all(&gpu, ShaderSources::default(), &scene, &views, samples);
            let all = draw_all(&gpu, brute_force(), &scene, &views, samples);
            for (index, (sorted, all)) in sorted.iter().zip(&all).enumerate() {
                let apart = relative_rms(sorted, all);
                let differing = sorted.texels.iter().zip(&all.texels).filter(|(a, b)| a != b).count();
                println!("{name}, camera {index}, {size_px}: {apart:e}, {differing} texels differ");
                assert!(differing == 0, "{name}, camera {index}, {size_px}: {differing} texels, {apart:e}");
            }
        }
    }
}

/// What each of these would do, were it not right.
const FAULTS: [(&str, &str, &str); 7] = [
    ("lighting/clusters.wgsl", "+ clusters.slice_bias", "- clusters.slice_bias"),
    ("lighting/clusters.wgsl", "at.xy / w", "at.yx / w"),
    ("lighting/clusters.wgsl", "cell.z * clusters.rows", "cell.z * clusters.columns"),
    (CLUSTERED, "cluster + 1u];\n    loop", "cluster + 1u] - 1u;\n    loop"),
    (CLUSTERED, "x < 1.0 {", "x < 0.5 {"),
    (CLUSTERED, "lights[i].position - position", "lights[i].position"),
    ("lighting/unbounded.wgsl", "i < turns(", "i + 1u < turns("),
];

#[test]
fn planted_faults_change_the_radiance() {
    let gpu = gpu(Precision::Float);
    let scene = with_unbounded(LightField { lights: 256, range_m: Some(6.0), spot_every: 3 }.scene());
    let views = [view(&scene, light_field::camera(), UVec2::new(120, 64))];
    let all = draw_all(&gpu, brute_force(), &scene, &views, 1);
    for (file, right, wrong) in FAULTS {
        let mut shaders = ShaderSources::default();
        let text = shaders.get(file).unwrap();
        assert_eq!(text.matches(right).count(), 1, "{file}: {right}");
        shaders.insert(file, text.replace(right, wrong));
        let faulty = draw_all(&gpu, shaders, &scene, &views, 1);
        let apart = relative_rms(&faulty[0], &all[0]);
        assert!(apart > 1e-3, "{file}: {right} instead of {wrong} changes {apart:e}");
    }
}

#[test]
fn lists_are_short_and_single_lights_are_those_of_the_scene() {
    let gpu = gpu(Precision::Float);
    let scene = with_unbounded(LightField { lights: 256, range_m: Some(6.0), spot_every: 0 }.scene());
    let view = view(&scene, light_field::camera(), UVec2::splat(64));
    let channel = |channel| View { channel: Some(channel), ..view.clone() };
    let by_light = |light| {
        let source = LightSource::Light(light);
        channel(Channel::Radiance { source, components: Components::ALL })
    };
    let lights = scene.lights_in_world().len() as u32;
    let mut views = vec![channel(Channel::LightCount), view.clone()];
    views.extend((0..lights).map(by_light));
    let frames = draw_all(&gpu, ShaderSources::default(), &scene, &views, 1);
    let mean = frames[0].texels.iter().map(|texel| f64::from(texel.x)).sum::<f64>() / (64.0 * 64.0);
    println!("{mean} of {lights} lights are looked at");
    // Measured 15.5, in tiles as coarse as a quarter of so small a picture; the two without an end are among them.
    assert!(mean > 2.0 && mean < 18.0, "{mean}");
    // Each light by itself, in whatever order they are kept: they add up, and the dark one is dark.
    let mut sum = frames[1].clone();
    for texel in 0..sum.texels.len() {
        let of_lights: glam::Vec4 = frames[2..].iter().map(|frame| frame.texels[texel]).sum();
        sum.texels[texel] = of_lights.truncate().extend(frames[1].texels[texel].w);
    }
    assert!(relative_rms(&sum, &frames[1]) < 1e-5);
    assert!(frames[frames.len() - 1].texels.iter().all(|texel| texel.truncate() == glam::Vec3::ZERO));
    assert!(frames[frames.len() - 3].texels.iter().any(|texel| texel.x > 0.0), "the directional light");
}
