//! Uris: what is followed and what is not.

use super::builder::*;
use super::hostile::assert_clean;
use crate::import::{ImportError, ImportOptions, Imported, Limits, model_from_path};
use glam::Vec3;
use serde_json::json;
use std::fs;
use std::path::Path;

/// Imports a triangle whose buffer has this uri, from `folder`/model.gltf.
fn import(folder: &Path, uri: &str) -> Result<Imported, ImportError> {
    let mut asset = Asset::triangle();
    asset.json["buffers"] = json!([{ "byteLength": 36, "uri": uri }]);
    fs::write(folder.join("model.gltf"), asset.gltf()).unwrap();
    model_from_path(&folder.join("model.gltf"), &ImportOptions::default())
}

/// A temporary folder with a secret in it and, below, the folder of the model, which is returned too.
fn folders() -> (tempfile::TempDir, std::path::PathBuf) {
    let outside = tempfile::tempdir().unwrap();
    let folder = outside.path().join("model");
    fs::create_dir_all(folder.join("data")).unwrap();
    for path in [outside.path().join("secret.bin"), folder.join("a.bin"), folder.join("data/b c.bin")] {
        fs::write(path, bytes_of(TRIANGLE.as_flattened())).unwrap();
    }
    (outside, folder)
}

#[test]
fn uris_inside_the_folder_are_followed() {
    let (_outside, folder) = folders();
    for uri in ["a.bin", "./a.bin", "data/b%20c.bin", "data/b c.bin", "data/../a.bin", "%61.bin"] {
        let scene = import(&folder, uri).unwrap_or_else(|error| panic!("{error}")).scene;
        assert_eq!(scene.meshes[0].primitives[0].positions, [Vec3::ZERO, Vec3::X, Vec3::Y], "{uri}");
    }
}

#[test]
fn data_uris_are_followed_without_a_folder() {
    use base64::Engine;
    let bytes = bytes_of(TRIANGLE.as_flattened());
    let padded = base64::engine::general_purpose::STANDARD.encode(&bytes);
    let escaped: String = bytes.iter().map(|byte| format!("%{byte:02X}")).collect();
    for uri in [
        format!("data:application/octet-stream;base64,{padded}"),
        format!("DATA:;base64,{}", padded.trim_end_matches('=')),
        format!("data:,{escaped}"),
    ] {
        let mut asset = Asset::triangle();
        asset.json["buffers"] = json!([{ "byteLength": 36, "uri": uri }]);
        let scene = load(&asset.gltf()).unwrap().scene;
        assert_eq!(scene.meshes[0].primitives[0].positions, [Vec3::ZERO, Vec3::X, Vec3::Y], "{uri}");
    }
}

#[test]
fn uris_that_leave_the_folder_are_refused() {
    let (outside, folder) = folders();
    let secret = outside.path().join("secret.bin");
    let secret = secret.to_str().unwrap();
    let uris = [
        "../secret.bin".into(),
        "%2e%2e/secret.bin".into(),
        "data/../../secret.bin".into(),
        "..%2Fsecret.bin".into(),
        secret.to_owned(),
        secret.replace('/', "%2F"),
        format!("file://{secret}"),
        format!("FILE:{secret}"),
        format!("file%3A{secret}"),
        "//server/secret.bin".into(),
        "\\\\server\\secret.bin".into(),
        "C:\\secret.bin".into(),
        "http://localhost/secret.bin".into(),
        "/dev/zero".into(),
        String::new(),
        ".".into(),
        "data".into(),
        "missing.bin".into(),
        "a.bin%00".into(),
        "%C3%28.bin".into(),
    ];
    for uri in uris {
        let Err(error) = import(&folder, &uri) else { panic!("{uri} was followed") };
        assert_clean(&uri, &error, folder.join("model.gltf").to_str().unwrap());
        assert!(error.to_string().contains(": /buffers/0/uri: "), "{error}");
    }
}

#[cfg(unix)]
#[test]
fn links_out_of_the_folder_and_devices_are_refused() {
    use std::os::unix::fs::symlink;
    let (outside, folder) = folders();
    symlink(outside.path().join("secret.bin"), folder.join("link.bin")).unwrap();
    symlink(outside.path(), folder.join("up")).unwrap();
    symlink("/dev/zero", folder.join("zero")).unwrap();
    symlink(folder.join("a.bin"), folder.join("inside.bin")).unwrap();
    for uri in ["link.bin", "up/secret.bin", "zero"] {
        let error = import(&folder, uri).unwrap_err().to_string();
        assert!(error.contains("leads out of the model's folder"), "{uri}: {error}");
    }
    import(&folder, "inside.bin").unwrap();
}

#[test]
fn without_a_folder_no_file_is_read() {
    let mut asset = Asset::triangle();
    asset.json["buffers"] = json!([{ "byteLength": 36, "uri": "Cargo.toml" }]);
    let error = load(&asset.gltf()).unwrap_err().to_string();
    assert!(error.contains("/buffers/0/uri: \"Cargo.toml\" names a file, but the model has no folder"), "{error}");
}

#[test]
fn unreadable_models_are_one_line() {
    let folder = tempfile::tempdir().unwrap();
    let missing = folder.path().join("missing.glb");
    for path in [missing.as_path(), folder.path()] {
        let error = model_from_path(path, &ImportOptions::default()).unwrap_err().to_string();
        assert!(error.starts_with(&format!("{}: cannot be read: ", path.display())), "{error}");
        assert!(error.contains("; check the path"), "{error}");
    }
}

#[test]
fn the_budget_bounds_everything_that_is_decoded() {
    let asset = Asset::triangle();
    let import = |decoded_bytes: u64| {
        let options = ImportOptions { limits: Limits { decoded_bytes, ..Limits::default() }, ..Default::default() };
        crate::import::model_from_slice(&asset.gltf(), "model", None, &options)
    };
    assert!(import(10_000).is_ok());
    let error = import(40).unwrap_err().to_string();
    assert!(error.contains("needs more than is left of 40 bytes in all; reduce the model"), "{error}");
}

#[test]
fn progress_goes_through_two_stages() {
    #[derive(Default)]
    struct Log(std::sync::Mutex<Vec<(String, u64, u64)>>);
    impl crate::progress::Progress for Log {
        fn begin(&self, stage: &str, total: u64) {
            self.0.lock().unwrap().push((stage.into(), total, 0));
        }
        fn advance(&self, steps: u64) {
            self.0.lock().unwrap().last_mut().unwrap().2 += steps;
        }
    }
    let log = Log::default();
    let options = ImportOptions { progress: &log, ..Default::default() };
    crate::import::model_from_slice(&super::hostile::model().glb(), "model", None, &options).unwrap();
    let expected = [("read", 0, 0), ("decode", 3, 3)];
    assert_eq!(*log.0.lock().unwrap(), expected.map(|(stage, total, done)| (stage.to_owned(), total, done)));
}
