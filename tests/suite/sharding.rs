//! One suite in one process and in parts: the reports are the same, by whatever the parts are started.

use crate::cli::stderr;
use crate::support::program;
use serde_json::{Value, json};
use std::path::Path;
use std::process::{Command, Output};

/// Small pictures of two scenes; 14 cases, of which one is skipped and one fails.
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
    assert_eq!((count("pass"), count("skipped"), count("fail")), (12, 1, 1), "{states:?}");
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
    assert_eq!(parts.map(|part| part.lines().count()), [4, 5, 5]);
}

/// The commands of a recipe in docs/sharding.md.
fn recipe(name: &str) -> String {
    let text = std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/sharding.md")).unwrap();
    let (_, rest) = text.split_once(&format!("<!-- {name} -->\n```sh\n")).expect("the recipe is there");
    rest.split_once("```").expect("the recipe ends").0.to_owned()
}

/// Follows a recipe in the folder, with the program on the path.
fn follow(folder: &Path, recipe: &str) -> Output {
    let program = program();
    let own = Path::new(program.get_program()).parent().unwrap().to_owned();
    let path = std::env::var_os("PATH").unwrap_or_default();
    let mut shell = Command::new("sh");
    shell.env("PATH", std::env::join_paths([own].into_iter().chain(std::env::split_paths(&path))).unwrap());
    shell.envs(program.get_envs().filter_map(|(name, value)| Some((name, value?))));
    shell.current_dir(folder).env("HOME", folder).args(["-ec", recipe]).output().unwrap()
}

/// Follows a recipe for 4 parts with other numbers of them.
fn follow_with(recipe: &str, four: &str, numbers: &[usize]) {
    let suite = suite();
    let folder = suite.path();
    let whole = whole(folder);
    assert_eq!(whole["cases_in_suite"], json!(14));
    assert!(recipe.contains(four), "{recipe}");
    for number in numbers {
        let output = follow(folder, &recipe.replace(four, &four.replace('4', &number.to_string())));
        assert_eq!(output.status.code(), Some(1), "the furnace fails: {}", stderr(&output));
        assert_eq!(std::fs::read_dir(folder.join("parts")).unwrap().count(), *number);
        assert_eq!(timeless(&folder.join("report")), whole, "{number} parts");
        for name in ["report", "parts"] {
            std::fs::remove_dir_all(folder.join(name)).unwrap();
        }
    }
}

/// What a command prints when it works.
fn printed(program: &str, argument: &str) -> Option<String> {
    let output = Command::new(program).arg(argument).output().ok().filter(|output| output.status.success())?;
    String::from_utf8(output.stdout).ok()
}

#[test]
fn the_recipe_for_gnu_parallel_works() {
    if printed("parallel", "--version").is_some_and(|version| version.starts_with("GNU parallel")) {
        follow_with(&recipe("parallel"), "parts=4", &[1, 2, 4]);
    } else {
        println!("skipped: no GNU parallel; apt-get install parallel");
    }
}

#[test]
fn the_recipe_for_slurm_works() {
    if printed("sinfo", "--noheader").is_some_and(|nodes| nodes.contains("idle")) {
        follow_with(&recipe("slurm"), "--array=1-4", &[1, 2, 4]);
    } else {
        println!("skipped: no Slurm with an idle node");
    }
}
