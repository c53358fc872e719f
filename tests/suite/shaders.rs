//! Composed modules against the bind-group layouts they are drawn with: no binding without use, no use without binding.

use glam::{Vec2, Vec3, Vec4};
use naga::valid::{Capabilities, ValidationFlags, Validator};
use specula::gpu::bindings::{
    FRAME_INSTANCES, FRAME_TAPS, FRAME_UNIFORM, background_entries, covered_entries, display_entries, frame_entries,
    material_entries, over_entries, present_entries, pulled_entries,
};
use specula::scene::{
    AlphaMode, Disney, Geometry, Material, MetalFresnel, Primitive, Quality, Sampler, Scene, Term, Texture, TextureRef,
    TextureSlot, ToneMap, Topology, UvTransform,
};
use specula::shader::{
    Backdrop, Composed, DisplayFeatures, ForwardFeatures, LightList, MaterialFeatures, SceneFeatures, Seen,
    ShaderSources, Shading, TargetLight, VertexFeatures, background_module, background_module_into, covered_module,
    deferred_module, display_module, forward_module, forward_module_into, over_module, present_module,
    visibility_module,
};
use std::collections::BTreeMap;
use wgpu::{BindGroupLayoutEntry, BindingType, BufferBindingType, ShaderStages};

/// Every set of texture slots under every kind of light, with the other switches running through their values.
pub(crate) fn forward_features() -> Vec<ForwardFeatures> {
    let of_slots = |slots: u32| {
        // Every set of slots with the standard lobes, some with the Disney lobes too.
        let disney = (slots % 5 < 3).then(|| Disney { anisotropic: (slots / 2 % 2) as f32, ..Default::default() });
        let materials = [Some(None), disney.map(Some)].into_iter().flatten();
        materials.flat_map(move |disney| of_material(&Material { disney, ..material(slots) }, &primitive(slots), slots))
    };
    (0..1 << TextureSlot::ALL.len()).flat_map(of_slots).collect()
}

/// A few materials, each with one term of its light alone.
pub(crate) fn term_features() -> Vec<ForwardFeatures> {
    let of_term = |features: &ForwardFeatures| Term::ALL.map(|term| ForwardFeatures { term: Some(term), ..*features });
    forward_features().iter().step_by(7).flat_map(of_term).collect()
}

const LIGHT_LISTS: [LightList; 5] =
    [LightList::Named(2), LightList::Few, LightList::All, LightList::Clustered, LightList::ClusteredAndUnbounded];

/// A material under every kind of light.
fn of_material(material: &Material, primitive: &Primitive, slots: u32) -> [ForwardFeatures; 4] {
    let scene = Scene {
        textures: vec![
            Texture { image: 0, sampler: Sampler::default() },
            Texture { image: 0, sampler: Sampler { mag_linear: false, ..Default::default() } },
        ],
        ..Default::default()
    };
    [(false, false), (false, true), (true, false), (true, true)].map(|(punctual, environment)| {
        let scene_features = SceneFeatures {
            punctual,
            light_list: LIGHT_LISTS[(slots / 2) as usize % 5],
            environment,
            fresnel_tail: !slots.is_multiple_of(3),
            suns: if environment { (slots % 3) as u8 } else { 0 },
        };
        let features = MaterialFeatures::of(material, primitive, &scene, scene_features);
        ForwardFeatures {
            scene: scene_features,
            material: features,
            vertex: VertexFeatures::of(&features, primitive),
            energy_compensation: !slots.is_multiple_of(5),
            geometry: Geometry::ALL[slots as usize % 5],
            // Anisotropic materials are every fourth: they get every tier too.
            quality: Quality::ALL[(slots + slots / 4) as usize % 4],
            term: None,
            topology: Topology::Triangles,
            channel: slots % 9 < 4,
        }
    })
}

