//! Documents that must be refused: each with one clean line that says where.

use super::builder::*;
use crate::import::ImportError;
use serde_json::{Value, json};

/// A small valid model that uses a bit of everything.
pub(super) fn model() -> Asset {
    let mut asset = Asset::of_primitive(|asset| {
        let positions = asset.floats(&TRIANGLE);
        let normals = asset.floats(&[[0.0, 0.0, 1.0]; 3]);
        let uvs = asset.floats(&[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]);
        let indices = asset.indices(&[0, 1, 2]);
        let attributes = json!({ "POSITION": positions, "NORMAL": normals, "TEXCOORD_0": uvs });
        json!({ "indices": indices, "attributes": attributes, "targets": [{ "POSITION": positions }] })
    });
    // Accessor 4: sparse.
    let (indices, values) = (asset.view(&[0, 2]), asset.view(&bytes_of(&[1.0_f32; 6])));
    asset.push(
        "accessors",
        json!({ "componentType": F32, "type": "VEC3", "count": 3, "sparse": { "count": 2,
            "indices": { "bufferView": indices, "componentType": U8 }, "values": { "bufferView": values } } }),
    );
    let points = json!({ "mode": 0, "attributes": { "POSITION": 4 } });
    asset.json["meshes"][0]["primitives"].as_array_mut().unwrap().push(points);
    let texture = asset.texture();
    asset.push("samplers", json!({ "wrapS": 33071, "minFilter": 9986 }));
    asset.json["textures"][0]["sampler"] = json!(0);
    asset.push("cameras", json!({ "type": "perspective", "perspective": { "yfov": 0.8, "znear": 0.1 } }));
    asset.push("skins", json!({ "joints": [0], "skeleton": 0 }));
    asset.push("nodes", json!({ "camera": 0, "extensions": { "KHR_lights_punctual": { "light": 0 } } }));
    asset.push("nodes", json!({ "children": [1], "mesh": 0, "skin": 0 }));
    asset.json["scenes"][0]["nodes"] = json!([0, 2]);
    asset.json["scene"] = json!(0);
    asset.json["extensionsUsed"] = json!(["KHR_lights_punctual", "KHR_materials_specular", "KHR_texture_transform"]);
    asset.json["extensions"] = json!({ "KHR_lights_punctual": { "lights": [{ "type": "spot", "spot": {} }] } });
    asset.push(
        "animations",
        json!({ "samplers": [{ "input": 0, "output": 0 }], "channels": [{ "sampler": 0, "target": { "node": 0 } }] }),
    );
    asset.json["buffers"] = json!([{ "byteLength": asset.binary.len() }]);
    asset.with_material(json!({
        "normalTexture": { "index": texture, "extensions": { "KHR_texture_transform": { "scale": [2, 2] } } },
        "extensions": { "KHR_materials_specular": { "specularTexture": { "index": texture } } }
    }))
}

#[test]
fn the_model_that_is_spoiled_below_is_good() {
    model().load().unwrap();
}

/// Writes `value` at a JSON pointer whose last step may be new.
fn set(json: &mut Value, pointer: &str, value: Value) {
    let (parent, key) = pointer.rsplit_once('/').unwrap();
    match json.pointer_mut(parent).unwrap_or_else(|| panic!("{pointer}")) {
        Value::Array(items) => {
            let index: usize = key.parse().unwrap();
            items.resize(items.len().max(index + 1), Value::Null);
            items[index] = value;
        }
        parent => parent[key] = value,
    }
}

/// One line, `SOURCE: PLACE: PROBLEM; ADVICE`.
pub(super) fn assert_clean(name: &str, error: &ImportError, source: &str) {
    let line = error.to_string();
    let rest = line.strip_prefix(source).and_then(|rest| rest.strip_prefix(": "));
    let rest = rest.unwrap_or_else(|| panic!("{name}: {line}"));
    let (place, message) = rest.split_once(": ").unwrap_or_else(|| panic!("{name}: {line}"));
    let is_byte = place.strip_prefix("byte ").is_some_and(|offset| offset.parse::<u64>().is_ok());
    assert!(is_byte || place.starts_with('/'), "{name}: {line}");
    let (problem, advice) = message.rsplit_once("; ").unwrap_or_else(|| panic!("{name}: {line}"));
    assert!(problem.len() > 4 && advice.len() > 4, "{name}: {line}");
    assert!(!line.contains(['\n', '\r', '\t']), "{name}: {line}");
    assert!(line.len() < 600, "{name}: {line}");
}

