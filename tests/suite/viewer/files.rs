//! Files that are opened, looked for, remembered, damaged, and changed while they are open.

use super::events::{asset, click, drag, drop_file, hold, key, point_at};
use super::screen::{Screen, wait_for};
use std::path::Path;

#[test]
fn bad_files_are_named_in_the_window_and_leave_the_model() {
    let Some(screen) = Screen::open() else { return };
    std::fs::write(screen.path("notes.txt"), "not a model").unwrap();
    std::fs::write(screen.path("damaged.glb"), b"glTF\x02\0\0\0\xff\xff\xff\xff").unwrap();
    std::fs::write(screen.path("damaged.hdr"), "#?RADIANCE\n\n-Y 5 +X").unwrap();
    std::fs::create_dir(screen.path("empty")).unwrap();
    let bad = ["notes.txt", "damaged.glb", "damaged.hdr", "missing.glb", "missing.hdr", "empty"];
    // A message that is not there fails the replay.
    let mut events: Vec<String> =
        bad.iter().flat_map(|path| [vec![drop_file(path)], click("message/close", 0.5).into()].concat()).collect();
    events.extend(drag());
    let options = ["--size", "300x200", "--screenshot-at-end", "after.png"];
    screen.play(&asset("spheres.glb"), &options, &events).end();
    screen.assert_renders_again("after");
    let state = screen.state("after.json");
    assert!(state["model"].as_str().unwrap().ends_with("spheres.glb"), "{state}");
    assert_eq!(state["environment"]["source"], "neutral");

    let events = [click("message/close", 0.5).into(), vec![drop_file(&asset("spheres.glb"))], drag()].concat();
    let options = ["--size", "300x200", "--screenshot-at-end", "later.png"];
    screen.play("missing.glb", &options, &events).end();
    screen.assert_renders_again("later");
}

#[test]
fn files_are_looked_for_in_the_window() {
    let Some(screen) = Screen::open() else { return };
    std::fs::create_dir(screen.path("models")).unwrap();
    for copy in ["first.glb", "models/second.glb"] {
        std::fs::copy(asset("spheres.glb"), screen.path(copy)).unwrap();
    }
    std::fs::write(screen.path("models/notes.txt"), "not listed").unwrap();
    let sky = image::Rgb32FImage::from_fn(32, 16, |_, y| image::Rgb([0.2, 0.4, 0.1 * y as f32]));
    sky.save(screen.path("sky.hdr")).unwrap();
    let events = [
        key("P").to_vec(),
        // Escape closes it without a choice.
        click("file/browse", 0.5).into(),
        vec![point_at("browser/models", 0.5)],
        key("Escape").into(),
        vec![hold(1)],
        click("file/browse", 0.5).into(),
        vec![hold(1)],
        click("browser/models", 0.5).into(),
        vec![hold(1)],
        click("browser/second.glb", 0.5).into(),
        vec![hold(1)],
        click("environment/browse", 0.5).into(),
        vec![hold(1)],
        click("browser/..", 0.5).into(),
        vec![hold(1)],
        click("browser/sky.hdr", 0.5).into(),
        key("P").into(),
    ];
    let options = ["--size", "800x700", "--screenshot-at-end", "found.png"];
    screen.play("first.glb", &options, &events.concat()).end();
    screen.assert_renders_again("found");
    let state = screen.state("found.json");
    assert!(state["model"].as_str().unwrap().ends_with("models/second.glb"), "{state}");
    let source = state["environment"]["source"].as_str().unwrap();
    assert!(source.ends_with("sky.hdr") && !source.contains("models"), "{state}");
}

#[test]
fn a_model_with_a_damaged_image_leaves_the_one_before() {
    let Some(screen) = Screen::open() else { return };
    // Its geometry is whole, and so may be seen before the image is found to be damaged.
    screen.write_triangle("damaged.gltf", b"\x89PNG\r\n\x1a\nand no more");
    let shot: Vec<String> = [key("F12").as_slice(), &key("Escape")].concat();
    // A message that is not there fails the replay.
    let bad = [vec![drop_file("damaged.gltf")], click("message/close", 0.5).into()].concat();
    let events = [drag(), shot.clone(), bad, drag(), shot].concat();
    screen.play(&asset("spheres.glb"), &["--size", "300x200"], &events).end();
    for saved in ["spheres-1", "spheres-2"] {
        screen.assert_renders_again(saved);
    }
    assert_ne!(screen.state("spheres-1.json")["camera"], screen.state("spheres-2.json")["camera"]);
    // A window in which nothing was open stays empty, and opens the next.
    let events = [click("message/close", 0.5).into(), vec![drop_file(&asset("showcase.glb"))], drag()].concat();
    let options = ["--size", "300x200", "--screenshot-at-end", "later.png"];
    screen.play("damaged.gltf", &options, &events).end();
    screen.assert_renders_again("later");
}

