//! The HTML report in a browser: clicked, dragged, zoomed, looked at, and offered hostile names.

use crate::browser::{Browser, chromium};
use crate::report_fixture::{HOSTILE, SIZE_PX, color, hostile, report, write, write_pictures};
use crate::support::program;
use serde_json::{Value, json};
use std::path::Path;

/// The page of a report, as `merge-reports` writes it.
fn page(folder: &Path, report: &Value) -> std::path::PathBuf {
    write_pictures(folder);
    write(folder, "part", report);
    let output = program().current_dir(folder).args(["merge-reports", "part", "-o", "out"]).output().unwrap();
    let page = folder.join("out/report.html");
    assert!(page.is_file(), "{output:?}");
    page
}

/// The case that fails, and its views.
const CASE: &str = "details[data-status=fail]";

fn view(role: &str) -> String {
    format!("{CASE} figure[data-role={role}] .view")
}

fn button(mode: &str) -> String {
    format!("{CASE} button[data-mode={mode}]")
}

/// The role whose picture a place of the window shows, by its colour.
fn shown(picture: &image::RgbaImage, (x, y): (f64, f64)) -> &'static str {
    let blue = picture.get_pixel(x as u32, y as u32).0[2];
    let role = crate::report_fixture::BLUE.into_iter().find(|(_, b)| b.abs_diff(blue) <= 3);
    role.map_or("nothing", |(role, _)| role)
}

#[test]
fn pictures_are_compared_by_pointer_and_keys() {
    let Some(program) = chromium() else { return };
    let folder = tempfile::tempdir().unwrap();
    let mut browser = Browser::open(&program, &page(folder.path(), &report()));
    order_and_text(&mut browser);
    side_by_side(&mut browser);
    slider(&mut browser);
    flicker(&mut browser);
    maps(&mut browser);
    linked_zoom(&mut browser);
    filters(&mut browser);
    acceptance(&mut browser);
    assert_quiet(&browser);
}

fn order_and_text(browser: &mut Browser) {
    let names = browser.value("[...document.querySelectorAll('summary > bdi')].map(e => e.textContent)");
    // In error, failed, new; then by error; skipped.
    let expected = ["case-3", "case-4", "case-2", "case-8", "case-7", "case-6", "case-1", "case-0", "case-5"];
    assert_eq!(names, json!(expected));
    let open = browser.value("[...document.querySelectorAll('details[open] > summary > bdi')].map(e => e.textContent)");
    assert_eq!(open, json!(["case-3", "case-4", "case-2"]), "what is broken is open");
    let text = browser.text(&format!("document.querySelector('{CASE}').innerText"));
    for part in [
        "flip.mean is 0.020000, not <= 0.01 (suite.toml:3)",
        "5c5c",
        "specula accept suite.toml case-2",
        "llvmpipe-22.3",
    ] {
        assert!(text.contains(part), "{part} is not in {text}");
    }
    browser.screenshot("top");
}

fn side_by_side(browser: &mut Browser) {
    browser.place(CASE, 0.5, 0.5);
    let places = ["golden", "actual"].map(|role| browser.place(&view(role), 0.5, 0.5));
    let picture = browser.screenshot("side");
    assert_eq!(places.map(|at| shown(&picture, at)), ["golden", "actual"]);
    assert!((places[0].1 - places[1].1).abs() < 1.0 && places[1].0 > places[0].0 + 100.0, "{places:?}");
}

fn slider(browser: &mut Browser) {
    browser.click(&button("slider"));
    let grab = browser.place(&view("actual"), 0.5, 0.5);
    let to = browser.place(&view("actual"), 0.25, 0.5);
    browser.pointer("mousePressed", grab);
    browser.pointer("mouseMoved", to);
    browser.pointer("mouseReleased", to);
    let places = [0.1, 0.22, 0.28, 0.9].map(|x| browser.place(&view("actual"), x, 0.5));
    let picture = browser.screenshot("slider");
    assert_eq!(places.map(|at| shown(&picture, at)), ["golden", "golden", "actual", "actual"]);
    // The same by its own control.
    browser.click(&format!("{CASE} .divide input"));
    let places = [0.45, 0.55].map(|x| browser.place(&view("actual"), x, 0.5));
    let picture = browser.screenshot("slider-half");
    assert_eq!(places.map(|at| shown(&picture, at)), ["golden", "actual"]);
}

