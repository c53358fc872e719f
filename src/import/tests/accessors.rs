//! Component types, normalised, strided, sparse and empty accessors.

use super::builder::*;
use glam::{Vec2, Vec3, Vec4};
use serde_json::json;

/// The positions of one primitive of points whose POSITION is made by `build`.
fn positions(build: impl FnOnce(&mut Asset) -> usize) -> Vec<Vec3> {
    let asset = Asset::of_primitive(|asset| {
        let positions = build(asset);
        json!({ "mode": 0, "attributes": { "POSITION": positions } })
    });
    asset.primitive().positions
}

#[test]
fn quantised_positions_of_every_type() {
    let i8s = positions(|asset| asset.accessor(&bytes_of(&[-128_i8, -1, 127, 0]), I8, "VEC3", 1));
    assert_eq!(i8s, [Vec3::new(-128.0, -1.0, 127.0)]);
    let u8s = positions(|asset| asset.accessor(&[0, 1, 255], U8, "VEC3", 1));
    assert_eq!(u8s, [Vec3::new(0.0, 1.0, 255.0)]);
    let i16s = positions(|asset| asset.accessor(&bytes_of(&[-32768_i16, 5, 32767]), I16, "VEC3", 1));
    assert_eq!(i16s, [Vec3::new(-32768.0, 5.0, 32767.0)]);
    let u16s = positions(|asset| asset.accessor(&bytes_of(&[0_u16, 258, 65535]), U16, "VEC3", 1));
    assert_eq!(u16s, [Vec3::new(0.0, 258.0, 65535.0)]);
}

#[test]
fn normalised_positions_of_every_type() {
    let normalized = |component: u32, bytes: Vec<u8>| {
        positions(|asset| {
            let accessor = asset.accessor(&bytes, component, "VEC3", 1);
            asset.json["accessors"][accessor]["normalized"] = json!(true);
            accessor
        })[0]
    };
    assert_eq!(normalized(I8, bytes_of(&[-128_i8, -127, 127, 0])), Vec3::new(-1.0, -1.0, 1.0));
    assert_eq!(normalized(I8, bytes_of(&[64_i8, 0, 1, 0])), Vec3::new(64.0 / 127.0, 0.0, 1.0 / 127.0));
    assert_eq!(normalized(U8, vec![0, 51, 255]), Vec3::new(0.0, 0.2, 1.0));
    assert_eq!(normalized(I16, bytes_of(&[-32768_i16, 0, 32767])), Vec3::new(-1.0, 0.0, 1.0));
    assert_eq!(normalized(U16, bytes_of(&[0_u16, 13107, 65535])), Vec3::new(0.0, 0.2, 1.0));
}

#[test]
fn interleaved_attributes_with_offsets() {
    let asset = Asset::of_primitive(|asset| {
        let data: Vec<f32> = (0..2 * 5).map(|x| x as f32).collect();
        let view = asset.view(&bytes_of(&data));
        asset.json["bufferViews"][view]["byteStride"] = json!(20);
        let mut accessor = |offset: u32, kind: &str| {
            let accessor = json!({
                "bufferView": view, "byteOffset": offset, "componentType": F32, "type": kind, "count": 2
            });
            asset.push("accessors", accessor)
        };
        let (positions, uvs) = (accessor(0, "VEC3"), accessor(12, "VEC2"));
        json!({ "mode": 0, "attributes": { "POSITION": positions, "TEXCOORD_0": uvs } })
    });
    asset.loaded();
    let primitive = asset.primitive();
    assert_eq!(primitive.positions, [Vec3::new(0.0, 1.0, 2.0), Vec3::new(5.0, 6.0, 7.0)]);
    assert_eq!(primitive.uvs, [[Vec2::new(3.0, 4.0), Vec2::new(8.0, 9.0)]]);
}

/// A sparse accessor that moves elements 0 and 2 of three, over `base`.
fn sparse(asset: &mut Asset, base: Option<usize>) -> usize {
    let indices = asset.view(&[0, 2]);
    let values = asset.view(&bytes_of(&[7.0_f32, 8.0, 9.0, -1.0, -2.0, -3.0]));
    let mut accessor = json!({
        "componentType": F32, "type": "VEC3", "count": 3,
        "sparse": {
            "count": 2,
            "indices": { "bufferView": indices, "componentType": U8 },
            "values": { "bufferView": values }
        }
    });
    if let Some(view) = base {
        accessor["bufferView"] = json!(view);
    }
    asset.push("accessors", accessor)
}

