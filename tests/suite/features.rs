//! A material without a feature has nothing of it: no binding, no attribute, no number of the uniforms that is read, no
//! code but functions that return a constant or what they were given.

mod names;

use crate::support::{add_light, draw, front_view, gpu, relative_rms, sphere_scene, trace, white_environment};
use glam::{DVec3, Vec2, Vec3, Vec4};
use names::Names;
use specula::capture::CaptureOptions;
use specula::gpu::formats::Precision;
use specula::gpu_scene::TextureLevels;
use specula::renderer::Renderer;
use specula::scene::{
    AlphaMode, Disney, Geometry, Image, LightKind, Material, MetalFresnel, Pixels, Primitive, Quality, Sampler, Scene,
    Texture, TextureRef, TextureSlot, Topology, UvTransform, shapes,
};
use specula::shader::{
    Composed, ForwardFeatures, LightList, MaterialFeatures, SceneFeatures, Seen, ShaderSources, VertexFeatures,
    deferred_module, forward_module,
};
use std::collections::{BTreeMap, BTreeSet};

/// What shaders are chosen by.
#[derive(Clone)]
struct Setup {
    material: Material,
    primitive: Primitive,
    light: SceneFeatures,
    quality: Quality,
    energy_compensation: bool,
    channel: bool,
}

impl Setup {
    /// A material of numbers alone under a lamp and a sky.
    fn plain() -> Self {
        let mut primitive = shapes::sphere(1.0, 2, 0);
        primitive.uvs.push(primitive.uvs[0].clone());
        primitive.colors = None;
        Self {
            material: Material { metallic: 0.5, ..Default::default() },
            primitive,
            light: SceneFeatures {
                punctual: true,
                light_list: LightList::Few,
                environment: true,
                fresnel_tail: false,
                suns: 0,
            },
            quality: Quality::SplitSum,
            energy_compensation: true,
            channel: false,
        }
    }

    fn with_texture(&mut self, slot: TextureSlot) {
        let texture = TextureRef { texture: 0, uv_set: 0, transform: UvTransform::IDENTITY };
        self.material.set_texture(slot, Some(texture));
    }

    fn features(&self) -> ForwardFeatures {
        let textures = vec![Texture { image: 0, sampler: Sampler::default() }];
        let scene = Scene { textures, ..Default::default() };
        let material = MaterialFeatures::of(&self.material, &self.primitive, &scene, self.light);
        ForwardFeatures {
            scene: self.light,
            material,
            vertex: VertexFeatures::of(&material, &self.primitive),
            energy_compensation: self.energy_compensation,
            geometry: Geometry::default(),
            quality: self.quality,
            term: None,
            topology: Topology::Triangles,
            channel: self.channel,
        }
    }

    fn modules(&self) -> [Composed; 2] {
        let (sources, features) = (ShaderSources::default(), self.features());
        let seen = Seen { samples: 4, under: false };
        [forward_module(&sources, &features), deferred_module(&sources, &features, seen)].map(Result::unwrap)
    }
}

/// A feature: what it adds to a setup, or takes from it where the plain one has it, and the names that come with it.
struct Feature {
    name: &'static str,
    with: fn(&mut Setup),
    without: fn(&mut Setup),
    marks: &'static [&'static str],
}

