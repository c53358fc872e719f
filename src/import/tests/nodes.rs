//! Node trees, scenes, cameras, lights.

use super::builder::*;
use crate::import::{Choice, ImportOptions, model_from_slice};
use crate::scene::{LightKind, Projection, Scene};
use glam::{DMat4, DQuat, DVec3};
use serde_json::{Value, json};
use std::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_2, FRAC_PI_4};

fn nodes(list: Value) -> Asset {
    let mut asset = Asset::new();
    asset.json["nodes"] = list;
    asset
}

#[test]
fn translation_rotation_and_scale_compose() {
    let asset = nodes(json!([{ "translation": [1, 2, 3], "rotation": [0, 0.6, 0, 0.8], "scale": [2, -1, 0.5] }]));
    let scene = asset.loaded().scene;
    let rotation = DQuat::from_xyzw(0.0, f64::from(0.6_f32), 0.0, f64::from(0.8_f32)).normalize();
    let expected = DMat4::from_translation(DVec3::new(1.0, 2.0, 3.0))
        * DMat4::from_quat(rotation)
        * DMat4::from_scale(DVec3::new(2.0, -1.0, 0.5));
    assert!(scene.nodes[0].parent_from_node.abs_diff_eq(expected, 1e-12));
    assert!(scene.nodes[0].parent_from_node.determinant() < 0.0);
}

#[test]
fn matrices_are_columns() {
    let asset = nodes(json!([{ "matrix": [1, 2, 3, 0, 4, 5, 6, 0, 7, 8, 10, 0, 11, 12, 13, 1] }]));
    let point = asset.loaded().scene.nodes[0].parent_from_node.transform_point3(DVec3::X);
    assert_eq!(point, DVec3::new(12.0, 14.0, 16.0));
}

