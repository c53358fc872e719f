//! Material parameters, their extensions and their ranges.

use super::builder::*;
use crate::scene::{AlphaMode, Material, TextureSlot, UvTransform};
use glam::{Vec2, Vec3, Vec4};
use serde_json::{Value, json};

/// A triangle with two sets of texture coordinates, one texture, and this material.
fn with(material: Value) -> Asset {
    let mut asset = Asset::triangle();
    for set in ["TEXCOORD_0", "TEXCOORD_1"] {
        let uvs = asset.floats(&[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]);
        asset.json["meshes"][0]["primitives"][0]["attributes"][set] = json!(uvs);
    }
    asset.texture();
    asset.with_material(material)
}

fn material(json: Value) -> Material {
    with(json).loaded().scene.materials.remove(0)
}

#[test]
fn an_empty_material_is_the_default() {
    assert_eq!(material(json!({})), Material::default());
}

#[test]
fn core_parameters() {
    let material = material(json!({
        "name": "paint",
        "pbrMetallicRoughness": { "baseColorFactor": [0.1, 0.2, 0.3, 0.4], "metallicFactor": 0.25, "roughnessFactor": 0.5 },
        "emissiveFactor": [0.5, 0.25, 1], "doubleSided": true, "alphaMode": "BLEND",
        "normalTexture": { "index": 0, "scale": -2.5 }, "occlusionTexture": { "index": 0, "strength": 0.75, "texCoord": 1 }
    }));
    assert_eq!(material.name.as_deref(), Some("paint"));
    assert_eq!(material.base_color, Vec4::new(0.1, 0.2, 0.3, 0.4));
    assert_eq!((material.metallic, material.perceptual_roughness), (0.25, 0.5));
    assert_eq!(material.emissive_nits, Vec3::new(0.5, 0.25, 1.0));
    assert_eq!((material.double_sided, material.alpha_mode), (true, AlphaMode::Blend));
    assert_eq!((material.normal_scale, material.occlusion_strength), (-2.5, 0.75));
    assert_eq!(material.texture(TextureSlot::Normal).unwrap().uv_set, 0);
    assert_eq!(material.texture(TextureSlot::Occlusion).unwrap().uv_set, 1);
}

#[test]
fn alpha_modes() {
    assert_eq!(material(json!({ "alphaMode": "OPAQUE" })).alpha_mode, AlphaMode::Opaque);
    assert_eq!(material(json!({ "alphaMode": "MASK" })).alpha_mode, AlphaMode::Mask { cutoff: 0.5 });
    let mask = material(json!({ "alphaMode": "MASK", "alphaCutoff": 0.25 }));
    assert_eq!(mask.alpha_mode, AlphaMode::Mask { cutoff: 0.25 });
}

#[test]
fn material_extensions() {
    let asset = with(json!({ "emissiveFactor": [1, 0.5, 0], "extensions": {
        "KHR_materials_emissive_strength": { "emissiveStrength": 8 },
        "KHR_materials_ior": { "ior": 1.25 },
        "KHR_materials_specular": {
            "specularFactor": 0.5, "specularTexture": { "index": 0, "texCoord": 1 },
            "specularColorFactor": [2, 1, 0], "specularColorTexture": { "index": 0 }
        },
        "KHR_materials_anisotropy": { "anisotropyStrength": 0.75, "anisotropyRotation": 1.5 },
        "KHR_materials_unlit": {}
    } }));
    let material = &asset.loaded().scene.materials[0];
    assert_eq!(material.emissive_nits, Vec3::new(8.0, 4.0, 0.0));
    assert_eq!(material.ior, 1.25);
    assert_eq!((material.specular, material.specular_color), (0.5, Vec3::new(2.0, 1.0, 0.0)));
    assert_eq!(material.texture(TextureSlot::Specular).unwrap().uv_set, 1);
    assert_eq!(material.texture(TextureSlot::SpecularColor).unwrap().uv_set, 0);
    assert_eq!((material.anisotropy_strength, material.anisotropy_rotation_rad), (0.75, 1.5));
    assert!(material.unlit);
    assert_eq!(self::material(json!({ "extensions": { "KHR_materials_ior": { "ior": 0 } } })).ior, 0.0);
    assert_eq!(self::material(json!({ "extensions": { "KHR_materials_ior": {} } })).ior, 1.5);
}

