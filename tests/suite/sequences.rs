//! `specula render --frames` and `--manifest` as their users start them.

use crate::support::program;
use image::{AnimationDecoder, RgbaImage};
use serde_json::Value;
use std::io::BufReader;
use std::path::{Path, PathBuf};
use std::process::{Output, Stdio};
use tempfile::TempDir;

const MODEL: &str = "assets/spheres.glb";

/// Small frames, of which what is transparent shows nothing.
const SMALL: [&str; 5] = ["--size", "64x48", "--background", "transparent", "--msaa=1"];

fn render(arguments: &[&str]) -> Output {
    program().arg("render").args(arguments).arg("--json").output().unwrap()
}

/// The report of a run that has succeeded.
fn done(arguments: &[&str]) -> Value {
    let output = render(arguments);
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

fn states(report: &Value) -> Vec<&str> {
    report["pictures"].as_array().unwrap().iter().map(|picture| picture["status"].as_str().unwrap()).collect()
}

/// One line on stderr that has the words, and exit code 2.
fn refused(arguments: &[&str], words: &str) {
    let output = render(arguments);
    let stderr = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.code() == Some(2) && stderr.contains(words), "{arguments:?}: {stderr}");
}

fn folder() -> (TempDir, String) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("out").display().to_string();
    (folder, path)
}

fn open(path: &Path) -> RgbaImage {
    image::open(path).unwrap_or_else(|error| panic!("{}: {error}", path.display())).to_rgba8()
}

fn names(folder: &str) -> Vec<String> {
    let entries = std::fs::read_dir(folder).unwrap();
    let mut names: Vec<String> = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

fn turntable<'a>(frames: &'a str, out: &'a str, more: &[&'a str]) -> Vec<&'a str> {
    [&[MODEL, "--frames", frames, "-o", out][..], &SMALL, more].concat()
}

#[test]
fn a_turntable_shows_the_whole_model_from_all_around() {
    let (_guard, out) = folder();
    let report = done(&turntable("0..4", &out, &["--orbit=0,60"]));
    assert_eq!(states(&report), ["drawn"; 4]);
    let expected: Vec<String> = (0..4).map(|frame| format!("spheres_orbit_{frame:04}.png")).collect();
    assert_eq!(names(&out), expected);
    let frames: Vec<RgbaImage> = expected.iter().map(|name| open(&Path::new(&out).join(name))).collect();
    for (index, frame) in frames.iter().enumerate() {
        assert_eq!(frame.dimensions(), (64, 48));
        let is_border = |x: u32, y: u32| x == 0 || y == 0 || x == 63 || y == 47;
        let covered = frame.enumerate_pixels().filter(|(.., pixel)| pixel.0[3] > 0);
        let (border, inside): (Vec<_>, Vec<_>) = covered.partition(|(x, y, _)| is_border(*x, *y));
        assert!(border.is_empty() && inside.len() > 200, "frame {index}: {} on the border", border.len());
        assert!(frames[..index].iter().all(|other| other != frame), "frame {index} is there twice");
    }
    // A quarter turn is that of the orbit's angle, but for the rounding of edges.
    let (_guard, other) = folder();
    done(&turntable("0..1", &other, &["--orbit=90,60"]));
    let turned = open(&Path::new(&other).join("spheres_orbit_0000.png"));
    let differing = turned.pixels().zip(frames[1].pixels()).filter(|(a, b)| a != b).count();
    assert!(differing < 64 * 48 / 50, "{differing} pixels differ");
}

#[test]
fn frames_are_the_same_whoever_draws_them() {
    let (_guard, out) = folder();
    done(&turntable("0..6", &out, &[]));
    let (_guard, parts) = folder();
    done(&turntable("0..6", &parts, &["--partition=slice:2/2"]));
    assert_eq!(names(&parts).len(), 3);
    done(&turntable("0..6", &parts, &["--partition=slice:1/2"]));
    done(&turntable("4..5", &parts, &["--turn=60", "--frame-name=alone{frame}"]));
    for name in names(&out) {
        let [one, other] = [&out, &parts].map(|folder| std::fs::read(Path::new(folder).join(&name)).unwrap());
        assert_eq!(one, other, "{name}");
    }
    let alone = open(&Path::new(&parts).join("alone4.png"));
    assert_eq!(alone, open(&Path::new(&out).join("spheres_auto_0004.png")));
}

