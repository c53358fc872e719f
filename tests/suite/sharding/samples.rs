//! The sample models in one process and in parts, twice: the same reports, and goldens with the same bytes.

use super::recipes::Scheduler;
use super::{specula_with_cache, timeless};
use crate::cli::stderr;
use crate::support::samples;
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::Instant;
use tempfile::TempDir;

const SUITE: &str = include_str!("samples.toml");

/// A folder with the suite; models and panoramas are links.
fn folder(samples: &Path) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("suite.toml"), SUITE).unwrap();
    for name in ["models", "env"] {
        std::os::unix::fs::symlink(samples.join(name), folder.path().join(name)).unwrap();
    }
    folder
}

/// All files of a folder by their place in it.
fn contents(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut files = BTreeMap::new();
    let mut left = vec![folder.to_owned()];
    while let Some(next) = left.pop() {
        for entry in std::fs::read_dir(next).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                left.push(path);
            } else {
                files.insert(path.strip_prefix(folder).unwrap().to_owned(), std::fs::read(&path).unwrap());
            }
        }
    }
    files
}

/// The report of the whole as `merge-reports` leaves it.
fn whole(folder: &Path, cache: &Path) -> Value {
    let start = Instant::now();
    let output = specula_with_cache(folder, cache, &["test", "suite.toml", "--out", "whole", "--quiet"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    println!("one process: {:.1} s", start.elapsed().as_secs_f64());
    let output = specula_with_cache(folder, cache, &["merge-reports", "whole", "-o", "report"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let report = timeless(&folder.join("report"));
    for name in ["whole", "report"] {
        std::fs::remove_dir_all(folder.join(name)).unwrap();
    }
    report
}

/// Every golden case has drawn its golden to the bit; returns how many do.
fn bitwise_the_goldens(report: &Value) -> usize {
    let cases = report["cases"].as_array().unwrap().iter().filter(|case| case["kind"] == "golden");
    let compared: Vec<&Value> = cases.filter(|case| case["status"] != "skipped").collect();
    for case in &compared {
        assert!(case["status"] == "pass" && case["paths"]["actual"].is_null(), "{case}");
    }
    compared.len()
}

#[cfg(unix)]
#[test]
#[ignore = "takes minutes; its figures are in docs/sharding.md"]
fn the_samples_in_parts_are_those_of_one_process() {
    let Some(samples) = samples() else { return };
    let first = folder(&samples);
    let cache = tempfile::tempdir().unwrap();
    let goldens = |folder: &TempDir| contents(&folder.path().join("suite.goldens"));
    let output = specula_with_cache(
        first.path(),
        cache.path(),
        &["test", "suite.toml", "--update", "new", "--repeat", "2", "--quiet"],
    );
    assert_eq!(output.status.code(), Some(0), "{}{}", String::from_utf8_lossy(&output.stdout), stderr(&output));
    let expected = goldens(&first);

    // Goldens that four processes make are those that one makes.
    let second = folder(&samples);
    for part in 1..=4 {
        let [partition, out] = [format!("hash:{part}/4"), format!("parts/{part}")];
        let arguments = ["test", "suite.toml", "--update", "new", "--partition", &partition, "--out", &out, "--quiet"];
        let output = specula_with_cache(second.path(), cache.path(), &arguments);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    }
    assert!(goldens(&second) == expected, "parts have made other goldens");

    let report = whole(first.path(), cache.path());
    println!("{} cases, {} with goldens", report["cases"].as_array().unwrap().len(), bitwise_the_goldens(&report));
    assert!(bitwise_the_goldens(&report) >= 28 && report["cases"].as_array().unwrap().len() >= 30, "{report}");
    // A difference would be a page of text.
    assert!(whole(first.path(), cache.path()) == report, "another report of the same run");
    let before = format!("export SPECULA_CACHE_DIR='{}'", cache.path().display());
    for (name, scheduler) in [("GNU parallel", Scheduler::parallel()), ("Slurm", Scheduler::slurm())] {
        let Some(scheduler) = scheduler else { continue };
        for parts in [1, 2, 4, 1, 2, 4] {
            let start = Instant::now();
            let output = scheduler.run(first.path(), &before, parts);
            assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
            println!("{name}, {parts} parts: {:.1} s", start.elapsed().as_secs_f64());
            assert!(timeless(&first.path().join("report")) == report, "{name}, {parts} parts: another report");
            for name in ["report", "parts"] {
                std::fs::remove_dir_all(first.path().join(name)).unwrap();
            }
        }
    }
    assert!(goldens(&first) == expected, "a run has changed goldens");
}