fn material(slots: u32) -> Material {
    let mut material = Material { metallic: 0.5, emissive_nits: Vec3::ONE, ..Default::default() };
    // With three kinds the occlusion texture is read elsewhere than the metallic-roughness texture, with two as that is.
    let kinds = 2 + slots % 2;
    for (index, slot) in (0..).zip(TextureSlot::ALL).filter(|(index, _)| slots >> index & 1 == 1) {
        let transform = UvTransform { offset: Vec2::splat((index % kinds) as f32), ..UvTransform::IDENTITY };
        material.set_texture(slot, Some(TextureRef { texture: index as usize % 2, uv_set: index % 2, transform }));
    }
    material.double_sided = slots.is_multiple_of(2);
    material.anisotropy_strength = if slots.is_multiple_of(4) { 0.5 } else { 0.0 };
    let (n, k, a) = (Vec3::ONE, Vec3::ONE, Vec3::ONE);
    let curves = [MetalFresnel::Schlick, MetalFresnel::Lazanyi { a }, MetalFresnel::Conductor { n, k, a }];
    material.metal_fresnel = curves[slots as usize % 3];
    material.unlit = slots.is_multiple_of(11);
    material.alpha_mode = [AlphaMode::Opaque, AlphaMode::Mask { cutoff: 0.5 }, AlphaMode::Blend][slots as usize % 3];
    material
}

fn primitive(slots: u32) -> Primitive {
    Primitive {
        topology: Topology::Triangles,
        positions: vec![Vec3::ZERO; 3],
        normals: Some(vec![Vec3::Y; 3]),
        tangents: Some(vec![Vec4::X; 3]),
        uvs: vec![vec![Vec2::ZERO; 3]; 2],
        colors: slots.is_multiple_of(7).then(|| vec![Vec4::ONE; 3]),
        indices: vec![0, 1, 2],
        material: 0,
    }
}

/// Every display shader.
pub(crate) fn display_features() -> Vec<DisplayFeatures> {
    let tone_maps = [ToneMap::Neutral, ToneMap::Aces, ToneMap::AgX, ToneMap::Reinhard, ToneMap::Linear, ToneMap::None];
    let both = |tone_map| [true, false].map(|encode_srgb| DisplayFeatures { tone_map, encode_srgb });
    tone_maps.into_iter().flat_map(both).collect()
}

/// Group and binding, and what is bound there for which stages.
type Bindings = BTreeMap<(u32, u32), (&'static str, ShaderStages)>;

/// The bindings that the entry points of a module reach.
fn used(composed: &Composed) -> Bindings {
    let module = composed.parse().unwrap_or_else(|error| panic!("{error}\n{}", composed.text));
    let info = Validator::new(ValidationFlags::all(), Capabilities::PRIMITIVE_INDEX).validate(&module).unwrap();
    let mut bindings = Bindings::new();
    for (index, entry_point) in module.entry_points.iter().enumerate() {
        let stage = match entry_point.stage {
            naga::ShaderStage::Vertex => ShaderStages::VERTEX,
            naga::ShaderStage::Fragment => ShaderStages::FRAGMENT,
            other => panic!("{other:?} entry point in a frame"),
        };
        for (handle, variable) in module.global_variables.iter() {
            let Some(at) = &variable.binding else { continue };
            if info.get_entry_point(index)[handle].is_empty() {
                continue;
            }
            let kind = kind_of_variable(&module, variable);
            let (_, stages) = bindings.entry((at.group, at.binding)).or_insert((kind, ShaderStages::NONE));
            *stages |= stage;
        }
    }
    bindings
}

fn kind_of_variable(module: &naga::Module, variable: &naga::GlobalVariable) -> &'static str {
    match (variable.space, &module.types[variable.ty].inner) {
        (naga::AddressSpace::Uniform, _) => "uniform",
        (naga::AddressSpace::Storage { access }, _) if !access.contains(naga::StorageAccess::STORE) => "storage",
        (_, naga::TypeInner::Sampler { comparison: false }) => "sampler",
        (_, naga::TypeInner::Image { dim: naga::ImageDimension::D2, arrayed: false, .. }) => "texture",
        other => panic!("no layout binds {other:?} yet"),
    }
}

/// The bindings that layouts offer, group by group.
fn offered(groups: &[Vec<BindGroupLayoutEntry>]) -> Bindings {
    let kind = |entry: &BindGroupLayoutEntry| match entry.ty {
        BindingType::Buffer { ty: BufferBindingType::Uniform, .. } => "uniform",
        BindingType::Buffer { ty: BufferBindingType::Storage { read_only: true }, .. } => "storage",
        BindingType::Sampler(_) => "sampler",
        BindingType::Texture { .. } => "texture",
        other => panic!("no shader takes {other:?} yet"),
    };
    let of_group = |(group, entries): (u32, &Vec<BindGroupLayoutEntry>)| {
        entries.iter().map(|entry| ((group, entry.binding), (kind(entry), entry.visibility))).collect::<Vec<_>>()
    };
    (0..).zip(groups).flat_map(of_group).collect()
}

