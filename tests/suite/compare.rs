//! `specula compare` as its users start it.

use crate::support::program;
use specula::metrics::Pair;
use specula::metrics::flip::flip;
use specula::metrics::heat::heat;
use std::path::{Path, PathBuf};
use std::process::{Output, Stdio};
use tempfile::TempDir;

/// Pictures in a folder of their own.
struct Fixture {
    folder: TempDir,
}

impl Fixture {
    fn new() -> Self {
        Self { folder: tempfile::tempdir().unwrap() }
    }

    fn path(&self, name: &str) -> String {
        self.folder.path().join(name).display().to_string()
    }

    /// A grey ramp of 24 x 16 pixels; `change` is added at pixel (5, 3).
    fn png(&self, name: &str, change: u8) -> String {
        let picture = image::RgbImage::from_fn(24, 16, |x, y| {
            let code = (x * 8) as u8 + if (x, y) == (5, 3) { change } else { 0 };
            image::Rgb([code, 64, code])
        });
        picture.save(self.path(name)).unwrap();
        self.path(name)
    }

    /// The same with 16 bits.
    fn png16(&self, name: &str, change: u16) -> String {
        let picture = image::ImageBuffer::from_fn(24, 16, |x, y| {
            let code = x as u16 * 8 * 257 + if (x, y) == (5, 3) { change } else { 0 };
            image::Rgb([code, 64 * 257, code])
        });
        picture.save(self.path(name)).unwrap();
        self.path(name)
    }

    /// Radiance of 24 x 16 pixels; that of pixel (5, 3) is `at`.
    fn exr(&self, name: &str, at: f32) -> String {
        let value = |x: usize, y: usize| if (x, y) == (5, 3) { at } else { x as f32 };
        exr::prelude::write_rgba_file(self.path(name), 24, 16, |x, y| (value(x, y), 1.0, 2.0, 1.0)).unwrap();
        self.path(name)
    }
}

fn compare(arguments: &[&str]) -> Output {
    program().arg("compare").args(arguments).output().unwrap()
}

/// One line on stderr with all of `expected`, or none where nothing is expected, and the exit code.
fn assert_ends(arguments: &[&str], code: i32, expected: &[&str]) -> String {
    let output = compare(arguments);
    let error = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(code), "{arguments:?}: {error}");
    for text in expected {
        assert!(error.contains(text), "{arguments:?}: {error:?} does not say {text:?}");
    }
    if code < 2 {
        assert_eq!(error.lines().count(), usize::from(code == 1), "{error}");
    } else {
        assert!(output.stdout.is_empty(), "{arguments:?}: stdout is not empty");
    }
    String::from_utf8(output.stdout).unwrap()
}

#[test]
fn equal_pictures_are_equal() {
    let fixture = Fixture::new();
    let (a, b) = (fixture.png("a.png", 0), fixture.png("b.png", 0));
    let text = assert_ends(&[&a, &b], 0, &[]);
    for name in ["pixels", "max-abs", "relative-rms", "psnr", "ssim", "flip.mean", "flip.p99"] {
        assert!(text.contains(name), "{name} is missing in {text}");
    }
    assert!(!text.contains("hdr-flip"), "{text}");
    // The same numbers with more bits.
    assert_ends(&[&a, &fixture.png16("deep.png", 0)], 0, &[]);
    let (a, b) = (fixture.exr("a.exr", 1.0), fixture.exr("b.exr", 1.0));
    let text = assert_ends(&[&a, &b], 0, &[]);
    assert!(text.contains("hdr-flip.mean") && !text.contains("psnr"), "{text}");
}

#[test]
fn different_pictures_end_with_1() {
    let fixture = Fixture::new();
    let (a, b) = (fixture.png("a.png", 100), fixture.png("b.png", 0));
    let text = assert_ends(&[&a, &b], 1, &["a.png differs from", "0.2604 %"]);
    assert!(text.contains("R of pixel (5, 3)"), "{text}");
    assert_ends(&[&fixture.png16("deep.png", 1), &b], 1, &["differs"]);
    let (a, b) = (fixture.exr("a.exr", 5.5), fixture.exr("b.exr", 5.0));
    assert_ends(&[&a, &b], 1, &["a.exr differs from"]);
}

