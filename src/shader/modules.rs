//! Which file fills which slot, for each pass.

use super::compose::{Composed, ShaderError, Slot, Slots, compose};
use super::features::{Alpha, ForwardFeatures, Shading};
use super::sources::ShaderSources;
use super::{interface, types};
use crate::scene::{TextureSlot, ToneMap};

/// The forward pass of one kind of draw.
pub fn forward_module(sources: &ShaderSources, features: &ForwardFeatures) -> Result<Composed, ShaderError> {
    compose(sources, "pass/forward.wgsl", &forward_slots(features))
}

/// What fills the slots of the forward pass.
pub fn forward_slots(features: &ForwardFeatures) -> Slots {
    let choose = |on: bool, with: &'static str, without: &'static str| Slot::File(if on { with } else { without });
    let ForwardFeatures { scene, material, vertex, energy_compensation, .. } = features;
    let normal_mapped = material.texture(TextureSlot::Normal).is_some();
    Slots::from([
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
    ])
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
