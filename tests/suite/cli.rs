//! The program as its users start it.

use crate::support::{program, samples};
use std::path::Path;
use std::process::{Output, Stdio};

const SHOWCASE: &str = "assets/showcase.glb";

pub(crate) fn specula(arguments: &[&str]) -> Output {
    program().args(arguments).output().unwrap()
}

/// stderr without what the driver says on its own.
pub(crate) fn stderr(output: &Output) -> String {
    let text = String::from_utf8_lossy(&output.stderr);
    text.lines().filter(|line| !line.contains("XDG_RUNTIME_DIR")).map(|line| format!("{line}\n")).collect()
}

pub(crate) fn assert_fails(arguments: &[&str], code: i32, expected: &str) {
    let output = specula(arguments);
    let error = stderr(&output);
    assert_eq!(output.status.code(), Some(code), "{arguments:?}: {error}");
    assert!(error.contains(expected), "{arguments:?}: {error:?} does not say {expected:?}");
    assert!(output.stdout.is_empty(), "{arguments:?}: stdout is not empty");
}

#[test]
fn a_picture_is_written_and_reported() {
    let folder = tempfile::tempdir().unwrap();
    let [png, exr, stats] = ["a.png", "a.exr", "a.json"].map(|name| folder.path().join(name).display().to_string());
    let output = specula(&["render", SHOWCASE, "-o", &png, "--size", "80x60", "--stats", &stats]);
    assert!(output.status.success(), "{}", stderr(&output));
    assert_eq!(image::open(&png).unwrap().to_rgba8().dimensions(), (80, 60));
    let stats: serde_json::Value = serde_json::from_slice(&std::fs::read(&stats).unwrap()).unwrap();
    assert!(stats["gpu"]["draws"].as_u64() > Some(10) && stats["adapter"]["name"].is_string(), "{stats}");
    let placements = &stats["gpu"]["placements"];
    let count = |key: &str| placements[key].as_u64().unwrap();
    assert!(
        count("all") > 10 && count("drawn") + count("outside") + count("between_samples") == count("all"),
        "{stats}"
    );
    for stage in ["decode", "environment bake", "device", "upload", "pipelines", "first frame", "readback", "encode"] {
        let mut stages = stats["milliseconds"].as_array().unwrap().iter();
        assert!(stages.any(|entry| entry["stage"] == stage), "{stage} is missing in {stats}");
    }

    let output = specula(&["render", SHOWCASE, "-o", &exr, "--size", "80x60", "--json", "--precision", "float"]);
    assert!(output.status.success(), "{}", stderr(&output));
    let json: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(json["renderer"], "gpu");
    assert!(std::fs::read(&exr).unwrap().starts_with(&[0x76, 0x2f, 0x31, 0x01]), "no OpenEXR file");
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 3);
}

#[test]
fn a_state_stands_for_all_flags_of_the_picture() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).display().to_string();
    let (state, by_state, by_flags) = (path("state.json"), path("state.png"), path("flags.png"));
    let text = r#"{"schema": "specula-state/1", "model": "assets/spheres.glb", "size_px": [64, 48],
        "camera": {"pose": {"file": 0}, "fov_deg": 35.0, "orthographic": false},
        "look": {"exposure_ev": 1.0, "tone_map": "aces", "background": "transparent", "energy_compensation": true,
            "geometry": "smith-correlated", "quality": "draft", "debug_view": "none"},
        "environment": {"source": "neutral", "rotation_deg": 90.0, "intensity": 0.5}}"#;
    std::fs::write(&state, text).unwrap();
    let render = |arguments: &[&str]| {
        let output = specula(arguments);
        assert!(output.status.success(), "{}", stderr(&output));
    };
    // The showcase has a camera; a model that is named takes the place of the state's.
    render(&["render", "--state", &state, SHOWCASE, "-o", &by_state]);
    let look = ["--exposure", "1", "--tone-map", "aces", "--background", "transparent", "--quality", "draft"];
    let light = ["--env-rotation", "90", "--env-intensity", "0.5", "--size", "64x48", "--camera", "0"];
    render(&[&["render", SHOWCASE, "-o", &by_flags], &look[..], &light].concat());
    assert_eq!(std::fs::read(&by_state).unwrap(), std::fs::read(&by_flags).unwrap());
    render(&["render", "--state", &state, "-o", &by_state]);
    assert_ne!(std::fs::read(&by_state).unwrap(), std::fs::read(&by_flags).unwrap());

    assert_fails(&["render", "-o", &by_state], 2, "<MODEL>");
    assert_fails(&["render", "--state", &state, "--exposure", "1", "-o", &by_state], 2, "cannot be used with");
    assert_fails(&["render", "--state", "no/such.json", "-o", &by_state], 2, "no/such.json: cannot read");
}