#[test]
fn conditions_decide() {
    let fixture = Fixture::new();
    let (a, b) = (fixture.png("a.png", 100), fixture.png("b.png", 0));
    assert_ends(&[&a, &b, "--fail", "flip.mean<=0.1, max-abs <= 0.4, psnr>=20,pixels<=1%"], 0, &[]);
    assert_ends(&[&a, &b, "--fail", "max-abs<=0.39"], 1, &["max-abs is 0.392157, not <= 0.39"]);
    assert_ends(&[&a, &b, "--fail", "max-abs<=0.39", "--fail", "ssim>1"], 1, &["max-abs is", "and 1 more"]);
    assert_ends(&[&b, &b, "--fail", "pixels>0"], 1, &["pixels is 0"]);
    // A condition is measured even where other metrics were named.
    let text = assert_ends(&[&a, &b, "--metric", "psnr", "--fail", "pixels<=1%"], 0, &[]);
    assert!(text.contains("psnr") && text.contains("pixels ") && !text.contains("flip"), "{text}");
}

#[test]
fn masks_select() {
    let fixture = Fixture::new();
    let (a, b) = (fixture.png("a.png", 100), fixture.png("b.png", 0));
    let mask = |name: &str, white: &dyn Fn(u32, u32) -> bool| {
        let picture = image::GrayImage::from_fn(24, 16, |x, y| image::Luma([if white(x, y) { 255 } else { 0 }]));
        picture.save(fixture.path(name)).unwrap();
        fixture.path(name)
    };
    let without = mask("without.png", &|x, y| (x, y) != (5, 3));
    let text = assert_ends(&[&a, &b, "--mask", &without], 0, &[]);
    assert!(text.contains("383 pixels count"), "{text}");
    let only = mask("only.png", &|x, y| (x, y) == (5, 3));
    assert_ends(&[&a, &b, "--mask", &only], 1, &["100.0000 %"]);
    // No window about this pixel lies within the picture.
    assert_ends(&[&a, &b, "--mask", &only, "--fail", "ssim>=0.5"], 2, &["ssim cannot be measured"]);
    assert_ends(&[&a, &b, "--mask", &mask("none.png", &|_, _| false)], 2, &["none.png", "selects no pixel"]);
}

#[test]
fn json_has_everything() {
    let fixture = Fixture::new();
    let (a, b) = (fixture.png("a.png", 100), fixture.png("b.png", 0));
    let text = assert_ends(&[&a, &b, "--json", "--fail", "max-abs<=0.39"], 1, &["max-abs"]);
    let json: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert_eq!(json["schema"], "specula-compare/1");
    assert_eq!(json["size_px"], serde_json::json!([24, 16]));
    assert_eq!(json["broken"], serde_json::json!(["max-abs <= 0.39"]));
    assert_eq!(json["equal"], false);
    assert!((json["values"]["max-abs"].as_f64().unwrap() - 100.0 / 255.0).abs() < 1e-7);
    assert!(json["values"]["flip.mean"].as_f64() > Some(0.0));
    let text = assert_ends(&[&b, &b, "--json"], 0, &[]);
    let json: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert_eq!((&json["equal"], &json["values"]["psnr"]), (&true.into(), &serde_json::Value::Null));
}

#[test]
fn pictures_of_the_difference_are_written() {
    let fixture = Fixture::new();
    let (a, b) = (fixture.png("a.png", 100), fixture.png("b.png", 0));
    let [difference, heat_map, signed] = ["difference.png", "heat.png", "signed.exr"].map(|name| fixture.path(name));
    assert_ends(&[&a, &b, "--difference", &difference, "--heat-map", &heat_map, "--metric", "pixels"], 1, &[]);
    let picture = image::open(&difference).unwrap().to_rgb8();
    assert_eq!((picture.get_pixel(5, 3).0, picture.get_pixel(4, 3).0), ([255, 0, 255], [0, 0, 0]));
    let picture = image::open(&heat_map).unwrap().to_rgb8();
    let [shown, wanted] = [&a, &b].map(|path| specula::import::picture_from_path(Path::new(path)).unwrap());
    let map = flip(&Pair::new(&shown, &wanted, None).unwrap());
    assert!(map.values.iter().any(|&error| error > 0.1));
    for (pixel, &error) in picture.pixels().zip(&map.values) {
        assert_eq!(pixel.0, heat(error));
    }
    let (a, b) = (fixture.exr("a.exr", 5.0), fixture.exr("b.exr", 5.5));
    assert_ends(&[&a, &b, "--difference", &signed], 1, &[]);
    let read = specula::import::picture_from_path(Path::new(&signed)).unwrap();
    assert_eq!(read.texels[3 * 24 + 5].truncate().to_array(), [-0.5, 0.0, 0.0]);
}

