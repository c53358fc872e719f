//! Primitive modes, missing normals, missing texture coordinates.

use super::builder::*;
use crate::scene::{Primitive, Topology};
use glam::{Vec2, Vec3};
use serde_json::{Value, json};

/// Four vertices of a unit square, as a strip has them.
const SQUARE: [[f32; 3]; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]];

/// A primitive of the square with normals, so that vertices stay where they are.
fn square(mode: u32, indices: Option<&[u16]>) -> Primitive {
    let asset = Asset::of_primitive(|asset| {
        let positions = asset.floats(&SQUARE);
        let normals = asset.floats(&[[0.0, 0.0, 1.0]; 4]);
        let mut primitive = json!({ "mode": mode, "attributes": { "POSITION": positions, "NORMAL": normals } });
        if let Some(indices) = indices {
            primitive["indices"] = json!(asset.indices(indices));
        }
        primitive
    });
    asset.loaded();
    asset.primitive()
}

#[test]
fn all_seven_modes_unroll_to_lists() {
    for (mode, topology, expected) in [
        (0, Topology::Points, vec![0, 1, 2, 3]),
        (1, Topology::Lines, vec![0, 1, 2, 3]),
        (2, Topology::Lines, vec![0, 1, 1, 2, 2, 3, 3, 0]),
        (3, Topology::Lines, vec![0, 1, 1, 2, 2, 3]),
        (4, Topology::Triangles, vec![0, 1, 2]),
        (5, Topology::Triangles, vec![0, 1, 2, 1, 3, 2]),
        (6, Topology::Triangles, vec![1, 2, 0, 2, 3, 0]),
    ] {
        let primitive = square(mode, None);
        assert_eq!((primitive.topology, primitive.indices), (topology, expected), "mode {mode}");
    }
}

#[test]
fn strips_go_through_their_indices() {
    assert_eq!(square(5, Some(&[3, 2, 1, 0])).indices, [3, 2, 1, 2, 0, 1]);
    assert_eq!(square(6, Some(&[3, 2, 1, 0])).indices, [2, 1, 3, 1, 0, 3]);
    assert_eq!(square(2, Some(&[2, 0])).indices, [2, 0, 0, 2]);
}

#[test]
fn strips_keep_their_winding() {
    let strip = square(5, None);
    for triangle in strip.indices.chunks_exact(3) {
        let [a, b, c] = [0, 1, 2].map(|corner| strip.positions[triangle[corner] as usize]);
        assert!((b - a).cross(c - a).z > 0.0, "{triangle:?} faces away");
    }
}

