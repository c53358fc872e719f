//! Pictures of every layout, samplers, and pictures that must not be decoded.

use super::builder::*;
use super::hostile::assert_clean;
use crate::import::{ImportOptions, model_from_path, model_from_slice};
use crate::scene::{Pixels, Sampler, TextureSlot, Wrap};
use image::ExtendedColorType;
use serde_json::{Value, json};

/// A triangle whose base colour is an image file of these bytes.
fn with_image(file: &[u8]) -> Asset {
    let mut asset = Asset::triangle();
    let uvs = asset.floats(&[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]);
    asset.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = json!(uvs);
    let view = asset.view(file);
    asset.push("images", json!({ "bufferView": view, "mimeType": "image/png", "name": "picture" }));
    asset.push("textures", json!({ "source": 0 }));
    asset.with_material(json!({ "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 } } }))
}

fn rgba8(file: &[u8]) -> Vec<u8> {
    match &with_image(file).loaded().scene.images[0].pixels {
        Pixels::Rgba8(pixels) => pixels.to_vec(),
        other => panic!("{other:?}"),
    }
}

#[test]
fn png_layouts_become_rgba() {
    assert_eq!(rgba8(&png(2, 1, ExtendedColorType::L8, &[7, 200])), [7, 7, 7, 255, 200, 200, 200, 255]);
    assert_eq!(rgba8(&png(1, 1, ExtendedColorType::La8, &[7, 9])), [7, 7, 7, 9]);
    assert_eq!(rgba8(&png(1, 1, ExtendedColorType::Rgb8, &[1, 2, 3])), [1, 2, 3, 255]);
    assert_eq!(rgba8(&png(1, 2, ExtendedColorType::Rgba8, &[1, 2, 3, 4, 5, 6, 7, 8])), [1, 2, 3, 4, 5, 6, 7, 8]);
}

#[test]
fn deep_png_keeps_16_bits() {
    let file = png(1, 1, ExtendedColorType::Rgb16, &bytes_of(&[1_u16, 256, 65535]));
    let scene = with_image(&file).loaded().scene;
    let Pixels::Rgba16(pixels) = &scene.images[0].pixels else { panic!("not deep") };
    assert_eq!(pixels[..], [1, 256, 65535, 65535]);
    let file = png(1, 1, ExtendedColorType::L16, &bytes_of(&[258_u16]));
    let scene = with_image(&file).loaded().scene;
    let Pixels::Rgba16(pixels) = &scene.images[0].pixels else { panic!("not deep") };
    assert_eq!(pixels[..], [258, 258, 258, 65535]);
}

#[test]
fn palettes_become_rgba() {
    let mut file = b"\x89PNG\r\n\x1a\n".to_vec();
    let mut chunk = |kind: &[u8], data: &[u8]| {
        file.extend((data.len() as u32).to_be_bytes());
        file.extend(kind);
        file.extend(data);
        file.extend(crc32(&[kind, data].concat()).to_be_bytes());
    };
    chunk(b"IHDR", &[0, 0, 0, 2, 0, 0, 0, 1, 8, 3, 0, 0, 0]);
    chunk(b"PLTE", &[10, 20, 30, 40, 50, 60]);
    chunk(b"tRNS", &[255, 128]);
    // A stored (not compressed) block of one row: filter 0, indices 1 and 0; then Adler-32.
    chunk(b"IDAT", &[0x78, 0x01, 0x01, 3, 0, 0xFC, 0xFF, 0, 1, 0, 0, 5, 0, 2]);
    chunk(b"IEND", &[]);
    assert_eq!(rgba8(&file), [40, 50, 60, 128, 10, 20, 30, 255]);
}

#[test]
fn jpeg_is_told_by_its_content() {
    let mut file = Vec::new();
    image::codecs::jpeg::JpegEncoder::new_with_quality(&mut file, 100)
        .encode(&[128; 8 * 8 * 3], 8, 8, ExtendedColorType::Rgb8)
        .unwrap();
    let pixels = rgba8(&file);
    assert_eq!(pixels.len(), 8 * 8 * 4);
    assert!(pixels.chunks(4).all(|texel| texel[..3].iter().all(|x| x.abs_diff(128) <= 1) && texel[3] == 255));
}

#[test]
fn jpeg_is_decoded_to_four_channels_as_to_three() {
    let (width, height) = (61, 43);
    for (color, channels) in [(ExtendedColorType::Rgb8, 3), (ExtendedColorType::L8, 1)] {
        let wave = |i: usize| (128.0 + 120.0 * (i as f32 * 0.37 + (i / 61) as f32 * 0.11).sin()) as u8;
        let texels: Vec<u8> = (0..width as usize * height as usize * channels).map(wave).collect();
        for quality in [30, 95] {
            let mut file = Vec::new();
            let mut encoder = image::codecs::jpeg::JpegEncoder::new_with_quality(&mut file, quality);
            encoder.encode(&texels, width, height, color).unwrap();
            let by_image = image::load_from_memory(&file).unwrap().into_rgba8().into_raw();
            assert_eq!(rgba8(&file), by_image, "{color:?} of quality {quality}");
        }
    }
}

#[test]
fn images_that_no_primitive_shows_are_not_decoded() {
    let mut asset = with_image(&png(1, 1, ExtendedColorType::L8, &[0]));
    let broken = asset.view(b"no image");
    asset.push("images", json!({ "bufferView": broken }));
    asset.push("textures", json!({ "source": 1 }));
    asset.push("materials", json!({ "emissiveTexture": { "index": 1 } }));
    let scene = asset.loaded().scene;
    assert_eq!((scene.images.len(), scene.textures.len(), scene.materials.len()), (1, 1, 2));
    assert_eq!(scene.images[0].name.as_deref(), Some("picture"));
    assert!(scene.materials[1].textures().next().is_none());
}

#[test]
fn textures_share_images_and_are_numbered_anew() {
    let mut asset = with_image(&png(1, 1, ExtendedColorType::L8, &[0]));
    asset.json["textures"] = json!([{}, { "source": 0 }, { "source": 0 }]);
    asset.json["materials"][0] = json!({
        "pbrMetallicRoughness": { "baseColorTexture": { "index": 2 } },
        "occlusionTexture": { "index": 1 }, "emissiveTexture": { "index": 2 }
    });
    let scene = asset.loaded().scene;
    assert_eq!((scene.images.len(), scene.textures.len()), (1, 2));
    let number = |slot| scene.materials[0].texture(slot).unwrap().texture;
    assert_eq!(number(TextureSlot::BaseColor), number(TextureSlot::Emissive));
    assert_ne!(number(TextureSlot::BaseColor), number(TextureSlot::Occlusion));
}

#[test]
fn textures_without_an_image_are_left_out() {
    let mut asset = with_image(&png(1, 1, ExtendedColorType::L8, &[0]));
    asset.json["textures"] = json!([{ "extensions": { "KHR_texture_basisu": { "source": 0 } } }]);
    asset.json["extensionsUsed"] = json!(["KHR_texture_basisu"]);
    assert!(asset.load().unwrap().scene.materials[0].textures().next().is_none());
    let warnings = asset.warnings();
    assert!(warnings.contains("/extensionsUsed/0: the extension \"KHR_texture_basisu\" is not supported"));
    assert!(warnings.contains("/textures/0: the texture has no image that can be read and is left out"));
}

#[test]
fn samplers_of_every_kind() {
    let sampler = |json: Value| {
        let mut asset = with_image(&png(1, 1, ExtendedColorType::L8, &[0]));
        asset.push("samplers", json);
        asset.json["textures"][0]["sampler"] = json!(0);
        asset.loaded().scene.textures[0].sampler
    };
    assert_eq!(sampler(json!({})), Sampler::default());
    assert!(!sampler(json!({ "magFilter": 9728 })).mag_linear);
    assert!(sampler(json!({ "magFilter": 9729 })).mag_linear);
    for (code, min_linear, mip_linear) in [
        (9728, false, None),
        (9729, true, None),
        (9984, false, Some(false)),
        (9985, true, Some(false)),
        (9986, false, Some(true)),
        (9987, true, Some(true)),
    ] {
        let sampler = sampler(json!({ "minFilter": code }));
        assert_eq!((sampler.min_linear, sampler.mip_linear), (min_linear, mip_linear), "{code}");
    }
    for (code, wrap) in [(33071, Wrap::ClampToEdge), (33648, Wrap::MirroredRepeat), (10497, Wrap::Repeat)] {
        let sampler = sampler(json!({ "wrapS": code, "wrapT": 33071 }));
        assert_eq!((sampler.wrap_u, sampler.wrap_v), (wrap, Wrap::ClampToEdge), "{code}");
    }
}

#[test]
fn bad_images_are_refused() {
    let good = png(8, 8, ExtendedColorType::Rgba8, &[9; 256]);
    let mut bad_checksum = good.clone();
    bad_checksum[20] ^= 1;
    for (name, file) in [
        ("cut in the data", good[..good.len() - 20].to_vec()),
        ("cut in the header", good[..20].to_vec()),
        ("signature alone", good[..8].to_vec()),
        ("bad checksum", bad_checksum),
        ("bomb", png_header(30_000, 30_000)),
        ("long bomb", png_header(u32::MAX >> 1, 1)),
        ("over the budget", png_header(16_384, 16_384)),
        ("no size", png_header(0, 8)),
        ("JPEG signature alone", vec![0xFF, 0xD8, 0xFF]),
        ("KTX2", b"\xABKTX 20\xBB\r\n\x1a\n and so on".to_vec()),
        ("WebP", b"RIFF\x00\x00\x00\x00WEBPVP8 ".to_vec()),
        ("text", b"hello".to_vec()),
        ("nothing", vec![]),
    ] {
        let error = match name {
            "over the budget" => {
                let limits = crate::import::Limits { decoded_bytes: 1 << 30, ..Default::default() };
                let options = ImportOptions { limits, ..Default::default() };
                crate::import::model_from_slice(&with_image(&file).glb(), "model", None, &options).err()
            }
            _ => with_image(&file).load().err(),
        };
        let Some(error) = error else { panic!("{name} was accepted") };
        assert_clean(name, &error, "model");
        assert!(error.to_string().starts_with("model: /images/0/bufferView: "), "{name}: {error}");
    }
}

#[test]
fn external_images_are_read_and_named_in_errors() {
    let folder = tempfile::tempdir().unwrap();
    let mut asset = with_image(&[]);
    asset.json["images"] = json!([{ "uri": "my%20picture.png" }]);
    let model = folder.path().join("model.gltf");
    std::fs::write(&model, asset.gltf()).unwrap();
    let error = model_from_path(&model, &ImportOptions::default()).unwrap_err().to_string();
    assert!(error.contains("/images/0/uri: \"my%20picture.png\" cannot be found"), "{error}");

    let picture = folder.path().join("my picture.png");
    std::fs::write(&picture, b"hello").unwrap();
    let error = model_from_path(&model, &ImportOptions::default()).unwrap_err().to_string();
    assert!(error.contains("/images/0/uri: the image \"my%20picture.png\" is of an unknown kind"), "{error}");

    std::fs::write(&picture, png(3, 2, ExtendedColorType::Rgb8, &[5; 18])).unwrap();
    let scene = model_from_path(&model, &ImportOptions::default()).unwrap().scene;
    assert_eq!((scene.images[0].width, scene.images[0].height), (3, 2));
}

#[test]
fn what_only_another_scene_shows_is_not_decoded() {
    let mut asset = with_image(b"no picture");
    assert!(asset.load().is_err());
    let node = asset.push("nodes", json!({ "name": "empty" }));
    asset.json["scenes"] = json!([{ "nodes": [node] }]);
    asset.json["scene"] = json!(0);
    let scene = asset.loaded().scene;
    assert_eq!((scene.images.len(), scene.textures.len(), scene.meshes.len()), (0, 0, 1));
}

#[test]
fn textures_that_are_never_sampled_can_be_left_out() {
    // Damaged on purpose: whoever decodes it fails.
    let damaged = |slot: &str, material: Value| {
        let mut asset = with_image(&png(1, 1, ExtendedColorType::L8, &[7]));
        let view = asset.view(b"\x89PNG\r\n\x1a\nno more");
        asset.push("images", json!({ "bufferView": view, "mimeType": "image/png" }));
        asset.push("textures", json!({ "source": 1 }));
        asset.json["materials"][0][slot] = json!({ "index": 1 });
        let members = material.as_object().unwrap().clone();
        members.into_iter().for_each(|(name, value)| asset.json["materials"][0][name.as_str()] = value);
        asset
    };
    let load_with = |asset: &Asset, options: &ImportOptions<'_>| model_from_slice(&asset.glb(), "model", None, options);
    let sampled = ImportOptions { sampled_textures_only: true, ..Default::default() };
    let unlit = json!({ "extensions": { "KHR_materials_unlit": {} } });
    let black = json!({});
    let weak = json!({ "occlusionTexture": { "index": 1, "strength": 0.0 } });
    for (slot, material) in [("normalTexture", unlit), ("emissiveTexture", black), ("occlusionTexture", weak)] {
        let asset = damaged(slot, material);
        assert!(load_with(&asset, &ImportOptions::default()).is_err(), "{slot}");
        assert_eq!(load_with(&asset, &sampled).unwrap().scene.images.len(), 1, "{slot}");
    }
    let bright = json!({ "emissiveFactor": [1.0, 1.0, 1.0] });
    for (slot, material) in [("normalTexture", json!({})), ("emissiveTexture", bright), ("occlusionTexture", json!({}))]
    {
        assert!(load_with(&damaged(slot, material), &sampled).is_err(), "{slot}");
    }
}