#[test]
fn invisible_colours_are_no_difference() {
    let fixture = Fixture::new();
    let save = |name: &str, color: [u8; 4]| {
        image::RgbaImage::from_pixel(12, 12, image::Rgba(color)).save(fixture.path(name)).unwrap();
        fixture.path(name)
    };
    let (red, green) = (save("red.png", [255, 0, 0, 0]), save("green.png", [0, 255, 0, 0]));
    assert_ends(&[&red, &green], 0, &[]);
    assert_ends(&[&red, &save("opaque.png", [0, 0, 0, 255])], 1, &["differs"]);
}

#[test]
fn a_picture_comes_through_a_pipe() {
    let fixture = Fixture::new();
    let b = fixture.png("b.png", 0);
    let output =
        program().args(["compare", "-", &b]).stdin(Stdio::from(std::fs::File::open(&b).unwrap())).output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    assert_ends(&["-", "-"], 2, &["only one picture"]);
}

#[test]
fn mistakes_get_one_line() {
    let fixture = Fixture::new();
    let (png, exr) = (fixture.png("a.png", 0), fixture.exr("a.exr", 1.0));
    let small: PathBuf = fixture.path("small.png").into();
    image::RgbImage::new(5, 4).save(&small).unwrap();
    let small = small.display().to_string();
    let [nan, infinite] = [("nan.exr", f32::NAN), ("infinite.exr", f32::INFINITY)].map(|(n, v)| fixture.exr(n, v));
    let text = fixture.path("text.png");
    std::fs::write(&text, "no picture").unwrap();
    let broken = fixture.path("broken.png");
    let bytes = std::fs::read(&png).unwrap();
    std::fs::write(&broken, &bytes[..bytes.len() / 2]).unwrap();

    assert_ends(&[&png, &small], 2, &["a.png is 24 x 16", "small.png is 5 x 4"]);
    assert_ends(&[&png, &exr], 2, &["a.png is display-referred", "a.exr is linear"]);
    assert_ends(&[&exr, &nan], 2, &["nan.exr: pixel (5, 3): R is NaN"]);
    assert_ends(&[&infinite, &exr], 2, &["infinite.exr: pixel (5, 3): R is inf"]);
    assert_ends(&[&png, &png, "--mask", &small], 2, &["small.png is 5 x 4"]);
    assert_ends(&[&png, "no/such.png"], 2, &["no/such.png"]);
    assert_ends(&[&png, &text], 2, &["text.png", "neither a PNG nor an OpenEXR"]);
    assert_ends(&[&png, &broken], 2, &["broken.png", "cannot be decoded"]);
    assert_ends(&[&png, &png, "--fail", "flip<=1"], 2, &["flip.mean"]);
    assert_ends(&[&png, &png, "--fail", ""], 2, &["no condition"]);
    assert_ends(&[&png, &png, "--fail", "hdr-flip.mean<=1"], 2, &["hdr-flip is not for", "take flip"]);
    assert_ends(&[&exr, &exr, "--metric", "ssim"], 2, &["ssim is not for", "take hdr-flip"]);
    assert_ends(&[&png, &png, "--heat-map", "-"], 2, &["stdout"]);
    let heat = fixture.path("heat.exr");
    assert_ends(&[&png, &png, "--heat-map", &heat], 2, &["a heat map is a .png"]);
    assert!(!Path::new(&heat).exists());
}