const fn added(name: &'static str, with: fn(&mut Setup), marks: &'static [&'static str]) -> Feature {
    Feature { name, with, without: |_| {}, marks }
}

const fn taken(name: &'static str, without: fn(&mut Setup), marks: &'static [&'static str]) -> Feature {
    Feature { name, with: |_| {}, without, marks }
}

const FEATURES: &[Feature] = &[
    added(
        "base colour texture",
        |s| s.with_texture(TextureSlot::BaseColor),
        &["base_color_texture", "base_color_texel", "material_sampler_0", "attribute uv_0"],
    ),
    added(
        "metallic-roughness texture",
        |s| s.with_texture(TextureSlot::MetallicRoughness),
        &["metallic_roughness_texture", "metallic_roughness_texel"],
    ),
    added(
        "normal map",
        |s| s.with_texture(TextureSlot::Normal),
        &["normal_texture", "normal_scale", "attribute tangent"],
    ),
    added(
        "occlusion",
        |s| s.with_texture(TextureSlot::Occlusion),
        &["occlusion_texture", "occlusion_strength", "read_occlusion", "occlusion_texel"],
    ),
    Feature {
        name: "occlusion of its own",
        with: |s| {
            s.with_texture(TextureSlot::Occlusion);
            s.with_texture(TextureSlot::MetallicRoughness);
            s.material.texture_slots[TextureSlot::Occlusion as usize].as_mut().unwrap().uv_set = 1;
        },
        without: |s| {
            s.with_texture(TextureSlot::Occlusion);
            s.with_texture(TextureSlot::MetallicRoughness);
        },
        marks: &["occlusion_texture", "occlusion_texel", "attribute uv_1"],
    },
    added("emission", |s| s.material.emissive_nits = Vec3::ONE, &["emissive", "read_emission"]),
    added(
        "emissive texture",
        |s| {
            s.material.emissive_nits = Vec3::ONE;
            s.with_texture(TextureSlot::Emissive);
        },
        &["emissive_texture", "emissive_texel"],
    ),
    added(
        "specular weight and tint",
        |s| s.material.specular = 0.5,
        &["specular", "specular_color", "read_specular", "read_specular_color"],
    ),
    added("specular texture", |s| s.with_texture(TextureSlot::Specular), &["specular_texture", "specular_texel"]),
    added(
        "specular colour texture",
        |s| s.with_texture(TextureSlot::SpecularColor),
        &["specular_color_texture", "specular_color_texel"],
    ),
    added(
        "texture transform",
        |s| {
            s.with_texture(TextureSlot::BaseColor);
            let texture = s.material.texture_slots[TextureSlot::BaseColor as usize].as_mut().unwrap();
            texture.transform.offset = Vec2::ONE;
        },
        &["uv_transforms"],
    ),
    added(
        "vertex colour",
        |s| s.primitive.colors = Some(vec![Vec4::ONE; s.primitive.positions.len()]),
        &["attribute color", "vertex_color"],
    ),
    added("alpha mask", |s| s.material.alpha_mode = AlphaMode::Mask { cutoff: 0.5 }, &["alpha_cutoff", "discard"]),
    added("blending", |s| s.material.alpha_mode = AlphaMode::Blend, &["premultiply"]),
    added("double-sided", |s| s.material.double_sided = true, &["face_viewer"]),
    added(
        "anisotropy",
        |s| s.material.anisotropy_strength = 0.5,
        &[
            "anisotropy",
            "read_tangents",
            "compensated_share",
            "D_GGX_anisotropic",
            "bent_mirror_direction",
            "attribute tangent",
        ],
    ),
    added(
        "anisotropy texture",
        |s| {
            s.material.anisotropy_strength = 0.5;
            s.with_texture(TextureSlot::Anisotropy);
        },
        &["anisotropy_texture"],
    ),
    added(
        "Lazanyi's Fresnel",
        |s| {
            s.light.fresnel_tail = true;
            s.material.metal_fresnel = MetalFresnel::Lazanyi { a: Vec3::ONE };
        },
        &["lazanyi_a", "fresnel_tail_table", "fresnel_tail", "F_Lazanyi_weight"],
    ),
    added(
        "conductor",
        |s| {
            s.light.fresnel_tail = true;
            s.material.metal_fresnel = MetalFresnel::Conductor { n: Vec3::ONE, k: Vec3::ONE, a: Vec3::ONE };
        },
        &["conductor_n", "conductor_k", "F_conductor"],
    ),
    added(
        "Disney",
        |s| s.material.disney = Some(Disney { anisotropic: 0.5, ..Default::default() }),
        &[
            "disney",
            "disney_table",
            "subsurface",
            "specular_tint",
            "anisotropic",
            "sheen",
            "sheen_tint",
            "clearcoat",
            "clearcoat_gloss",
            "shading_tangent",
            "D_GTR1",
            "Fd_Burley",
        ],
    ),
    taken("energy compensation", |s| s.energy_compensation = false, &["F_multiscatter"]),
    taken(
        "punctual lights",
        |s| s.light.punctual = false,
        &[
            "lights",
            "light_count",
            "position",
            "w",
            "intensity",
            "inverse_range_squared",
            "direction",
            "spot_scale",
            "spot_offset",
            "punctual_radiance",
            "radiance_of_light",
            "distance_attenuation",
            "spot_attenuation",
            "evaluate_lobes",
        ],
    ),
    added(
        "clusters of lights",
        |s| s.light.light_list = LightList::ClusteredAndUnbounded,
        &[
            "clusters",
            "cluster_table",
            "tiles_from_world",
            "slice_per_octave",
            "slice_per_clip_z",
            "slice_bias",
            "unbounded",
            "columns",
            "rows",
            "slices",
        ],
    ),
    taken(
        "environment",
        |s| s.light.environment = false,
        &[
            "environment",
            "environment_atlas",
            "irradiance_over_pi",
            "atlas",
            "environment_from_world",
            "radiance_scale",
            "environment_radiance",
            "prefiltered_radiance",
        ],
    ),
    added("tiers above the split sum", |s| s.quality = Quality::Standard, &["taps_table", "tap", "share_of_metal"]),
    added(
        "suns",
        |s| s.light.suns = 2,
        &["suns", "sun_illuminance", "radiance_of_sun", "sun_radiance", "lobes_of_disc", "disc_share"],
    ),
    taken(
        "light of any kind",
        |s| s.material.unlit = true,
        &[
            "dfg_table",
            "clamp_sampler",
            "make_lobes",
            "metallic",
            "perceptual_roughness",
            "dielectric_F0",
            "attribute normal",
            "normal_from_object",
        ],
    ),
    added("a tangent frame", |s| s.with_texture(TextureSlot::Normal), &["handedness", "attribute tangent"]),
    added("channels", |s| s.channel = true, &["channel", "channel_index", "channel_components", "radiance_channel"]),
];

/// What every draw has.
const OF_ALL: [&str; 8] = [
    "frame",
    "instances",
    "visible_instances",
    "clip_from_world",
    "viewer",
    "world_from_object",
    "material",
    "base_color",
];

#[test]
fn what_a_feature_brings_is_not_there_without_it() {
    let mut faults = Vec::new();
    for Feature { name, with, without, marks } in FEATURES {
        let [present, absent] = [with, without].map(|change| {
            let mut setup = Setup::plain();
            change(&mut setup);
            setup.modules().map(|composed| Names::of(&composed))
        });
        for mark in *marks {
            if !present.iter().any(|names| names.contains(mark)) {
                faults.push(format!("{name}: {mark} does not come with it"));
            }
            if absent.iter().any(|names| names.contains(mark)) {
                faults.push(format!("{name}: {mark} is there without it"));
            }
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn every_binding_attribute_and_number_belongs_to_a_feature() {
    let marks: BTreeSet<&str> = FEATURES.iter().flat_map(|feature| feature.marks).copied().chain(OF_ALL).collect();
    let is_known = |name: &String| {
        // More samplers and sets of coordinates are as the first.
        let first = name.replace("material_sampler_1", "material_sampler_0").replace("uv_1", "uv_0");
        marks.contains(first.as_str()) || ["attribute position", "attribute instance"].contains(&name.as_str())
    };
    let mut unknown: BTreeMap<String, String> = BTreeMap::new();
    for features in crate::shaders::forward_features().iter().step_by(5) {
        let names = Names::of(&forward_module(&ShaderSources::default(), features).unwrap());
        for name in names.data.into_iter().filter(|name| !is_known(name)) {
            unknown.entry(name).or_insert_with(|| features.to_string());
        }
    }
    assert!(unknown.is_empty(), "of no feature: {unknown:?}");
}

#[test]
fn attributes_that_no_shader_reads_stay_on_the_processor() {
    let gpu = gpu(Precision::Half);
    let renderer = Renderer::new(&gpu.device, &gpu.queue);
    let bytes_a_vertex = |change: fn(&mut Setup)| {
        let mut setup = Setup::plain();
        setup.primitive.colors = Some(vec![Vec4::ONE; setup.primitive.positions.len()]);
        change(&mut setup);
        let mut scene = sphere_scene(setup.material);
        scene.meshes[0].primitives = vec![setup.primitive];
        let texel = Image { name: None, width: 1, height: 1, pixels: Pixels::Rgba8(vec![255; 4].into()) };
        (scene.images, scene.textures) = (vec![texel], vec![Texture { image: 0, sampler: Sampler::default() }]);
        add_light(&mut scene, LightKind::Directional, 1.0, DVec3::ZERO);
        let levels = TextureLevels::of(&scene, 16);
        let uploaded = renderer.upload_with(&gpu.device, &gpu.queue, &scene, levels, None).unwrap();
        let primitive = &scene.meshes[0].primitives[0];
        let indices = 4 * primitive.indices.len() as u64;
        (uploaded.bytes.geometry - indices) / primitive.positions.len() as u64
    };
    let (position, normal, tangent, color, uv) = (12, 12, 16, 16, 8);
    assert_eq!(bytes_a_vertex(|s| s.material.unlit = true), position + color);
    assert_eq!(bytes_a_vertex(|s| s.primitive.colors = None), position + normal);
    assert_eq!(bytes_a_vertex(|_| {}), position + normal + color);
    assert_eq!(bytes_a_vertex(|s| s.with_texture(TextureSlot::BaseColor)), position + normal + color + uv);
    assert_eq!(bytes_a_vertex(|s| s.with_texture(TextureSlot::Normal)), position + normal + tangent + color + uv);
    // Strength 0 reads no texture, and black emission none either.
    let of_nothing = |s: &mut Setup| {
        s.material.occlusion_strength = 0.0;
        s.with_texture(TextureSlot::Occlusion);
        s.with_texture(TextureSlot::Emissive);
    };
    assert_eq!(bytes_a_vertex(of_nothing), position + normal + color);
}

#[test]
fn a_metal_whose_texture_says_it_is_none_reads_its_specular_texture() {
    let mut scene = sphere_scene(Material::default());
    let texel = |rgba: [u8; 4]| Image { name: None, width: 1, height: 1, pixels: Pixels::Rgba8(rgba.to_vec().into()) };
    scene.images = vec![texel([255, 128, 0, 255]), texel([255, 255, 255, 0])];
    scene.textures = [0, 1].map(|image| Texture { image, sampler: Sampler::default() }).into();
    for (slot, texture) in [(TextureSlot::MetallicRoughness, 0), (TextureSlot::Specular, 1)] {
        let reference = TextureRef { texture, uv_set: 0, transform: UvTransform::IDENTITY };
        scene.materials[0].set_texture(slot, Some(reference));
    }
    scene.materials[0].base_color = Vec4::new(0.0, 0.0, 0.0, 1.0);
    // A little emission, as black has no relative error.
    scene.materials[0].emissive_nits = Vec3::splat(0.01);
    scene.environment = Some(white_environment());
    let view = front_view(48);
    let drawn = draw(&gpu(Precision::Float), &scene, &view, CaptureOptions::default()).radiance.unwrap();
    let error = relative_rms(&drawn, &trace(&scene, &view, 16));
    println!("error {error:.2e}");
    assert!(error < 0.01, "{error}");
}
