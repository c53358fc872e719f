//! `specula test` and `specula accept` as their users start them.

mod crashes;
mod fixture;
mod regressions;

use crate::support::program;
use fixture::{CASE, Fixture, Model, Ran};
use std::path::Path;

fn pixels(path: &Path) -> Vec<u8> {
    image::open(path).unwrap().to_rgba8().into_raw()
}

/// The command after `accept` in the text of a run, without the name of the program.
fn accept_command(ran: &Ran) -> Vec<String> {
    let line = ran.stdout.lines().find_map(|line| line.trim().strip_prefix("accept ")).unwrap_or_else(|| {
        panic!("nothing is said of accepting in {}", ran.stdout);
    });
    let words: Vec<String> = line.split_whitespace().map(str::to_owned).collect();
    assert_eq!(words[0], "specula");
    words[1..].to_vec()
}

#[test]
fn a_missing_golden_fails_and_the_picture_can_be_accepted() {
    let fixture = Fixture::new();
    let ran = fixture.run("test", &[]).expect(1);
    let case = ran.case("sphere");
    assert_eq!(case["status"], "new");
    assert!(ran.stdout.contains("NEW   sphere") && ran.stderr.contains("cases failed: sphere"), "{}", ran.stdout);
    assert!(!fixture.path("s.goldens").exists(), "a run has written a golden that nobody asked for");
    let candidate = Path::new(case["paths"]["actual"].as_str().unwrap());
    assert_eq!(image::open(candidate).unwrap().to_rgb8().dimensions(), (96, 96));

    let output = program().args(accept_command(&ran)).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let golden = fixture.golden("sphere");
    assert_eq!(std::fs::read(&golden).unwrap(), std::fs::read(candidate).unwrap());

    let ran = fixture.run("test", &[]).expect(0);
    let case = ran.case("sphere");
    assert_eq!(case["status"], "pass");
    assert!(case["paths"]["actual"].is_null(), "a picture that is the golden is written again");
    assert_eq!(case["golden_provenance"], case["provenance"]);
    assert!(ran.stdout.contains("1 passed"), "{}", ran.stdout);
}

#[test]
fn goldens_say_where_they_come_from() {
    let fixture = Fixture::new();
    fixture.bless();
    let golden = fixture.golden("sphere");
    let sidecar: serde_json::Value =
        serde_json::from_slice(&std::fs::read(golden.with_extension("json")).unwrap()).unwrap();
    for key in ["version", "name", "driver", "class", "cpu", "scene_hash", "settings_hash", "picture_hash"] {
        assert!(sidecar[key].as_str().is_some_and(|text| !text.is_empty()), "{key} is missing in {sidecar}");
    }
    assert_eq!((&sidecar["case"], &sidecar["suite"]), (&"sphere".into(), &"s".into()));
    // The same in an international text chunk of the PNG.
    let png = std::fs::read(&golden).unwrap();
    let text = String::from_utf8_lossy(&png);
    assert!(text.contains("iTXtspecula:provenance") && text.contains(sidecar["scene_hash"].as_str().unwrap()));

    // What the model refers to is part of the scene, and what it does not is none.
    fixture.write("other.txt", "x");
    let hash = |ran: &Ran| ran.case("sphere")["provenance"]["scene_hash"].clone();
    assert_eq!(hash(&fixture.run("test", &[])), sidecar["scene_hash"]);
    fixture.texture(|x, _| [x as u8, 120, 60]);
    let ran = fixture.run("test", &[]).expect(1);
    assert_ne!(hash(&ran), sidecar["scene_hash"]);
    assert!(ran.stdout.contains("changed    the scene's files\n"), "{}", ran.stdout);
}