#[test]
fn resumed_runs_draw_what_is_missing_damaged_or_of_other_settings() {
    let (_guard, out) = folder();
    let run = |more: &[&str]| states(&done(&turntable("0..3", &out, more))).join(" ");
    assert_eq!(run(&["--resume"]), "drawn drawn drawn");
    assert_eq!(run(&["--resume"]), "kept kept kept");
    let path = |frame: u32| PathBuf::from(format!("{out}/spheres_auto_{frame:04}.png"));
    let whole = std::fs::read(path(1)).unwrap();
    std::fs::write(path(1), &whole[..whole.len() - 9]).unwrap();
    std::fs::remove_file(path(2)).unwrap();
    assert_eq!(run(&["--resume"]), "kept drawn drawn");
    assert_eq!(std::fs::read(path(1)).unwrap(), whole);
    assert_eq!(run(&["--resume", "--exposure=1"]), "drawn drawn drawn");
    assert_eq!(run(&["--resume", "--exposure=1", "--override=*.perceptual_roughness=0.3"]), "drawn drawn drawn");
    assert_eq!(run(&[]), "drawn drawn drawn");
    // Of a model that is another under the same name.
    let model = format!("{out}/model.glb");
    std::fs::copy(MODEL, &model).unwrap();
    let of_model = |more: &[&str]| {
        let arguments = [&[model.as_str(), "--frames=0..1", "-o", &out][..], &SMALL, more].concat();
        states(&done(&arguments)).join(" ")
    };
    assert_eq!(of_model(&[]), "drawn");
    assert_eq!(of_model(&["--resume"]), "kept");
    std::fs::copy("assets/showcase.glb", &model).unwrap();
    assert_eq!(of_model(&["--resume"]), "drawn");
}

#[test]
fn animations_and_sheets_are_made_of_the_frames() {
    let (_guard, out) = folder();
    let [apng, gif, sheet] = ["turn.png", "turn.gif", "sheet.png"].map(|name| format!("{out}/made/{name}"));
    let more = ["--animation", &apng, "--animation", &gif, "--fps=10", "--contact-sheet", &sheet];
    let report = done(&turntable("0..5", &out, &more));
    assert_eq!(report["made"].as_array().unwrap().len(), 3);
    let file = |path: &str| BufReader::new(std::fs::File::open(path).unwrap());
    let apng = image::codecs::png::PngDecoder::new(file(&apng)).unwrap().apng().unwrap();
    let frames = apng.into_frames().collect_frames().unwrap();
    assert_eq!((frames.len(), frames[0].delay().numer_denom_ms()), (5, (100, 1)));
    for (index, frame) in frames.iter().enumerate() {
        let drawn = open(Path::new(&format!("{out}/spheres_auto_{index:04}.png")));
        // What is transparent may have any colour.
        let same = frame.buffer().pixels().zip(drawn.pixels()).all(|(a, b)| a == b || (a.0[3] == 0 && b.0[3] == 0));
        assert!(same, "frame {index}");
    }
    let gif = image::codecs::gif::GifDecoder::new(file(&gif)).unwrap();
    assert_eq!(gif.into_frames().collect_frames().unwrap().len(), 5);
    assert_eq!(open(Path::new(&sheet)).dimensions(), (3 * 68 - 4, 2 * 52 - 4));
}

/// A folder with a manifest of three jobs, and where their pictures go.
fn manifest() -> (TempDir, String, String) {
    let (guard, out) = folder();
    let model = std::fs::canonicalize(MODEL).unwrap();
    let job = |more: &str| format!("{{\"model\": {:?}, \"size\": \"64x48\", \"msaa\": 1, {more}}}\n", model.display());
    let lines = [
        job("\"output\": \"a/front.png\", \"orbit\": [0, 80]"),
        job("\"output\": \"a/top.png\", \"orbit\": \"0,5\", \"env\": \"white\""),
        job("\"output\": \"normal.png\", \"debug-view\": \"normal\""),
    ];
    let path = guard.path().join("jobs.jsonl");
    std::fs::write(&path, lines.concat()).unwrap();
    (guard, path.display().to_string(), out)
}

#[test]
fn jobs_of_a_manifest_are_what_single_calls_draw() {
    let (_guard, jobs, out) = manifest();
    let run = |more: &[&str]| done(&[&["--manifest", &jobs, "-o", &out][..], more].concat());
    assert_eq!(states(&run(&[])), ["drawn"; 3]);
    assert_eq!(states(&run(&["--resume"])), ["kept"; 3]);
    let single = |name: &str, flags: &[&str]| {
        let path = format!("{out}/single.png");
        done(&[&[MODEL, "-o", &path, "--size=64x48", "--msaa=1"][..], flags].concat());
        assert_eq!(open(Path::new(&path)), open(&Path::new(&out).join(name)), "{name}");
    };
    single("a/front.png", &["--orbit=0,80"]);
    single("a/top.png", &["--orbit=0,5", "--env=white"]);
    single("normal.png", &["--debug-view=normal"]);
    std::fs::remove_dir_all(&out).unwrap();
    let parts = ["1/2", "2/2"].map(|part| states(&run(&[&format!("--partition=hash:{part}")])).len());
    assert_eq!(parts.iter().sum::<usize>(), 3);
    assert_eq!(
        (names(&out), names(&format!("{out}/a"))),
        (vec!["a".into(), "normal.png".into()], vec!["front.png".into(), "top.png".into()])
    );
}

