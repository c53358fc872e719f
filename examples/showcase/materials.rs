//! The materials of the showcase.

use super::glb::Glb;
use super::{layout, textures};
use image::ImageResult;
use serde_json::{Value, json};

const REPEAT: u32 = 10497;
const CLAMP_TO_EDGE: u32 = 33071;

/// Spheres in a row, from perceptual roughness 0 to 1.
pub(crate) const ROUGHNESS_STEPS: usize = 7;

/// Indices of the materials in the file.
pub(crate) struct Materials {
    pub(crate) floor: usize,
    pub(crate) steps: usize,
    pub(crate) steel: usize,
    pub(crate) halo: usize,
    pub(crate) painted: usize,
    pub(crate) glass: usize,
    pub(crate) enamel: usize,
    pub(crate) frame: usize,
    pub(crate) grille: usize,
    /// Copper, gold, lacquer: from the upper row to the lower.
    pub(crate) rows: [[usize; ROUGHNESS_STEPS]; 3],
}

impl Materials {
    /// Adds all materials and their textures.
    pub(crate) fn add(glb: &mut Glb) -> ImageResult<Self> {
        let ground =
            glb.texture("ground occlusion", &textures::grey(112, 112, layout::ground_openness)?, CLAMP_TO_EDGE);
        let on_steps = glb.texture("steps occlusion", &textures::grey(192, 72, layout::steps_openness)?, CLAMP_TO_EDGE);
        let matte = |name: &str, color: [f64; 3], perceptual_roughness: f64, occlusion: usize| {
            let mut material = plain(name, color, 0.0, perceptual_roughness);
            material["occlusionTexture"] = json!({ "index": occlusion });
            material
        };
        let floor = glb.material(matte("backdrop", [0.30, 0.32, 0.35], 0.75, ground));
        let steps = glb.material(matte("plaster", [0.66, 0.64, 0.60], 0.55, on_steps));
        Ok(Self {
            floor,
            steps,
            steel: glb.material(plain("steel", [0.62, 0.60, 0.58], 1.0, 0.24)),
            halo: glb.material(halo()),
            painted: glb.material(painted()),
            glass: glb.material(glass()),
            enamel: enamel(glb)?,
            frame: glb.material(plain("walnut", [0.17, 0.08, 0.04], 0.0, 0.38)),
            grille: grille(glb)?,
            rows: [
                row(glb, "copper", [0.955, 0.638, 0.538], 1.0),
                row(glb, "gold", [1.0, 0.766, 0.336], 1.0),
                row(glb, "lacquer", [0.42, 0.02, 0.03], 0.0),
            ],
        })
    }
}

/// A material without textures; `color` is linear.
fn plain(name: &str, color: [f64; 3], metallic: f64, perceptual_roughness: f64) -> Value {
    let [r, g, b] = color;
    json!({
        "name": name,
        "pbrMetallicRoughness": {
            "baseColorFactor": [r, g, b, 1.0],
            "metallicFactor": metallic,
            "roughnessFactor": perceptual_roughness,
        },
    })
}

fn row(glb: &mut Glb, name: &str, color: [f64; 3], metallic: f64) -> [usize; ROUGHNESS_STEPS] {
    std::array::from_fn(|i| {
        let perceptual_roughness = i as f64 / (ROUGHNESS_STEPS - 1) as f64;
        // Three decimals say enough.
        let perceptual_roughness = (perceptual_roughness * 1e3).round() / 1e3;
        glb.material(plain(&format!("{name} {perceptual_roughness}"), color, metallic, perceptual_roughness))
    })
}

fn halo() -> Value {
    let mut material = plain("halo", [0.0, 0.0, 0.0], 0.0, 1.0);
    material["emissiveFactor"] = json!([1.0, 0.42, 0.10]);
    material["extensions"] = json!({ "KHR_materials_emissive_strength": { "emissiveStrength": 3.0 } });
    material
}

/// For vertex colours; the interface is tinted and weaker than plain plastic's.
fn painted() -> Value {
    let mut material = plain("painted", [1.0, 1.0, 1.0], 0.0, 0.3);
    let specular = json!({ "specularFactor": 0.8, "specularColorFactor": [0.7, 0.85, 1.0] });
    material["extensions"] = json!({ "KHR_materials_specular": specular });
    material
}

fn glass() -> Value {
    let mut material = plain("glass", [0.55, 0.80, 0.72], 0.0, 0.0);
    material["pbrMetallicRoughness"]["baseColorFactor"][3] = 0.42.into();
    material["alphaMode"] = "BLEND".into();
    material["extensions"] = json!({ "KHR_materials_ior": { "ior": 1.8 } });
    material
}

fn enamel(glb: &mut Glb) -> ImageResult<usize> {
    let base_color = glb.texture("enamel base colour", &textures::enamel_base_color()?, REPEAT);
    let metallic_roughness = glb.texture("enamel metal", &textures::enamel_metallic_roughness()?, REPEAT);
    let normals = glb.texture("enamel normals", &textures::enamel_normals()?, REPEAT);
    Ok(glb.material(json!({
        "name": "enamel",
        "pbrMetallicRoughness": {
            "baseColorTexture": { "index": base_color },
            "metallicRoughnessTexture": { "index": metallic_roughness },
        },
        "normalTexture": { "index": normals },
    })))
}

fn grille(glb: &mut Glb) -> ImageResult<usize> {
    let perforation = glb.texture("perforation", &textures::perforation()?, REPEAT);
    let mut material = plain("grille", [0.90, 0.34, 0.10], 0.0, 0.42);
    material["pbrMetallicRoughness"]["baseColorTexture"] = json!({ "index": perforation });
    material["alphaMode"] = "MASK".into();
    material["alphaCutoff"] = 0.5.into();
    material["doubleSided"] = true.into();
    Ok(glb.material(material))
}