/// Where to write what, and the place that the error must name.
fn spoiled_values() -> Vec<(&'static str, Value, &'static str)> {
    vec![
        ("/asset", json!({}), "/asset/version"),
        ("/asset/version", json!("1.0"), "/asset/version"),
        ("/asset/version", json!("3.0"), "/asset/version"),
        ("/asset/version", json!(2.0), "/asset/version"),
        ("/asset/version", json!("two\nlines"), "/asset/version"),
        ("/asset/minVersion", json!("2.1"), "/asset/minVersion"),
        ("/extensionsRequired", json!(["KHR_lights_punctual", "VENDOR_magic"]), "/extensionsRequired/1"),
        ("/extensionsRequired", json!(["KHR_draco_mesh_compression"]), "/extensionsRequired/0"),
        ("/extensionsRequired", json!("KHR_lights_punctual"), "/extensionsRequired"),
        // Indices that lead nowhere.
        ("/scene", json!(9), "/scene"),
        ("/scene", json!(-1), "/scene"),
        ("/scene", json!(1.5), "/scene"),
        ("/scene", json!(4_294_967_296_u64), "/scene"),
        ("/scenes/0/nodes/0", json!(9), "/scenes/0/nodes/0"),
        ("/scenes/0/nodes/0", json!(4_294_967_296_u64), "/scenes/0/nodes/0"),
        ("/nodes/0/mesh", json!(9), "/nodes/0/mesh"),
        ("/nodes/0/mesh", json!("0"), "/nodes/0/mesh"),
        ("/nodes/1/camera", json!(9), "/nodes/1/camera"),
        ("/nodes/2/skin", json!(9), "/nodes/2/skin"),
        ("/nodes/2/children/0", json!(9), "/nodes/2/children/0"),
        ("/nodes/1/extensions/KHR_lights_punctual/light", json!(9), "/nodes/1/extensions/KHR_lights_punctual/light"),
        ("/nodes/1/extensions/KHR_lights_punctual", json!({}), "/nodes/1/extensions/KHR_lights_punctual"),
        ("/skins/0/joints/0", json!(9), "/skins/0/joints/0"),
        ("/skins/0/skeleton", json!(9), "/skins/0/skeleton"),
        ("/skins/0/inverseBindMatrices", json!(9), "/skins/0/inverseBindMatrices"),
        ("/meshes/0/primitives/0/material", json!(9), "/meshes/0/primitives/0/material"),
        ("/meshes/0/primitives/0/indices", json!(9), "/meshes/0/primitives/0/indices"),
        ("/meshes/0/primitives/0/attributes/POSITION", json!(9), "/meshes/0/primitives/0/attributes/POSITION"),
        ("/meshes/0/primitives/0/attributes/_CUSTOM", json!(9), "/meshes/0/primitives/0/attributes/_"),
        (
            "/meshes/0/primitives/0/attributes/NORMAL",
            json!(4_294_967_297_u64),
            "/meshes/0/primitives/0/attributes/NORMAL",
        ),
        ("/meshes/0/primitives/0/targets/0/POSITION", json!(9), "/meshes/0/primitives/0/targets/0/POSITION"),
        ("/materials/0/normalTexture/index", json!(9), "/materials/0/normalTexture/index"),
        (
            "/materials/0/extensions/KHR_materials_specular/specularTexture/index",
            json!(9),
            "/materials/0/extensions/KHR_materials_specular/specularTexture/index",
        ),
        ("/textures/0/source", json!(9), "/textures/0/source"),
        ("/textures/0/sampler", json!(9), "/textures/0/sampler"),
        ("/images/0/bufferView", json!(99), "/images/0/bufferView"),
        ("/bufferViews/0/buffer", json!(9), "/bufferViews/0/buffer"),
        ("/accessors/0/bufferView", json!(99), "/accessors/0/bufferView"),
        ("/accessors/4/sparse/indices/bufferView", json!(99), "/accessors/4/sparse/indices/bufferView"),
        ("/accessors/4/sparse/values/bufferView", json!(99), "/accessors/4/sparse/values/bufferView"),
        ("/animations/0/samplers/0/input", json!(9), "/animations/0/samplers/0/input"),
        ("/animations/0/samplers/0/output", json!(9), "/animations/0/samplers/0/output"),
        ("/animations/0/channels/0/sampler", json!(9), "/animations/0/channels/0/sampler"),
        ("/animations/0/channels/0/target/node", json!(9), "/animations/0/channels/0/target/node"),
        // Ranges that leave their parent.
        ("/buffers/0/byteLength", json!(1_000_000), "/buffers/0/byteLength"),
        ("/buffers/0/byteLength", json!(10), "/bufferViews/0"),
        ("/bufferViews/0/byteOffset", json!(1_000_000), "/bufferViews/0"),
        ("/bufferViews/0/byteOffset", json!(u64::MAX), "/bufferViews/0"),
        ("/bufferViews/0/byteLength", json!(u64::MAX), "/bufferViews/0"),
        ("/bufferViews/0/byteLength", json!(-1), "/bufferViews/0/byteLength"),
        ("/bufferViews/0/byteStride", json!(4), "/bufferViews/0/byteStride"),
        ("/bufferViews/0/byteStride", json!(16), "/accessors/0"),
        ("/bufferViews/0/byteStride", json!(u64::MAX), "/accessors/0"),
        ("/accessors/0/byteOffset", json!(4), "/accessors/0"),
        ("/accessors/0/byteOffset", json!(u64::MAX), "/accessors/0"),
        ("/accessors/0/count", json!(4), "/accessors/0"),
        ("/accessors/0/count", json!(u64::MAX), "/accessors/0"),
        ("/accessors/4/count", json!(1_u64 << 62), "/accessors/4/count"),
        ("/accessors/4/sparse/count", json!(4), "/accessors/4/sparse/count"),
        ("/accessors/4/sparse/count", json!(3), "/accessors/4/sparse/indices"),
        ("/accessors/4/sparse/indices/byteOffset", json!(1), "/accessors/4/sparse/indices"),
        ("/accessors/4/sparse/values/byteOffset", json!(u64::MAX), "/accessors/4/sparse/values"),
        // Types that are none, or the wrong ones.
        ("/accessors/0/componentType", json!(5124), "/accessors/0/componentType"),
        ("/accessors/0/componentType", json!(4_294_972_422_u64), "/accessors/0/componentType"),
        ("/accessors/0/type", json!("VEC9"), "/accessors/0/type"),
        ("/accessors/0/type", json!("VEC2"), "/accessors/0/type"),
        ("/accessors/3/componentType", json!(5122), "/accessors/3"),
        ("/accessors/4/sparse/indices/componentType", json!(5126), "/accessors/4/sparse/indices/componentType"),
        ("/meshes/0/primitives/0/mode", json!(7), "/meshes/0/primitives/0/mode"),
        ("/meshes/0/primitives/0/mode", json!(4_294_967_300_u64), "/meshes/0/primitives/0/mode"),
        ("/meshes/0/primitives", json!({}), "/meshes/0/primitives"),
        ("/meshes/0/primitives/0/attributes", json!([]), "/meshes/0/primitives/0/attributes"),
        ("/samplers/0/wrapS", json!(1), "/samplers/0/wrapS"),
        ("/samplers/0/minFilter", json!(1), "/samplers/0/minFilter"),
        ("/samplers/0/magFilter", json!(9984), "/samplers/0/magFilter"),
        ("/materials/0/alphaMode", json!("SOLID"), "/materials/0/alphaMode"),
        ("/materials/0/emissiveFactor", json!([1, 2]), "/materials/0/emissiveFactor"),
        ("/cameras/0/type", json!("fisheye"), "/cameras/0/type"),
        ("/cameras/0/type", json!("orthographic"), "/cameras/0"),
        (
            "/extensions/KHR_lights_punctual/lights/0/type",
            json!("laser"),
            "/extensions/KHR_lights_punctual/lights/0/type",
        ),
        // Attributes and indices that do not fit together.
        ("/accessors/1/count", json!(2), "/meshes/0/primitives/0/attributes/NORMAL"),
        ("/accessors/0/count", json!(2), "/meshes/0/primitives/0/attributes/NORMAL"),
        // Trees that are none.
        ("/nodes/1/children", json!([2]), "/nodes/1"),
        ("/nodes/1/children", json!([1]), "/nodes/2/children/0"),
        ("/nodes/0/children", json!([1]), "/nodes/2/children/0"),
        ("/nodes/2/children", json!([1, 1]), "/nodes/2/children/1"),
        ("/scenes/0/nodes", json!([0, 1]), "/scenes/0/nodes/1"),
        ("/nodes/0/matrix", json!([1, 2, 3]), "/nodes/0/matrix"),
        ("/nodes/0/matrix", json!([1e39, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]), "/nodes/0/matrix"),
        ("/nodes/0/translation", json!([0, 1e39, 0]), "/nodes/0/translation"),
        ("/nodes/0/scale", json!([-1e39, 0, 0]), "/nodes/0/scale"),
        // Uris that lead out, or nowhere.
        ("/images/0", json!({ "uri": "../secret.png" }), "/images/0/uri"),
        ("/images/0", json!({ "uri": "http://example.org/a.png" }), "/images/0/uri"),
        ("/images/0", json!({ "uri": "data:image/png;base64,%%%" }), "/images/0/uri"),
        ("/images/0", json!({ "uri": "data:image/png;base64" }), "/images/0/uri"),
        ("/images/0", json!({ "uri": "data:image/png,plain" }), "/images/0/uri"),
        ("/images/0", json!({ "uri": "%FF%FE.png" }), "/images/0/uri"),
        ("/images/0", json!({}), "/images/0"),
        ("/buffers/0/uri", json!("file:///etc/passwd"), "/buffers/0/uri"),
        ("/buffers/0/uri", json!("data:,short"), "/buffers/0/byteLength"),
        ("/buffers", json!([]), "/bufferViews/0/buffer"),
        ("/buffers/0", json!("buffer"), "/buffers/0"),
        ("/nodes", json!(7), "/nodes"),
    ]
}

