//! Reports of runs that never were, for what is made of reports.

use serde_json::{Value, json};
use std::path::{Path, PathBuf};

/// Size of the pictures.
pub(crate) const SIZE_PX: (u32, u32) = (64, 48);

/// Cases of [`report`].
pub(crate) const CASES: usize = 9;

/// A name that would break out of every quotation, and turn around what follows.
pub(crate) const HOSTILE: &str =
    "x--><script>window.broken=1</script><img src=x onerror=window.broken=2>\"'`&amp;]]>\u{202e}gnp.\u{1}";

/// Blue of the pictures in their roles; red and green are the column and the row.
pub(crate) const BLUE: [(&str, u8); 4] = [("golden", 40), ("actual", 200), ("difference", 90), ("heat", 140)];

pub(crate) fn color(role: &str, x: u32, y: u32) -> [u8; 4] {
    let blue = BLUE.into_iter().find(|(name, _)| *name == role).unwrap().1;
    [x as u8 * 4, y as u8 * 5, blue, 255]
}

/// Writes the pictures into `pictures` of the folder.
pub(crate) fn write_pictures(folder: &Path) {
    std::fs::create_dir_all(folder.join("pictures")).unwrap();
    for (role, _) in BLUE {
        let picture = image::RgbaImage::from_fn(SIZE_PX.0, SIZE_PX.1, |x, y| image::Rgba(color(role, x, y)));
        picture.save(folder.join(format!("pictures/{role}.png"))).unwrap();
    }
}

/// The report of a whole run.
pub(crate) fn report() -> Value {
    json!({
        "schema": "specula-test/1",
        "suite": "fixture",
        "suite_file": "suite.toml",
        "suite_hash": "a0".repeat(32),
        "version": "0.1.0",
        "adapter": adapter(),
        "cases_in_suite": CASES,
        "cases": (0..CASES).map(case).collect::<Vec<_>>(),
        "milliseconds": 1500.0,
    })
}

fn adapter() -> Value {
    json!({"name": "llvmpipe", "backend": "vulkan", "driver": "Mesa 22.3.6", "class": "llvmpipe-22.3", "cpu": "x86_64-avx2"})
}

/// The third fails, the fourth is in error, the fifth new, the sixth skipped; others pass.
fn case(index: usize) -> Value {
    let status = ["pass", "pass", "fail", "error", "new", "skipped"].get(index).copied().unwrap_or("pass");
    let picture = |role: &str, states: &[&str]| {
        let is_there = states.contains(&status);
        is_there.then(|| format!("pictures/{role}.png"))
    };
    let error = if status == "fail" { 0.02 } else { 1e-4 * (index + 1) as f64 };
    let mut provenance = adapter();
    let hashes = json!({"version": "0.1.0", "suite": "fixture", "case": format!("case-{index}"),
        "scene_hash": "5c".repeat(32), "picture_hash": "77".repeat(32), "settings_hash": "1f".repeat(32), "settings": ["--size=64x48"]});
    provenance.as_object_mut().unwrap().append(&mut hashes.as_object().unwrap().clone());
    json!({
        "id": format!("case-{index}"),
        "index": index,
        "kind": "golden",
        "status": status,
        "reason": match status { "error" => Some("no such model"), "skipped" => Some("too slow"), _ => None },
        "line": 10 + index,
        "model": "model.glb",
        "settings": ["--size=64x48"],
        "metrics": if ["pass", "fail"].contains(&status) { json!([{
            "name": "flip.mean", "value": error, "comparison": "<=", "limit": 0.01, "limit_from": "suite.toml:3",
            "holds": error <= 0.01, "remark": "",
        }]) } else { json!([]) },
        "paths": {
            "actual": picture("actual", &["fail", "new"]),
            "golden": if status == "new" { Some("goldens/new.png".into()) } else { picture("golden", &["pass", "fail"]) },
            "difference": picture("difference", &["fail"]),
            "heat_map": picture("heat", &["fail"]),
            "actual_hash": null,
        },
        "provenance": provenance,
        "golden_provenance": null,
        "accept": (status == "fail").then(|| format!("specula accept suite.toml case-{index}")),
        "golden_written": false,
        "times": {"load_ms": 1.0, "draw_ms": 20.0, "judge_ms": 3.0},
    })
}

/// Every name of a report that a stranger may choose is [`HOSTILE`], with what keeps names of cases apart.
pub(crate) fn hostile(mut report: Value) -> Value {
    for name in ["suite", "suite_file", "version"] {
        report[name] = HOSTILE.into();
    }
    for name in ["name", "backend", "driver", "class", "cpu"] {
        report["adapter"][name] = HOSTILE.into();
    }
    for (index, case) in report["cases"].as_array_mut().unwrap().iter_mut().enumerate() {
        case["id"] = format!("{HOSTILE}{index}").into();
        case["settings"] = json!([HOSTILE]);
        for name in ["reason", "model", "accept"] {
            case[name] = HOSTILE.into();
        }
        for metric in case["metrics"].as_array_mut().unwrap() {
            for name in ["name", "limit_from", "remark", "comparison"] {
                metric[name] = HOSTILE.into();
            }
        }
        for name in ["version", "suite", "case", "name", "scene_hash", "settings_hash"] {
            case["provenance"][name] = HOSTILE.into();
        }
    }
    report
}

/// Writes a report as `FOLDER/NAME/report.json`, and returns that folder.
pub(crate) fn write(folder: &Path, name: &str, report: &Value) -> PathBuf {
    let folder = folder.join(name);
    std::fs::create_dir_all(&folder).unwrap();
    std::fs::write(folder.join("report.json"), report.to_string()).unwrap();
    folder
}

/// The reports of a run in parts, as `hash` would share it: case 0 to the first, case 1 to the second, and so on.
pub(crate) fn parts(of: usize) -> Vec<Value> {
    let part = |number: usize| {
        let mut report = report();
        report["part"] = json!({"scheme": "hash", "number": number, "of": of, "cases": CASES});
        report["cases"]
            .as_array_mut()
            .unwrap()
            .retain(|case| case["index"].as_u64().unwrap() as usize % of + 1 == number);
        report
    };
    (1..=of).map(part).collect()
}
