//! Scenes that are changed while they are shown: the picture is that of the same scene uploaded anew, to the bit.

use super::host::{Attachments, read};
use super::{encoder, model, view};
use crate::support::{gpu, white_environment};
use glam::{DMat4, DVec3, UVec2, Vec2, Vec4};
use specula::bake::environment::{BakeOptions, bake};
use specula::embed::{EmbedError, LiveScene, ModelId};
use specula::gpu::Gpu;
use specula::gpu::formats::Precision;
use specula::progress::Silent;
use specula::renderer::{FrameState, HostTarget, HostView, PassFormat, Renderer};
use specula::scene::{
    AlphaMode, Background, Environment, Image, Light, LightKind, Material, Pixels, Sampler, Scene, Texture, TextureRef,
    TextureSlot, UvTransform, View,
};
use std::sync::Arc;

/// A renderer with a target and what it keeps from frame to frame.
pub(super) struct Stage {
    pub(super) gpu: Gpu,
    pub(super) renderer: Renderer,
    pub(super) attachments: Attachments,
    pub(super) view: View,
    pub(super) state: FrameState,
}

impl Stage {
    pub(super) fn new(size_px: UVec2) -> Self {
        let gpu = gpu(Precision::Half);
        Self {
            renderer: Renderer::new(&gpu.device, &gpu.queue),
            attachments: Attachments::new(&gpu.device, &PassFormat::own(1), size_px),
            view: View { size_px, background: Background::Environment, ..view() },
            state: FrameState::default(),
            gpu,
        }
    }

    /// Records a frame of the scene.
    pub(super) fn record(&mut self, scene: &mut LiveScene) -> wgpu::CommandEncoder {
        let device = (&self.gpu.device, &self.gpu.queue);
        let uploaded = scene.update(&self.renderer, device).unwrap();
        let target = HostTarget {
            color: &self.attachments.color,
            resolve: None,
            load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
            depth: None,
            depth_load: wgpu::LoadOp::Load,
        };
        let mut encoder = encoder(&self.gpu);
        let mut views = [HostView { view: &self.view, at_px: UVec2::ZERO, state: &mut self.state }];
        let pass = PassFormat { depth: None, ..PassFormat::own(1) };
        self.renderer.encode(device, &mut encoder, uploaded, &mut views, (&pass, &target)).unwrap();
        encoder
    }

    pub(super) fn draw(&mut self, scene: &mut LiveScene) -> Vec<u8> {
        let encoder = self.record(scene);
        read(&self.gpu, encoder, self.attachments.picture()).unwrap()
    }

    /// Draws what the scene is now as one that was never anything else.
    pub(super) fn draw_anew(&mut self, scene: &LiveScene) -> Vec<u8> {
        let mut anew = LiveScene::new();
        anew.insert(scene.scene()).unwrap();
        anew.set_environment(scene.scene().environment.clone().map(with_maps));
        self.draw(&mut anew)
    }

    /// Draws the scene, asserts how often it was uploaded, and that its picture is that of the same scene made anew and
    /// another one than `before`. Returns it.
    #[track_caller]
    pub(super) fn expect(&mut self, scene: &mut LiveScene, uploads: u64, before: &[u8]) -> Vec<u8> {
        let picture = self.draw(scene);
        assert_eq!(scene.uploads(), uploads, "uploads");
        assert!(picture == self.draw_anew(scene), "the picture is not that of the scene");
        assert!(picture != before, "nothing has changed");
        picture
    }
}

/// How many pixels of two pictures of half floats are further apart than rounding.
fn apart(a: &[u8], b: &[u8]) -> usize {
    let halves =
        |bytes: &[u8]| -> Vec<[half::f16; 4]> { bytes.chunks_exact(8).map(bytemuck::pod_read_unaligned).collect() };
    let differ = |(a, b): &(half::f16, half::f16)| (a.to_f32() - b.to_f32()).abs() > 2e-3 * (1.0 + b.to_f32().abs());
    let pixels = halves(a).into_iter().zip(halves(b));
    pixels.filter(|(a, b)| a.iter().copied().zip(b.iter().copied()).any(|pair| differ(&pair))).count()
}

