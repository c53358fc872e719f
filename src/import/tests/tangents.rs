//! Generated and supplied tangents.

use super::builder::*;
use super::samples;
use crate::import::{ImportOptions, model_from_slice};
use crate::scene::Primitive;
use glam::{Vec3, Vec4};
use serde_json::json;

const SQUARE: [[f32; 3]; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]];

/// A square that faces +Z, with a normal texture; `uvs` as glTF has them, v downward.
fn square(uvs: &[[f32; 2]; 4]) -> Asset {
    let mut asset = Asset::of_primitive(|asset| {
        let positions = asset.floats(&SQUARE);
        let normals = asset.floats(&[[0.0, 0.0, 1.0]; 4]);
        let uvs = asset.floats(uvs);
        let indices = asset.indices(&[0, 1, 2, 2, 1, 3]);
        json!({ "indices": indices, "attributes": { "POSITION": positions, "NORMAL": normals, "TEXCOORD_0": uvs } })
    });
    let texture = asset.texture();
    asset.with_material(json!({ "normalTexture": { "index": texture } }))
}

const UPRIGHT: [[f32; 2]; 4] = [[0.0, 1.0], [1.0, 1.0], [0.0, 0.0], [1.0, 0.0]];

#[test]
fn tangents_point_toward_u_and_bitangents_up_in_the_picture() {
    let upright = square(&UPRIGHT);
    upright.loaded();
    let primitive = upright.primitive();
    assert_eq!(primitive.positions.len(), 4, "the corners are welded again");
    assert_eq!(primitive.tangents.unwrap(), [Vec4::new(1.0, 0.0, 0.0, 1.0); 4]);

    let mirrored = square(&UPRIGHT.map(|[u, v]| [1.0 - u, v])).primitive();
    assert_eq!(mirrored.tangents.unwrap(), [Vec4::new(-1.0, 0.0, 0.0, -1.0); 4]);
}

#[test]
fn tangents_follow_the_uv_set_of_the_normal_texture() {
    let mut asset = square(&UPRIGHT);
    let turned = asset.floats(&[[0.0, 0.0], [0.0, 1.0], [1.0, 0.0], [1.0, 1.0]]);
    asset.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_1"] = json!(turned);
    asset.json["materials"][0]["normalTexture"]["texCoord"] = json!(1);
    assert_eq!(asset.primitive().tangents.unwrap(), [Vec4::new(0.0, 1.0, 0.0, 1.0); 4]);
}

#[test]
fn supplied_tangents_are_kept_and_cleaned() {
    let mut asset = square(&UPRIGHT);
    let supplied = [[0.0, 1.0, 0.0, -1.0], [0.0, 2.0, 0.0, 1.0], [0.0; 4], [f32::NAN, 0.0, 0.0, 1.0]];
    let tangents = asset.floats(&supplied);
    asset.json["meshes"][0]["primitives"][0]["attributes"]["TANGENT"] = json!(tangents);
    let primitive = asset.primitive();
    let tangents = primitive.tangents.unwrap();
    assert_eq!(tangents[..2], [Vec4::new(0.0, 1.0, 0.0, -1.0), Vec4::new(0.0, 1.0, 0.0, 1.0)]);
    for tangent in &tangents[2..] {
        assert!((tangent.truncate().length() - 1.0).abs() < 1e-6 && tangent.z.abs() < 1e-6, "{tangent}");
    }
}

#[test]
fn no_geometry_gives_tangents_that_are_no_unit_vectors() {
    let degenerate = [[0.5, 0.5]; 4];
    let huge = [[0.0, 3e38], [3e38, 3e38], [0.0, 0.0], [3e38, 0.0]];
    let tiny = [[0.0, 1e-38], [1e-38, 1e-38], [0.0, 0.0], [1e-38, 0.0]];
    for uvs in [degenerate, huge, tiny] {
        for scale in [0.0, 1e-38, 1.0, 1e38] {
            let mut asset = square(&uvs);
            let positions = asset.floats(&SQUARE.map(|position| position.map(|x| x * scale)));
            asset.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = json!(positions);
            for tangent in asset.primitive().tangents.unwrap() {
                assert!((tangent.truncate().length() - 1.0).abs() < 1e-5, "{uvs:?} times {scale}: {tangent}");
                assert_eq!(tangent.w.abs(), 1.0);
            }
        }
    }
}

