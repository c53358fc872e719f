//! The rules of the house: who may import whom, where a thing may be said, and how long a file may be.

mod tree;

use crate::shaders::{display_features, forward_features, term_features};
use specula::proof;
use specula::shader::{
    Backdrop, SOURCES, Seen, ShaderSources, TargetLight, background_module_into, covered_module, deferred_module,
    display_module, forward_module, over_module, present_module, visibility_module,
};
use std::collections::BTreeSet;
use tree::{File, exists, files, names_after, read, words};

/// A module of the crate and the modules that it may import.
const LAYERS: &[(&str, &[&str])] = &[
    // Plain data.
    ("math", &[]),
    ("progress", &[]),
    // Loops, on as many threads as the crate may have.
    ("threads", &[]),
    // Quantities of light, with units in their types.
    ("radiometry", &["math"]),
    ("scene", &["math", "radiometry"]),
    ("import", &["math", "progress", "scene", "threads"]),
    // The float64 truth, and what is made from it. The renderer reads the baked tables and never the truth.
    ("reference", &["math", "progress", "scene", "threads"]),
    ("bake", &["math", "progress", "reference", "scene", "threads"]),
    // What was baked, in files: the only part below the program that writes any.
    ("cache", &["bake", "progress", "scene"]),
    // How far two pictures are apart.
    ("metrics", &["math", "scene", "threads"]),
    // What will be drawn, on the CPU.
    ("shader", &["math", "scene"]),
    ("frame", &["math", "scene", "shader"]),
    // The device and what is on it.
    ("gpu", &["math", "shader"]),
    ("gpu_scene", &["frame", "gpu", "math", "scene", "shader", "threads"]),
    ("passes", &["frame", "gpu", "gpu_scene", "math", "scene", "shader"]),
    ("renderer", &["bake", "frame", "gpu", "gpu_scene", "math", "passes", "scene", "shader"]),
    ("capture", &["frame", "gpu", "gpu_scene", "math", "passes", "renderer", "scene"]),
    // Scenes of a host, edited while they are shown.
    ("embed", &["gpu", "gpu_scene", "renderer", "scene"]),
    // What the shaders are held to: WGSL beside the truth, on a device.
    ("proof", &["bake", "gpu", "gpu_scene", "math", "progress", "reference", "renderer", "scene", "shader"]),
    // The program: everything.
    ("clock", &[]),
    ("output", &[]),
    ("parallel", &[]),
    ("app", VIEWER),
    ("cli", EVERYTHING),
    ("lib", EVERYTHING),
];

/// What the viewer is made of; the command line starts it and is not known to it.
const VIEWER: &[&str] = &[
    "bake",
    "cache",
    "capture",
    "clock",
    "frame",
    "gpu",
    "gpu_scene",
    "import",
    "math",
    "metrics",
    "output",
    "parallel",
    "passes",
    "progress",
    "reference",
    "renderer",
    "scene",
    "shader",
];

const EVERYTHING: &[&str] = &[
    "app",
    "bake",
    "cache",
    "capture",
    "cli",
    "clock",
    "embed",
    "frame",
    "gpu",
    "gpu_scene",
    "import",
    "math",
    "metrics",
    "output",
    "parallel",
    "passes",
    "progress",
    "proof",
    "radiometry",
    "reference",
    "renderer",
    "scene",
    "shader",
];

/// Crates that the root re-exports; [`WITHOUT_GPU`] says who may use them.
const RE_EXPORTED: [&str; 2] = ["glam", "wgpu"];

/// Text that only code below the given paths may contain.
const CONFINED: &[(&str, &[&str])] = &[
    ("TextureFormat::", &["src/gpu/formats.rs"]),
    ("create_shader_module", &["src/shader/"]),
    ("create_bind_group_layout", &["src/gpu/bindings.rs"]),
    ("clap", &["src/cli", "src/main.rs"]),
    ("indicatif", &["src/cli", "src/main.rs"]),
    ("winit", &["src/app"]),
    ("egui", &["src/app"]),
];

/// Modules that know nothing of a GPU.
const WITHOUT_GPU: [&str; 9] =
    ["math", "progress", "scene", "import", "reference", "bake", "cache", "metrics", "frame"];

/// What passes share.
const SHARED_BY_PASSES: [&str; 1] = ["ForwardTarget"];

const LONGEST_FILE: usize = 600;

fn assert_none(offences: &[String]) {
    assert!(offences.is_empty(), "\n{}", offences.join("\n"));
}