fn with_maps(environment: Environment) -> (Environment, Arc<specula::scene::EnvironmentMaps>) {
    let maps = bake(&environment.image, &BakeOptions::default(), &Silent);
    (environment, Arc::new(maps))
}

fn stage() -> Stage {
    Stage::new(UVec2::new(80, 60))
}

#[test]
fn transforms_are_written_and_not_uploaded() {
    let (mut stage, mut scene) = (stage(), LiveScene::new());
    let id = scene.insert(&model()).unwrap();
    let first = stage.draw(&mut scene);
    // Around the origin that the scene was uploaded with, which its bounds give once more.
    scene.set_transform(id, DMat4::from_rotation_y(0.7)).unwrap();
    let picture = stage.draw(&mut scene);
    assert!(picture != first && scene.uploads() == 1);
    scene.set_nodes(id, [(1, DMat4::from_scale(DVec3::new(0.2, 0.7, 0.5)))]).unwrap();
    let second = stage.draw(&mut scene);
    assert!(second != picture && scene.uploads() == 1);
    scene.set_nodes(id, [(1, DMat4::from_translation(DVec3::new(-1.1, 0.0, -1.1)))]).unwrap();
    scene.set_transform(id, DMat4::IDENTITY).unwrap();
    assert!(stage.draw(&mut scene) == first && scene.uploads() == 1);
    // With the light, which is a node of the model too. Uploaded anew, everything is around another origin.
    scene.set_transform(id, DMat4::from_rotation_x(0.5) * DMat4::from_scale(DVec3::splat(0.8))).unwrap();
    let (moved, anew) = (stage.draw(&mut scene), stage.draw_anew(&scene));
    let apart = apart(&moved, &anew);
    assert!(apart <= 5 && scene.uploads() == 1, "{apart} pixels of a moved scene are not those of one in that place");
    scene.set_nodes(id, [(0, DMat4::from_scale(DVec3::new(-1.0, 1.0, 1.0)))]).unwrap();
    // A mirrored mesh is another draw.
    stage.expect(&mut scene, 2, &second);
}

#[test]
fn materials_and_lights_are_written_where_they_need_no_other_shader() {
    let (mut stage, mut scene) = (stage(), LiveScene::new());
    let id = scene.insert(&model()).unwrap();
    let first = stage.draw(&mut scene);
    let material = Material { base_color: Vec4::new(0.1, 0.2, 0.9, 1.0), ..model().materials[0].clone() };
    scene.set_material(id, 0, material.clone()).unwrap();
    let blue = stage.expect(&mut scene, 1, &first);
    scene.set_material(id, 0, Material { perceptual_roughness: 0.9, ..material.clone() }).unwrap();
    scene
        .set_material(id, 1, Material { base_color: Vec4::new(1.0, 0.0, 0.0, 0.9), ..model().materials[1].clone() })
        .unwrap();
    let rough = stage.expect(&mut scene, 1, &blue);
    let lamp = Light { name: None, kind: LightKind::Point { range_m: None }, color: DVec3::X, intensity: 90.0 };
    scene.set_light(id, 1, lamp.clone()).unwrap();
    let red = stage.expect(&mut scene, 1, &rough);
    scene.set_light(id, 0, Light { intensity: 0.0, ..lamp.clone() }).unwrap();
    let one = stage.expect(&mut scene, 1, &red);
    scene.set_material(id, 0, Material { alpha_mode: AlphaMode::Blend, ..material.clone() }).unwrap();
    let blended = stage.expect(&mut scene, 2, &one);
    scene.set_material(id, 0, Material { emissive_nits: glam::Vec3::ONE, ..material }).unwrap();
    let dark = stage.expect(&mut scene, 3, &blended);
    scene.set_light(id, 1, Light { intensity: 0.0, ..lamp }).unwrap();
    stage.expect(&mut scene, 4, &dark);
}