fn flicker(browser: &mut Browser) {
    browser.click(&button("flicker"));
    let stage = format!("document.querySelector('{CASE} .stage').dataset.shown");
    for role in ["actual", "golden"] {
        browser.wait_for(&format!("{stage} === '{role}'"));
    }
    browser.click(&format!("{CASE} button[data-act=pause]"));
    let at = browser.place(&view("actual"), 0.5, 0.5);
    browser.pointer("mousePressed", at);
    browser.pointer("mouseReleased", at);
    for _ in 0..2 {
        browser.key(" ");
        let said = browser.text(&stage);
        assert_eq!(shown(&browser.screenshot(&format!("flicker-{said}")), at), said);
    }
}

fn maps(browser: &mut Browser) {
    for (mode, key) in [("difference", "4"), ("heat", "5")] {
        browser.click(&button(mode));
        let at = browser.place(&view(mode), 0.5, 0.5);
        assert_eq!(shown(&browser.screenshot(mode), at), mode);
        browser.click(&button("side"));
        let at = browser.place(&view("golden"), 0.5, 0.5);
        browser.pointer("mousePressed", at);
        browser.pointer("mouseReleased", at);
        browser.key(key);
        assert_eq!(browser.text(&format!("document.querySelector('{CASE} .stage').dataset.mode")), mode);
    }
    browser.key("1");
}

/// What the readout has to say of a pixel.
fn values(x: u32, y: u32) -> String {
    let value = |role: &str| format!("   {role} {}", color(role, x, y).map(|value| value.to_string()).join(" "));
    format!("x {x}, y {y}{}", ["golden", "actual", "difference", "heat"].map(value).concat())
}

fn linked_zoom(browser: &mut Browser) {
    let readout = format!("document.querySelector('{CASE} .readout').textContent");
    let center =
        |x: u32, y: u32| ((f64::from(x) + 0.5) / f64::from(SIZE_PX.0), (f64::from(y) + 0.5) / f64::from(SIZE_PX.1));
    for (x, y) in [(0, 0), (63, 47), (20, 31)] {
        let (u, v) = center(x, y);
        let at = browser.place(&view("golden"), u, v);
        browser.pointer("mouseMoved", at);
        assert_eq!(browser.text(&readout), values(x, y));
    }
    // The pixel under the pointer stays, in both pictures.
    let (u, v) = center(20, 31);
    let at = browser.place(&view("golden"), u, v);
    browser.wheel(at, -600.0);
    browser.wait_for(&format!("document.querySelector('{CASE} .stage').dataset.zoom > 4"));
    assert_eq!(browser.text(&readout), values(20, 31));
    let transform = |role: &str| format!("document.querySelector('{} img').style.transform", view(role));
    assert_eq!(browser.text(&transform("golden")), browser.text(&transform("actual")));
    let other = browser.place(&view("actual"), u, v);
    browser.pointer("mouseMoved", other);
    assert_eq!(browser.text(&readout), values(20, 31));
    let markers = browser.value(&format!(
        "[...document.querySelectorAll('{CASE} .marker')].map(e => [e.style.display, e.style.left, e.style.top].join()).filter((e, i, all) => all.indexOf(e) === i).length"
    ));
    assert_eq!(markers, 1, "the same pixel is marked in all");
    let picture = browser.screenshot("zoom");
    let expected = color("actual", 20, 31);
    let got = picture.get_pixel(other.0 as u32, other.1 as u32).0;
    assert!(got.iter().zip(expected).all(|(a, b)| a.abs_diff(b) <= 3), "{got:?} instead of {expected:?}");

    // Dragged by a quarter of the view, another pixel is under the pointer; a double click shows the whole.
    let to = browser.place(&view("actual"), u + 0.25, v);
    browser.pointer("mousePressed", other);
    browser.pointer("mouseMoved", to);
    browser.pointer("mouseReleased", to);
    assert_eq!(browser.text(&readout), values(20, 31), "the picture moves with the pointer");
    browser.pointer("mouseMoved", other);
    assert!(browser.text(&readout) != values(20, 31));
    browser.click(&format!("{CASE} button[data-act=whole]"));
    assert_eq!(browser.text(&transform("golden")), "scale(1) translate(0%, 0%)");
}