#[test]
fn sparse_accessors_replace_elements_of_their_base_or_of_zeros() {
    let over_data = positions(|asset| {
        let base = asset.view(&bytes_of(TRIANGLE.as_flattened()));
        sparse(asset, Some(base))
    });
    assert_eq!(over_data, [Vec3::new(7.0, 8.0, 9.0), Vec3::X, Vec3::new(-1.0, -2.0, -3.0)]);
    let over_zeros = positions(|asset| sparse(asset, None));
    assert_eq!(over_zeros, [Vec3::new(7.0, 8.0, 9.0), Vec3::ZERO, Vec3::new(-1.0, -2.0, -3.0)]);
}

#[test]
fn accessors_without_data_are_zero() {
    let zeros = positions(|asset| asset.push("accessors", json!({ "componentType": F32, "type": "VEC3", "count": 5 })));
    assert_eq!(zeros, [Vec3::ZERO; 5]);
}

#[test]
fn a_million_zeros_cost_a_few_bytes_but_a_billion_are_refused() {
    let mut asset = Asset::of_primitive(|asset| {
        let zeros = asset.push("accessors", json!({ "componentType": F32, "type": "VEC3", "count": 1_000_000 }));
        json!({ "mode": 0, "attributes": { "POSITION": zeros } })
    });
    assert_eq!(asset.primitive().positions.len(), 1_000_000);
    asset.json["accessors"][0]["count"] = json!(1_000_000_000);
    assert!(asset.load().unwrap_err().to_string().starts_with("model: /accessors/0/count: asks for 1000000000"));
}

#[test]
fn colours_of_every_kind() {
    let colors = |kind: &str, component: u32, bytes: &[u8]| {
        let asset = Asset::of_primitive(|asset| {
            let positions = asset.floats(&[[0.0; 3]]);
            let colors = asset.accessor(bytes, component, kind, 1);
            asset.json["accessors"][colors]["normalized"] = json!(component != F32);
            json!({ "mode": 0, "attributes": { "POSITION": positions, "COLOR_0": colors } })
        });
        asset.primitive().colors.unwrap()[0]
    };
    assert_eq!(colors("VEC3", F32, &bytes_of(&[0.25_f32, 0.5, 2.0])), Vec4::new(0.25, 0.5, 2.0, 1.0));
    assert_eq!(colors("VEC4", F32, &bytes_of(&[0.25_f32, 0.5, 1.0, 0.5])), Vec4::new(0.25, 0.5, 1.0, 0.5));
    assert_eq!(colors("VEC3", U8, &[0, 51, 255]), Vec4::new(0.0, 0.2, 1.0, 1.0));
    assert_eq!(colors("VEC4", U16, &bytes_of(&[0_u16, 13107, 65535, 65535])), Vec4::new(0.0, 0.2, 1.0, 1.0));
}

#[test]
fn indices_of_every_type_and_none() {
    let indices = |component: u32, bytes: &[u8]| {
        let asset = Asset::of_primitive(|asset| {
            let positions = asset.floats(&TRIANGLE);
            let indices = asset.accessor(bytes, component, "SCALAR", 3);
            json!({ "mode": 0, "indices": indices, "attributes": { "POSITION": positions } })
        });
        asset.primitive().indices
    };
    assert_eq!(indices(U8, &[2, 0, 1]), [2, 0, 1]);
    assert_eq!(indices(U16, &bytes_of(&[2_u16, 0, 1])), [2, 0, 1]);
    assert_eq!(indices(U32, &bytes_of(&[2_u32, 0, 1])), [2, 0, 1]);
    assert_eq!(Asset::triangle().primitive().indices, [0, 1, 2]);
}

#[test]
fn numbers_that_are_not_finite_become_zero_with_a_warning() {
    let asset = Asset::of_primitive(|asset| {
        let positions = asset.floats(&TRIANGLE);
        let uvs = asset.floats(&[[f32::NAN, 1.0], [0.0, f32::INFINITY], [2.0, 3.0]]);
        json!({ "attributes": { "POSITION": positions, "TEXCOORD_0": uvs } })
    });
    assert_eq!(asset.primitive().uvs[0], [Vec2::new(0.0, 1.0), Vec2::ZERO, Vec2::new(2.0, 3.0)]);
    assert_eq!(
        asset.warnings(),
        "model: /meshes/0/primitives/0/attributes/TEXCOORD_0: 2 numbers are not finite and count as 0\n"
    );
}
