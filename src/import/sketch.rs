//! Images that stand in for those that are not decoded yet.

use crate::scene::{Image, Pixels, Scene, TextureSlot};

/// Large enough to have smaller levels, as the images will: drivers compile shaders for textures with and without.
const SIDE: u32 = 4;

/// One image each, for the slots of materials that show it.
pub(super) fn images(scene: &Scene, count: usize) -> Vec<Image> {
    let mut slots: Vec<Option<TextureSlot>> = vec![None; count];
    for (slot, texture) in scene.materials.iter().flat_map(|material| material.textures()) {
        let first = &mut slots[scene.textures[texture.texture].image];
        // What looks worst when it is taken for something else decides.
        *first = (*first).into_iter().chain([slot]).min_by_key(|slot| rank(*slot));
    }
    slots.into_iter().map(|slot| image(texel(slot))).collect()
}

fn rank(slot: TextureSlot) -> usize {
    let worst_first = [TextureSlot::Normal, TextureSlot::Emissive, TextureSlot::MetallicRoughness];
    worst_first.iter().position(|other| *other == slot).unwrap_or(worst_first.len())
}

fn texel(slot: Option<TextureSlot>) -> [u8; 4] {
    match slot {
        // Half the light, sRGB-encoded, and all of the coverage.
        Some(TextureSlot::BaseColor) => [188, 188, 188, 255],
        // No occlusion; a perceptual roughness of 0.6, if the factor is 1; no metal.
        Some(TextureSlot::MetallicRoughness) => [255, 153, 0, 255],
        Some(TextureSlot::Normal) => [128, 128, 255, 255],
        Some(TextureSlot::Emissive) => [0, 0, 0, 255],
        // Along the tangent, at the strength of the factor.
        Some(TextureSlot::Anisotropy) => [255, 128, 255, 255],
        Some(TextureSlot::Occlusion | TextureSlot::Specular | TextureSlot::SpecularColor) | None => [255; 4],
    }
}

fn image(texel: [u8; 4]) -> Image {
    let pixels = Pixels::Rgba8(texel.repeat((SIDE * SIDE) as usize).into());
    Image { name: None, width: SIDE, height: SIDE, pixels }
}