#[test]
fn goldens_are_written_only_where_that_was_asked_for() {
    let fixture = Fixture::new();
    let second = CASE.replace("sphere", "second");
    fixture.suite(&(CASE.to_owned() + &second));
    fixture.run("test", &["--update", "changed"]).expect(1);
    assert!(!fixture.golden("sphere").exists());
    fixture.run("test", &["--update", "new", "--filter", "sph*"]).expect(0);
    assert!(fixture.golden("sphere").exists() && !fixture.golden("second").exists());

    let before = std::fs::read(fixture.golden("sphere")).unwrap();
    fixture.model(&Model { perceptual_roughness: 0.6, ..Model::default() });
    let ran = fixture.run("test", &["--update", "new"]).expect(1);
    assert_eq!(
        (ran.case("sphere")["status"].as_str(), ran.case("second")["status"].as_str()),
        (Some("fail"), Some("pass"))
    );
    assert_eq!(std::fs::read(fixture.golden("sphere")).unwrap(), before);
    let ran = fixture.run("test", &["--update", "changed"]).expect(0);
    assert_eq!(ran.case("sphere")["golden_written"], true);
    assert_ne!(std::fs::read(fixture.golden("sphere")).unwrap(), before);

    // A difference within the limits is taken over by `all` alone, and no difference by nothing.
    fixture.model(&Model { perceptual_roughness: 0.602, ..Model::default() });
    let before = std::fs::read(fixture.golden("sphere")).unwrap();
    let ran = fixture.run("test", &["--update", "changed"]).expect(0);
    assert_eq!(ran.case("sphere")["golden_written"], false);
    assert!(ran.case("sphere")["paths"]["actual"].is_string(), "no bit differs: {}", ran.report);
    assert_eq!(std::fs::read(fixture.golden("sphere")).unwrap(), before);
    assert_eq!(fixture.bless().case("sphere")["golden_written"], true);
    assert_eq!(fixture.bless().case("sphere")["golden_written"], false);
}

#[test]
fn only_the_declared_class_may_bless() {
    let fixture = Fixture::new();
    let head = |bless: &str| {
        fixture.write("s.toml", &format!("[suite]\n{bless}\n[defaults]\n{}\n{CASE}", fixture::THRESHOLDS));
    };
    for (bless, expected) in [("", "no adapter may bless"), ("bless = ['nvidia-*']", "those of nvidia-* may")] {
        head(bless);
        let ran = fixture.run("test", &["--update", "new"]).expect(2);
        assert!(ran.stderr.contains(expected), "{}", ran.stderr);
        fixture.run("test", &[]).expect(1);
        let ran = fixture.run("accept", &[]).expect(2);
        assert!(ran.stderr.contains(expected), "{}", ran.stderr);
        assert!(!fixture.path("s.goldens").exists());
    }
    head("bless = ['*']\ngolden-set = 'class'");
    let ran = fixture.bless();
    let class = ran.report["adapter"]["class"].as_str().unwrap();
    assert!(fixture.path("s.goldens").join(class).join("sphere.png").exists(), "no set of {class}");
}

#[test]
fn what_was_not_looked_at_is_not_accepted() {
    let fixture = Fixture::new();
    let refused = |arguments: &[&str], expected: &str| {
        let ran = fixture.run("accept", arguments).expect(2);
        assert!(ran.stderr.contains(expected) && ran.stderr.lines().count() == 1, "{}", ran.stderr);
        assert!(!fixture.path("s.goldens").exists());
    };
    refused(&[], "run `specula test`");
    fixture.run("test", &[]).expect(1);
    refused(&["cube"], "no case of the last run is called cube");
    let actual = fixture.path("s.out/sphere.actual.png");
    let png = std::fs::read(&actual).unwrap();
    std::fs::write(&actual, std::fs::read(fixture.path("texture.png")).unwrap()).unwrap();
    refused(&["sphere"], "is not the picture that was judged");
    std::fs::write(&actual, png).unwrap();
    fixture.suite(&CASE.replace("96x96", "64x64"));
    refused(&[], "the suite has another such case now");
    fixture.suite(CASE);
    fixture.run("accept", &["sph*"]).expect(0);
    assert!(fixture.golden("sphere").exists());
}

