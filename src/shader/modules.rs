//! Which file fills which slot, for each pass.

use super::compose::{Composed, ShaderError, Slot, Slots, compose};
use super::features::{Alpha, ForwardFeatures, Shading};
use super::sources::ShaderSources;
use super::{interface, types};
use crate::scene::{TextureSlot, ToneMap};

/// The forward pass of one kind of draw.
pub fn forward_module(sources: &ShaderSources, features: &ForwardFeatures) -> Result<Composed, ShaderError> {
    let choose = |on: bool, with: &'static str, without: &'static str| Slot::File(if on { with } else { without });
    let ForwardFeatures { scene, material, vertex, energy_compensation, .. } = features;
    let normal_mapped = material.texture(TextureSlot::Normal).is_some();
    let slots = Slots::from([
        ("types", Slot::Text(types::wgsl())),
        ("interface", Slot::Text(interface::vertex_interface(vertex))),
        ("material", Slot::Text(interface::material_interface(material))),
        (
            "normal",
            match (material.shading, normal_mapped) {
                (Shading::Lit, true) => Slot::File("surface/normal_map.wgsl"),
                (Shading::Lit, false) => Slot::File("surface/normal_vertex.wgsl"),
                _ => Slot::File("surface/normal_none.wgsl"),
            },
        ),
        (
            "facing",
            choose(
                material.double_sided && material.shading == Shading::Lit,
                "surface/facing_double.wgsl",
                "surface/facing_single.wgsl",
            ),
        ),
        (
            "shading",
            Slot::File(match material.shading {
                Shading::Lit => "lighting/lit.wgsl",
                Shading::EmissiveOnly => "lighting/emissive_only.wgsl",
                Shading::Unlit => "lighting/unlit.wgsl",
            }),
        ),
        ("punctual", choose(scene.punctual, "lighting/punctual.wgsl", "lighting/punctual_none.wgsl")),
        ("environment", choose(scene.environment, "lighting/environment.wgsl", "lighting/environment_none.wgsl")),
        (
            "multiscatter",
            choose(*energy_compensation, "lobe/multiscatter_kulla_conty.wgsl", "lobe/multiscatter_none.wgsl"),
        ),
        (
            "alpha",
            Slot::File(match material.alpha {
                Alpha::Opaque => "surface/alpha_opaque.wgsl",
                Alpha::Mask => "surface/alpha_mask.wgsl",
                Alpha::Blend => "surface/alpha_blend.wgsl",
            }),
        ),
    ]);
    compose(sources, "pass/forward.wgsl", &slots)
}

/// The panorama behind the scene.
pub fn background_module(sources: &ShaderSources) -> Result<Composed, ShaderError> {
    compose(sources, "pass/background.wgsl", &Slots::from([("types", Slot::Text(types::wgsl()))]))
}

/// What chooses the display shader.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct DisplayFeatures {
    pub tone_map: ToneMap,
    /// Whether the shader applies the sRGB transfer, because the target format does not.
    pub encode_srgb: bool,
}

/// Scene radiance to display values.
pub fn display_module(sources: &ShaderSources, features: DisplayFeatures) -> Result<Composed, ShaderError> {
    let tone_map = match features.tone_map {
        ToneMap::Neutral => "color/tone_map_neutral.wgsl",
        ToneMap::Aces => "color/tone_map_aces.wgsl",
        ToneMap::AgX => "color/tone_map_agx.wgsl",
        ToneMap::Reinhard => "color/tone_map_reinhard.wgsl",
        ToneMap::Linear | ToneMap::None => "color/tone_map_linear.wgsl",
    };
    let encode = if features.encode_srgb { "color/encode_srgb.wgsl" } else { "color/encode_linear.wgsl" };
    let slots = Slots::from([
        ("types", Slot::Text(types::wgsl())),
        ("tone_map", Slot::File(tone_map)),
        ("encode", Slot::File(encode)),
    ]);
    compose(sources, "pass/display.wgsl", &slots)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Material, Primitive, Scene, Texture, TextureRef, Topology, UvTransform};
    use crate::shader::{MaterialFeatures, SceneFeatures, VertexFeatures};
    use glam::{Vec2, Vec3, Vec4};

    fn validate(composed: &Composed) {
        let module = composed.parse().unwrap_or_else(|error| panic!("{error}\n{}", composed.text));
        let mut validator =
            naga::valid::Validator::new(naga::valid::ValidationFlags::all(), naga::valid::Capabilities::empty());
        if let Err(error) = validator.validate(&module) {
            panic!("{}", error.emit_to_string(&composed.text));
        }
    }

    #[test]
    fn every_texture_slot_light_and_alpha_mode_composes_and_validates() {
        let scene = Scene {
            textures: vec![
                Texture { image: 0, sampler: Default::default() },
                Texture { image: 0, sampler: crate::scene::Sampler { mag_linear: false, ..Default::default() } },
            ],
            ..Default::default()
        };
        let primitive = Primitive {
            topology: Topology::Triangles,
            positions: vec![Vec3::ZERO; 3],
            normals: Some(vec![Vec3::Y; 3]),
            tangents: Some(vec![Vec4::X; 3]),
            uvs: vec![vec![Vec2::ZERO; 3]; 2],
            colors: Some(vec![Vec4::ONE; 3]),
            indices: vec![0, 1, 2],
            material: 0,
        };
        let sources = ShaderSources::default();
        let mut modules = 0;
        for slots in 0..1 << TextureSlot::ALL.len() {
            let mut material = Material { metallic: 0.5, emissive_nits: Vec3::ONE, ..Default::default() };
            for (index, slot) in TextureSlot::ALL.into_iter().enumerate().filter(|(index, _)| slots >> index & 1 == 1) {
                let transform = UvTransform { offset: Vec2::splat((index % 3) as f32), ..UvTransform::IDENTITY };
                let texture = TextureRef { texture: index % 2, uv_set: index as u32 % 2, transform };
                material.set_texture(slot, Some(texture));
            }
            // The remaining switches run through all their values while the slots run through all theirs.
            material.double_sided = slots % 2 == 0;
            material.unlit = slots % 11 == 0;
            material.alpha_mode = match slots % 3 {
                0 => crate::scene::AlphaMode::Opaque,
                1 => crate::scene::AlphaMode::Mask { cutoff: 0.5 },
                _ => crate::scene::AlphaMode::Blend,
            };
            for lights in 0..4 {
                let scene_features = SceneFeatures { punctual: lights & 1 == 1, environment: lights & 2 == 2 };
                let features = MaterialFeatures::of(&material, &primitive, &scene, scene_features.is_lit());
                let features = ForwardFeatures {
                    scene: scene_features,
                    material: features,
                    vertex: VertexFeatures::of(&features, &primitive),
                    energy_compensation: slots % 5 != 0,
                    topology: Topology::Triangles,
                };
                let composed = forward_module(&sources, &features).unwrap();
                validate(&composed);
                let sampled = composed.text.matches("textureSample(").count();
                assert_eq!(sampled, features.material.textures().count(), "{features}");
                modules += 1;
            }
        }
        assert_eq!(modules, 512);
    }

    #[test]
    fn the_other_passes_validate() {
        let sources = ShaderSources::default();
        validate(&background_module(&sources).unwrap());
        for tone_map in
            [ToneMap::Neutral, ToneMap::Aces, ToneMap::AgX, ToneMap::Reinhard, ToneMap::Linear, ToneMap::None]
        {
            for encode_srgb in [true, false] {
                validate(&display_module(&sources, DisplayFeatures { tone_map, encode_srgb }).unwrap());
            }
        }
    }
}
