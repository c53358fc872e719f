//! Runs that are killed, and folders that take no files.

use super::fixture::{CASE, Fixture, Model};
use crate::support::program;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::time::Duration;

/// All files below a folder.
fn files(folder: &Path) -> Vec<PathBuf> {
    let Ok(entries) = std::fs::read_dir(folder) else { return Vec::new() };
    let paths = entries.map(|entry| entry.unwrap().path());
    paths.flat_map(|path| if path.is_dir() { files(&path) } else { vec![path] }).collect()
}

/// Whatever has its final name is whole. Temporary files, which a killed run leaves, have none of these endings.
fn assert_whole(fixture: &Fixture) {
    for path in ["s.out", "s.goldens", "seen"].map(|name| files(&fixture.path(name))).concat() {
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

/// Every file may have so many bytes at most: the system refuses to write on in the middle of larger ones.
#[cfg(unix)]
#[test]
fn files_that_cannot_be_written_to_their_end_are_not_there() {
    let fixture = Fixture::new();
    fixture.bless();
    let golden = std::fs::read(fixture.golden("sphere")).unwrap();
    fixture.model(&Model { perceptual_roughness: 0.6, ..Model::default() });
    let mut codes = Vec::new();
    for blocks in [0, 1, 4, 16, 64, 100_000] {
        let program = program();
        let mut shell = Command::new("sh");
        // The signal would end the process.
        shell.args(["-c", "ulimit -f $0; trap '' XFSZ; exec \"$@\"", &blocks.to_string()]).arg(program.get_program());
        shell.envs(program.get_envs().filter_map(|(name, value)| Some((name, value?))));
        let output = shell.arg("test").arg(fixture.path("s.toml")).args(["--update", "all"]).output().unwrap();
        let error = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_whole(&fixture);
        let is_new = std::fs::read(fixture.golden("sphere")).unwrap() != golden;
        match output.status.code() {
            Some(0) => assert!(is_new, "{blocks}: {error}"),
            // report.html is written after the goldens.
            Some(2) => assert!(error.contains("File too large") || error.contains("could not be judged"), "{error}"),
            other => panic!("{blocks}: {other:?} {error}"),
        }
        codes.push(output.status.code().unwrap());
    }
    assert!(codes.first() == Some(&2) && codes.last() == Some(&0), "{codes:?}");
    fixture.run("test", &[]).expect(0);
}

/// Runs commands where they may mount what nobody else sees; `None` (printed) where the system does not let us. `S` runs the
/// suite and updates goldens, `D` is the folder.
fn with_mounts(fixture: &Fixture, commands: &str) -> Option<Output> {
    let unshare = |arguments: &[&str]| {
        let mut command = Command::new("unshare");
        command.args(["--map-root-user", "--mount", "sh", "-ec"]).args(arguments);
        command
    };
    if !unshare(&["mount -t tmpfs tmpfs /mnt"]).output().is_ok_and(|output| output.status.success()) {
        println!("skipped: nothing can be mounted here");
        return None;
    }
    let program = program();
    let mut shell = unshare(&[commands]);
    shell.envs(program.get_envs().filter_map(|(name, value)| Some((name, value?))));
    let suite = fixture.path("s.toml").display().to_string();
    shell.env("S", format!("{} test {suite} --update all", program.get_program().display()));
    shell.env("D", fixture.path("")).output().ok()
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_leaves_nothing_half_written() {
    let fixture = Fixture::new();
    fixture.bless();
    fixture.model(&Model { perceptual_roughness: 0.6, ..Model::default() });
    for (folder, kib) in [("s.out", 4), ("s.out", 24), ("s.out", 60), ("s.goldens", 4), ("s.goldens", 8)] {
        let golden = std::fs::read(fixture.golden("sphere")).unwrap();
        let commands = format!(
            "mkdir -p $D/seen $D/{folder}; mount -t tmpfs -o size={kib}k tmpfs $D/{folder}\n\
             code=0; $S || code=$?; cp -r $D/{folder}/. $D/seen; exit $code"
        );
        let Some(output) = with_mounts(&fixture, &commands) else { return };
        let said = format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
        assert_eq!(output.status.code(), Some(2), "{folder} of {kib} KiB: {said}");
        assert!(said.contains("No space left on device"), "{folder} of {kib} KiB: {said}");
        assert_whole(&fixture);
        std::fs::remove_dir_all(fixture.path("seen")).unwrap();
        if folder == "s.goldens" {
            // Hidden by the full disk.
            assert_eq!(std::fs::read(fixture.golden("sphere")).unwrap(), golden);
        }
    }
    fixture.bless();
    fixture.run("test", &[]).expect(0);
}

#[cfg(target_os = "linux")]
#[test]
fn read_only_folders_are_told_and_keep_what_they_have() {
    let fixture = Fixture::new();
    fixture.bless();
    fixture.run("test", &[]).expect(0);
    fixture.model(&Model { perceptual_roughness: 0.6, ..Model::default() });
    for folder in ["s.out", "s.goldens", ""] {
        let before = ["s.out", "s.goldens"].map(|name| contents(&fixture.path(name)));
        let commands = format!("mount --bind $D/{folder} $D/{folder}; mount -o remount,bind,ro $D/{folder}; cd $D; $S");
        let Some(output) = with_mounts(&fixture, &commands) else { return };
        let said = format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
        assert_eq!(output.status.code(), Some(2), "{folder}: {said}");
        assert!(said.contains("Read-only file system") && !said.contains("panicked"), "{folder}: {said}");
        assert_whole(&fixture);
        assert_eq!(contents(&fixture.path("s.goldens")), before[1], "{folder}: goldens have changed");
        if folder != "s.goldens" {
            assert_eq!(contents(&fixture.path("s.out")), before[0], "{folder}: the last run's files have changed");
        }
    }
    fixture.bless();
    fixture.run("test", &[]).expect(0);
}

fn contents(folder: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    let mut files: Vec<_> =
        files(folder).into_iter().map(|path| (path.clone(), std::fs::read(path).unwrap())).collect();
    files.sort();
    files
}
