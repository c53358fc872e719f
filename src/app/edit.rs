//! Materials that were changed by hand.

use crate::scene::{AlphaMode, Disney, Material, TextureSlot};
use glam::{Vec3, Vec4};
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};

/// All numbers of a material that can be changed, in the units of [`Material`], and the textures that are left out.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MaterialEdit {
    pub base_color: [f32; 4],
    pub metallic: f32,
    pub perceptual_roughness: f32,
    pub normal_scale: f32,
    pub occlusion_strength: f32,
    pub emissive_nits: [f32; 3],
    pub ior: f32,
    pub specular: f32,
    pub specular_color: [f32; 3],
    pub anisotropy_strength: f32,
    pub anisotropy_rotation_rad: f32,
    pub alpha: AlphaEdit,
    pub double_sided: bool,
    pub unlit: bool,
    /// By name; the Disney BRDF where it is given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub disney: Option<BTreeMap<String, f32>>,
    /// Names of the slots whose textures are left out.
    #[serde(default, skip_serializing_if = "BTreeSet::is_empty")]
    pub without_textures: BTreeSet<String>,
}

/// [`AlphaMode`], as files have it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum AlphaEdit {
    Opaque,
    Mask { cutoff: f32 },
    Blend,
}

impl MaterialEdit {
    /// The material as it is.
    pub fn of(material: &Material) -> Self {
        Self {
            base_color: material.base_color.to_array(),
            metallic: material.metallic,
            perceptual_roughness: material.perceptual_roughness,
            normal_scale: material.normal_scale,
            occlusion_strength: material.occlusion_strength,
            emissive_nits: material.emissive_nits.to_array(),
            ior: material.ior,
            specular: material.specular,
            specular_color: material.specular_color.to_array(),
            anisotropy_strength: material.anisotropy_strength,
            anisotropy_rotation_rad: material.anisotropy_rotation_rad,
            alpha: match material.alpha_mode {
                AlphaMode::Opaque => AlphaEdit::Opaque,
                AlphaMode::Mask { cutoff } => AlphaEdit::Mask { cutoff },
                AlphaMode::Blend => AlphaEdit::Blend,
            },
            double_sided: material.double_sided,
            unlit: material.unlit,
            disney: material.disney.map(|disney| named(&disney)),
            without_textures: BTreeSet::new(),
        }
    }

    /// Whether every number is in its range.
    pub fn is_valid(&self) -> bool {
        let unit = |value: f32| (0.0..=1.0).contains(&value);
        let positive = |value: f32| value >= 0.0 && value.is_finite();
        let units = [self.metallic, self.perceptual_roughness, self.occlusion_strength, self.specular];
        let is_disney = |(name, value): (&String, &f32)| Disney::NAMES.contains(&name.as_str()) && unit(*value);
        let is_slot = |name: &String| TextureSlot::ALL.iter().any(|slot| slot.name() == name);
        let cutoff = if let AlphaEdit::Mask { cutoff } = self.alpha { cutoff } else { 0.0 };
        self.base_color.into_iter().chain(units).chain([self.anisotropy_strength]).all(unit)
            && self.emissive_nits.into_iter().chain(self.specular_color).chain([cutoff]).all(positive)
            && self.normal_scale.is_finite()
            && self.anisotropy_rotation_rad.is_finite()
            && (self.ior == 0.0 || (self.ior >= 1.0 && self.ior.is_finite()))
            && self.disney.iter().flatten().all(is_disney)
            && self.without_textures.iter().all(is_slot)
    }

    /// Puts the numbers into a material.
    pub fn apply(&self, material: &mut Material) {
        material.base_color = Vec4::from_array(self.base_color);
        material.metallic = self.metallic;
        material.perceptual_roughness = self.perceptual_roughness;
        material.normal_scale = self.normal_scale;
        material.occlusion_strength = self.occlusion_strength;
        material.emissive_nits = Vec3::from_array(self.emissive_nits);
        material.ior = self.ior;
        material.specular = self.specular;
        material.specular_color = Vec3::from_array(self.specular_color);
        material.anisotropy_strength = self.anisotropy_strength;
        material.anisotropy_rotation_rad = self.anisotropy_rotation_rad;
        material.alpha_mode = match self.alpha {
            AlphaEdit::Opaque => AlphaMode::Opaque,
            AlphaEdit::Mask { cutoff } => AlphaMode::Mask { cutoff },
            AlphaEdit::Blend => AlphaMode::Blend,
        };
        material.double_sided = self.double_sided;
        material.unlit = self.unlit;
        material.disney = self.disney.as_ref().map(|parameters| {
            let mut disney = Disney::default();
            for (name, value) in parameters {
                if let Some(parameter) = disney.parameter_mut(name) {
                    *parameter = *value;
                }
            }
            disney
        });
        let left_out = TextureSlot::ALL.into_iter().filter(|slot| self.without_textures.contains(slot.name()));
        left_out.for_each(|slot| material.set_texture(slot, None));
    }
}

/// Every parameter by its name.
pub(super) fn named(disney: &Disney) -> BTreeMap<String, f32> {
    let mut disney = *disney;
    let value = |name: &str| (name.to_owned(), disney.parameter_mut(name).map_or(0.0, |value| *value));
    Disney::NAMES.map(value).into()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{TextureRef, UvTransform};

    #[test]
    fn an_edit_that_changes_nothing_changes_nothing() {
        let texture = TextureRef { texture: 0, uv_set: 0, transform: UvTransform::IDENTITY };
        let disney = Some(Disney { sheen: 0.3, ..Disney::default() });
        let alpha_mode = AlphaMode::Mask { cutoff: 0.4 };
        let mut material = Material { ior: 1.33, disney, alpha_mode, metallic: 0.1, ..Material::default() };
        material.set_texture(TextureSlot::Normal, Some(texture));
        let edit = MaterialEdit::of(&material);
        assert!(edit.is_valid());
        let mut edited = material.clone();
        edit.apply(&mut edited);
        assert_eq!(edited, material);
        let json = serde_json::to_string(&edit).unwrap();
        assert_eq!(serde_json::from_str::<MaterialEdit>(&json).unwrap(), edit);
    }

    #[test]
    fn textures_can_be_left_out_and_bad_numbers_are_noticed() {
        let texture = TextureRef { texture: 0, uv_set: 0, transform: UvTransform::IDENTITY };
        let mut material = Material::default();
        material.set_texture(TextureSlot::Normal, Some(texture));
        let mut edit = MaterialEdit::of(&material);
        edit.without_textures.insert("normal".into());
        edit.apply(&mut material);
        assert_eq!(material.texture(TextureSlot::Normal), None);
        let bad: [fn(&mut MaterialEdit); 5] = [
            |edit| edit.metallic = 1.5,
            |edit| edit.ior = 0.5,
            |edit| edit.emissive_nits[1] = f32::NAN,
            |edit| edit.without_textures = ["paint".to_owned()].into(),
            |edit| edit.disney = Some([("gloss".to_owned(), 0.5)].into()),
        ];
        for spoil in bad {
            let mut spoilt = edit.clone();
            spoil(&mut spoilt);
            assert!(!spoilt.is_valid(), "{spoilt:?}");
        }
    }
}