#[test]
fn modules_import_only_the_layers_below() {
    let mut offences = Vec::new();
    let mut imports = 0;
    for file in files("src", "rs") {
        // The program sees the library from outside.
        let (module, prefix) =
            if file.path == "src/main.rs" { ("cli", "specula::") } else { (file.module(), "crate::") };
        let Some((_, allowed)) = LAYERS.iter().find(|(name, _)| *name == module) else {
            offences.push(format!("{}: the module {module} has no place in LAYERS", file.path));
            continue;
        };
        for name in names_after(&file.code(), prefix) {
            imports += 1;
            let is_module = name.starts_with(|c: char| c.is_lowercase()) && !RE_EXPORTED.contains(&name.as_str());
            if is_module && name != module && !allowed.contains(&name.as_str()) {
                offences.push(format!("{}: {module} may not import {name}", file.path));
            }
        }
    }
    assert_none(&offences);
    assert!(imports > 50, "only {imports} imports were found: is the search broken?");
}

#[test]
fn no_module_reaches_the_root_by_super() {
    let too_high = |code: &str, depth: usize| code.contains(&"super::".repeat(depth));
    // Unit tests at the end of a file are one module deeper.
    let leaves = |file: &File| too_high(&file.shipped_code(), file.depth()) || too_high(&file.code(), file.depth() + 1);
    let offenders = files("src", "rs").into_iter().filter(leaves).map(|file| file.path);
    assert_none(&offenders.collect::<Vec<_>>());
}

#[test]
fn passes_do_not_know_each_other() {
    let mut offences = Vec::new();
    for file in files("src/passes", "rs").iter().filter(|file| !file.path.ends_with("/mod.rs")) {
        let code = file.shipped_code();
        let names = [names_after(&code, "super::"), names_after(&code, "crate::passes::")].concat();
        let foreign = names.iter().filter(|name| !SHARED_BY_PASSES.contains(&name.as_str()));
        offences.extend(foreign.map(|name| format!("{}: uses {name}", file.path)));
    }
    assert_none(&offences);
}

#[test]
fn plain_data_and_truth_know_nothing_of_a_gpu() {
    let mentions = |file: &File| WITHOUT_GPU.contains(&file.module()) && words(&file.text).any(|word| word == "wgpu");
    let offenders = files("src", "rs").into_iter().filter(mentions).map(|file| file.path);
    assert_none(&offenders.collect::<Vec<_>>());
}

#[test]
fn some_things_are_said_in_one_place() {
    let mut offences = Vec::new();
    for file in files("src", "rs") {
        let code = file.code();
        for (text, places) in CONFINED {
            let allowed = places.iter().any(|place| file.path.starts_with(place));
            if !allowed && code.contains(text) {
                offences.push(format!("{}: `{text}` belongs to {}", file.path, places.join(" and ")));
            }
        }
    }
    assert_none(&offences);
}

#[test]
fn every_shader_file_is_embedded_and_part_of_some_module() {
    let sources = ShaderSources::default();
    let on_disk: BTreeSet<String> =
        files("shaders", "wgsl").into_iter().map(|file| file.path.trim_start_matches("shaders/").to_owned()).collect();
    let embedded: BTreeSet<String> = SOURCES.iter().map(|(path, _)| (*path).to_owned()).collect();
    let of_proofs: BTreeSet<String> = proof::SOURCES.iter().map(|(path, _)| (*path).to_owned()).collect();
    assert_eq!(on_disk, &embedded | &of_proofs, "files under shaders/, and files in SOURCES");
    let is_apart = |path: &String| path.starts_with("naive/") || path.starts_with("proof/");
    assert!(of_proofs.iter().all(is_apart) && !embedded.iter().any(is_apart), "proofs have folders of their own");

    let mut modules = vec![present_module(&sources).unwrap()];
    let forward = [forward_features(), term_features()].concat();
    modules.extend(forward.iter().map(|features| forward_module(&sources, features).unwrap()));
    modules.extend(display_features().into_iter().map(|features| display_module(&sources, features).unwrap()));
    let lights = display_features().into_iter().map(TargetLight::Display).chain([TargetLight::Radiance]);
    let backdrops = [Backdrop::Sharp, Backdrop::Blurred];
    let backgrounds = lights.flat_map(|light| backdrops.map(|backdrop| (backdrop, light)));
    modules.extend(backgrounds.map(|(backdrop, light)| background_module_into(&sources, backdrop, light).unwrap()));
    for under in [false, true] {
        let seen = Seen { samples: 4, under };
        modules.extend(forward.iter().step_by(50).map(|features| deferred_module(&sources, features, seen).unwrap()));
        modules.push(covered_module(&sources, seen).unwrap());
    }
    modules.extend([over_module(&sources, 4).unwrap(), visibility_module(&sources).unwrap()]);
    let used: BTreeSet<&str> = modules.iter().flat_map(|module| module.files()).collect();
    let unused: Vec<&String> = embedded.iter().filter(|path| !used.contains(path.as_str())).collect();
    assert!(unused.is_empty(), "no module contains {unused:?}");
}