#[test]
fn mistakes_end_before_anything_is_drawn() {
    let fixture = Fixture::new();
    let refused = |cases: &str, arguments: &[&str], expected: &str| {
        fixture.suite(cases);
        let ran = fixture.run("test", arguments).expect(2);
        assert!(ran.stderr.contains(expected) && ran.stdout.is_empty(), "{}", ran.stderr);
        assert!(!fixture.path("s.out").exists());
    };
    refused(&format!("{CASE}colour = 1\n"), &[], "s.toml:14: `colour` is no key of [[case]]");
    refused(&format!("{CASE}thresholds = []\n"), &[], "s.toml:14: `thresholds` is empty");
    refused(CASE, &["--filter", "cube"], "no case of");
    let missing = program().args(["test", "no/such.toml"]).output().unwrap();
    assert_eq!(missing.status.code(), Some(2));
    let none = fixture.run("test", &["--adapter", "no such adapter"]).expect(3);
    assert!(none.stderr.contains("no such adapter"), "{}", none.stderr);
}

#[test]
fn cases_are_listed_skipped_and_in_error_one_by_one() {
    let fixture = Fixture::new();
    let case = |name: &str, more: &str| CASE.replace("sphere", name) + more + "\n";
    fixture.suite(
        &[
            case("varied", "matrix = { quality = ['draft', 'high'] }"),
            case("left-out", "skip = { reason = 'a driver', until = 9999-12-31 }"),
            case("back-again", "skip = { reason = 'a driver', until = 2020-01-01 }"),
            CASE.replace("sphere", "broken").replace("model.gltf", "none.glb"),
        ]
        .concat(),
    );
    let ran = fixture.run("test", &["--list"]).expect(0);
    let names = ["varied/quality=draft", "varied/quality=high", "left-out", "back-again", "broken"];
    assert_eq!(ran.stdout.lines().collect::<Vec<_>>(), names);
    let ran = fixture.run("test", &["--update", "new", "--json"]).expect(2);
    let printed: serde_json::Value = serde_json::from_str(&ran.stdout).unwrap();
    assert_eq!(printed, ran.report);
    let states = names.map(|name| ran.case(name)["status"].as_str().unwrap().to_owned());
    assert_eq!(states, ["pass", "pass", "skipped", "pass", "error"]);
    assert!(ran.case("broken")["reason"].as_str().unwrap().contains("none.glb"));
    assert_eq!(ran.case("left-out")["reason"], "a driver (until 9999-12-31)");
    let only = fixture.run("test", &["--filter", "left-out", "--filter", "*=draft"]).expect(0);
    assert_eq!(only.report["cases"].as_array().unwrap().len(), 2);
    assert_eq!(only.report["cases_in_suite"], 5);
}

#[test]
fn variants_of_a_model_are_cases() {
    let fixture = Fixture::new();
    let text = std::fs::read_to_string(fixture.path("model.gltf")).unwrap();
    let mut model: serde_json::Value = serde_json::from_str(&text).unwrap();
    let variants = |value| serde_json::json!({ "KHR_materials_variants": value });
    model["extensionsUsed"] = serde_json::json!(["KHR_lights_punctual", "KHR_materials_variants"]);
    model["extensions"]["KHR_materials_variants"] =
        serde_json::json!({ "variants": [{ "name": "blue" }, { "name": "as it is" }] });
    model["materials"].as_array_mut().unwrap().push(serde_json::json!({
        "name": "paint", "pbrMetallicRoughness": { "baseColorFactor": [0, 0, 1, 1], "metallicFactor": 0 }
    }));
    model["meshes"][0]["primitives"][0]["extensions"] =
        variants(serde_json::json!({ "mappings": [{ "material": 1, "variants": [0] }] }));
    fixture.write("model.gltf", &model.to_string());
    let case = |name: &str, more: &str| CASE.replace("sphere", name) + more + "\n";
    fixture.suite(
        &[case("plain", ""), case("v", "matrix = { variant = ['blue', 'as it is'] }"), case("none", "variant = 'red'")]
            .concat(),
    );
    let ran = fixture.run("test", &["--update", "new"]).expect(2);
    let [plain, blue, same] = ["plain", "v/variant=blue", "v/variant=as_it_is"].map(|id| pixels(&fixture.golden(id)));
    assert!(plain == same && plain != blue, "a variant shows its own materials");
    let middle = &blue[4 * (48 * 96 + 48)..][..3];
    assert!(middle[2] > 2 * middle[0].max(middle[1]), "{middle:?} is not blue");
    let reason = ran.case("none")["reason"].as_str().unwrap();
    let expected =
        "/extensions/KHR_materials_variants/variants: has no variant \"red\"; choose one of: \"blue\", \"as it is\"";
    assert!(reason.ends_with(expected), "{reason}");
}