#[test]
fn a_model_that_changes_is_read_again_and_stays_while_it_is_damaged() {
    let Some(screen) = Screen::open() else { return };
    std::fs::copy(asset("spheres.glb"), screen.path("model.glb")).unwrap();
    let shot: Vec<String> = [key("F12"), key("Escape")].concat();
    // It waits for the message that there is something wrong, and closes it.
    let events = [drag(), shot.clone(), click("message/close", 0.5).into(), shot, vec![hold(15)]].concat();
    let options = ["--watch", "--size", "300x200", "--screenshot-at-end", "after.png"];
    let window = screen.play("model.glb", &options, &events);
    let replace = |bytes: &[u8]| {
        std::fs::write(screen.path("new.glb"), bytes).unwrap();
        std::fs::rename(screen.path("new.glb"), screen.path("model.glb")).unwrap();
    };
    wait_for("the first picture", || screen.path("model-1.json").exists().then_some(()));
    let bytes = std::fs::read(asset("showcase.glb")).unwrap();
    replace(&bytes[..bytes.len() / 2]);
    wait_for("the picture that stays", || screen.path("model-2.json").exists().then_some(()));
    assert_eq!(screen.picture("model-1.png"), screen.picture("model-2.png"));
    replace(&bytes);
    window.end();
    assert_ne!(screen.picture("model-1.png"), screen.picture("after.png"));
    assert_eq!(screen.state("model-1.json"), screen.state("after.json"));
    screen.assert_renders_again("after");
}

/// Copies the shaders of the repository into the folder `shaders`.
fn copy_shaders(screen: &Screen) {
    let own = Path::new(env!("CARGO_MANIFEST_DIR")).join("shaders");
    for (name, _) in specula::shader::SOURCES {
        let copy = screen.path("shaders").join(name);
        std::fs::create_dir_all(copy.parent().unwrap()).unwrap();
        std::fs::copy(own.join(name), copy).unwrap();
    }
}

#[test]
fn shaders_that_change_are_taken_and_stay_while_they_are_broken() {
    let Some(screen) = Screen::open() else { return };
    copy_shaders(&screen);
    let (width, height) = (300, 200);
    let encode = screen.path("shaders/color/encode_srgb.wgsl");
    let own = std::fs::read_to_string(&encode).unwrap();
    let events = [
        key("F12").to_vec(),
        key("Escape").into(),
        vec![point_at("message/shaders", 0.5)],
        key("F12").into(),
        key("Escape").into(),
        vec![hold(300)],
    ];
    let options = ["--watch", "--shaders", "shaders", "--size", "300x200"];
    let _window = screen.play(&asset("spheres.glb"), &options, &events.concat());
    wait_for("the first picture", || screen.path("spheres-1.json").exists().then_some(()));
    screen.assert_renders_again("spheres-1");
    // WGSL that is read and is not right: what it returns is no vector.
    std::fs::write(&encode, own.replace("return ", "return 1.0; return ")).unwrap();
    wait_for("the picture that stays", || screen.path("spheres-2.json").exists().then_some(()));
    assert_eq!(screen.picture("spheres-1.png"), screen.picture("spheres-2.png"));
    std::fs::write(&encode, own.replace("return ", "return vec3f(0.0, 1.0, 0.0) * ")).unwrap();
    let is_green = |pixel: &[u8]| pixel[0] == 0 && pixel[2] == 0;
    wait_for("a picture in green", || screen.pixels(width, height).chunks_exact(3).all(is_green).then_some(()));
}

#[test]
fn folders_without_shaders_are_told() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path().to_str().unwrap();
    let output = crate::support::program().args(["view", "--shaders", folder]).output().unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(said.lines().count() == 1 && said.contains("holds no shader"), "{said}");
}

