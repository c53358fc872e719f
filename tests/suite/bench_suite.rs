//! `specula bench --suite`: fixed scenes, and what they are compared with.

use crate::cli::{assert_fails, specula, stderr};
use crate::support::{program, samples};
use serde_json::Value;
use std::process::Output;

fn json(output: &Output) -> Value {
    assert!(output.status.success(), "{}", stderr(output));
    serde_json::from_slice(&output.stdout).unwrap()
}

const SUITE: [&str; 4] = ["bench", "--suite", "lights-1", "--no-floor"];

#[test]
fn a_scene_is_timed_drawn_and_compared_with_figures_and_with_a_program() {
    let folder = tempfile::tempdir().unwrap();
    let [figures, svg] = ["a.json", "a.svg"].map(|name| folder.path().join(name).display().to_string());
    let first = ["--frames", "2", "--json", "--stats", &figures];
    let report = json(&specula(&[&SUITE[..], &first].concat()));
    let scenes = report["scenes"].as_array().unwrap();
    assert_eq!((&report["schema"], scenes.len()), (&"specula-suite/1".into(), 1));
    assert_eq!((&scenes[0]["name"], &scenes[0]["path"]), (&"lights-1".into(), &"forward".into()));
    assert_eq!(scenes[0]["frames"].as_array().unwrap().len(), 2);
    assert!(scenes[0]["floor"].is_null() && scenes[0]["baseline"].is_null(), "{report}");
    let median = |report: &Value| report["scenes"][0]["median"]["wall_ms"].as_f64().unwrap();
    assert!(median(&report) > 0.0);

    let second = ["--frames", "2", "--json", "--clock", "wall", "--baseline", &figures, "--plot", &svg];
    let compared = json(&specula(&[&SUITE[..], &second].concat()));
    let baseline = |name: &str| compared["scenes"][0]["baseline"][name].as_f64().unwrap();
    // Numbers that were printed and read lose their last bit.
    let is_same = |a: f64, b: f64| (a / b - 1.0).abs() < 1e-12;
    assert!(is_same(baseline("baseline_ms"), median(&report)) && is_same(baseline("ms"), median(&compared)));
    assert!(is_same(baseline("ratio"), median(&compared) / median(&report)), "{compared}");
    let svg = std::fs::read_to_string(svg).unwrap();
    assert!(svg.contains(">lights-1<") && svg.contains(" of baseline<") && !svg.contains("NaN"), "{svg}");

    let other = program().get_program().to_str().unwrap().to_owned();
    let output = specula(&[&SUITE[..], &["--frames", "1", "--baseline", &other]].concat());
    assert!(output.status.success(), "{}", stderr(&output));
    let table = String::from_utf8(output.stdout).unwrap();
    assert!(table.contains("of the baseline") && table.lines().any(|line| line.contains("lights-1: ")), "{table}");
}

#[test]
fn without_sample_models_what_needs_them_is_skipped_with_the_reason() {
    let mut command = program();
    command.env_remove("SPECULA_SAMPLES").args(["bench", "--suite", "helmet,cold-start", "--no-floor", "--json"]);
    let output = command.output().unwrap();
    let report = json(&output);
    let skipped = report["skipped"].as_array().unwrap();
    let names: Vec<&str> = skipped.iter().map(|skipped| skipped["name"].as_str().unwrap()).collect();
    assert_eq!(names, ["helmet", "helmet-1-sample", "cold-start"]);
    let message = "specula: cold-start is skipped: SPECULA_SAMPLES is not set";
    assert!(stderr(&output).contains(message), "{}", stderr(&output));
    assert!(report["scenes"].as_array().unwrap().is_empty() && report["cold_start"].is_null(), "{report}");
}

#[test]
fn a_cold_start_is_told_by_its_stages() {
    let Some(samples) = samples() else { return };
    let mut command = program();
    command.env("SPECULA_SAMPLES", samples).args(["bench", "--suite", "cold-start", "--frames", "1", "--json"]);
    let cold = &json(&command.output().unwrap())["cold_start"];
    let stages = cold["stages"].as_array().unwrap();
    let names: Vec<&str> = stages.iter().map(|stage| stage["stage"].as_str().unwrap()).collect();
    assert!(["decode", "upload", "first frame"].iter().all(|name| names.contains(name)), "{names:?}");
    let longest = stages.iter().filter_map(|stage| stage["wall_ms"].as_f64()).fold(0.0, f64::max);
    assert!(longest > 0.0 && cold["wall_ms"].as_f64().unwrap() > longest, "{cold}");
}

#[test]
fn mistakes_with_the_suite_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let [text, other] = [("a.json", "{"), ("b.json", "{\"schema\": \"specula-bench/1\"}")].map(|(name, text)| {
        let path = folder.path().join(name);
        std::fs::write(&path, text).unwrap();
        path.display().to_string()
    });
    let fails = |more: &[&str], expected: &str| assert_fails(&[&["bench", "--quiet"], more].concat(), 2, expected);
    fails(&["--suite", "light"], "no scene of the suite is called `light`; there are helmet");
    fails(&["assets/spheres.glb", "--suite"], "--suite");
    fails(&["--suite", "--size", "8x8"], "--size");
    fails(&["assets/spheres.glb", "--plot", "a.svg"], "--plot and --baseline are for --suite");
    fails(&["--suite", "sphere", "--baseline", "no/such/program"], "no/such/program: there is no such file");
    fails(&["--suite", "sphere", "--baseline", &text], "no JSON");
    fails(&["--suite", "sphere", "--baseline", &other], "its schema is not specula-suite/1");
    #[cfg(unix)]
    fails(&["--suite", "lights-1", "--frames", "1", "--no-floor", "--baseline", "/bin/false"], "/bin/false has failed");
}