#[test]
fn odd_transforms_are_repaired_with_a_warning() {
    let asset = nodes(json!([
        { "rotation": [0, 0, 0, 2] },
        { "rotation": [0, 0, 0, 0] },
        { "matrix": [1, 0, 0, 5, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 2] },
        { "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1], "scale": [3, 3, 3] }
    ]));
    let imported = asset.load().unwrap();
    for node in &imported.scene.nodes {
        assert_eq!(node.parent_from_node, DMat4::IDENTITY);
    }
    let places: Vec<String> = imported.warnings.iter().map(|warning| format!("{:?}", warning.place)).collect();
    let expected = ["/nodes/0/rotation", "/nodes/1/rotation", "/nodes/2/matrix", "/nodes/3"];
    assert_eq!(places, expected.map(|place| format!("Pointer({place:?})")));
}

#[test]
fn meshes_are_placed_by_all_their_ancestors() {
    let mut asset = Asset::triangle();
    asset.json["nodes"] = json!([
        { "name": "root", "translation": [1, 0, 0], "children": [2, 1] },
        { "mesh": 0, "scale": [2, 2, 2] },
        { "rotation": [0, 0, 1, 0], "children": [3] },
        { "mesh": 0 }
    ]);
    let scene = asset.loaded().scene;
    assert_eq!(scene.nodes[0].name.as_deref(), Some("root"));
    let instances = scene.instances();
    assert_eq!(instances.iter().map(|instance| instance.node).collect::<Vec<_>>(), [3, 1]);
    assert!(instances[0].world_from_object.transform_point3(DVec3::X).abs_diff_eq(DVec3::ZERO, 1e-12));
    assert_eq!(instances[1].world_from_object.transform_point3(DVec3::X), DVec3::new(3.0, 0.0, 0.0));
}

#[test]
fn a_chain_of_a_hundred_thousand_nodes_loads() {
    const LENGTH: usize = 100_000;
    let node = |n: usize| {
        if n + 1 < LENGTH { json!({ "translation": [1, 0, 0], "children": [n + 1] }) } else { json!({}) }
    };
    let asset = nodes((0..LENGTH).map(node).collect());
    let transforms = asset.loaded().scene.world_transforms();
    assert_eq!(transforms.len(), LENGTH);
    assert_eq!(transforms[LENGTH - 1].1.w_axis.x, (LENGTH - 1) as f64);
}

#[test]
fn a_cycle_behind_a_hundred_thousand_nodes_is_found() {
    let asset = nodes((0..100_000).map(|n| json!({ "children": [(n + 1) % 100_000] })).collect());
    let error = asset.load().unwrap_err().to_string();
    assert!(error.starts_with("model: /nodes/0: is part of a cycle"), "{error}");
}

/// Three scenes of one node each.
fn three_scenes() -> Asset {
    let mut asset = nodes(json!([{}, {}, {}, {}]));
    asset.json["scenes"] = json!([{ "nodes": [2] }, { "nodes": [1], "name": "second" }, {}]);
    asset
}

fn choose(asset: &Asset, scene: Option<Choice>) -> Result<Scene, String> {
    let options = ImportOptions { scene, ..ImportOptions::default() };
    let imported = model_from_slice(&asset.glb(), "model", None, &options).map_err(|error| error.to_string())?;
    Ok(imported.scene)
}

#[test]
fn scenes_are_chosen_by_wish_default_or_order() {
    let mut asset = three_scenes();
    assert_eq!(choose(&asset, None).unwrap().roots, [2]);
    assert_eq!(choose(&asset, Some(Choice::Index(1))).unwrap().roots, [1]);
    let second = choose(&asset, Some(Choice::Name("second".into()))).unwrap();
    assert_eq!((second.roots, second.name.as_deref()), (vec![1], Some("second")));
    assert!(choose(&asset, Some(Choice::Index(2))).unwrap().roots.is_empty());
    asset.json["scene"] = json!(1);
    assert_eq!(choose(&asset, None).unwrap().roots, [1]);
    let imported = asset.loaded();
    assert_eq!(imported.scene_names, [None, Some("second".to_owned()), None]);
    assert_eq!(imported.scene_index, Some(1));
}

#[test]
fn scenes_that_are_not_there_are_refused_with_those_that_are() {
    for choice in [Choice::Index(3), Choice::Name("third".into())] {
        let error = choose(&three_scenes(), Some(choice)).unwrap_err();
        assert!(error.starts_with("model: /scenes: has no scene "), "{error}");
        assert!(error.ends_with("; choose one of: 0, \"second\", 2"), "{error}");
    }
}

#[test]
fn without_scenes_all_root_nodes_are_taken() {
    let asset = nodes(json!([{ "children": [2] }, {}, {}]));
    assert_eq!(asset.loaded().scene.roots, [0, 1]);
    assert_eq!(asset.loaded().scene_index, None);
}

#[test]
fn cameras_are_placed_by_their_nodes_without_scale() {
    let mut asset = nodes(json!([
        { "translation": [1, 2, 3], "scale": [2, 3, -4], "camera": 0 },
        { "rotation": [0, FRAC_1_SQRT_2, 0, FRAC_1_SQRT_2], "camera": 1 }
    ]));
    asset.json["cameras"] = json!([
        { "name": "lens", "type": "perspective", "perspective": { "yfov": 0.5, "znear": 0.25, "zfar": 8, "aspectRatio": 2 } },
        { "type": "orthographic", "orthographic": { "xmag": 5, "ymag": 2, "znear": 0, "zfar": 16 } }
    ]);
    let scene = asset.loaded().scene;
    assert!(scene.cameras.iter().all(|camera| camera.world_from_view == DMat4::IDENTITY));
    let cameras = scene.cameras_in_world();
    assert_eq!(cameras[0].name.as_deref(), Some("lens"));
    assert_eq!(cameras[0].projection, Projection::Perspective { fov_y_rad: 0.5 });
    assert_eq!((cameras[0].near_m, cameras[0].far_m), (0.25, 8.0));
    assert_eq!(cameras[0].position_in_world(), DVec3::new(1.0, 2.0, 3.0));
    assert_eq!(cameras[0].forward_in_world(), DVec3::Z, "the node mirrors z");
    assert_eq!(cameras[1].projection, Projection::Orthographic { height_m: 4.0 });
    assert!(cameras[1].forward_in_world().abs_diff_eq(DVec3::NEG_X, 1e-7));
    for camera in cameras {
        let rotation = glam::DMat3::from_mat4(camera.world_from_view);
        assert!((rotation * rotation.transpose()).abs_diff_eq(glam::DMat3::IDENTITY, 1e-12));
        assert!((rotation.determinant() - 1.0).abs() < 1e-12);
    }
}

#[test]
fn cameras_out_of_range_are_replaced_with_a_warning() {
    let mut asset = nodes(json!([]));
    asset.json["cameras"] = json!([
        { "type": "perspective", "perspective": { "yfov": -1, "znear": 0, "zfar": 0 } },
        { "type": "orthographic", "orthographic": { "xmag": 1, "ymag": 0, "znear": 2, "zfar": 1 } }
    ]);
    let imported = asset.load().unwrap();
    let [lens, plan] = &imported.scene.cameras[..] else { panic!("two cameras") };
    assert_eq!(lens.projection, Projection::Perspective { fov_y_rad: FRAC_PI_4 });
    assert_eq!((lens.near_m, lens.far_m), (0.01, f64::INFINITY));
    assert_eq!(plan.projection, Projection::Orthographic { height_m: 2.0 });
    assert_eq!((plan.near_m, plan.far_m), (2.0, 1002.0));
    assert_eq!(imported.warnings.len(), 5);
}

fn lights(list: &Value) -> Asset {
    let count = list.as_array().unwrap().len();
    let on_node = |light: usize| json!({ "extensions": { "KHR_lights_punctual": { "light": light } } });
    let mut asset = nodes((0..count).map(on_node).collect());
    asset.json["extensions"] = json!({ "KHR_lights_punctual": { "lights": list } });
    asset.json["extensionsUsed"] = json!(["KHR_lights_punctual"]);
    asset.json["extensionsRequired"] = json!(["KHR_lights_punctual"]);
    asset
}

#[test]
fn lights_of_every_kind() {
    let scene = lights(&json!([
        { "type": "directional", "color": [1, 0.5, 0.25], "intensity": 3, "name": "sun" },
        { "type": "point", "range": 10 },
        { "type": "spot", "spot": { "innerConeAngle": 0.25, "outerConeAngle": 0.5 } },
        { "type": "spot", "spot": {} }
    ]))
    .loaded()
    .scene;
    let [sun, point, spot, default_spot] = &scene.lights[..] else { panic!("four lights") };
    assert_eq!((sun.name.as_deref(), sun.kind), (Some("sun"), LightKind::Directional));
    assert_eq!((sun.color, sun.intensity), (DVec3::new(1.0, 0.5, 0.25), 3.0));
    assert_eq!((point.kind, point.intensity), (LightKind::Point { range_m: Some(10.0) }, 1.0));
    assert_eq!(spot.kind, LightKind::Spot { range_m: None, inner_cone_rad: 0.25, outer_cone_rad: 0.5 });
    let LightKind::Spot { inner_cone_rad, outer_cone_rad, .. } = default_spot.kind else { panic!("no spot") };
    assert!(inner_cone_rad == 0.0 && (outer_cone_rad - FRAC_PI_4).abs() < 1e-7);
    assert_eq!(scene.lights_in_world().len(), 4);
}

#[test]
fn lights_out_of_range_are_repaired_with_a_warning() {
    let imported = lights(&json!([
        { "type": "point", "intensity": -1, "range": 0 },
        { "type": "spot", "spot": { "innerConeAngle": 2, "outerConeAngle": 3 } },
        { "type": "spot", "spot": { "innerConeAngle": 0, "outerConeAngle": 0 } }
    ]))
    .load()
    .unwrap();
    let [point, wide, closed] = &imported.scene.lights[..] else { panic!("three lights") };
    assert_eq!((point.intensity, point.kind), (0.0, LightKind::Point { range_m: None }));
    assert_eq!(wide.kind, LightKind::Spot { range_m: None, inner_cone_rad: FRAC_PI_2, outer_cone_rad: FRAC_PI_2 });
    assert_eq!(closed.kind, LightKind::Spot { range_m: None, inner_cone_rad: 0.0, outer_cone_rad: FRAC_PI_4 });
    assert_eq!(imported.warnings.len(), 4);
}

#[test]
fn what_does_not_move_yet_is_said() {
    let warnings = super::hostile::model().warnings();
    assert!(warnings.contains("/animations: animations are not played yet\n"));
    assert!(warnings.contains("/nodes/2/skin: skins are not applied yet"));
    assert!(warnings.contains("/meshes/0: morph targets are not applied yet"));
}