#[test]
fn what_was_open_is_offered_to_the_next_session() {
    let Some(screen) = Screen::open() else { return };
    let sky = image::Rgb32FImage::from_fn(32, 16, |_, y| image::Rgb([0.2, 0.4, 0.1 * y as f32]));
    sky.save(screen.path("sky.hdr")).unwrap();
    let list = screen.path("cache/recent.json");
    let size = ["--size", "700x600"];
    let show = |model: &str, options: &[&str], events: &[Vec<String>]| {
        screen.play(model, &[&size[..], options].concat(), &events.concat()).end();
    };
    show(&asset("spheres.glb"), &["--no-cache"], &[drag()]);
    assert!(!screen.path("cache").exists(), "something was kept");
    show(&asset("spheres.glb"), &[], &[vec![drop_file("sky.hdr")], drag()]);
    // From the empty window, and from the panel.
    let events = [
        click("welcome/spheres.glb", 0.5).into(),
        key("P").into(),
        click("environment/recent", 0.5).into(),
        vec![hold(1)],
        click("environment/recent/sky.hdr", 0.5).into(),
        vec![hold(1)],
    ];
    show("", &["--screenshot-at-end", "again.png"], &events);
    screen.assert_renders_again("again");
    let state = screen.state("again.json");
    assert!(state["model"].as_str().unwrap().ends_with("spheres.glb"), "{state}");
    assert!(state["environment"]["source"].as_str().unwrap().ends_with("sky.hdr"), "{state}");
    // A list that is damaged is told, and the next model begins another.
    std::fs::write(&list, "{\"schema\": \"specula-recent/1\", \"models\": [").unwrap();
    show(&asset("showcase.glb"), &[], &[click("message/close", 0.5).into()]);
    show("", &[], &[click("welcome/showcase.glb", 0.5).into(), drag()]);
    let kept: serde_json::Value = serde_json::from_slice(&std::fs::read(&list).unwrap()).unwrap();
    assert_eq!(kept["models"].as_array().unwrap().len(), 1, "{kept}");
}

#[test]
fn a_state_that_is_dropped_is_opened() {
    let Some(screen) = Screen::open() else { return };
    let ctrl = |held: bool| format!(r#"{{"modifiers":{{"ctrl":{held}}}}}"#);
    let save = [vec![ctrl(true)], key("S").into(), vec![ctrl(false)], key("Escape").into()].concat();
    let events = [drag(), key("T").into(), save, key("T").into(), key("7").into()];
    let options = ["--size", "300x200", "--screenshot-at-end", "first.png"];
    screen.play(&asset("spheres.glb"), &options, &events.concat()).end();
    let saved = screen.state("spheres-1.json");
    assert!(!screen.path("spheres-1.png").exists());
    let options = ["--size", "300x200", "--screenshot-at-end", "again.png"];
    screen.play(&asset("showcase.glb"), &options, &[drop_file("spheres-1.json"), super::events::wheel(0)]).end();
    let again = screen.state("again.json");
    for part in ["model", "camera", "look", "environment"] {
        assert_eq!(saved[part], again[part], "{part}");
    }
    screen.assert_renders_again("again");
}

#[test]
fn a_variant_is_chosen_in_the_panel_and_kept_in_the_state() {
    let Some(screen) = Screen::open() else { return };
    let mut png = std::io::Cursor::new(Vec::new());
    image::RgbImage::from_pixel(2, 2, image::Rgb([128, 128, 255])).write_to(&mut png, image::ImageFormat::Png).unwrap();
    screen.write_triangle("chair.gltf", png.get_ref());
    let text = std::fs::read_to_string(screen.path("chair.gltf")).unwrap();
    let mut model: serde_json::Value = serde_json::from_str(&text).unwrap();
    let name = "KHR_materials_variants";
    model["extensionsUsed"].as_array_mut().unwrap().push(name.into());
    model["extensions"][name] = serde_json::json!({ "variants": [{ "name": "red" }, { "name": "unused" }] });
    let red = serde_json::json!({ "pbrMetallicRoughness": { "baseColorFactor": [1, 0, 0, 1], "metallicFactor": 0 } });
    model["materials"].as_array_mut().unwrap().push(red);
    model["meshes"][0]["primitives"][0]["extensions"] =
        serde_json::json!({ name: { "mappings": [{ "material": 1, "variants": [0] }] } });
    std::fs::write(screen.path("chair.gltf"), model.to_string()).unwrap();
    let choose = |variant: &str| [click(&format!("variant/{variant}"), 0.5).into(), vec![hold(1)], key("F12").into()];
    let events = [vec![key("P").to_vec()], choose("red").into(), choose("none").into()].concat().concat();
    screen.play("chair.gltf", &["--size", "800x700"], &events).end();
    let variants = ["chair-1", "chair-2"].map(|saved| {
        screen.assert_renders_again(saved);
        screen.state(&format!("{saved}.json"))["variant"].clone()
    });
    assert_eq!(variants, [serde_json::json!("red"), serde_json::Value::Null]);
    let [red, none] = ["chair-1.png", "chair-2.png"].map(|saved| std::fs::read(screen.path(saved)).unwrap());
    assert_ne!(red, none);
}