#[test]
fn models_and_pictures_go_through_pipes() {
    let model = std::fs::File::open(SHOWCASE).unwrap();
    let output = program()
        .args(["render", "-", "-o", "-", "--size", "40x30", "--background", "transparent"])
        .stdin(Stdio::from(model))
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", stderr(&output));
    let picture = image::load_from_memory(&output.stdout).unwrap().to_rgba8();
    assert_eq!(picture.dimensions(), (40, 30));
}

#[test]
fn without_an_adapter_the_reference_draws() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("a.png").display().to_string();
    let run = |more: &[&str]| {
        let arguments = ["render", SHOWCASE, "-o", &out, "--size", "32x24", "--samples", "4"];
        program()
            .args(arguments.iter().chain(more))
            .env("VK_DRIVER_FILES", "/nonexistent")
            .env("VK_ICD_FILENAMES", "/nonexistent")
            .env("WGPU_BACKEND", "vulkan")
            .output()
            .unwrap()
    };
    let output = run(&[]);
    assert!(output.status.success(), "{}", stderr(&output));
    assert!(stderr(&output).contains("the CPU reference renderer draws instead"), "{}", stderr(&output));
    assert_eq!(image::open(&out).unwrap().to_rgba8().dimensions(), (32, 24));
    let output = run(&["--require-gpu"]);
    assert_eq!(output.status.code(), Some(3), "{}", stderr(&output));
}

#[test]
fn mistakes_get_one_line_and_leave_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("a.png").display().to_string();
    let broken = folder.path().join("broken.glb");
    std::fs::write(&broken, b"glTF\x02\0\0\0").unwrap();
    let broken = broken.display().to_string();
    let render = |model, more: &[&'static str]| {
        let base = vec!["render", model, "-o", &out, "--size", "16x16"];
        base.into_iter().chain(more.iter().copied()).collect::<Vec<&str>>()
    };
    assert_fails(&render("no/such.glb", &[]), 2, "no/such.glb");
    assert_fails(&render(&broken, &[]), 2, "broken.glb: ");
    assert_fails(&render(SHOWCASE, &["--camera", "nobody"]), 2, "no such camera");
    assert_fails(&render(SHOWCASE, &["--scene", "nowhere"]), 2, "nowhere");
    assert_fails(&render(SHOWCASE, &["--env", "no.hdr"]), 2, "no.hdr");
    assert_fails(&render(SHOWCASE, &["--orbit", "1,2,-3"]), 2, "RADIUS");
    assert_fails(&render(SHOWCASE, &["--fov", "180"]), 2, "--fov");
    assert_fails(&render(SHOWCASE, &["--msaa", "3"]), 2, "samples");
    assert_fails(&render(SHOWCASE, &["--override", "nobody.metallic=1"]), 2, "nobody");
    assert_fails(&render(SHOWCASE, &["--adapter", "no such adapter", "--require-gpu"]), 3, "no such adapter");
    assert_fails(&["render", SHOWCASE, "-o", "a.bmp"], 2, "a.bmp");
    assert_fails(&["render", SHOWCASE, "-o", "-", "--json"], 2, "stdout");
    assert!(!Path::new(&out).exists());
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1, "something was left behind");
}

#[test]
fn the_embedded_tables_are_what_bake_makes() {
    assert!(specula(&["bake", "--check"]).status.success());
}

