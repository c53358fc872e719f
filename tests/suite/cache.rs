//! Prefiltered environments that are kept from one run of the program to the next.

use crate::support::program;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// A sky of two colours with a sun, as Radiance HDR.
fn panorama(folder: &Path) -> PathBuf {
    let texel = |x: u32, y: u32| match (x, y) {
        (40, 20) => [2e4, 1.8e4, 1.5e4],
        (_, 32..) => [0.2, 0.15, 0.1],
        _ => [0.3, 0.5, 0.9],
    };
    let image = image::Rgb32FImage::from_fn(128, 64, |x, y| image::Rgb(texel(x, y)));
    let path = folder.join("sky.hdr");
    image.save(&path).unwrap();
    path
}

/// One run in `folder` with its cache below `cache`.
fn render(folder: &Path, cache: &Path, name: &str, more: &[&str]) -> Command {
    let mut command = program();
    let path = |end: &str| folder.join(format!("{name}.{end}"));
    command.args(["render", "assets/showcase.glb", "--size", "48x36", "--precision", "float", "--env"]);
    command.arg(folder.join("sky.hdr")).arg("-o").arg(path("exr")).arg("--stats").arg(path("json")).args(more);
    command.env("SPECULA_CACHE_DIR", cache).stderr(Stdio::piped());
    command
}

/// What the cache had to do with the run, the picture, and what the program said.
fn run(folder: &Path, cache: &Path, name: &str, more: &[&str]) -> (String, Vec<u8>, String) {
    let output = render(folder, cache, name, more).output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{said}");
    (used(folder, name), std::fs::read(folder.join(format!("{name}.exr"))).unwrap(), said)
}

fn used(folder: &Path, name: &str) -> String {
    let text = std::fs::read(folder.join(format!("{name}.json"))).unwrap();
    let stats: serde_json::Value = serde_json::from_slice(&text).unwrap();
    stats["gpu"]["environment_cache"].as_str().unwrap_or("null").to_owned()
}

fn files(cache: &Path) -> Vec<PathBuf> {
    std::fs::read_dir(cache.join("environments")).unwrap().map(|file| file.unwrap().path()).collect()
}

#[test]
fn pictures_are_the_same_with_and_without_the_cache() {
    let temporary = tempfile::tempdir().unwrap();
    let (folder, cache) = (temporary.path(), temporary.path().join("cache"));
    panorama(folder);
    let without = run(folder, &cache, "without", &["--no-cache"]);
    assert!(without.0 == "off" && !cache.exists());
    let cold = run(folder, &cache, "cold", &[]);
    let warm = run(folder, &cache, "warm", &[]);
    assert_eq!((cold.0.as_str(), warm.0.as_str()), ("stored", "hit"));
    assert!(cold.1 == without.1 && warm.1 == without.1, "pictures differ");

    let [file] = files(&cache).try_into().unwrap();
    let mut bytes = std::fs::read(&file).unwrap();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 0x40;
    std::fs::write(&file, &bytes).unwrap();
    let mended = run(folder, &cache, "mended", &["-v"]);
    assert!(mended.0 == "stored" && mended.1 == without.1 && !mended.2.contains("kept"), "{}", mended.2);
    assert_eq!(run(folder, &cache, "again", &[]).0, "hit");

    // Rotation and intensity are applied to what is kept; a black one needs nothing.
    let turned = run(folder, &cache, "turned", &["--env-rotation", "40", "--env-intensity", "2"]);
    assert!(turned.0 == "hit" && turned.1 != without.1);
    assert_eq!(run(folder, &cache, "dark", &["--env-intensity", "0"]).0, "null");
    assert_eq!(run(folder, &cache, "split-sum", &["--quality", "split-sum"]).0, "stored");
    assert_eq!(files(&cache).len(), 2);
}

#[test]
fn a_cache_that_cannot_be_is_told_of_only_when_asked() {
    let temporary = tempfile::tempdir().unwrap();
    let (folder, cache) = (temporary.path(), temporary.path().join("cache"));
    panorama(folder);
    std::fs::write(&cache, b"mine").unwrap();
    let plain = run(folder, &cache, "plain", &[]);
    let verbose = run(folder, &cache, "verbose", &["-v"]);
    let without = run(folder, &cache, "without", &["--no-cache", "-v"]);
    assert_eq!((plain.0.as_str(), verbose.0.as_str(), without.0.as_str()), ("unavailable", "unavailable", "off"));
    assert!(plain.1 == without.1 && verbose.1 == without.1, "pictures differ");
    let warning = "the environment is not kept for the next time";
    let told = |said: &str| said.matches(warning).count();
    assert_eq!((told(&plain.2), told(&verbose.2), told(&without.2)), (0, 1, 0), "{}", verbose.2);
    assert_eq!(std::fs::read(&cache).unwrap(), b"mine");
}

#[test]
fn processes_share_the_cache() {
    let temporary = tempfile::tempdir().unwrap();
    let (folder, cache) = (temporary.path(), temporary.path().join("cache"));
    panorama(folder);
    let names = ["a", "b", "c", "d"];
    let running: Vec<_> = names.iter().map(|name| render(folder, &cache, name, &[]).spawn().unwrap()).collect();
    for process in running {
        let output = process.wait_with_output().unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    }
    let picture = |name: &str| std::fs::read(folder.join(format!("{name}.exr"))).unwrap();
    for name in names {
        assert!(["stored", "hit"].contains(&used(folder, name).as_str()), "{name}: {}", used(folder, name));
        assert!(picture(name) == picture("a"), "{name}");
    }
    assert_eq!(files(&cache).len(), 1);
    assert_eq!(run(folder, &cache, "last", &[]).0, "hit");
}