#[test]
fn triangles_without_normals_become_flat_and_lose_their_tangents() {
    let asset = Asset::of_primitive(|asset| {
        let positions = asset.floats(&[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
        let tangents = asset.floats(&[[1.0, 0.0, 0.0, 1.0]; 4]);
        let indices = asset.indices(&[0, 1, 2, 0, 3, 1]);
        json!({ "indices": indices, "attributes": { "POSITION": positions, "TANGENT": tangents } })
    });
    asset.loaded();
    let primitive = asset.primitive();
    assert_eq!(primitive.indices, [0, 1, 2, 3, 4, 5]);
    assert_eq!(primitive.positions, [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::ZERO, Vec3::Z, Vec3::X]);
    assert_eq!(primitive.normals.unwrap(), [Vec3::Z, Vec3::Z, Vec3::Z, Vec3::Y, Vec3::Y, Vec3::Y]);
    assert_eq!(primitive.tangents, None);
}

#[test]
fn points_and_lines_without_normals_stay_without() {
    for mode in 0..4 {
        let mut asset = Asset::triangle();
        asset.json["meshes"][0]["primitives"][0]["mode"] = json!(mode);
        assert_eq!(asset.primitive().normals, None, "mode {mode}");
    }
}

#[test]
fn degenerate_triangles_have_unit_normals() {
    let asset = Asset::of_primitive(|asset| {
        let positions = asset.floats(&[[1.0, 2.0, 3.0]; 3]);
        json!({ "attributes": { "POSITION": positions } })
    });
    assert_eq!(asset.primitive().normals.unwrap(), [Vec3::Z; 3]);
}

#[test]
fn huge_triangles_have_unit_normals() {
    let asset = Asset::of_primitive(|asset| {
        let positions = asset.floats(&[[0.0; 3], [f32::MAX, 0.0, 0.0], [0.0, f32::MAX, 0.0]]);
        json!({ "attributes": { "POSITION": positions } })
    });
    assert_eq!(asset.primitive().normals.unwrap(), [Vec3::Z; 3]);
}

#[test]
fn normals_of_no_length_are_computed_and_others_normalised() {
    let asset = Asset::of_primitive(|asset| {
        let positions = asset.floats(&TRIANGLE);
        let normals = asset.floats(&[[0.0; 3], [0.0, 3.0, 0.0], [f32::NAN, 0.0, 0.0]]);
        json!({ "attributes": { "POSITION": positions, "NORMAL": normals } })
    });
    assert_eq!(asset.primitive().normals.unwrap(), [Vec3::Z, Vec3::Y, Vec3::Z]);
    assert!(asset.warnings().contains("/attributes/NORMAL: 2 normals have no length and are computed\n"));
}

#[test]
fn incomplete_shapes_are_left_out() {
    let mut asset = Asset::triangle();
    asset.json["meshes"][0]["primitives"][0]["indices"] = json!(1);
    asset.indices(&[0, 1, 2, 0, 1]);
    assert_eq!(asset.primitive().indices, [0, 1, 2]);

    let mut asset = Asset::triangle();
    asset.json["meshes"][0]["primitives"][0]["indices"] = json!(1);
    asset.indices(&[0, 1]);
    assert!(asset.load().unwrap().scene.meshes[0].primitives.is_empty());
    assert!(asset.warnings().contains("/meshes/0/primitives/0: the primitive has no complete"));
}

#[test]
fn primitives_without_positions_are_left_out() {
    let asset = Asset::of_primitive(|_| json!({ "attributes": {} }));
    assert!(asset.load().unwrap().scene.meshes[0].primitives.is_empty());
    assert!(asset.warnings().contains("has no POSITION"));
}

/// A triangle with the texture coordinate sets that are `given`, and a material whose base colour wants set `wanted`.
fn uv_sets(given: &[u32], wanted: u32) -> Asset {
    let mut asset = Asset::of_primitive(|asset| {
        let mut attributes = json!({ "POSITION": asset.floats(&TRIANGLE) });
        for &set in given {
            attributes[format!("TEXCOORD_{set}")] = json!(asset.floats(&[[set as f32, 0.5]; 3]));
        }
        json!({ "attributes": attributes })
    });
    let texture = asset.texture();
    let base_color: Value = json!({ "index": texture, "texCoord": wanted });
    asset.with_material(json!({ "pbrMetallicRoughness": { "baseColorTexture": base_color } }))
}

#[test]
fn several_uv_sets_keep_their_numbers() {
    let asset = uv_sets(&[0, 1, 2], 1);
    asset.loaded();
    let expected: Vec<_> = [0.0, 1.0, 2.0].map(|set| vec![Vec2::new(set, 0.5); 3]).into();
    assert_eq!(asset.primitive().uvs, expected);
}

#[test]
fn uv_sets_that_a_material_wants_and_a_primitive_lacks_are_zero() {
    let asset = uv_sets(&[], 1);
    assert_eq!(asset.primitive().uvs, [[Vec2::ZERO; 3], [Vec2::ZERO; 3]]);
    assert!(asset.warnings().contains("TEXCOORD_1 is missing"));
}

#[test]
fn uv_sets_of_absurd_number_are_ignored() {
    let asset = uv_sets(&[0, 4_000_000_000], 4_000_000_000);
    let imported = asset.load().unwrap();
    assert_eq!(imported.scene.meshes[0].primitives[0].uvs.len(), 1);
    assert_eq!(imported.scene.materials[0].textures().count(), 0);
    assert!(asset.warnings().contains("TEXCOORD_4000000000 is not read"));
}

#[test]
fn primitives_without_material_share_one_default() {
    let mut asset = Asset::triangle();
    asset.push("materials", json!({ "name": "other" }));
    let scene = asset.loaded().scene;
    assert_eq!(scene.materials.len(), 2);
    assert_eq!(scene.meshes[0].primitives[0].material, 1);
    assert_eq!(scene.materials[1], crate::scene::Material::default());
}
