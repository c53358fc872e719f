//! Textures: which of the document's are in use, and how they are sampled.

use super::error::{Fault, Notes};
use super::references::NO_SOURCE;
use crate::scene::{Material, Sampler, Texture, TextureSlot, Wrap};
use gltf::json;
use gltf::json::texture::{MagFilter, MinFilter, WrappingMode};
use gltf::json::validation::Checked;
use std::collections::HashMap;

/// The textures that are in use, and the document's images that they show.
#[derive(Debug, Default)]
pub(super) struct UsedTextures {
    /// Their `image` counts in `images`.
    pub(super) textures: Vec<Texture>,
    /// Indices into the document's images.
    pub(super) images: Vec<usize>,
}

/// Numbers the textures of the materials that `used` marks, and writes the numbers into them. Other materials lose
/// their textures, so that nothing is decoded for them.
pub(super) fn collect(
    root: &json::Root,
    materials: &mut [Material],
    used: &[bool],
    notes: &mut Notes,
) -> Result<UsedTextures, Fault> {
    let mut found = UsedTextures::default();
    let mut texture_numbers = HashMap::new();
    let mut image_numbers = HashMap::new();
    for (index, material) in materials.iter_mut().enumerate() {
        for slot in TextureSlot::ALL {
            let Some(mut reference) = material.texture(slot).copied() else { continue };
            let texture = &root.textures[reference.texture];
            if !used[index] || texture.source.value() == NO_SOURCE {
                if used[index] {
                    let pointer = format_args!("/textures/{}", reference.texture);
                    notes.add(pointer, "the texture has no image that can be read and is left out");
                }
                material.set_texture(slot, None);
                continue;
            }
            let number = match texture_numbers.get(&reference.texture) {
                Some(&number) => number,
                None => {
                    let image = *image_numbers.entry(texture.source.value()).or_insert_with(|| {
                        found.images.push(texture.source.value());
                        found.images.len() - 1
                    });
                    let sampler =
                        texture.sampler.map_or(Ok(Sampler::default()), |index| sampler(root, index.value()))?;
                    found.textures.push(Texture { image, sampler });
                    texture_numbers.insert(reference.texture, found.textures.len() - 1);
                    found.textures.len() - 1
                }
            };
            reference.texture = number;
            material.set_texture(slot, Some(reference));
        }
    }
    Ok(found)
}

/// What the specification leaves to the renderer when a filter is not given is the best one.
fn sampler(root: &json::Root, index: usize) -> Result<Sampler, Fault> {
    let json = &root.samplers[index];
    let invalid = |name: &str| Fault::at(format_args!("/samplers/{index}/{name}"), "is not a value of this property");
    let wrap = |mode: &Checked<WrappingMode>, name: &str| match mode {
        Checked::Valid(WrappingMode::Repeat) => Ok(Wrap::Repeat),
        Checked::Valid(WrappingMode::MirroredRepeat) => Ok(Wrap::MirroredRepeat),
        Checked::Valid(WrappingMode::ClampToEdge) => Ok(Wrap::ClampToEdge),
        Checked::Invalid => Err(invalid(name)),
    };
    let (min_linear, mip_linear) = match json.min_filter {
        None | Some(Checked::Valid(MinFilter::LinearMipmapLinear)) => (true, Some(true)),
        Some(Checked::Valid(MinFilter::LinearMipmapNearest)) => (true, Some(false)),
        Some(Checked::Valid(MinFilter::Linear)) => (true, None),
        Some(Checked::Valid(MinFilter::NearestMipmapLinear)) => (false, Some(true)),
        Some(Checked::Valid(MinFilter::NearestMipmapNearest)) => (false, Some(false)),
        Some(Checked::Valid(MinFilter::Nearest)) => (false, None),
        Some(Checked::Invalid) => return Err(invalid("minFilter")),
    };
    let mag_linear = match json.mag_filter {
        None | Some(Checked::Valid(MagFilter::Linear)) => true,
        Some(Checked::Valid(MagFilter::Nearest)) => false,
        Some(Checked::Invalid) => return Err(invalid("magFilter")),
    };
    let (wrap_u, wrap_v) = (wrap(&json.wrap_s, "wrapS")?, wrap(&json.wrap_t, "wrapT")?);
    Ok(Sampler { wrap_u, wrap_v, mag_linear, min_linear, mip_linear })
}
