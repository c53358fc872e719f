//! Runs that are killed, and folders that take no files.

use super::fixture::{CASE, Fixture};
use crate::support::program;
use std::path::{Path, PathBuf};
use std::process::Stdio;
use std::time::Duration;

/// All files below a folder.
fn files(folder: &Path) -> Vec<PathBuf> {
    let Ok(entries) = std::fs::read_dir(folder) else { return Vec::new() };
    let paths = entries.map(|entry| entry.unwrap().path());
    paths.flat_map(|path| if path.is_dir() { files(&path) } else { vec![path] }).collect()
}

/// Whatever has its final name is whole. Temporary files, which a killed run leaves, have none of these endings.
fn assert_whole(fixture: &Fixture) {
    for path in [files(&fixture.path("s.out")), files(&fixture.path("s.goldens"))].concat() {
        let bytes = std::fs::read(&path).unwrap();
        match path.extension().and_then(|ending| ending.to_str()) {
            Some("png") => drop(image::load_from_memory(&bytes).unwrap_or_else(|e| panic!("{}: {e}", path.display()))),
            Some("json") => {
                let read: Result<serde_json::Value, _> = serde_json::from_slice(&bytes);
                drop(read.unwrap_or_else(|error| panic!("{}: {error}", path.display())));
            }
            Some("html") => assert!(bytes.ends_with(b"</html>"), "{}", path.display()),
            Some("xml") => assert!(bytes.trim_ascii_end().ends_with(b"</testsuites>"), "{}", path.display()),
            other => assert_eq!(other, Some("tmp"), "{}", path.display()),
        }
    }
}

fn kill_at(fixture: &Fixture, after: Duration) {
    let mut child = program()
        .arg("test")
        .arg(fixture.path("s.toml"))
        .args(["--update", "all"])
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    std::thread::sleep(after);
    // SIGKILL on unix.
    child.kill().unwrap();
    child.wait().unwrap();
    assert_whole(fixture);
}

/// Kills a run that writes goldens at so many moments between its beginning and its usual end.
fn kill(moments: u32) {
    let fixture = Fixture::new();
    let matrix = "matrix = { quality = ['draft', 'standard', 'high'], msaa = [1, 4], exposure = [0, 1] }\n";
    fixture.suite(&format!("{CASE}{matrix}"));
    let start = std::time::Instant::now();
    fixture.bless();
    let usual = start.elapsed();
    for moment in 0..moments {
        // All changes from one to the next, so that every run writes every file.
        fixture.texture(|x, y| [(x * 7 + moment * 31) as u8, (y * 5) as u8, 60]);
        kill_at(&fixture, usual * moment / moments);
    }
    let ran = fixture.bless();
    assert_eq!(ran.report["cases"].as_array().unwrap().len(), 12);
    fixture.run("test", &[]).expect(0);
    assert_whole(&fixture);
    // What the killed ones have left is gone.
    let left = [files(&fixture.path("s.out")), files(&fixture.path("s.goldens"))].concat();
    assert!(left.iter().all(|path| path.extension().is_none_or(|ending| ending != "tmp")), "{left:?}");
}

#[test]
fn a_killed_run_leaves_nothing_half_written() {
    kill(5);
}

#[test]
#[ignore = "takes minutes; the short one is always run"]
fn fifty_killed_runs_leave_nothing_half_written() {
    kill(50);
}

#[test]
fn a_file_where_a_folder_should_be_is_told_and_nothing_is_lost() {
    let fixture = Fixture::new();
    fixture.write("s.out", "a file");
    let ran = fixture.run("test", &[]);
    assert!(ran.code == Some(2) && ran.stderr.contains("s.out"), "{}", ran.stderr);
    std::fs::remove_file(fixture.path("s.out")).unwrap();
    fixture.write("s.goldens", "a file");
    let ran = fixture.run("test", &["--update", "new"]).expect(2);
    assert_eq!(ran.case("sphere")["status"], "error");
    assert_eq!(std::fs::read(fixture.path("s.goldens")).unwrap(), b"a file");
    std::fs::remove_file(fixture.path("s.goldens")).unwrap();
    fixture.bless();
}
