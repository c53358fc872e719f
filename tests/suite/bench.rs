//! `specula bench`, and the tiers that `specula render` chooses by the same measurement.

use crate::cli::{assert_fails, specula, stderr};
use serde_json::Value;

const SPHERES: &str = "assets/spheres.glb";
const TIERS: [&str; 4] = ["split-sum", "draft", "standard", "high"];

fn read_json(path: &std::path::Path) -> Value {
    serde_json::from_slice(&std::fs::read(path).unwrap()).unwrap()
}

#[test]
fn settings_are_measured_reported_and_drawn() {
    let folder = tempfile::tempdir().unwrap();
    let [svg, json] = ["a.svg", "a.json"].map(|name| folder.path().join(name));
    let (svg_text, json_text) = (svg.display().to_string(), json.display().to_string());
    let effort = ["--size", "48x24", "--frames", "2", "--truth-samples", "32"];
    let files = ["--pareto", &svg_text, "--stats", &json_text];
    let output = specula(&[&["bench", SPHERES], &effort[..], &files[..]].concat());
    assert!(output.status.success(), "{}", stderr(&output));
    let table = String::from_utf8(output.stdout).unwrap();
    assert!(table.starts_with("| setting") && table.contains("standard, 4x MSAA (base)"), "{table}");

    let report = read_json(&json);
    let settings = report["settings"].as_array().unwrap();
    assert_eq!((&report["schema"], settings.len()), (&"specula-bench/1".into(), 17));
    assert_eq!((&settings[0]["quality"], &settings[0]["ratio"]), (&"standard".into(), &1.0.into()));
    for setting in settings {
        let errors =
            [&setting["picture_error"], &setting["shading_error"]].map(|error| error["upper"].as_f64().unwrap());
        let times = [&setting["ratio"], &setting["times"]["wall_ms"]].map(|time| time.as_f64().unwrap());
        assert!(errors.into_iter().chain(times).all(|x| x > 0.0 && x.is_finite()), "{setting}");
    }
    let paths: Vec<_> = settings.iter().map(|setting| &setting["path"]).collect();
    assert!(paths.contains(&&"faster".into()) && paths.contains(&&"forward".into()), "{paths:?}");
    let on_front = |which: &str| settings.iter().filter(|setting| setting[which] == true).count();
    assert!(on_front("is_on_picture_front") > 0 && on_front("is_on_shading_front") > 0, "{report}");
    let light_of = |quality: &str| {
        let setting = settings.iter().find(|setting| setting["quality"] == quality).unwrap();
        setting["shading_error"]["upper"].as_f64().unwrap()
    };
    assert!(light_of("split-sum") > light_of("standard"), "{report}");
    let terms = report["terms"].as_array().unwrap();
    assert_eq!(terms.iter().map(|row| row["quality"].as_str().unwrap()).collect::<Vec<_>>(), TIERS);
    assert!(report["floor"]["ms"].as_f64().unwrap() > 0.0, "{report}");
    // The lamp and the studio, diffuse and specular.
    assert_eq!(terms[0]["errors"].as_array().unwrap().len(), 4);

    let svg = std::fs::read_to_string(svg).unwrap();
    assert_eq!(svg.matches("<polyline").count(), 2);
    assert!(svg.contains(">base<") && !svg.contains("NaN") && !svg.contains("inf"), "{svg}");
}

#[test]
fn a_frame_is_compared_with_what_the_device_does_at_best() {
    let arguments = ["bench", SPHERES, "--steady", "--frames", "2", "--size", "64x64", "--json", "--quiet"];
    let output = specula(&arguments);
    assert!(output.status.success(), "{}", stderr(&output));
    let report: Value = serde_json::from_slice(&output.stdout).unwrap();
    let floor = |name: &str| report["floor"][name].as_f64().unwrap();
    assert_eq!(floor("pixels"), 4096.0);
    assert!((0.1..0.9).contains(&floor("covered")), "{report}");
    // The table of the lobes and of their taps, two taps of two levels, and irradiance.
    assert!(floor("taps_a_covered_pixel") >= 9.0 && floor("multiply_adds_a_covered_pixel") > 50.0, "{report}");
    assert!(floor("fill_ms") > 0.0 && floor("taps_ms") > 0.0 && floor("arithmetic_ms") > 0.0, "{report}");
    let median = report["median"][format!("{}_ms", report["basis"].as_str().unwrap())].as_f64().unwrap();
    assert!((floor("ratio") * floor("ms") / median - 1.0).abs() < 1e-9, "{report}");
    assert!(floor("ratio_to_fill_and_taps") > floor("ratio"), "{report}");
}