#[test]
fn texture_transforms_in_every_slot() {
    let transformed = |n: u32| {
        json!({ "index": 0, "texCoord": 0, "extensions": { "KHR_texture_transform": {
            "offset": [n, 0.5], "rotation": 0.25, "scale": [2, -3], "texCoord": 1, "extras": 7
        } } })
    };
    let material = material(json!({
        "pbrMetallicRoughness": { "baseColorTexture": transformed(0), "metallicRoughnessTexture": transformed(1) },
        "normalTexture": transformed(2), "occlusionTexture": transformed(3), "emissiveTexture": transformed(4),
        "extensions": { "KHR_materials_specular": {
            "specularTexture": transformed(5), "specularColorTexture": transformed(6)
        }, "KHR_materials_anisotropy": { "anisotropyTexture": transformed(7) } }
    }));
    for (n, slot) in TextureSlot::ALL.into_iter().enumerate() {
        let texture = material.texture(slot).unwrap();
        let expected =
            UvTransform { offset: Vec2::new(n as f32, 0.5), rotation_rad: 0.25, scale: Vec2::new(2.0, -3.0) };
        assert_eq!((texture.uv_set, texture.transform), (1, expected), "{slot:?}");
    }
}

#[test]
fn texture_transforms_have_defaults() {
    let texture = json!({ "index": 0, "texCoord": 1, "extensions": { "KHR_texture_transform": {} } });
    let material = material(json!({ "emissiveTexture": texture }));
    let texture = material.texture(TextureSlot::Emissive).unwrap();
    assert_eq!((texture.uv_set, texture.transform), (1, UvTransform::IDENTITY));
}

#[test]
fn numbers_out_of_range_are_clamped_with_a_warning() {
    let asset = with(json!({
        "pbrMetallicRoughness": { "baseColorFactor": [2, -1, 0.5, 1], "metallicFactor": 1.5, "roughnessFactor": -1 },
        "emissiveFactor": [3, 0, 0], "alphaMode": "MASK", "alphaCutoff": -0.5,
        "normalTexture": { "index": 0, "scale": 1e39 },
        "extensions": { "KHR_materials_ior": { "ior": 0.5 }, "KHR_materials_specular": { "specularFactor": 2 } }
    }));
    let imported = asset.load().unwrap();
    let material = &imported.scene.materials[0];
    assert_eq!(material.base_color, Vec4::new(1.0, 0.0, 0.5, 1.0));
    assert_eq!((material.metallic, material.perceptual_roughness), (1.0, 0.0));
    assert_eq!((material.emissive_nits, material.alpha_mode), (Vec3::X, AlphaMode::Mask { cutoff: 0.0 }));
    assert_eq!((material.normal_scale, material.ior, material.specular), (1.0, 1.0, 1.0));
    let places: Vec<String> = asset.warnings().lines().map(|line| line.split(": ").nth(1).unwrap().into()).collect();
    let expected = [
        "pbrMetallicRoughness/baseColorFactor",
        "pbrMetallicRoughness/baseColorFactor",
        "pbrMetallicRoughness/metallicFactor",
        "pbrMetallicRoughness/roughnessFactor",
        "emissiveFactor",
        "alphaCutoff",
        "normalTexture/scale",
        "extensions/KHR_materials_ior/ior",
        "extensions/KHR_materials_specular/specularFactor",
    ];
    assert_eq!(places, expected.map(|name| format!("/materials/0/{name}")));
}

#[test]
fn unknown_extensions_are_a_warning_each() {
    let mut asset = with(json!({ "extensions": { "VENDOR_gloss": { "gloss": 1 } } }));
    asset.json["extensionsUsed"] = json!(["KHR_materials_unlit", "VENDOR_gloss"]);
    assert_eq!(
        asset.warnings(),
        "model: /extensionsUsed/1: the extension \"VENDOR_gloss\" is not supported and is ignored\n"
    );
}

#[test]
fn extras_may_be_anything() {
    let mut asset = with(json!({ "extras": 7, "pbrMetallicRoughness": { "extras": "text" } }));
    asset.json["extras"] = json!([1, 2]);
    asset.json["nodes"][0]["extras"] = Value::Null;
    asset.json["asset"]["extras"] = json!(4_294_967_296_u64);
    asset.loaded();
}