#[test]
fn spoiled_documents_are_refused_where_they_are_spoiled() {
    let cases = spoiled_values();
    assert!(cases.len() >= 60);
    for (pointer, value, expected) in cases {
        let mut asset = model();
        set(&mut asset.json, pointer, value.clone());
        let name = format!("{pointer} = {value}");
        let Err(error) = asset.load() else { panic!("{name} was accepted") };
        assert_clean(&name, &error, "model");
        let line = error.to_string();
        let place = line.split(": ").nth(1).unwrap();
        assert_eq!(place, expected, "{name}: {line}");
    }
}

#[test]
fn broken_containers_are_refused() {
    let good = model().glb();
    let json_length = u32::from_le_bytes(good[12..16].try_into().unwrap());
    let binary_header = 20 + json_length as usize;
    let spoil = |at: usize, bytes: &[u8]| {
        let mut glb = good.clone();
        glb[at..at + bytes.len()].copy_from_slice(bytes);
        glb
    };
    let deep = format!("{{\"asset\":{{\"version\":\"2.0\"}},\"extras\":{}", "[".repeat(100_000));
    let cases: Vec<(&str, Vec<u8>)> = vec![
        ("empty", vec![]),
        ("white space", b" \n ".to_vec()),
        ("noise", (0..200).map(|i| (i * 37 % 251) as u8).collect()),
        ("an array", b"[1]".to_vec()),
        ("half a document", b"{\"asset\":\n{\"version\"".to_vec()),
        ("not UTF-8", b"{\"asset\":{\"version\":\"2.0\",\"generator\":\"\xFF\"}}".to_vec()),
        ("deep", deep.into_bytes()),
        ("a number that is too large", b"{\"asset\":{\"version\":\"2.0\"},\"scene\":1e999}".to_vec()),
        ("magic alone", b"glTF".to_vec()),
        ("version 1", spoil(4, &1_u32.to_le_bytes())),
        ("version 3", spoil(4, &3_u32.to_le_bytes())),
        ("longer than the file", spoil(8, &u32::MAX.to_le_bytes())),
        ("shorter than the header", spoil(8, &8_u32.to_le_bytes())),
        ("without chunks", spoil(8, &12_u32.to_le_bytes())),
        ("a JSON chunk that is too long", spoil(12, &u32::MAX.to_le_bytes())),
        ("a JSON chunk of no length", spoil(12, &0_u32.to_le_bytes())),
        ("a JSON chunk that is too short", spoil(12, &(json_length - 4).to_le_bytes())),
        ("no JSON chunk", spoil(16, b"ABCD")),
        ("a binary chunk that is too long", spoil(binary_header, &u32::MAX.to_le_bytes())),
        ("a binary chunk of another kind", spoil(binary_header + 4, b"ABCD")),
        ("cut in the middle", good[..good.len() / 2].to_vec()),
    ];
    for (name, bytes) in cases {
        let Err(error) = load(&bytes) else { panic!("{name} was accepted") };
        assert_clean(name, &error, "model");
    }
}

