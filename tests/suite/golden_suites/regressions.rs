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

/// What is said of one thing that has moved.
fn moved<'a>(ran: &'a Ran, what: &str) -> Vec<&'a str> {
    let found = ran.case("sphere")["moved"].as_array().map(Vec::as_slice).unwrap_or_default();
    let of = found.iter().filter(|finding| finding["moved"] == what);
    of.map(|finding| finding["text"].as_str().unwrap()).collect()
}

/// A fault to plant, and how it has to be attributed: what has moved, and words of the sentence.
struct Plant {
    what: &'static str,
    plant: fn(&Fixture),
    moved: &'static str,
    words: &'static [&'static str],
}

const PLANTS: [Plant; 5] = [
    Plant {
        what: "a swapped texture",
        plant: |fixture| fixture.texture(|x, y| [if (x / 8 + y / 8) % 2 == 0 { 40 } else { 220 }, 120, 60]),
        moved: "material",
        words: &["material \"ball\": base-color differs by about 0.", "another base_color texture"],
    },
    Plant {
        what: "a change of perceptual roughness",
        plant: |fixture| fixture.model(&Model { perceptual_roughness: 0.45, ..Model::default() }),
        moved: "material",
        words: &[
            "material \"ball\": perceptual-roughness 0.300 -> 0.450, and so direct-",
            "direct-specular",
            "ibl-specular",
        ],
    },
    Plant {
        what: "a missing light",
        plant: |fixture| fixture.model(&Model { light_cd: None, ..Model::default() }),
        moved: "lights",
        words: &["no longer there: point light of 20 cd at (2, 2, 3) m; with it direct-diffuse, direct-specular"],
    },
    Plant {
        what: "a shift by one pixel",
        plant: |fixture| {
            fixture
                .suite(&CASE.replace("eye = [0, 0, 3]", "eye = [0.025, 0, 3]").replace("[0, 0, 0]", "[0.025, 0, 0]"));
        },
        moved: "geometry",
        words: &["all that is seen has moved by -1.00 pixels to the right and +0.00 down"],
    },
    Plant {
        what: "a colour that is no longer multiplied",
        plant: |fixture| fixture.model(&Model { textured: false, ..Model::default() }),
        moved: "material",
        words: &["material \"ball\": base-color (", "-> 1.000", "no base_color texture any more"],
    },
];

#[test]
fn planted_regressions_are_caught_and_attributed() {
    let fixture = Fixture::new();
    fixture.bless();
    let golden = std::fs::read(fixture.golden("sphere")).unwrap();
    let passed = fixture.run("test", &[]).expect(0);
    assert!(passed.case("sphere")["moved"].is_null() && passed.case("sphere")["ingredients"].is_null());
    for Plant { what, plant, moved: kind, words } in PLANTS {
        plant(&fixture);
        let ran = caught(&fixture, what);
        assert!(ran.case("sphere")["accept"].is_string(), "{what}");
        assert_eq!(std::fs::read(fixture.golden("sphere")).unwrap(), golden, "{what} has changed the golden");
        let found = ran.case("sphere")["moved"].as_array().unwrap();
        let [text] = moved(&ran, kind)[..] else { panic!("{what}: {found:?}") };
        assert_eq!(found.len(), 1, "{what}: {found:?}");
        for word in words {
            assert!(text.contains(word), "{what}: {text}");
        }
        // In every form of the report.
        assert!(ran.stdout.contains(&format!("moved      {text}\n")), "{what}: {}", ran.stdout);
        let quoted = text.replace('"', "&quot;").replace('>', "&gt;");
        for file in ["junit.xml", "report.html"] {
            let report = std::fs::read_to_string(fixture.path("s.out").join(file)).unwrap();
            assert!(report.contains(&quoted) || report.contains(&text.replace('>', "&gt;")), "{what}: {file}");
        }
        fixture.texture(|x, y| [if (x / 8 + y / 8) % 2 == 0 { 220 } else { 40 }, 120, 60]);
        fixture.model(&Model::default());
        fixture.suite(CASE);
    }
    fixture.run("test", &[]).expect(0);
}

#[test]
fn what_comes_after_the_light_is_told_by_what_is_the_same() {
    let fixture = Fixture::new();
    fixture.bless();
    fixture.suite(&format!("{CASE}exposure = 0.5\n"));
    let ran = caught(&fixture, "an exposure");
    assert!(moved(&ran, "display")[0].contains("all parts of the light are the same"), "{}", ran.stdout);
    fixture.suite(&format!("{CASE}energy-compensation = \"off\"\n"));
    fixture.model(&Model { perceptual_roughness: 1.0, ..Model::default() });
    fixture.bless();
    fixture.suite(&format!("{CASE}thresholds = [\"pixels <= 0\"]\n"));
    let ran = fixture.run("test", &[]).expect(1);
    let text = moved(&ran, "shading")[0];
    assert!(text.contains("-multiple-scattering 0 -> ") && text.ends_with("so its shading is not"), "{text}");
}

