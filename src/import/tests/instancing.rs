//! EXT_mesh_gpu_instancing.

use super::builder::*;
use super::hostile::assert_clean;
use crate::import::ImportError;
use glam::{DMat4, DQuat, DVec3};
use serde_json::{Value, json};

/// A triangle on a node that is moved by (10, 0, 0), with these attributes.
fn instanced(attributes: impl FnOnce(&mut Asset) -> Value) -> Asset {
    let mut asset = Asset::triangle();
    let attributes = attributes(&mut asset);
    let extensions = json!({ "EXT_mesh_gpu_instancing": { "attributes": attributes } });
    asset.json["nodes"] = json!([{ "mesh": 0, "translation": [10, 0, 0], "extensions": extensions }]);
    asset.json["extensionsUsed"] = json!(["EXT_mesh_gpu_instancing"]);
    asset.json["extensionsRequired"] = json!(["EXT_mesh_gpu_instancing"]);
    asset
}

/// Where the instances are put.
fn places(asset: &Asset) -> Vec<DMat4> {
    asset.loaded().scene.instances().iter().map(|instance| instance.world_from_object).collect()
}

#[test]
fn translation_rotation_and_scale_compose_below_the_node() {
    let quarter = std::f32::consts::FRAC_1_SQRT_2;
    let asset = instanced(|asset| {
        let translation = asset.floats(&[[1.0, 2.0, 3.0], [0.0, 0.0, 0.0]]);
        let rotation = asset.floats(&[[0.0, 0.0, quarter, quarter], [0.0, 0.0, 0.0, 1.0]]);
        let scale = asset.floats(&[[1.0, 1.0, 1.0], [2.0, -1.0, 0.0]]);
        json!({ "TRANSLATION": translation, "ROTATION": rotation, "SCALE": scale })
    });
    let places = places(&asset);
    let node = DMat4::from_translation(DVec3::X * 10.0);
    let turned = DQuat::from_rotation_z(std::f64::consts::FRAC_PI_2);
    assert_eq!(places.len(), 2);
    let first = node * DMat4::from_translation(DVec3::new(1.0, 2.0, 3.0)) * DMat4::from_quat(turned);
    assert!(places[0].abs_diff_eq(first, 1e-7));
    assert_eq!(places[1], node * DMat4::from_scale(DVec3::new(2.0, -1.0, 0.0)));
}

#[test]
fn each_attribute_alone_is_enough_and_others_are_let_be() {
    let translations = instanced(|asset| json!({ "TRANSLATION": asset.floats(&[[1.0, 0.0, 0.0]; 3]) }));
    assert_eq!(places(&translations), [DMat4::from_translation(DVec3::X * 11.0); 3]);
    let custom = instanced(|asset| json!({ "_ID": asset.accessor(&[1, 2, 3, 4], U8, "SCALAR", 4) }));
    assert_eq!(places(&custom), [DMat4::from_translation(DVec3::X * 10.0); 4]);
    let none = instanced(|asset| json!({ "TRANSLATION": asset.accessor(&[], F32, "VEC3", 0) }));
    assert_eq!(places(&none), []);
}

#[test]
fn rotations_may_be_bytes_and_shorts() {
    let mut asset = instanced(|asset| {
        let bytes: [i8; 4] = [0, 90, 0, 90];
        json!({ "ROTATION": asset.accessor(bytemuck::cast_slice(&bytes), I8, "VEC4", 1) })
    });
    let rotation = asset.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["ROTATION"].clone();
    asset.json["accessors"][rotation.as_u64().unwrap() as usize]["normalized"] = json!(true);
    let imported = asset.load().unwrap();
    assert!(imported.warnings.is_empty() || !imported.warnings[0].to_string().contains("ROTATION"));
    let expected = DMat4::from_translation(DVec3::X * 10.0) * DMat4::from_rotation_y(std::f64::consts::FRAC_PI_2);
    assert!(places(&asset)[0].abs_diff_eq(expected, 1e-12));
}

#[test]
fn odd_quaternions_are_normalised_with_one_warning() {
    let asset = instanced(|asset| json!({ "ROTATION": asset.floats(&[[0.0, 0.0, 0.0, 2.0], [0.0; 4]]) }));
    let imported = asset.load().unwrap();
    let placed: Vec<DMat4> = imported.scene.instances().iter().map(|instance| instance.world_from_object).collect();
    assert_eq!(placed, [DMat4::from_translation(DVec3::X * 10.0); 2]);
    let warnings: Vec<String> = imported.warnings.iter().map(ToString::to_string).collect();
    let place = "/nodes/0/extensions/EXT_mesh_gpu_instancing/attributes/ROTATION: 2 quaternions";
    assert!(warnings.iter().any(|warning| warning.contains(place)), "{warnings:?}");
}

#[test]
fn a_node_without_a_mesh_places_nothing() {
    let mut asset = instanced(|asset| json!({ "TRANSLATION": asset.floats(&[[1.0, 0.0, 0.0]; 3]) }));
    asset.json["nodes"][0].as_object_mut().unwrap().remove("mesh");
    let imported = asset.load().unwrap();
    assert!(imported.scene.instances().is_empty());
    let warning = imported.warnings[0].to_string();
    assert!(warning.contains("/nodes/0/extensions/EXT_mesh_gpu_instancing: the node has no mesh"), "{warning}");
}

#[test]
fn faults_name_their_place() {
    let here = "/nodes/0/extensions/EXT_mesh_gpu_instancing/attributes";
    let refused = |attributes: fn(&mut Asset) -> Value| -> ImportError { instanced(attributes).load().unwrap_err() };
    let cases: [(&str, ImportError, String); 6] = [
        ("empty", refused(|_| json!({})), here.to_owned()),
        ("no map", refused(|_| json!([0])), here.to_owned()),
        ("beyond", refused(|_| json!({ "SCALE": 99 })), format!("{here}/SCALE")),
        (
            "not as many",
            refused(|asset| {
                let (two, three) = (asset.floats(&[[1.0; 3]; 2]), asset.floats(&[[1.0; 3]; 3]));
                json!({ "SCALE": two, "TRANSLATION": three })
            }),
            format!("{here}/TRANSLATION"),
        ),
        (
            "infinite",
            refused(|asset| json!({ "TRANSLATION": asset.floats(&[[0.0; 3], [0.0, f32::INFINITY, 0.0]]) })),
            format!("{here}/TRANSLATION"),
        ),
        ("of two", refused(|asset| json!({ "SCALE": asset.floats(&[[1.0; 2]; 2]) })), "/accessors/1/type".to_owned()),
    ];
    for (name, error, place) in cases {
        assert_clean(name, &error, "model");
        assert!(error.to_string().starts_with(&format!("model: {place}: ")), "{name}: {error}");
    }
}
