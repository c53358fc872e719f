//! Planted regressions: each has to be caught by everyday limits, and what people need to act on it has to be said.

use super::fixture::{CASE, Fixture, Model, Ran};
use super::pixels;
use std::path::Path;

/// A run after something has been broken: it fails, names limits with their place, and leaves three pictures.
fn caught(fixture: &Fixture, what: &str) -> Ran {
    let ran = fixture.run("test", &[]).expect(1);
    assert_eq!(ran.case("sphere")["status"], "fail", "{what} was not caught");
    let broken = ran.broken("sphere");
    assert!(!broken.is_empty(), "{what}: no limit is broken in {}", ran.report);
    for name in broken {
        assert!(ran.stdout.contains(&format!("{name} is ")), "{what}: {}", ran.stdout);
    }
    assert!(ran.stdout.contains("s.toml:5"), "{what}: where the limit comes from is missing in {}", ran.stdout);
    for key in ["actual", "golden", "difference", "heat_map"] {
        let path = ran.case("sphere")["paths"][key].as_str().unwrap_or_else(|| panic!("{what}: no {key}"));
        assert!(ran.stdout.contains(path), "{what}: {path} is missing in {}", ran.stdout);
        assert_eq!(pixels(Path::new(path)).len(), 96 * 96 * 4, "{what}: {key}");
    }
    ran
}

#[test]
fn planted_regressions_are_caught() {
    let fixture = Fixture::new();
    fixture.bless();
    let golden = std::fs::read(fixture.golden("sphere")).unwrap();
    fixture.run("test", &[]).expect(0);
    type Plant = fn(&Fixture);
    let plants: [(&str, Plant); 5] = [
        ("a swapped texture", |fixture| {
            fixture.texture(|x, y| [if (x / 8 + y / 8) % 2 == 0 { 40 } else { 220 }, 120, 60]);
        }),
        ("a change of perceptual roughness", |fixture| {
            fixture.model(&Model { perceptual_roughness: 0.45, ..Model::default() });
        }),
        ("a missing light", |fixture| fixture.model(&Model { light_cd: None, ..Model::default() })),
        ("a shift by one pixel", |fixture| {
            fixture
                .suite(&CASE.replace("eye = [0, 0, 3]", "eye = [0.025, 0, 3]").replace("[0, 0, 0]", "[0.025, 0, 0]"));
        }),
        ("a colour that is no longer multiplied", |fixture| {
            fixture.model(&Model { textured: false, ..Model::default() });
        }),
    ];
    for (what, plant) in plants {
        plant(&fixture);
        let ran = caught(&fixture, what);
        assert!(ran.case("sphere")["accept"].is_string(), "{what}");
        assert_eq!(std::fs::read(fixture.golden("sphere")).unwrap(), golden, "{what} has changed the golden");
        fixture.texture(|x, y| [if (x / 8 + y / 8) % 2 == 0 { 220 } else { 40 }, 120, 60]);
        fixture.model(&Model::default());
        fixture.suite(CASE);
    }
    fixture.run("test", &[]).expect(0);
}

#[test]
fn black_frames_and_nan_are_caught_and_never_become_goldens() {
    let fixture = Fixture::new();
    fixture.bless();
    let golden = std::fs::read(fixture.golden("sphere")).unwrap();
    let dark = format!("{CASE}env = \"black\"\nbackground = \"#000000\"\n");
    let infinite = format!("{CASE}env-intensity = 3e38\n");
    for (suite, reason) in [(&dark, "the picture is blank: #000000"), (&infinite, "is infinite")] {
        fixture.model(&Model { light_cd: None, ..Model::default() });
        fixture.suite(suite);
        let ran = caught(&fixture, reason);
        let case = ran.case("sphere");
        assert!(case["reason"].as_str().unwrap().contains(reason) && case["accept"].is_null(), "{case}");
        // Not even when that is asked for.
        let ran = fixture.run("test", &["--update", "all"]).expect(1);
        assert!(ran.stdout.contains("cannot become a golden"), "{}", ran.stdout);
        let refused = fixture.run("accept", &["sphere"]).expect(2);
        assert!(refused.stderr.contains("cannot become a golden"), "{}", refused.stderr);
        assert_eq!(std::fs::read(fixture.golden("sphere")).unwrap(), golden);
    }
    std::fs::remove_dir_all(fixture.path("s.goldens")).unwrap();
    for suite in [&dark, &infinite] {
        fixture.suite(suite);
        let ran = fixture.run("test", &["--update", "all"]).expect(1);
        assert_eq!(ran.case("sphere")["status"], "new");
        assert!(!fixture.path("s.goldens").exists());
    }
}

#[test]
fn a_blank_golden_of_unknown_origin_is_refused() {
    let fixture = Fixture::new();
    std::fs::create_dir_all(fixture.path("s.goldens/any")).unwrap();
    image::RgbImage::new(96, 96).save(fixture.golden("sphere")).unwrap();
    let ran = fixture.run("test", &[]).expect(2);
    assert!(ran.case("sphere")["reason"].as_str().unwrap().contains("is no golden"), "{}", ran.report);
}