#[test]
fn stability_is_reported_as_a_document_as_json_and_as_files() {
    let few = ["stability", "--evaluations", "4096"];
    let output = specula(&few);
    assert!(output.status.success(), "{}", stderr(&output));
    assert!(String::from_utf8_lossy(&output.stdout).starts_with("# Numerical stability"));
    let output = specula(&[few.as_slice(), &["--json", "--seed", "7"]].concat());
    let json: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!((&json["schema"], &json["fuzz"]["seed"]), (&"specula.stability.1".into(), &7.into()));
    let folder = tempfile::tempdir().unwrap();
    let output = specula(&[few.as_slice(), &["--write", &folder.path().display().to_string()]].concat());
    assert!(output.status.success() && output.stdout.is_empty(), "{}", stderr(&output));
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 2);
    assert_fails(&["stability", "--adapter", "no such adapter"], 3, "no such adapter");
}

#[test]
fn every_used_shader_is_dumped() {
    let [lit, over, display] = ["forward+lit+environment+standard", "over.4", "display+neutral"];
    let deferred = "deferred.4+lit+environment+standard";
    for (path, used, unused) in [("forward", [lit, display], over), ("deferred", [deferred, over], lit)] {
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path().join("a.png").display().to_string();
        let dump = folder.path().join("wgsl");
        let dump_text = dump.display().to_string();
        let arguments = ["render", SHOWCASE, "-o", &out, "--size", "16x16", "--path", path, "--dump-wgsl", &dump_text];
        let output = specula(&arguments);
        assert!(output.status.success(), "{}", stderr(&output));
        let files = std::fs::read_dir(dump).unwrap();
        let names: Vec<String> = files.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        let is_there = |name: &str| names.contains(&format!("{name}.wgsl"));
        assert!(used.into_iter().all(is_there) && !is_there(unused), "{path}: {names:?}");
    }
}

#[test]
fn unsupported_samples_say_what_they_need() {
    let Some(root) = samples() else { return };
    let model = root.join("models/heart_draco.glb").display().to_string();
    assert_fails(&["render", &model, "-o", "x.png"], 2, "KHR_draco_mesh_compression");
}

#[test]
fn the_reference_stops_at_an_error_and_writes_it() {
    let folder = tempfile::tempdir().unwrap();
    let [out, errors, stats] = ["a.exr", "e.exr", "a.json"].map(|name| folder.path().join(name).display().to_string());
    let common = ["render", SHOWCASE, "-o", &out, "--size", "24x18", "--stats", &stats, "--renderer", "reference"];
    let run = |more: &[&str]| -> serde_json::Value {
        let output = specula(&[&common, more].concat());
        assert!(output.status.success(), "{}", stderr(&output));
        serde_json::from_slice(&std::fs::read(&stats).unwrap()).unwrap()
    };
    let report = run(&["--error", "5%", "--error-image", &errors, "--bounces", "2"]);
    assert!(report["relative_error"].as_f64().is_some_and(|error| error > 0.0 && error <= 0.05), "{report}");
    assert!(std::fs::read(&errors).unwrap().starts_with(&[0x76, 0x2f, 0x31, 0x01]), "no OpenEXR file");
    let report = run(&["--samples", "3"]);
    assert!(report["samples"] == 3 && report["relative_error"].is_null(), "{report}");
    assert_fails(&["render", SHOWCASE, "-o", &out, "--bounces", "2"], 2, "add --renderer reference");
    let bad = ["--error-image", "e.png", "--renderer", "reference"];
    assert_fails(&[&["render", SHOWCASE, "-o", &out], &bad[..]].concat(), 2, "end the name in .exr");
}

#[test]
fn the_doctor_measures_where_it_is_asked_to() {
    let report = |arguments: &[&str]| {
        let output = specula(arguments);
        // Something may work less well on this adapter.
        assert!(matches!(output.status.code(), Some(0 | 1)), "{}", stderr(&output));
        serde_json::from_slice::<serde_json::Value>(&output.stdout).unwrap()
    };
    assert!(report(&["doctor", "--json"]).get("measured").is_none());
    let measured = &report(&["doctor", "--measure", "--json"])["measured"];
    for (kind, count) in [("fill", 6), ("taps", 7), ("arithmetic", 10)] {
        let rates = measured[kind].as_array().unwrap();
        assert_eq!(rates.len(), count, "{measured}");
        for rate in rates {
            let ns = rate["ns"].as_f64().unwrap();
            assert!(ns.is_finite() && ns >= 0.0 && !rate["name"].as_str().unwrap().is_empty(), "{rate}");
        }
        assert!(rates.iter().any(|rate| rate["ns"].as_f64().unwrap() > 0.0), "{measured}");
    }
}