#[test]
fn forward_modules_use_all_that_is_bound_and_nothing_else() {
    let mut compared = 0;
    for features in forward_features() {
        let used = used(&forward_module(&ShaderSources::default(), &features).unwrap());
        let mut offered = offered(&[frame_entries(features.scene), material_entries(&features.material)]);
        if matches!(features.material.shading, Shading::Unlit | Shading::Disney) {
            // Group 0 is the scene's: an unlit surface among lit ones leaves its light alone, and a Disney one what the
            // standard lobes read.
            offered.retain(|(group, binding), _| *group > 0 || used.contains_key(&(0, *binding)));
        }
        if !features.reads_taps() {
            // So is the tier: the view may change it.
            offered.remove(&(0, FRAME_TAPS));
        }
        assert_eq!(used, offered, "{features}");
        compared += used.len();
    }
    println!("{compared} bindings compared");
    assert!(compared > 512 * 3, "{compared}");
}

#[test]
fn modules_of_one_term_are_valid_and_use_nothing_that_is_not_bound() {
    for features in term_features() {
        let used = used(&forward_module(&ShaderSources::default(), &features).unwrap());
        let offered = offered(&[frame_entries(features.scene), material_entries(&features.material)]);
        let missing: Vec<_> = used.keys().filter(|binding| !offered.contains_key(binding)).collect();
        assert!(missing.is_empty(), "{features}: {missing:?}");
    }
}

#[test]
fn the_other_passes_use_all_that_is_bound_and_nothing_else() {
    let sources = ShaderSources::default();
    assert_eq!(used(&present_module(&sources).unwrap()), offered(&[present_entries()]));
    for features in display_features() {
        for backdrop in [Backdrop::Sharp, Backdrop::Blurred] {
            let light = TargetLight::Display(features);
            let backgrounds = [
                background_module(&sources, backdrop).unwrap(),
                background_module_into(&sources, backdrop, light).unwrap(),
            ];
            for background in backgrounds {
                assert_eq!(used(&background), offered(&[background_entries(backdrop)]), "{backdrop:?} {features:?}");
            }
        }
        assert_eq!(used(&display_module(&sources, features).unwrap()), offered(&[display_entries()]), "{features:?}");
    }
}

#[test]
fn forward_modules_into_display_light_bind_what_those_into_radiance_bind() {
    let sources = ShaderSources::default();
    let lights = display_features().into_iter().map(TargetLight::Display);
    for (features, light) in forward_features().iter().step_by(7).zip(lights.cycle()) {
        let mut radiance = used(&forward_module(&sources, features).unwrap());
        let display = used(&forward_module_into(&sources, features, light).unwrap());
        // The exposure is in the frame's uniform.
        let frame = radiance.get_mut(&(0, FRAME_UNIFORM)).unwrap();
        frame.1 |= ShaderStages::FRAGMENT;
        assert_eq!(display, radiance, "{features}");
    }
}

#[test]
fn deferred_modules_use_all_that_is_bound_and_of_the_frame_what_forward_modules_use() {
    let sources = ShaderSources::default();
    for (samples, under) in [(1, false), (4, false), (1, true), (4, true)] {
        let seen = Seen { samples, under };
        assert_eq!(used(&over_module(&sources, samples).unwrap()), offered(&[over_entries(samples)]));
        assert_eq!(used(&covered_module(&sources, seen).unwrap()), offered(&[covered_entries(seen)]));
        for features in forward_features().into_iter().step_by(7) {
            let used = used(&deferred_module(&sources, &features, seen).unwrap());
            let mut expected = self::used(&forward_module(&sources, &features).unwrap());
            // The draw's own uniform places it, and only shading reads the frame.
            expected.remove(&(0, FRAME_INSTANCES));
            expected.retain(|_, (_, stages)| stages.contains(ShaderStages::FRAGMENT));
            expected.values_mut().for_each(|(_, stages)| *stages = ShaderStages::FRAGMENT);
            expected.insert((0, FRAME_UNIFORM), ("uniform", ShaderStages::FRAGMENT));
            let pulled = offered(&[Vec::new(), Vec::new(), pulled_entries(seen)]);
            expected.extend(pulled);
            assert_eq!(used, expected, "{features}");
        }
    }
    let visibility = used(&visibility_module(&sources).unwrap());
    assert!(visibility.contains_key(&(1, 0)), "{visibility:?}");
}