#[test]
fn furnaces_and_references_say_which_light_is_not_as_it_should_be() {
    let fixture = Fixture::new();
    fixture.model(&Model { base_color: [0.9, 1.0, 1.0, 1.0], textured: false, light_cd: None, ..Model::default() });
    let furnace = format!("{CASE}kind = \"furnace\"\nwithin = \"0.5%\"\n");
    let spheres = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/spheres.glb");
    let truth = |name: &str, more: &str| {
        let spheres = spheres.display();
        format!(
            "[[case]]\nname = \"{name}\"\nmodel = \"{spheres}\"\nsize = \"48x48\"\nkind = \"reference\"\n\
             samples = 16\n{more}thresholds = [\"pixels <= 0\"]\n"
        )
    };
    sky_with_a_sun(&fixture.path("sky.hdr"));
    let blurred = truth("blurred", "env = \"sky.hdr\"\nquality = \"split-sum\"\n");
    let reference = blurred + &truth("hidden", "bounces = 2\n");
    fixture.suite(&format!("{furnace}{reference}"));
    let ran = fixture.run("test", &[]).expect(1);
    let [text] = moved(&ran, "material")[..] else { panic!("{}", ran.stdout) };
    assert!(text.starts_with("material \"ball\" returns (0.9") && text.contains("(diffuse (0."), "{text}");
    assert!(text.ends_with(": its base-color of (0.900, 1.000, 1.000) is not white"), "{text}");
    assert!(ran.stdout.contains(&format!("moved      {text}\n")), "{}", ran.stdout);
    let of = |case: &str, moved: &str, quantity: &str| {
        let case = ran.case(case)["moved"].as_array().unwrap();
        let mut found = case.iter().filter(|finding| finding["moved"] == moved && finding["quantities"][0] == quantity);
        found.next().unwrap_or_else(|| panic!("no {quantity} in {case:?}"))["text"].as_str().unwrap()
    };
    // The split sum smears the sun over rough metals; there is no other light.
    let text = of("blurred", "shading", "ibl-specular");
    assert!(text.contains(" metal ") || text.contains("gold"), "{text}");
    assert!(text.contains(" % more than the truth's ") && text.contains("(+- "), "{text}");
    assert!(!ran.case("blurred")["moved"].to_string().contains("direct-"), "{}", ran.stdout);
    // Spheres hide light from each other, and send it on.
    let text = of("hidden", "lights", "bounces");
    assert!(text.contains("make the truth of 2 bounces ") && text.ends_with("pictures have neither"), "{text}");
}

fn sky_with_a_sun(path: &Path) {
    let texel = |pixel: usize| match (pixel % 64, pixel / 64) {
        (20..23, 8..11) => image::Rgb([300.0, 280.0, 250.0]),
        _ => image::Rgb([0.3, 0.4, 0.6_f32]),
    };
    let texels: Vec<image::Rgb<f32>> = (0..64 * 32).map(texel).collect();
    image::codecs::hdr::HdrEncoder::new(std::fs::File::create(path).unwrap()).encode(&texels, 64, 32).unwrap();
}

#[test]
fn accepting_keeps_what_the_golden_is_made_of() {
    let fixture = Fixture::new();
    fixture.run("test", &[]).expect(1);
    fixture.run("accept", &[]).expect(0);
    fixture.model(&Model { perceptual_roughness: 0.45, ..Model::default() });
    let ran = caught(&fixture, "a change of perceptual roughness");
    assert_eq!(moved(&ran, "material").len(), 1, "{}", ran.stdout);
    // Of a golden that came from elsewhere nothing is claimed.
    let sidecar = fixture.golden("sphere").with_extension("json");
    let text = std::fs::read_to_string(&sidecar).unwrap();
    let mut value: serde_json::Value = serde_json::from_str(&text).unwrap();
    value["picture_hash"] = "of another".into();
    for other in [value.to_string(), "{}".into()] {
        std::fs::write(&sidecar, other).unwrap();
        let ran = caught(&fixture, "a change of perceptual roughness");
        assert!(moved(&ran, "unknown")[0].contains("nothing is kept"), "{}", ran.stdout);
    }
}

#[test]
fn black_frames_and_nan_are_caught_and_never_become_goldens() {
    let fixture = Fixture::new();
    fixture.bless();
    let golden = std::fs::read(fixture.golden("sphere")).unwrap();
    let dark = format!("{CASE}env = \"black\"\nbackground = \"#000000\"\n");
    let infinite = format!("{CASE}env-intensity = 3e38\n");
    // The lobe of a black surface takes nothing of an infinite illuminance, which is no number.
    let no_number =
        format!("{CASE}light = [\"point:intensity=3e38cd,at=0,0,1.3\"]\noverride = [\"ball.base_color=#000000\"]\n");
    let broken = [
        (&dark, "the picture is blank: #000000", "lights", "no longer there: environment neutral of intensity 1"),
        (&infinite, "is infinite", "fault", "material \"ball\": radiance is infinite in "),
        (&no_number, "the radiance of pixel (", "fault", "material \"ball\": radiance is NaN in "),
    ];
    for (suite, reason, kind, words) in broken {
        fixture.model(&Model { light_cd: None, ..Model::default() });
        fixture.suite(suite);
        let ran = caught(&fixture, reason);
        let case = ran.case("sphere");
        assert!(case["reason"].as_str().unwrap().contains(reason) && case["accept"].is_null(), "{case}");
        assert!(moved(&ran, kind).iter().any(|text| text.contains(words)), "{words}: {}", ran.stdout);
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
