//! Extensions: which are understood, and their JSON.

use super::document::typed;
use super::error::{Fault, Notes, quote};
use serde::Deserialize;
use serde::de::DeserializeOwned;
use serde_json::{Map, Value};
use std::collections::BTreeMap;

/// The extensions that are imported.
pub const SUPPORTED_EXTENSIONS: [&str; 10] = [
    "EXT_mesh_gpu_instancing",
    "KHR_lights_punctual",
    "KHR_materials_anisotropy",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_specular",
    "KHR_materials_unlit",
    "KHR_materials_variants",
    "KHR_mesh_quantization",
    "KHR_texture_transform",
];

/// Refuses documents that cannot be shown without an extension that is not supported; notes those that can.
pub(super) fn check_declared(document: &Value, notes: &mut Notes) -> Result<(), Fault> {
    let list = |key: &str| document.get(key).and_then(Value::as_array).into_iter().flatten().enumerate();
    let unsupported = |value: &Value| !value.as_str().is_some_and(|name| SUPPORTED_EXTENSIONS.contains(&name));
    let name = |value: &Value| value.as_str().map_or_else(|| value.to_string(), str::to_owned);
    for (index, value) in list("extensionsRequired") {
        if unsupported(value) {
            let problem = format!("the file requires the extension {}, which is not supported", quote(&name(value)));
            return Err(
                Fault::at(format_args!("/extensionsRequired/{index}"), problem).advise("export without this extension")
            );
        }
    }
    for (index, value) in list("extensionsUsed") {
        if unsupported(value) {
            let problem = format!("the extension {} is not supported and is ignored", quote(&name(value)));
            notes.add(format_args!("/extensionsUsed/{index}"), problem);
        }
    }
    Ok(())
}

/// The extension `name` of the object at `pointer`, out of the object's raw map.
pub(super) fn find<T: DeserializeOwned>(
    raw: Option<&Map<String, Value>>,
    name: &str,
    pointer: &str,
) -> Result<Option<T>, Fault> {
    let Some(value) = raw.and_then(|raw| raw.get(name)) else { return Ok(None) };
    typed(value.clone(), &format!("{pointer}/extensions/{name}")).map(Some)
}

/// A texture slot inside an extension: like the core's texture info.
#[derive(Debug, Deserialize)]
pub(super) struct TextureInfo {
    pub(super) index: u64,
    #[serde(default, rename = "texCoord")]
    pub(super) tex_coord: u32,
    #[serde(default)]
    pub(super) extensions: Map<String, Value>,
}

#[derive(Debug, Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub(super) struct TextureTransform {
    pub(super) offset: [f32; 2],
    pub(super) rotation: f32,
    pub(super) scale: [f32; 2],
    pub(super) tex_coord: Option<u32>,
}

impl Default for TextureTransform {
    fn default() -> Self {
        Self { offset: [0.0; 2], rotation: 0.0, scale: [1.0; 2], tex_coord: None }
    }
}

#[derive(Debug, Deserialize)]
pub(super) struct EmissiveStrength {
    #[serde(default = "one", rename = "emissiveStrength")]
    pub(super) emissive_strength: f32,
}

#[derive(Debug, Deserialize)]
pub(super) struct Ior {
    #[serde(default = "Ior::of_glass")]
    pub(super) ior: f32,
}

impl Ior {
    fn of_glass() -> f32 {
        1.5
    }
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Specular {
    #[serde(default = "one")]
    pub(super) specular_factor: f32,
    pub(super) specular_texture: Option<TextureInfo>,
    #[serde(default = "white")]
    pub(super) specular_color_factor: [f32; 3],
    pub(super) specular_color_texture: Option<TextureInfo>,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Anisotropy {
    #[serde(default)]
    pub(super) anisotropy_strength: f32,
    #[serde(default)]
    pub(super) anisotropy_rotation: f32,
    pub(super) anisotropy_texture: Option<TextureInfo>,
}

/// The lights of the document.
#[derive(Debug, Default, Deserialize)]
pub(super) struct Lights {
    #[serde(default)]
    pub(super) lights: Vec<PunctualLight>,
}

#[derive(Debug, Deserialize)]
pub(super) struct PunctualLight {
    pub(super) name: Option<String>,
    #[serde(default = "white")]
    pub(super) color: [f32; 3],
    #[serde(default = "one")]
    pub(super) intensity: f32,
    pub(super) range: Option<f32>,
    #[serde(rename = "type")]
    pub(super) kind: PunctualKind,
    #[serde(default)]
    pub(super) spot: SpotCone,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum PunctualKind {
    Directional,
    Point,
    Spot,
}

#[derive(Debug, Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub(super) struct SpotCone {
    pub(super) inner_cone_angle: f32,
    pub(super) outer_cone_angle: f32,
}

impl Default for SpotCone {
    fn default() -> Self {
        Self { inner_cone_angle: 0.0, outer_cone_angle: std::f32::consts::FRAC_PI_4 }
    }
}

/// The variants of the document.
#[derive(Debug, Default, Deserialize)]
pub(super) struct Variants {
    pub(super) variants: Vec<Variant>,
}

#[derive(Debug, Deserialize)]
pub(super) struct Variant {
    pub(super) name: String,
}

/// The materials of a primitive by variant.
#[derive(Debug, Default, Deserialize)]
pub(super) struct VariantMappings {
    pub(super) mappings: Vec<VariantMapping>,
}

#[derive(Debug, Deserialize)]
pub(super) struct VariantMapping {
    pub(super) material: u64,
    pub(super) variants: Vec<u64>,
}

/// The light on a node.
#[derive(Debug, Deserialize)]
pub(super) struct NodeLight {
    pub(super) light: u64,
}

/// The accessors that place a node's mesh many times.
#[derive(Debug, Deserialize)]
pub(super) struct MeshInstancing {
    pub(super) attributes: BTreeMap<String, u64>,
}

fn one() -> f32 {
    1.0
}

fn white() -> [f32; 3] {
    [1.0; 3]
}