#[test]
fn a_furnace_is_lit_where_other_pictures_are_not() {
    let (guard, out) = folder();
    let model = std::fs::canonicalize(MODEL).unwrap();
    let job = |name: &str, more: &str| {
        let model = model.display();
        format!("{{\"model\": \"{model}\", \"output\": \"{name}\", \"size\": \"64x48\", \"env\": \"black\"{more}}}\n")
    };
    let furnace = ", \"debug-view\": \"furnace\"";
    let jobs = [job("dark.png", ""), job("furnace.png", furnace), job("dark-again.png", "")];
    let path = guard.path().join("jobs.jsonl");
    std::fs::write(&path, jobs.concat()).unwrap();
    assert_eq!(states(&done(&["--manifest", path.to_str().unwrap(), "-o", &out])), ["drawn"; 3]);
    let single = format!("{out}/single.png");
    done(&[MODEL, "-o", &single, "--size=64x48", "--env=black", "--debug-view=furnace"]);
    let of_batch = |name: &str| open(&Path::new(&out).join(name));
    assert_eq!(open(Path::new(&single)), of_batch("furnace.png"));
    assert_eq!(of_batch("dark.png"), of_batch("dark-again.png"));
    assert!(of_batch("furnace.png").pixels().any(|pixel| pixel.0[0] > 200), "nothing is lit");
}

#[test]
fn a_bad_job_costs_itself_alone() {
    let (_guard, jobs, out) = manifest();
    let text = std::fs::read_to_string(&jobs).unwrap();
    let bad = "{\"model\": \"none.glb\", \"output\": \"none.png\"}\n";
    std::fs::write(&jobs, format!("{bad}{text}")).unwrap();
    let output = render(&["--manifest", &jobs, "-o", &out]);
    let report: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(states(&report), ["failed", "drawn", "drawn", "drawn"]);
    let stderr = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.code() == Some(2) && stderr.contains("none.png could not be drawn"), "{stderr}");
    // A mistake in the file ends before anything is drawn.
    std::fs::write(&jobs, format!("{text}{{\"output\": 1}}\n")).unwrap();
    std::fs::remove_dir_all(&out).unwrap();
    refused(&["--manifest", &jobs, "-o", &out], "jobs.jsonl:4: ");
    assert!(!Path::new(&out).exists());
}

#[test]
fn mistakes_are_told() {
    let (_guard, jobs, out) = manifest();
    refused(&turntable("3..3", &out, &[]), "no frame");
    refused(&turntable("0..2", &out, &["--frame-name=x"]), "has no {frame}");
    refused(&turntable("0..2", &out, &["--renderer=reference"]), "leave out --renderer");
    refused(&turntable("0..2", &out, &["--animation=x.webp"]), "unknown kind of animation");
    refused(&turntable("0..2", &out, &["--partition=weight:1/2"]), "take slice or hash");
    refused(&turntable("0..2", &out, &["--partition=hash:1/2", "--contact-sheet=x.png"]), "cannot be used with");
    refused(&turntable("0..2", &out, &["--samples=4"]), "cannot be used with");
    refused(&[MODEL, "-o", &out, "--resume"], "required arguments");
    // What is not heeded is refused.
    for flag in
        [MODEL, "--size=9x9", "--env=white", "--env-rotation=9", "--exposure=1", "--msaa=1", "--orbit=1,2", "--stats=x"]
    {
        refused(&["--manifest", &jobs, "-o", &out, flag], "cannot be used with");
    }
    refused(&["--state=x.json", "-o", "x.png", "--size=9x9"], "cannot be used with");
    refused(&["--state=x.json", "-o", "x.png", "--env-rotation=9"], "cannot be used with");
    refused(&["--manifest", "none.jsonl", "-o", &out], "none.jsonl: cannot be read");
    assert!(!Path::new(&out).exists());
}

#[test]
fn a_killed_run_is_resumed_and_leaves_nothing_behind() {
    let (_guard, out) = folder();
    let arguments = turntable("0..12", &out, &["--resume"]);
    std::fs::create_dir_all(&out).unwrap();
    std::fs::write(format!("{out}/.specula-dead.tmp"), "half a picture").unwrap();
    for files in [3, 7] {
        let mut child =
            program().arg("render").args(&arguments).stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
        // Killed in the middle of it, whenever that is.
        while names(&out).len() < files && child.try_wait().unwrap().is_none() {
            std::thread::sleep(std::time::Duration::from_millis(2));
        }
        child.kill().unwrap();
        child.wait().unwrap();
        for name in names(&out).iter().filter(|name| name.ends_with(".png")) {
            open(&Path::new(&out).join(name));
        }
    }
    let report = done(&arguments);
    let kept = states(&report).iter().filter(|state| **state == "kept").count();
    assert!((6..=12).contains(&kept), "{kept}");
    assert_eq!(names(&out).len(), 12);
}
