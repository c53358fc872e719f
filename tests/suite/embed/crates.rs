//! What the library brings into somebody's program, as docs/embedding.md says.

use std::collections::BTreeSet;
use std::process::Command;

/// Names of all crates that a build with these features has on this system.
fn crates(features: &[&str]) -> BTreeSet<String> {
    let mut cargo = Command::new(env!("CARGO"));
    cargo.current_dir(env!("CARGO_MANIFEST_DIR"));
    cargo.args(["tree", "--offline", "--package", "specula", "-e", "normal", "--prefix", "none", "--no-dedupe"]);
    let output = cargo.args(features).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8(output.stdout).unwrap();
    text.lines().filter(|line| !line.is_empty()).map(str::to_owned).collect()
}

#[test]
fn the_library_alone_has_no_window_no_program_and_no_threads() {
    let alone = crates(&["--no-default-features"]);
    let named = |name: &str| alone.iter().find(|line| line.split(' ').next() == Some(name));
    for unwanted in ["winit", "egui", "clap", "rayon", "rayon-core", "tempfile", "notify", "indicatif", "toml"] {
        assert_eq!(named(unwanted), None);
    }
    assert!(named("wgpu").is_some() && named("glam").is_some(), "{alone:?}");
}

/// Other systems have other windows, and other drivers.
#[cfg(target_os = "linux")]
#[test]
fn the_page_says_how_many_crates_there_are() {
    let counts = [crates(&["--no-default-features"]).len(), crates(&[]).len()];
    let page = include_str!("../../../docs/embedding.md");
    let said = format!("{} crates; {} with default features", counts[0], counts[1]);
    assert!(page.contains(&said), "docs/embedding.md does not say \"{said}\"");
}