#[test]
fn an_environment_is_turned_and_dimmed_in_place() {
    let (mut stage, mut scene) = (stage(), LiveScene::new());
    scene.insert(&model()).unwrap();
    let dark = stage.draw(&mut scene);
    scene.set_environment(Some(with_maps(Environment::new(specula::bake::studio::studio()))));
    let lit = stage.expect(&mut scene, 2, &dark);
    scene.turn_environment(1.0, 1.0).unwrap();
    let turned = stage.expect(&mut scene, 2, &lit);
    scene.turn_environment(1.0, 0.25).unwrap();
    let dimmed = stage.expect(&mut scene, 2, &turned);
    // Without any light it is as if there was none.
    scene.turn_environment(1.0, 0.0).unwrap();
    let out = stage.expect(&mut scene, 3, &dimmed);
    assert!(out == dark);
    scene.set_environment(Some(with_maps(white_environment())));
    stage.expect(&mut scene, 4, &dark);
    scene.set_environment(None);
    assert!(stage.draw(&mut scene) == dark);
}

/// A small sphere at x with a texture of its own.
pub(super) fn textured(x: f64, color: [u8; 4]) -> Scene {
    let mut scene = crate::support::sphere_scene(Material { metallic: 0.0, ..Default::default() });
    scene.images = vec![Image { name: None, width: 1, height: 1, pixels: Pixels::Rgba8(Arc::new(color.to_vec())) }];
    scene.textures = vec![Texture { image: 0, sampler: Sampler::default() }];
    let texture = TextureRef { texture: 0, uv_set: 0, transform: UvTransform::IDENTITY };
    scene.materials[0].set_texture(TextureSlot::BaseColor, Some(texture));
    let moved = DMat4::from_translation(DVec3::new(x, 0.0, 0.0)) * DMat4::from_scale(DVec3::splat(0.4));
    scene.nodes[0].parent_from_node = moved;
    scene
}

#[test]
fn models_come_and_go_and_handles_tell_them_apart() {
    let (mut stage, mut scene) = (stage(), LiveScene::new());
    let light = scene.insert(&model()).unwrap();
    let only = stage.draw(&mut scene);
    let colors = [[255, 0, 0, 255], [0, 255, 0, 255], [0, 0, 255, 255]];
    let ids: Vec<ModelId> =
        colors.iter().zip([-1.0, 0.3, 1.6]).map(|(color, x)| scene.insert(&textured(x, *color)).unwrap()).collect();
    let all = stage.expect(&mut scene, 2, &only);
    scene.remove(ids[0]).unwrap();
    let two = stage.expect(&mut scene, 3, &all);
    // The ones behind it have moved up, and are found.
    scene.set_transform(ids[2], DMat4::from_translation(DVec3::Y)).unwrap();
    let lifted = stage.draw(&mut scene);
    assert!(lifted != two && scene.uploads() == 3);
    let again = scene.insert(&textured(-1.0, colors[0])).unwrap();
    assert_ne!(again, ids[0]);
    for id in [again, ids[1], ids[2], light] {
        scene.remove(id).unwrap();
        assert_eq!(scene.remove(id), Err(EmbedError::StaleHandle));
    }
    assert_eq!((scene.scene().nodes.len(), scene.scene().images.len(), scene.scene().roots.len()), (0, 0, 0));
    assert!(stage.draw(&mut scene).iter().all(|&byte| byte == 0) || scene.scene().environment.is_none());
    scene.insert(&model()).unwrap();
    assert!(stage.draw(&mut scene) == only);
}

#[test]
fn a_material_changes_its_textures() {
    let (mut stage, mut scene) = (stage(), LiveScene::new());
    scene.insert(&model()).unwrap();
    let id = scene.insert(&textured(0.0, [0, 255, 0, 255])).unwrap();
    scene.set_transform(id, DMat4::from_scale(DVec3::splat(3.0))).unwrap();
    let green = stage.draw(&mut scene);
    scene.set_material(id, 0, Material { metallic: 0.0, ..Default::default() }).unwrap();
    let white = stage.expect(&mut scene, 2, &green);
    let textured = textured(0.0, [0; 4]).materials[0].clone();
    scene.set_material(id, 0, textured.clone()).unwrap();
    assert!(stage.expect(&mut scene, 3, &white) == green);
    let mut both = textured.clone();
    both.emissive_nits = glam::Vec3::splat(0.3);
    both.set_texture(TextureSlot::Emissive, textured.texture(TextureSlot::BaseColor).copied());
    scene.set_material(id, 0, both).unwrap();
    stage.expect(&mut scene, 4, &green);
}

