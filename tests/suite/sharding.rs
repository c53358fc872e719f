//! One suite in one process and in parts: the reports are the same, by whatever the parts are started.

mod recipes;
mod samples;
mod slurm;

use crate::cli::stderr;
use crate::support::program;
use serde_json::Value;
use std::path::Path;
use std::process::Output;

/// Small pictures of two scenes; 15 cases, of which one is skipped and one fails.
const SUITE: &str = r#"
[suite]
bless = ["*"]

[defaults]
size = "24x24"
env = "black"
light = "point:flux=3000lm,at=1,2,3"
thresholds = ["flip.mean <= 0.004"]

[[case]]
name = "spheres"
model = "spheres.glb"
matrix = { tone-map = ["neutral", "aces", "agx"], exposure = ["-1", "0"] }

[[case]]
name = "showcase"
model = "showcase.glb"
matrix = { tone-map = ["neutral", "aces", "agx"], exposure = ["-1", "0"] }

[[case]]
name = "later"
model = "showcase.glb"
skip = { reason = "a test of skips", until = 9999-01-31 }

[[case]]
name = "truth"
kind = "reference"
model = "spheres.glb"
samples = 4
thresholds = ["flip.mean <= 0.5"]

[[case]]
name = "furnace"
kind = "furnace"
model = "showcase.glb"
within = "1 %"
"#;

/// A folder with the suite, its models and its goldens.
fn suite() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("suite.toml"), SUITE).unwrap();
    for name in ["spheres.glb", "showcase.glb"] {
        let model = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets").join(name);
        std::fs::copy(model, folder.path().join(name)).unwrap();
    }
    let output = specula(folder.path(), &["test", "suite.toml", "--update", "new", "--quiet"]);
    assert_eq!(output.status.code(), Some(1), "the furnace fails: {}", stderr(&output));
    folder
}

fn specula(folder: &Path, arguments: &[&str]) -> Output {
    program().current_dir(folder).args(arguments).output().unwrap()
}

/// The same with prefiltered panoramas kept in a folder.
fn specula_with_cache(folder: &Path, cache: &Path, arguments: &[&str]) -> Output {
    program().current_dir(folder).env("SPECULA_CACHE_DIR", cache).args(arguments).output().unwrap()
}

/// The report in a folder, without times.
fn timeless(folder: &Path) -> Value {
    let text = std::fs::read_to_string(folder.join("report.json")).unwrap();
    let mut report: Value = serde_json::from_str(&text).unwrap();
    report["milliseconds"] = Value::Null;
    for case in report["cases"].as_array_mut().unwrap() {
        case["times"] = Value::Null;
    }
    report
}

/// The report of the whole, drawn by one process, as `merge-reports` leaves it in `report`.
fn whole(folder: &Path) -> Value {
    specula(folder, &["test", "suite.toml", "--out", "whole", "--quiet"]);
    specula(folder, &["merge-reports", "whole", "-o", "report"]);
    let report = timeless(&folder.join("report"));
    std::fs::remove_dir_all(folder.join("report")).unwrap();
    let states: Vec<&str> = report["cases"].as_array().unwrap().iter().filter_map(|c| c["status"].as_str()).collect();
    let count = |state: &str| states.iter().filter(|other| **other == state).count();
    assert_eq!((count("pass"), count("skipped"), count("fail")), (13, 1, 1), "{states:?}");
    report
}

#[test]
fn parts_make_the_report_of_one_process() {
    let suite = suite();
    let folder = suite.path();
    let whole = whole(folder);
    for scheme in ["slice", "hash", "weight"] {
        let part = |number: usize| {
            let out = format!("parts/{scheme}-{number}");
            let mut command = program();
            command.current_dir(folder).args(["test", "suite.toml", "--quiet", "--partition", scheme, "--out", &out]);
            // As a scheduler says it.
            command.env("CI_NODE_INDEX", number.to_string()).env("CI_NODE_TOTAL", "3");
            if scheme == "weight" {
                command.args(["--times", "whole"]);
            }
            let output = command.output().unwrap();
            assert!(matches!(output.status.code(), Some(0 | 1)), "{scheme}: {}", stderr(&output));
            out
        };
        let parts = [3, 1, 2].map(part);
        let arguments = [&["merge-reports", "-o", "report"], &parts.each_ref().map(String::as_str)[..]].concat();
        let output = specula(folder, &arguments);
        assert_eq!(output.status.code(), Some(1), "the furnace fails: {}", stderr(&output));
        assert_eq!(timeless(&folder.join("report")), whole, "{scheme}");
        std::fs::remove_dir_all(folder.join("report")).unwrap();
    }
}

#[test]
fn what_is_asked_of_a_part_is_checked() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("suite.toml"), SUITE).unwrap();
    let fails = |arguments: &[&str], expected: &str| {
        let output = specula(folder.path(), &[&["test", "suite.toml", "--list"], arguments].concat());
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(stderr(&output).contains(expected), "{arguments:?}: {}", stderr(&output));
    };
    fails(&["--partition", "hash:3/2"], "there is no part 3/2");
    fails(&["--partition", "weight:1/2"], "go together");
    fails(&["--partition", "hash:1/2", "--times", "out"], "go together");
    fails(&["--partition", "weight:1/2", "--times", "out"], "report.json: cannot read it");
    let listed = |arguments: &[&str]| {
        let output = specula(folder.path(), &[&["test", "suite.toml", "--list"], arguments].concat());
        String::from_utf8(output.stdout).unwrap()
    };
    let parts = [1, 2, 3].map(|number| listed(&["--partition", &format!("slice:{number}/3")]));
    assert_eq!(parts.concat(), listed(&[]), "slices are in the order of the suite");
    assert_eq!(parts.map(|part| part.lines().count()), [5, 5, 5]);
}
