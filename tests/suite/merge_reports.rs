//! `specula merge-reports`: parts that make a whole, and those that do not.

use crate::cli::stderr;
use crate::report_fixture::{CASES, parts, report, write, write_pictures};
use crate::support::program;
use serde_json::{Value, json};
use std::path::Path;
use std::process::Output;

/// Merges folders of `folder` into its folder `merged`.
fn merge(folder: &Path, names: &[String], more: &[&str]) -> Output {
    let mut command = program();
    command.current_dir(folder).arg("merge-reports").args(names).args(["-o", "merged"]).args(more);
    command.output().unwrap()
}

/// A folder with pictures and the reports, and the names of their folders.
fn on_disk(reports: &[Value]) -> (tempfile::TempDir, Vec<String>) {
    let folder = tempfile::tempdir().unwrap();
    write_pictures(folder.path());
    let names: Vec<String> = (1..=reports.len()).map(|number| format!("part-{number}")).collect();
    for (report, name) in reports.iter().zip(&names) {
        write(folder.path(), name, report);
    }
    (folder, names)
}

#[test]
fn one_two_and_four_parts_make_the_same_report() {
    let mut files: Vec<Vec<Vec<u8>>> = Vec::new();
    for reports in [vec![report()], parts(1), parts(2), parts(4)] {
        let (folder, mut names) = on_disk(&reports);
        names.reverse();
        let output = merge(folder.path(), &names, &[]);
        assert_eq!(output.status.code(), Some(2), "a case is in error: {}", stderr(&output));
        assert!(stderr(&output).contains("cases could not be judged: case-3"), "{output:?}");
        let merged = folder.path().join("merged");
        let read = |name: &str| std::fs::read(merged.join(name)).unwrap();
        files.push(["report.json", "report.html", "junit.xml"].map(read).into());
        assert_eq!(std::fs::read_dir(merged.join("blobs")).unwrap().count(), 4, "equal pictures are one file");
    }
    assert!(files.iter().all(|same| same == &files[0]), "they differ");
    let merged: Value = serde_json::from_slice(&files[0][0]).unwrap();
    let indices: Vec<u64> = merged["cases"].as_array().unwrap().iter().map(|c| c["index"].as_u64().unwrap()).collect();
    assert_eq!(indices, (0..CASES as u64).collect::<Vec<_>>());
    let failed = &merged["cases"][2];
    let blob = format!("merged/blobs/{}.png", failed["blobs"]["actual"].as_str().unwrap());
    assert_eq!(
        (failed["paths"]["actual"].as_str(), failed["paths"]["golden"].as_str()),
        (Some(&*blob), Some("pictures/golden.png"))
    );
    assert!(merged["cases"][4]["blobs"]["golden"].is_null(), "a new case has no golden");
}

#[test]
fn a_merged_report_can_be_moved_and_merged_again() {
    let (folder, names) = on_disk(&parts(2));
    merge(folder.path(), &names, &[]);
    let elsewhere = tempfile::tempdir().unwrap();
    std::fs::rename(folder.path().join("merged"), elsewhere.path().join("part-1")).unwrap();
    let page = std::fs::read(elsewhere.path().join("part-1/report.html")).unwrap();
    let output = merge(elsewhere.path(), &["part-1".into()], &[]);
    assert!(stderr(&output).contains("could not be judged"), "{}", stderr(&output));
    assert!(std::fs::read(elsewhere.path().join("merged/report.html")).unwrap() == page);
}