#[test]
fn stale_handles_and_bad_numbers_are_errors_and_change_nothing() {
    let (mut stage, mut scene, mut other) = (stage(), LiveScene::new(), LiveScene::new());
    let [gone, id] = [scene.insert(&model()).unwrap(), scene.insert(&model()).unwrap()];
    let foreign = other.insert(&model()).unwrap();
    scene.remove(gone).unwrap();
    let before = stage.draw(&mut scene);
    let lamp = model().lights[1].clone();
    for stale in [gone, foreign] {
        assert_eq!(scene.remove(stale), Err(EmbedError::StaleHandle));
        assert_eq!(scene.set_transform(stale, DMat4::IDENTITY), Err(EmbedError::StaleHandle));
        assert_eq!(scene.set_nodes(stale, []), Err(EmbedError::StaleHandle));
        assert_eq!(scene.set_material(stale, 0, Material::default()), Err(EmbedError::StaleHandle));
        assert_eq!(scene.set_light(stale, 0, lamp.clone()), Err(EmbedError::StaleHandle));
    }
    let read = |texture, uv_set| {
        let mut material = Material::default();
        let texture = TextureRef { texture, uv_set, transform: UvTransform::IDENTITY };
        material.set_texture(TextureSlot::BaseColor, Some(texture));
        material
    };
    let nan = DMat4::from_translation(DVec3::NAN);
    let strong = Light { intensity: f64::INFINITY, ..lamp.clone() };
    let backwards = LightKind::Spot { range_m: None, inner_cone_rad: 0.5, outer_cone_rad: 0.4 };
    let errors = [
        scene.set_transform(id, nan),
        scene.set_nodes(id, [(0, nan)]),
        scene.set_nodes(id, [(model().nodes.len(), DMat4::IDENTITY)]),
        scene.set_material(id, 2, Material::default()),
        scene.set_material(id, 0, read(0, 0)),
        scene.set_light(id, 2, lamp.clone()),
        scene.set_light(id, 0, strong),
        scene.set_light(id, 0, Light { kind: backwards, ..lamp.clone() }),
        scene.set_light(id, 0, Light { kind: LightKind::Point { range_m: Some(0.0) }, ..lamp }),
        scene.turn_environment(f64::NAN, 1.0),
        scene.turn_environment(0.0, -1.0),
    ];
    for error in errors {
        println!("{}", error.unwrap_err());
    }
    let error = scene.insert(&Scene { roots: vec![0, 0], ..model() }).unwrap_err();
    println!("{error}");
    assert!(stage.draw(&mut scene) == before && scene.uploads() == 1);
}

#[test]
fn assets_that_do_not_fit_together_are_refused() {
    type Fault = fn(&mut Scene);
    let faults: [(&str, Fault); 13] = [
        ("node 9", |s| s.roots.push(9)),
        ("hangs in two places", |s| s.nodes[0].children.push(1)),
        ("hangs in two places", |s| s.nodes[0].children.push(0)),
        ("mesh 7 of 2", |s| s.nodes[0].mesh = Some(7)),
        ("light 7 of 2", |s| s.nodes[0].light = Some(7)),
        ("not finite", |s| s.nodes[0].parent_from_node = DMat4::NAN),
        ("material 7 of 2", |s| s.meshes[0].primitives[0].material = 7),
        ("of 9", |s| s.meshes[0].primitives[0].positions.truncate(9)),
        ("normals for", |s| s.meshes[0].primitives[0].normals.as_mut().unwrap().truncate(9)),
        ("no multiple of 3", |s| s.meshes[0].primitives[0].indices.truncate(4)),
        ("texture coordinates", |s| s.meshes[0].primitives[0].uvs.push(vec![Vec2::ZERO])),
        ("image 0 of 0", |s| s.textures.push(Texture { image: 0, sampler: Sampler::default() })),
        ("16 channels", |s| {
            let pixels = Pixels::Rgba8(Arc::new(vec![0; 16]));
            s.images.push(Image { name: None, width: 3, height: 1, pixels });
        }),
    ];
    for (expected, fault) in faults {
        let mut asset = model();
        fault(&mut asset);
        let error = LiveScene::new().insert(&asset).unwrap_err().to_string();
        println!("{error}");
        assert!(error.contains(expected) || (expected == "of 9" && error.contains("for 9")), "{expected}: {error}");
    }
}