#[test]
fn a_vertex_shared_by_a_hundred_thousand_triangles_is_no_trap() {
    const SPOKES: u32 = 100_000;
    let mut asset = Asset::of_primitive(|asset| {
        let mut positions = vec![[0.0, 0.0, 0.0]];
        positions.extend((0..SPOKES).map(|i| {
            let (sin, cos) = (i as f32 / SPOKES as f32 * std::f32::consts::TAU).sin_cos();
            [cos, sin, 0.0]
        }));
        let uvs: Vec<_> = positions.iter().map(|&[x, y, _]| [x, -y]).collect();
        let normals = vec![[0.0, 0.0, 1.0]; positions.len()];
        let attributes = json!({
            "POSITION": asset.floats(&positions), "NORMAL": asset.floats(&normals), "TEXCOORD_0": asset.floats(&uvs)
        });
        json!({ "mode": 6, "attributes": attributes })
    });
    let texture = asset.texture();
    let primitive = asset.with_material(json!({ "normalTexture": { "index": texture } })).primitive();
    let tangents = primitive.tangents.unwrap();
    assert!(tangents.iter().all(|tangent| tangent.distance(Vec4::new(1.0, 0.0, 0.0, 1.0)) < 2e-2));
}

#[test]
fn triangles_without_area_take_the_tangents_of_their_vertices_in_linear_time() {
    const DEGENERATE: usize = 300_000;
    let mut asset = square(&UPRIGHT);
    let indices: Vec<u16> = [0, 1, 2, 2, 1, 3].into_iter().chain([0, 1, 1].repeat(DEGENERATE)).collect();
    asset.json["meshes"][0]["primitives"][0]["indices"] = json!(asset.indices(&indices));
    let primitive = asset.primitive();
    assert_eq!(primitive.indices.len(), indices.len());
    assert_eq!(primitive.positions.len(), 4);
    assert_eq!(primitive.tangents.unwrap(), [Vec4::new(1.0, 0.0, 0.0, 1.0); 4]);
}

/// Corner by corner: position, normal, tangent.
fn corners(primitive: &Primitive) -> Vec<(Vec3, Vec4)> {
    let tangents = primitive.tangents.as_ref().unwrap();
    primitive.indices.iter().map(|&index| (primitive.positions[index as usize], tangents[index as usize])).collect()
}

/// The model's supplied tangents were made with MikkTSpace by another program: ours must agree with them.
#[test]
fn generated_tangents_agree_with_those_of_another_program() {
    let Some(path) = samples::model("NormalTangentMirrorTest.glb") else { return };
    let bytes = std::fs::read(path).unwrap();
    let import = |bytes: &[u8]| {
        let imported = model_from_slice(bytes, "mirror", None, &ImportOptions::default()).unwrap();
        corners(&imported.scene.meshes[0].primitives[0])
    };
    // Renaming the attribute to a custom one of the same length hides it and moves no byte.
    let at = bytes.windows(9).position(|window| window == b"\"TANGENT\"").unwrap();
    let mut hidden = bytes.clone();
    hidden[at + 1..at + 8].copy_from_slice(b"_ANGENT");
    let (supplied, generated) = (import(&bytes), import(&hidden));
    assert_eq!(supplied.len(), generated.len());

    assert_ne!(supplied, generated, "the supplied tangents were not hidden");

    let mut least_cosine = 1.0_f32;
    for ((position, supplied), (same_position, generated)) in supplied.iter().zip(&generated) {
        assert_eq!(position, same_position);
        assert_eq!(supplied.w, generated.w, "at {position}");
        least_cosine = least_cosine.min(supplied.truncate().dot(generated.truncate()));
    }
    // Measured: 1 - 2.4e-7, the rounding of f32. Times four.
    assert!(least_cosine > 1.0 - 1e-6, "{least_cosine}");
}