#[test]
fn goldens_of_no_case_are_told_and_removed_when_that_is_asked_for() {
    let fixture = Fixture::new();
    let second = CASE.replace("sphere", "old/second");
    fixture.suite(&(CASE.to_owned() + &second));
    let ran = fixture.bless();
    assert!(!ran.stderr.contains("of no case"), "{}", ran.stderr);
    fixture.suite(CASE);
    // One of another suite in the same folder, and one from elsewhere.
    std::fs::copy(fixture.golden("sphere"), fixture.golden("foreign")).unwrap();
    let sidecar = std::fs::read_to_string(fixture.golden("old/second").with_extension("json")).unwrap();
    std::fs::copy(fixture.golden("sphere"), fixture.golden("old/third")).unwrap();
    let others = sidecar.replace("old/second", "old/third").replace("\"suite\": \"s\"", "\"suite\": \"t\"");
    fixture.write("s.goldens/any/old/third.json", &others);
    let ran = fixture.run("test", &[]).expect(0);
    assert!(
        ran.stderr.contains("of no case any more: ") && ran.stderr.contains("second.png; `specula"),
        "{}",
        ran.stderr
    );
    let ran = fixture.run("accept", &["--remove-unused"]).expect(0);
    assert_eq!(ran.stdout, format!("removed {}\n", fixture.golden("old/second").display()));
    assert!(!fixture.golden("old/second").with_extension("json").exists());
    for id in ["sphere", "foreign", "old/third"] {
        assert!(fixture.golden(id).exists(), "{id} is gone");
    }
    let ran = fixture.run("test", &[]).expect(0);
    assert!(!ran.stderr.contains("of no case"), "{}", ran.stderr);
}

#[test]
fn cases_that_failed_are_run_again_alone() {
    let fixture = Fixture::new();
    fixture.suite(&(CASE.to_owned() + &CASE.replace("sphere", "second")));
    fixture.run("test", &["--failed"]).expect(2);
    fixture.run("test", &["--update", "new", "--filter", "second"]).expect(0);
    fixture.run("test", &[]).expect(1);
    let ran = fixture.run("test", &["--failed", "--update", "new"]).expect(0);
    assert_eq!(ran.report["cases"].as_array().unwrap().len(), 1, "{}", ran.report);
    assert_eq!(ran.case("sphere")["golden_written"], true);
    let ran = fixture.run("test", &["--failed"]).expect(2);
    assert!(ran.stderr.contains("no such case has failed in the last run"), "{}", ran.stderr);
}

#[test]
fn repetitions_are_the_same_bit_by_bit_and_so_are_runs() {
    let fixture = Fixture::new();
    fixture.suite(&format!("{CASE}matrix = {{ quality = ['draft', 'standard'], msaa = [1, 4] }}\n"));
    let ran = fixture.run("test", &["--update", "new", "--repeat", "3"]).expect(0);
    for case in ran.report["cases"].as_array().unwrap() {
        let metric = &case["metrics"][0];
        assert_eq!((&metric["name"], &metric["value"]), (&"repeat.pixels".into(), &0.0.into()), "{case}");
    }
    let assert_same = |ran: &Ran| {
        for case in ran.report["cases"].as_array().unwrap() {
            assert!(case["paths"]["actual"].is_null(), "a bit differs: {case}");
        }
    };
    assert_same(&fixture.run("test", &["-j", "4"]).expect(0));
    // What cases share makes no difference: with the others or alone.
    fixture.suite(&format!("{CASE}matrix = {{ env = ['neutral', 'white'], quality = ['split-sum', 'standard'] }}\n"));
    fixture.bless();
    for alone in ["*env=neutral,quality=standard", "*env=white,quality=split-sum", "*env=white,quality=standard"] {
        assert_same(&fixture.run("test", &["--filter", alone]).expect(0));
    }
}

