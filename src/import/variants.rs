//! Variants of KHR_materials_variants: other materials on the same primitives. The one that is chosen takes the place of
//! the materials that the primitives name, so that nothing behind the importer knows of variants.

use super::choice::Choice;
use super::error::{Fault, Notes};
use super::extensions::{self, VariantMappings, Variants};
use super::references::within;
use gltf::json::{Index, Root};

const NAME: &str = "KHR_materials_variants";

/// Gives the primitives the materials of the chosen variant; those that it does not mention keep theirs. Returns the names
/// of all variants.
pub(super) fn apply(root: &mut Root, choice: Option<&Choice>, notes: &mut Notes) -> Result<Vec<String>, Fault> {
    let raw = root.extensions.as_ref().map(|raw| &raw.others);
    let Variants { variants } = extensions::find(raw, NAME, "")?.unwrap_or_default();
    let names: Vec<String> = variants.into_iter().map(|variant| variant.name).collect();
    let listed: Vec<Option<&str>> = names.iter().map(|name| Some(name.as_str())).collect();
    let pointer = format!("/extensions/{NAME}/variants");
    let chosen = choice.map(|choice| choice.find("variant", &listed, &pointer)).transpose()?;
    let materials = root.materials.len();
    for (m, mesh) in root.meshes.iter_mut().enumerate() {
        for (p, primitive) in mesh.primitives.iter_mut().enumerate() {
            let raw = primitive.extensions.as_ref().map(|raw| &raw.others);
            let here = format!("/meshes/{m}/primitives/{p}");
            let VariantMappings { mappings } = extensions::find(raw, NAME, &here)?.unwrap_or_default();
            // A variant's first material counts.
            let mut owners: Vec<Option<usize>> = vec![None; names.len()];
            for (k, mapping) in mappings.iter().enumerate() {
                let here = format!("{here}/extensions/{NAME}/mappings/{k}");
                let material = within(mapping.material, materials, "materials", format_args!("{here}/material"))?;
                for (v, variant) in mapping.variants.iter().enumerate() {
                    let place = format!("{here}/variants/{v}");
                    let owner = &mut owners[within(*variant, names.len(), &pointer[1..], &place)?];
                    match owner {
                        None => *owner = Some(material),
                        Some(_) => {
                            notes.add(&place, "this variant has a material on this primitive already, which counts");
                        }
                    }
                }
            }
            if let Some(material) = chosen.and_then(|chosen| owners[chosen]) {
                primitive.material = Some(Index::new(material as u32));
            }
        }
    }
    Ok(names)
}
