//! Materials: metallic-roughness and the extensions that refine it, with every number in its range.

use super::error::{Fault, Notes};
use super::extensions::{self, Anisotropy, EmissiveStrength, Ior, Specular, TextureInfo, TextureTransform};
use super::references::within;
use super::vertices::MAX_UV_SETS;
use crate::scene::{AlphaMode, Material, TextureRef, TextureSlot, UvTransform};
use glam::{Vec2, Vec3, Vec4};
use gltf::json;
use gltf::json::material::AlphaMode as JsonAlphaMode;
use gltf::json::validation::Checked;
use serde_json::{Map, Value};

/// All materials of the document. Their textures are still numbered as in the document.
pub(super) fn import(root: &json::Root, notes: &mut Notes) -> Result<Vec<Material>, Fault> {
    let import = |(index, material): (usize, &json::Material)| {
        Reader { root, notes, here: format!("/materials/{index}") }.read(material)
    };
    root.materials.iter().enumerate().map(import).collect()
}

/// A texture slot of the document: index, texture coordinates, raw extensions.
type Slot<'a> = (u64, u32, Option<&'a Map<String, Value>>);

struct Reader<'a> {
    root: &'a json::Root,
    notes: &'a mut Notes,
    here: String,
}

impl Reader<'_> {
    fn read(mut self, json: &json::Material) -> Result<Material, Fault> {
        let pbr = &json.pbr_metallic_roughness;
        let mut material = Material::default();
        material.name.clone_from(&json.name);
        let base_color = pbr.base_color_factor.0.map(|x| self.unit(x, "pbrMetallicRoughness/baseColorFactor"));
        material.base_color = Vec4::from_array(base_color);
        material.metallic = self.unit(pbr.metallic_factor.0, "pbrMetallicRoughness/metallicFactor");
        material.perceptual_roughness = self.unit(pbr.roughness_factor.0, "pbrMetallicRoughness/roughnessFactor");
        material.emissive_nits = Vec3::from_array(json.emissive_factor.0.map(|x| self.unit(x, "emissiveFactor")));
        material.alpha_mode = self.alpha_mode(json)?;
        material.double_sided = json.double_sided;
        self.read_slots(json, &mut material)?;
        self.read_extensions(json, &mut material)?;
        Ok(material)
    }

    fn alpha_mode(&mut self, json: &json::Material) -> Result<AlphaMode, Fault> {
        match json.alpha_mode {
            Checked::Valid(JsonAlphaMode::Opaque) => Ok(AlphaMode::Opaque),
            Checked::Valid(JsonAlphaMode::Blend) => Ok(AlphaMode::Blend),
            Checked::Valid(JsonAlphaMode::Mask) => {
                let cutoff = json.alpha_cutoff.unwrap_or_default().0;
                // Above 1 is legal and hides everything.
                Ok(AlphaMode::Mask { cutoff: self.clamp(cutoff, 0.0, f32::MAX, "alphaCutoff") })
            }
            Checked::Invalid => Err(Fault::at(format_args!("{}/alphaMode", self.here), "is not an alpha mode")),
        }
    }

    fn read_slots(&mut self, json: &json::Material, material: &mut Material) -> Result<(), Fault> {
        let pbr = &json.pbr_metallic_roughness;
        for (slot, texture, name) in [
            (TextureSlot::BaseColor, &pbr.base_color_texture, "pbrMetallicRoughness/baseColorTexture"),
            (
                TextureSlot::MetallicRoughness,
                &pbr.metallic_roughness_texture,
                "pbrMetallicRoughness/metallicRoughnessTexture",
            ),
            (TextureSlot::Emissive, &json.emissive_texture, "emissiveTexture"),
        ] {
            if let Some(info) = texture {
                let raw = info.extensions.as_ref().map(|raw| &raw.others);
                let texture = self.texture((info.index.value() as u64, info.tex_coord, raw), name)?;
                material.set_texture(slot, texture);
            }
        }
        if let Some(texture) = &json.normal_texture {
            material.normal_scale = self.finite(texture.scale, 1.0, "normalTexture/scale");
            let raw = texture.extensions.as_ref().map(|raw| &raw.others);
            let slot = (texture.index.value() as u64, texture.tex_coord, raw);
            material.set_texture(TextureSlot::Normal, self.texture(slot, "normalTexture")?);
        }
        if let Some(texture) = &json.occlusion_texture {
            material.occlusion_strength = self.unit(texture.strength.0, "occlusionTexture/strength");
            let raw = texture.extensions.as_ref().map(|raw| &raw.others);
            let slot = (texture.index.value() as u64, texture.tex_coord, raw);
            material.set_texture(TextureSlot::Occlusion, self.texture(slot, "occlusionTexture")?);
        }
        Ok(())
    }

    fn read_extensions(&mut self, json: &json::Material, material: &mut Material) -> Result<(), Fault> {
        let raw = json.extensions.as_ref().map(|raw| &raw.others);
        let here = self.here.clone();
        material.unlit = raw.is_some_and(|raw| raw.contains_key("KHR_materials_unlit"));
        if let Some(emissive) = extensions::find::<EmissiveStrength>(raw, "KHR_materials_emissive_strength", &here)? {
            let name = "extensions/KHR_materials_emissive_strength/emissiveStrength";
            material.emissive_nits *= self.clamp(emissive.emissive_strength, 0.0, f32::MAX, name);
        }
        if let Some(Ior { ior }) = extensions::find(raw, "KHR_materials_ior", &here)? {
            let name = "extensions/KHR_materials_ior/ior";
            material.ior = if ior == 0.0 { 0.0 } else { self.clamp(ior, 1.0, f32::MAX, name) };
        }
        if let Some(specular) = extensions::find::<Specular>(raw, "KHR_materials_specular", &here)? {
            let name = |member: &str| format!("extensions/KHR_materials_specular/{member}");
            material.specular = self.unit(specular.specular_factor, &name("specularFactor"));
            let color =
                specular.specular_color_factor.map(|x| self.clamp(x, 0.0, f32::MAX, &name("specularColorFactor")));
            material.specular_color = Vec3::from_array(color);
            for (slot, texture, member) in [
                (TextureSlot::Specular, specular.specular_texture, "specularTexture"),
                (TextureSlot::SpecularColor, specular.specular_color_texture, "specularColorTexture"),
            ] {
                if let Some(TextureInfo { index, tex_coord, extensions }) = texture {
                    let texture = self.texture((index, tex_coord, Some(&extensions)), &name(member))?;
                    material.set_texture(slot, texture);
                }
            }
        }
        if let Some(anisotropy) = extensions::find::<Anisotropy>(raw, "KHR_materials_anisotropy", &here)? {
            let name = |member: &str| format!("extensions/KHR_materials_anisotropy/{member}");
            material.anisotropy_strength = self.unit(anisotropy.anisotropy_strength, &name("anisotropyStrength"));
            material.anisotropy_rotation_rad =
                self.finite(anisotropy.anisotropy_rotation, 0.0, &name("anisotropyRotation"));
            if let Some(TextureInfo { index, tex_coord, extensions }) = anisotropy.anisotropy_texture {
                let texture = self.texture((index, tex_coord, Some(&extensions)), &name("anisotropyTexture"))?;
                material.set_texture(TextureSlot::Anisotropy, texture);
            }
        }
        Ok(())
    }

    /// The texture of the slot `name`; `None`, with a note, if it wants texture coordinates that are not read.
    fn texture(&mut self, (index, tex_coord, raw): Slot<'_>, name: &str) -> Result<Option<TextureRef>, Fault> {
        let here = format!("{}/{name}", self.here);
        let texture = within(index, self.root.textures.len(), "textures", format_args!("{here}/index"))?;
        let transform = extensions::find::<TextureTransform>(raw, "KHR_texture_transform", &here)?.unwrap_or_default();
        let uv_set = transform.tex_coord.unwrap_or(tex_coord);
        if uv_set >= MAX_UV_SETS {
            self.notes.add(
                &here,
                format!("TEXCOORD_{uv_set} is not read (only {MAX_UV_SETS} sets are); the texture is ignored"),
            );
            return Ok(None);
        }
        let place = format!("{name}/extensions/KHR_texture_transform");
        let transform = UvTransform {
            offset: Vec2::from_array(transform.offset.map(|x| self.finite(x, 0.0, &place))),
            rotation_rad: self.finite(transform.rotation, 0.0, &place),
            scale: Vec2::from_array(transform.scale.map(|x| self.finite(x, 1.0, &place))),
        };
        Ok(Some(TextureRef { texture, uv_set, transform }))
    }

    fn unit(&mut self, value: f32, name: &str) -> f32 {
        self.clamp(value, 0.0, 1.0, name)
    }

    fn clamp(&mut self, value: f32, least: f32, most: f32, name: &str) -> f32 {
        let clamped = value.clamp(least, most);
        if clamped != value {
            self.notes
                .add(format_args!("{}/{name}", self.here), format!("{value} is out of range and counts as {clamped}"));
        }
        clamped
    }

    /// JSON has no infinity, but numbers that overflow f32.
    fn finite(&mut self, value: f32, otherwise: f32, name: &str) -> f32 {
        if value.is_finite() {
            return value;
        }
        self.notes
            .add(format_args!("{}/{name}", self.here), format!("a number is too large and counts as {otherwise}"));
        otherwise
    }
}