#[test]
fn furnaces_and_references_need_no_golden() {
    let fixture = Fixture::new();
    fixture.model(&Model { perceptual_roughness: 0.5, textured: false, light_cd: None, ..Model::default() });
    let small = CASE.replace("96x96", "48x48");
    let furnace = small.replace("sphere", "furnace") + "kind = 'furnace'\nwithin = '0.5%'\n";
    let reference = |name: &str, limit: &str| {
        let truth = small.replace("sphere", name) + "kind = 'reference'\nsamples = 128\n";
        format!("{truth}thresholds = ['flip.mean <= {limit}']\n")
    };
    fixture.suite(&[furnace, reference("truth", "0.05"), reference("strict", "0.0001")].concat());
    let ran = fixture.run("test", &[]).expect(1);
    let of = |id: &str| ran.case(id)["status"].as_str().unwrap().to_owned();
    // Edges are sampled in other ways, and the reference is noisy.
    assert_eq!(["furnace", "truth", "strict"].map(of), ["pass", "pass", "fail"]);
    let metric = &ran.case("furnace")["metrics"][0];
    assert!(metric["value"].as_f64().unwrap() < 0.005 && metric["limit"] == 0.005, "{metric}");
    assert!(!fixture.path("s.goldens").exists());

    // A surface that takes away a tenth of the light fails in a furnace; the reference takes it away too.
    fixture.model(&Model { base_color: [0.9, 0.9, 0.9, 1.0], textured: false, light_cd: None, ..Model::default() });
    let ran = fixture.run("test", &[]).expect(1);
    assert_eq!(ran.broken("furnace"), ["furnace.max"]);
    assert_eq!(ran.case("truth")["status"], "pass");
    assert!(ran.stdout.contains("furnace.max is 0.0") && ran.case("furnace")["accept"].is_null(), "{}", ran.stdout);
}

#[test]
fn masks_and_limits_of_classes_are_heeded() {
    let fixture = Fixture::new();
    fixture.bless();
    fixture.texture(|_, _| [250, 250, 250]);
    fixture.run("test", &[]).expect(1);
    // The corner alone, where no sphere is.
    let corner = image::GrayImage::from_fn(96, 96, |x, y| image::Luma([if x < 8 && y < 8 { 255 } else { 0 }]));
    corner.save(fixture.path("corner.png")).unwrap();
    fixture.suite(&format!("{CASE}mask = \"corner.png\"\n"));
    fixture.run("test", &[]).expect(0);
    fixture.suite(&format!("[class.\"*\"]\nthresholds = [\"pixels <= 99%\"]\n{CASE}"));
    let ran = fixture.run("test", &[]).expect(0);
    let from = ran.case("sphere")["metrics"][0]["limit_from"].as_str().unwrap();
    assert!(from.ends_with("s.toml:8"), "{from}");
}

#[test]
fn pictures_of_another_size_and_large_files_are_told() {
    let fixture = Fixture::new();
    fixture.bless();
    fixture.suite(&CASE.replace("96x96", "64x64"));
    let ran = fixture.run("test", &[]).expect(1);
    assert_eq!(ran.case("sphere")["reason"], "the golden is 96 x 96 pixels, the picture 64 x 64");
    fixture.write(
        "s.toml",
        &format!("[suite]\nbless = ['*']\ngolden-kib = 1\n[defaults]\n{}\n{CASE}", fixture::THRESHOLDS),
    );
    let before = std::fs::read(fixture.golden("sphere")).unwrap();
    fixture.texture(|x, y| [(x * 37 % 256) as u8, (y * 91 % 256) as u8, ((x * y) % 256) as u8]);
    let ran = fixture.run("test", &["--update", "all"]).expect(2);
    assert!(ran.case("sphere")["reason"].as_str().unwrap().contains("more than the 1 KiB"), "{}", ran.report);
    assert_eq!(std::fs::read(fixture.golden("sphere")).unwrap(), before);
    std::fs::write(fixture.golden("sphere"), "no picture").unwrap();
    let ran = fixture.run("test", &[]).expect(2);
    assert!(ran.case("sphere")["reason"].as_str().unwrap().contains("cannot be read"), "{}", ran.report);
}