#[test]
fn what_passed_exits_with_zero_and_failures_are_annotated() {
    let mut reports = parts(2);
    let (folder, names) = on_disk(&reports);
    let output = merge(folder.path(), &names, &["--github"]);
    let stdout = String::from_utf8(output.stdout).unwrap();
    let annotated = stdout.lines().filter(|line| line.starts_with("::error file=suite.toml,line=1")).count();
    assert_eq!(annotated, 3, "{stdout}");
    for (states, code, expected) in [
        (&["pass", "skipped", "fail"][..], 1, "5 passed, 1 failed, 1 skipped"),
        (&["pass", "skipped"], 0, "5 passed, 1 skipped"),
    ] {
        for report in &mut reports {
            let cases = report["cases"].as_array_mut().unwrap();
            cases.retain(|case| states.contains(&case["status"].as_str().unwrap()));
            report["part"]["cases"] = json!(CASES + states.len() - 5);
        }
        let (folder, names) = on_disk(&reports);
        let output = merge(folder.path(), &names, &[]);
        assert_eq!(output.status.code(), Some(code), "{}", stderr(&output));
        let stdout = String::from_utf8(output.stdout).unwrap();
        assert!(stdout.contains(expected) && stdout.contains("merged/report.html"), "{stdout}");
    }
    // The pictures are in the merged folder now.
    let printed = merge(folder.path(), &names, &["--json"]);
    let printed: Value = serde_json::from_slice(&printed.stdout).unwrap();
    assert_eq!(printed["cases"][2]["accept"], "specula accept suite.toml case-2 --out merged");
}

#[test]
fn parts_that_make_no_whole_are_refused() {
    type Damage = fn(&mut Vec<Value>);
    let damages: [(&str, Damage); 13] = [
        ("part 2 of 3 is missing", |parts| drop(parts.remove(1))),
        ("part 3 of 3 is missing", |parts| drop(parts.pop())),
        ("both are part 1", |parts| parts[2] = parts[0].clone()),
        ("both have the case \"case-0\"", |parts| {
            let case = parts[0]["cases"][0].clone();
            parts[1]["cases"].as_array_mut().unwrap().push(case);
        }),
        ("8 of 9 cases", |parts| drop(parts[1]["cases"].as_array_mut().unwrap().pop())),
        ("adapters differ, \"llvmpipe\" and \"Radeon\"", |parts| parts[1]["adapter"]["name"] = json!("Radeon")),
        ("adapter classes differ", |parts| parts[2]["adapter"]["class"] = json!("llvmpipe-25.0")),
        ("processors differ", |parts| parts[2]["adapter"]["cpu"] = json!("x86_64-avx512")),
        ("versions of Specula differ", |parts| parts[1]["version"] = json!("0.2.0")),
        ("suite files differ", |parts| parts[1]["suite_hash"] = json!("00")),
        ("partitions differ", |parts| parts[1]["part"]["scheme"] = json!("slice")),
        ("partitions differ", |parts| parts[1]["part"] = Value::Null),
        ("is of the layout specula-test/9", |parts| parts[1]["schema"] = json!("specula-test/9")),
    ];
    for (expected, damage) in damages {
        let mut reports = parts(3);
        damage(&mut reports);
        let (folder, names) = on_disk(&reports);
        let output = merge(folder.path(), &names, &[]);
        assert_eq!(output.status.code(), Some(2), "{expected}: {}", stderr(&output));
        let error = stderr(&output);
        assert!(error.contains(expected) && error.trim_end().lines().count() == 1, "{expected}: {error}");
        assert!(!folder.path().join("merged").exists(), "{expected}: something was written");
    }
}

#[test]
fn pictures_that_are_gone_are_named_and_leave_no_report() {
    let (folder, names) = on_disk(&parts(2));
    std::fs::remove_file(folder.path().join("pictures/heat.png")).unwrap();
    let output = merge(folder.path(), &names, &[]);
    let error = stderr(&output);
    assert_eq!(output.status.code(), Some(2), "{error}");
    assert!(error.contains("pictures/heat.png: of the case \"case-2\": cannot read it"), "{error}");
    assert!(!folder.path().join("merged/report.json").exists());
    let output = merge(folder.path(), &["nowhere".into()], &[]);
    assert!(output.status.code() == Some(2) && stderr(&output).contains("report.json: cannot read it"), "{output:?}");
}