#[test]
fn steady_frames_are_timed_one_by_one() {
    let arguments = ["bench", SPHERES, "--steady", "--frames", "3", "--size", "48x24", "--no-floor", "--quiet"];
    let output = specula(&[&arguments[..], &["--json"]].concat());
    assert!(output.status.success(), "{}", stderr(&output));
    assert_eq!(stderr(&output), "");
    let report: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!((&report["schema"], &report["size_px"]), (&"specula-steady/1".into(), &serde_json::json!([48, 24])));
    assert_eq!((&report["setting"], &report["msaa"]), (&"standard, 4x MSAA".into(), &4.into()));
    assert!(report["draws"].as_u64().unwrap() > 1 && report["triangles"].as_u64().unwrap() > 1000, "{report}");
    assert!(report["floor"].is_null());
    let frames = report["frames"].as_array().unwrap();
    assert_eq!(frames.len(), 3);
    for time in ["wall_ms", "cpu_ms"] {
        let mut times: Vec<f64> = frames.iter().filter_map(|frame| frame[time].as_f64()).collect();
        assert!(times.len() == 3 && times.iter().all(|ms| *ms > 0.0 && ms.is_finite()), "{report}");
        times.sort_by(f64::total_cmp);
        assert_eq!(report["median"][time].as_f64(), Some(times[1]), "{report}");
    }
    let table = String::from_utf8(specula(&arguments).stdout).unwrap();
    assert!(table.starts_with("| a frame, ms") && table.contains("3 frames after 4 others"), "{table}");
}

#[test]
fn benches_that_make_no_sense_say_so() {
    assert_fails(&["bench", SPHERES, "--renderer", "reference"], 2, "leave out --renderer");
    assert_fails(&["bench", SPHERES, "--truth-samples", "4"], 2, "--truth-samples");
    assert_fails(&["bench", SPHERES, "--steady", "--pareto", "a.svg"], 2, "--pareto");
    assert_fails(&["bench", SPHERES, "--frames", "0"], 2, "--frames");
    assert_fails(&["bench", "no/such.glb"], 2, "no/such.glb");
    assert_fails(&["bench", SPHERES, "--adapter", "no such adapter"], 3, "no such adapter");
}

/// What `specula render` says that it took, and its warnings.
fn chosen(limits: &[&str]) -> (Value, Vec<String>) {
    let folder = tempfile::tempdir().unwrap();
    let [png, json] = ["a.png", "a.json"].map(|name| folder.path().join(name));
    let (png_text, json_text) = (png.display().to_string(), json.display().to_string());
    let output =
        specula(&[&["render", SPHERES, "-o", &png_text, "--size", "40x20", "--stats", &json_text], limits].concat());
    assert!(output.status.success(), "{}", stderr(&output));
    assert!(stderr(&output).contains("specula: quality "), "{}", stderr(&output));
    let stats = read_json(&json);
    let pipelines = stats["gpu"]["pipelines"].to_string();
    let taken = stats["tier"]["taken"].as_str().unwrap();
    assert!(taken == "split-sum" || pipelines.contains(&format!("+{taken}")), "{taken}: {pipelines}");
    let warnings = stats["warnings"].as_array().unwrap().iter().map(|warning| warning.as_str().unwrap().to_owned());
    (stats["tier"].clone(), warnings.collect())
}

#[test]
fn the_tier_is_the_cheapest_within_the_error_or_the_best_within_the_time() {
    let (tier, warnings) = chosen(&["--max-error", "6%"]);
    let candidates = tier["tiers"].as_array().unwrap();
    let of = |candidate: &Value, name: &str| candidate[name].as_f64().unwrap();
    let taken = candidates.iter().find(|candidate| candidate["quality"] == tier["taken"]).unwrap();
    let good_enough = || candidates.iter().filter(|candidate| of(candidate, "error") <= 0.06);
    assert!(good_enough().count() > 0 && warnings.is_empty(), "{tier} {warnings:?}");
    assert!(of(taken, "error") <= 0.06 && good_enough().all(|other| of(taken, "ms") <= of(other, "ms")), "{tier}");

    let (tier, warnings) = chosen(&["--max-ms", "1e6"]);
    assert_eq!((tier["taken"].as_str(), warnings.len()), (Some("high"), 0), "{tier}");
}

#[test]
fn limits_out_of_reach_are_warned_of() {
    let (tier, warnings) = chosen(&["--max-error", "0.0001%", "--max-ms", "1e-6"]);
    assert_eq!(tier["tiers"].as_array().unwrap().len(), 4);
    assert!(
        warnings.iter().any(|warning| warning.contains("no tier") && warning.contains(" ms a frame")),
        "{warnings:?}"
    );
    let render = ["render", SPHERES, "-o", "x.png"];
    let fails = |more: &[&str], expected: &str| assert_fails(&[&render[..], more].concat(), 2, expected);
    fails(&["--max-ms", "0"], "--max-ms");
    fails(&["--max-error", "2%", "--quality", "high"], "--quality");
    fails(&["--max-error", "2%", "--renderer", "reference"], "leave out --renderer");
}
