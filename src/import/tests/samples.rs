//! The sample models. They lie outside the repository; without them these tests are skipped.

#![expect(clippy::print_stdout, reason = "skipped tests and load times are read from the log")]

use crate::import::{ImportError, ImportOptions, Imported, model_from_path};
use std::path::PathBuf;
use std::time::Instant;

/// The folder of the samples. A skipped test is a failure where CI=true.
fn folder() -> Option<PathBuf> {
    let beside = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../shared/samples");
    let folder = std::env::var_os("SPECULA_SAMPLES").map_or(beside, PathBuf::from);
    if folder.is_dir() {
        return Some(folder);
    }
    assert!(std::env::var("CI").as_deref() != Ok("true"), "the samples are missing: set SPECULA_SAMPLES");
    println!("skipped: no samples; set SPECULA_SAMPLES");
    None
}

pub(crate) fn model(name: &str) -> Option<PathBuf> {
    Some(folder()?.join("models").join(name))
}

pub(super) fn environment(name: &str) -> Option<PathBuf> {
    Some(folder()?.join("env").join(name))
}

fn import(name: &str) -> Option<Result<Imported, ImportError>> {
    let path = model(name)?;
    let start = Instant::now();
    let result = model_from_path(&path, &ImportOptions::default());
    println!("{name}: {:.3} s", start.elapsed().as_secs_f64());
    match &result {
        Ok(imported) => imported.warnings.iter().for_each(|warning| println!("  {warning}")),
        Err(error) => println!("  {error}"),
    }
    Some(result)
}

/// Name, vertices, indices of all meshes together, materials, images.
const MODELS: [(&str, [usize; 4]); 10] = [
    ("DamagedHelmet.glb", [14556, 46356, 1, 5]),
    ("FlightHelmet/FlightHelmet.gltf", [55392, 284166, 6, 15]),
    ("NormalTangentTest.glb", [3983, 23322, 1, 3]),
    ("NormalTangentMirrorTest.glb", [2770, 15720, 1, 3]),
    ("Lights.glb", [24, 36, 1, 0]),
    ("Fox.glb", [1728, 1728, 1, 1]),
    ("PrimitiveModeNormalsTest.glb", [1053242, 1580534, 3, 1]),
    ("MorphStressTest.gltf", [1528, 7236, 2, 3]),
    ("SimpleSkin.gltf", [24, 24, 1, 0]),
    ("Soldier.glb", [7563, 34128, 2, 2]),
];

#[test]
fn sample_models_load() {
    for (name, expected) in MODELS {
        let Some(result) = import(name) else { return };
        let scene = result.unwrap().scene;
        let primitives = || scene.meshes.iter().flat_map(|mesh| &mesh.primitives);
        let found = [
            primitives().map(|primitive| primitive.positions.len()).sum(),
            primitives().map(|primitive| primitive.indices.len()).sum(),
            scene.materials.len(),
            scene.images.len(),
        ];
        check_promises(name, &scene);
        assert_eq!(found, expected, "{name}");
    }
}

/// What the types of the scene promise to their readers.
fn check_promises(name: &str, scene: &crate::scene::Scene) {
    assert!(!scene.bounds().is_empty(), "{name}");
    for primitive in scene.meshes.iter().flat_map(|mesh| &mesh.primitives) {
        let count = primitive.positions.len();
        assert!(primitive.indices.iter().all(|&index| (index as usize) < count), "{name}");
        let material = &scene.materials[primitive.material];
        for (slot, texture) in material.textures() {
            assert!(primitive.uvs[texture.uv_set as usize].len() == count, "{name}: {slot:?}");
            assert!(scene.textures[texture.texture].image < scene.images.len(), "{name}: {slot:?}");
        }
        let Some(normals) = &primitive.normals else { continue };
        assert!(normals.iter().all(|normal| (normal.length() - 1.0).abs() < 1e-4), "{name}");
        let has_normal_texture = material.texture(crate::scene::TextureSlot::Normal).is_some();
        assert!(primitive.tangents.is_some() || !has_normal_texture, "{name}");
    }
}

#[test]
fn an_instanced_sample_model_is_placed_by_its_extension() {
    let Some(result) = import("simple-instancing.glb") else { return };
    let Imported { scene, warnings, .. } = result.unwrap();
    check_promises("simple-instancing.glb", &scene);
    assert!(warnings.is_empty(), "{warnings:?}");
    let placed = scene.nodes.iter().filter_map(|node| node.node_from_objects.as_ref()).map(Vec::len);
    assert_eq!(placed.collect::<Vec<_>>(), [125]);
    assert_eq!(scene.instances().len(), 125);
}

#[test]
fn sample_models_with_extensions_load_or_say_what_they_need() {
    for (name, needs) in [
        ("heart_draco.glb", "/extensionsRequired/0: the file requires the extension \"KHR_draco_mesh_compression\""),
        ("carbon-sphere.glb", "/extensionsRequired/0: the file requires the extension \"KHR_draco_mesh_compression\""),
        ("pirate.glb", "/extensionsRequired/1: the file requires the extension \"EXT_meshopt_compression\""),
        ("AnisotropyBarnLamp/AnisotropyBarnLamp.gltf", "is KTX2, which is not supported"),
    ] {
        let Some(result) = import(name) else { return };
        let error = result.unwrap_err().to_string();
        assert!(error.contains(needs) && error.contains("; "), "{error}");
    }
    for (name, ignored) in [
        ("ClearCoatTest.glb", "KHR_materials_clearcoat"),
        ("AttenuationTest.glb", "KHR_materials_volume"),
        ("dispersion-test.glb", "KHR_materials_dispersion"),
    ] {
        let Some(result) = import(name) else { return };
        let imported = result.unwrap();
        check_promises(name, &imported.scene);
        let warned = imported.warnings.iter().any(|warning| warning.to_string().contains(ignored));
        assert!(warned, "{name}: {:?}", imported.warnings);
    }
}