fn filters(browser: &mut Browser) {
    let seen = "[...document.querySelectorAll('details.case')].filter(e => !e.hidden).length";
    assert_eq!(browser.value(seen), 9);
    browser.click(".filters input[value=pass]");
    assert_eq!(browser.value(seen), 4);
    browser.click(".filters input[type=search]");
    browser.call("Input.insertText", &json!({"text": "case-2"}));
    assert_eq!(browser.value(seen), 1);
}

fn acceptance(browser: &mut Browser) {
    browser.click(&format!("{CASE} .copy"));
    browser.wait_for(&format!("['copied', 'selected'].includes(document.querySelector('{CASE} .copy').textContent)"));
    assert_eq!(browser.text("getSelection().toString()"), "specula accept suite.toml case-2 --out out");
    browser.screenshot("accept");
}

/// No error of a script, nothing that the page's policy refused, and nothing fetched but the page itself.
fn assert_quiet(browser: &Browser) {
    let noisy =
        ["Runtime.exceptionThrown", "Runtime.consoleAPICalled", "Log.entryAdded", "Page.javascriptDialogOpening"];
    let said: Vec<&Value> =
        browser.events.iter().filter(|event| noisy.iter().any(|name| event["method"] == *name)).collect();
    assert!(said.is_empty(), "{said:?}");
    let requests = browser.events.iter().filter(|event| event["method"] == "Network.requestWillBeSent");
    let urls: Vec<&str> = requests.filter_map(|event| event["params"]["request"]["url"].as_str()).collect();
    let fetched: Vec<&&str> = urls.iter().filter(|url| !url.starts_with("data:")).collect();
    assert!(fetched.len() == 1 && fetched[0].starts_with("file://"), "{fetched:?}");
}

#[test]
fn hostile_names_stay_text() {
    let Some(program) = chromium() else { return };
    let folder = tempfile::tempdir().unwrap();
    let page = page(folder.path(), &hostile(report()));
    let mut browser = Browser::open(&program, &page);
    assert_eq!(browser.value("typeof window.broken"), "undefined");
    assert_eq!(browser.value("document.scripts.length"), 1);
    assert_eq!(browser.value("document.querySelectorAll('img:not([src^=\"data:image/png\"])').length"), 0);
    let shown = HOSTILE.replace('\u{202e}', "\\u{202e}").replace('\u{1}', "\\u{1}");
    assert_eq!(browser.text("document.querySelector('h1').textContent"), shown);
    let first = browser.text("document.querySelector('summary bdi').textContent");
    assert!(first.starts_with(&shown), "{first}");
    assert!(browser.text("document.title").contains(&shown));
    browser.click(&button("slider"));
    browser.screenshot("hostile");
    assert_quiet(&browser);

    // Should a name ever get out of its quotes, the page's policy holds.
    let text = std::fs::read_to_string(&page).unwrap();
    let injected =
        text.replace("<main>", "<main><script>window.broken=1</script><img src=x onerror='window.broken=2'>");
    assert!(injected != text);
    std::fs::write(&page, injected).unwrap();
    let mut browser = Browser::open(&program, &page);
    assert_eq!(browser.value("typeof window.broken"), "undefined");
}