/// Data of accessors that only shows when it is read.
#[test]
fn bad_data_is_refused() {
    let primitive = |positions: &[[f32; 3]], component: u32, indices: &[u8], count: usize| {
        Asset::of_primitive(|asset| {
            let positions = asset.floats(positions);
            let indices = asset.accessor(indices, component, "SCALAR", count);
            json!({ "indices": indices, "attributes": { "POSITION": positions } })
        })
    };
    let many = vec![[0.0; 3]; 300];
    let mut sparse_backward = model();
    let view = sparse_backward.view(&[2, 0]);
    sparse_backward.json["accessors"][4]["sparse"]["indices"]["bufferView"] = json!(view);
    sparse_backward.json["buffers"][0]["byteLength"] = json!(sparse_backward.binary.len());
    let mut sparse_beyond = sparse_backward.clone();
    let view = sparse_beyond.view(&[0, 3]);
    sparse_beyond.json["accessors"][4]["sparse"]["indices"]["bufferView"] = json!(view);
    sparse_beyond.json["buffers"][0]["byteLength"] = json!(sparse_beyond.binary.len());

    let mut no_data = model();
    no_data.json["buffers"] = json!([{ "byteLength": 0 }, { "byteLength": 100_000 }]);
    no_data.json["bufferViews"].as_array_mut().unwrap().iter_mut().for_each(|view| view["buffer"] = json!(1));

    for (name, asset, place) in [
        ("index beyond", primitive(&TRIANGLE, U16, &bytes_of(&[0_u16, 1, 3]), 3), "/meshes/0/primitives/0/indices"),
        ("restart u8", primitive(&many, U8, &[0, 255, 2], 3), "/meshes/0/primitives/0/indices"),
        ("restart u32", primitive(&TRIANGLE, U32, &bytes_of(&[0, 1, u32::MAX]), 3), "/meshes/0/primitives/0/indices"),
        (
            "NaN position",
            primitive(&[[0.0; 3], [f32::NAN, 0.0, 0.0], [0.0; 3]], U8, &[0, 1, 2], 3),
            "/meshes/0/primitives/0/attributes/POSITION",
        ),
        (
            "infinite position",
            primitive(&[[0.0; 3], [0.0; 3], [0.0, f32::INFINITY, 0.0]], U8, &[0, 1, 2], 3),
            "/meshes/0/primitives/0/attributes/POSITION",
        ),
        ("sparse indices backward", sparse_backward, "/accessors/4/sparse/indices"),
        ("sparse index beyond", sparse_beyond, "/accessors/4/sparse/indices"),
        ("a buffer without data", no_data, "/bufferViews/"),
    ] {
        let Err(error) = asset.load() else { panic!("{name} was accepted") };
        assert_clean(name, &error, "model");
        assert!(error.to_string().starts_with(&format!("model: {place}")), "{name}: {error}");
    }
}

#[test]
fn hostile_names_cannot_break_the_line() {
    let mut asset = model();
    asset.json["extensionsRequired"] = json!(["a\nb\u{2028}c\u{1b}[31m"]);
    let error = crate::import::model_from_slice(&asset.glb(), "evil\nname", None, &Default::default()).unwrap_err();
    assert_clean("names", &error, "evil name");
    assert!(!error.to_string().contains(['\u{2028}', '\u{1b}']), "{error}");
}