#[test]
fn only_passes_have_entry_points() {
    let has_entry_point = |text: &str| ["@vertex", "@fragment", "@compute"].iter().any(|stage| text.contains(stage));
    let misplaced = SOURCES.iter().filter(|(path, text)| has_entry_point(text) && !path.starts_with("pass/"));
    assert_none(&misplaced.map(|(path, _)| (*path).to_owned()).collect::<Vec<_>>());
    assert!(SOURCES.iter().any(|(_, text)| has_entry_point(text)), "no entry point was found: is the search broken?");
}

/// All that is written here.
fn written() -> Vec<File> {
    [("src", "rs"), ("tests", "rs"), ("shaders", "wgsl")].iter().flat_map(|(folder, end)| files(folder, end)).collect()
}

#[test]
fn files_are_short() {
    let long = |file: &File| file.text.lines().count() > LONGEST_FILE;
    let offenders = written().into_iter().filter(long).map(|file| format!("{} is too long", file.path));
    assert_none(&offenders.collect::<Vec<_>>());
}

/// It means alpha in one renderer and its square root in another; it is `perceptual_roughness` or `alpha` here.
#[test]
fn the_bare_word_roughness_is_avoided() {
    // Names that glTF and its crate gave.
    let given = ["roughness_factor", "roughnessFactor"];
    let qualifiers = ["perceptual", "metallic"];
    let mut offences = Vec::new();
    for file in written().iter().filter(|file| file.path.starts_with("src/") || file.path.starts_with("shaders/")) {
        let mut before = "";
        for word in words(&file.text) {
            let lower = word.to_lowercase();
            let bare = lower == "roughness" || lower.starts_with("roughness_") || lower.ends_with("_roughness");
            let qualified = |q: &str| before.eq_ignore_ascii_case(q) || lower.contains(&format!("{q}_roughness"));
            if bare && !qualifiers.into_iter().any(qualified) && !given.contains(&word) {
                offences.push(format!("{}: {before} {word}", file.path));
            }
            before = word;
        }
    }
    assert_none(&offences);
}

#[test]
fn nothing_has_to_be_kept_equal_by_hand() {
    let plea = concat!("in ", "sync");
    let pleads = |file: &File| file.text.to_lowercase().contains(plea);
    let offenders = written().into_iter().filter(pleads).map(|file| format!("{} says `{plea}`", file.path));
    assert_none(&offenders.collect::<Vec<_>>());
}

#[test]
fn tests_start_the_program_in_one_place() {
    // It keeps them away from the cache of whoever runs the tests.
    let variable = concat!("CARGO_BIN", "_EXE");
    let starts = |file: &File| file.path != "tests/suite/support.rs" && file.text.contains(variable);
    let offenders = files("tests", "rs").into_iter().filter(starts);
    assert_none(&offenders.map(|file| format!("{}: use support::program", file.path)).collect::<Vec<_>>());
}

#[test]
fn paths_in_the_architecture_document_exist() {
    let text = read("ARCHITECTURE.md").expect("ARCHITECTURE.md is at the root");
    let roots = ["src/", "shaders/", "tests/", "docs/", "assets/", "scripts/", "examples/", "benches/", ".ci/"];
    let quoted: Vec<&str> = text.split('`').skip(1).step_by(2).collect();
    let paths: Vec<&str> = quoted
        .into_iter()
        .filter(|path| roots.iter().any(|root| path.starts_with(root)) && !path.contains(' '))
        .collect();
    assert!(!paths.is_empty(), "ARCHITECTURE.md names no path");
    let missing = paths.iter().filter(|path| !exists(path)).map(|path| format!("{path} does not exist"));
    assert_none(&missing.collect::<Vec<_>>());
}
