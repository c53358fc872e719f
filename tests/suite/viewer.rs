//! `specula view` in a real window, under an X server without a screen: input goes in, pictures come out.

mod screen;

use crate::support::program;
use screen::{Screen, wait_for};
use std::path::Path;

fn asset(name: &str) -> String {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("assets").join(name).to_string_lossy().into_owned()
}

fn pointer(x: u32, y: u32) -> String {
    format!(r#"{{"pointer":{{"x":{x},"y":{y}}}}}"#)
}

fn button(pressed: bool) -> String {
    format!(r#"{{"button":{{"button":"left","pressed":{pressed}}}}}"#)
}

fn wheel(lines: i32) -> String {
    format!(r#"{{"wheel":{{"x":0,"y":{lines}}}}}"#)
}

/// A key goes down and up.
fn key(name: &str) -> [String; 2] {
    [true, false].map(|pressed| format!(r#"{{"key":{{"key":"{name}","pressed":{pressed},"text":null}}}}"#))
}

fn point_at(widget: &str, x: f64) -> String {
    format!(r#"{{"point-at":{{"widget":"{widget}","x":{x},"y":0.5}}}}"#)
}

/// The pointer goes to a part of the panel and clicks.
fn click(widget: &str, x: f64) -> [String; 3] {
    [point_at(widget, x), button(true), button(false)]
}

fn hold(seconds: u32) -> String {
    format!(r#"{{"hold":{{"seconds":{seconds}}}}}"#)
}

fn drop_file(path: &str) -> String {
    format!(r#"{{"drop":{{"path":"{path}"}}}}"#)
}

fn resize(width: u32, height: u32) -> String {
    format!(r#"{{"resize":{{"width":{width},"height":{height}}}}}"#)
}

/// From left to right over the picture, with the left button.
fn drag() -> Vec<String> {
    vec![pointer(100, 150), button(true), pointer(140, 160), pointer(180, 140), button(false)]
}

#[test]
fn the_window_shows_what_render_makes_of_its_state() {
    let Some(screen) = Screen::open() else { return };
    let (width, height) = (400, 300);
    let events = [drag(), vec![wheel(4)], key("F12").into(), key("Escape").into(), vec![hold(300)]].concat();
    let _window = screen.play(&asset("showcase.glb"), &["--size", "400x300"], &events);
    wait_for("the state of the picture", || screen.path("showcase-1.json").exists().then_some(()));
    screen.assert_renders_again("showcase-1");
    let expected = image::DynamicImage::from(screen.picture("showcase-1.png")).to_rgb8().into_raw();
    // The note that the picture was saved goes with the next frame.
    let differing = || {
        let shown = screen.pixels(width, height);
        let pixels = shown.chunks_exact(3).zip(expected.chunks_exact(3));
        pixels.filter(|(a, b)| a != b).count()
    };
    wait_for("the picture on the screen", || (differing() == 0).then_some(()));
    let camera = &screen.state("showcase-1.json")["camera"]["pose"]["orbit"];
    assert!(camera["theta_rad"].as_f64().unwrap() < 0.3, "the drag has not turned the camera: {camera}");
}

#[test]
fn materials_lights_and_views_are_edited() {
    let Some(screen) = Screen::open() else { return };
    let panorama = |x: u32, y: u32| {
        let sun = if (x, y) == (20, 8) { 60.0 } else { 0.0 };
        image::Rgb([0.3 + sun, 0.5 + sun, 0.1 * y as f32 + sun])
    };
    let panorama = image::Rgb32FImage::from_fn(64, 32, panorama);
    panorama.save(screen.path("sky.hdr")).unwrap();
    let metallic =
        [point_at("material/metallic", 0.1), button(true), point_at("material/metallic", 0.3), button(false)];
    let events = [
        vec![drop_file("sky.hdr")],
        key("P").into(),
        click("environment/rotation", 0.2).into(),
        click("look/background-blur", 0.2).into(),
        click("part/Environment", 0.1).into(),
        click("part/Picture", 0.1).into(),
        click("part/File", 0.1).into(),
        // Parts open and close over a few frames.
        vec![hold(1)],
        metallic.into(),
        click("material/disney", 0.1).into(),
        click("material/disney.clearcoat", 0.3).into(),
        click("part/Scene", 0.1).into(),
        vec![hold(1)],
        click("scene/1", 0.5).into(),
        key("Y").into(),
    ];
    let options = ["--size", "500x760", "--screenshot-at-end", "lit.png"];
    screen.play(&asset("showcase.glb"), &options, &events.concat()).end();
    screen.assert_renders_again("lit");
    let state = screen.state("lit.json");
    let material = &state["materials"]["0"];
    assert!(material["metallic"].as_f64().unwrap() > 0.2, "{material}");
    assert!(material["disney"]["clearcoat"].as_f64().unwrap() > 0.1, "{material}");
    assert!(state["environment"]["source"].as_str().unwrap().ends_with("sky.hdr"), "{state}");
    assert!(state["environment"]["rotation_deg"].as_f64().unwrap() > 1.0, "{state}");
    assert!(state["look"]["background_blur"].as_f64().unwrap() > 0.05, "{state}");
    assert_eq!(state["hidden_nodes"], serde_json::json!([1]), "{state}");
    assert_eq!(state["look"]["quality"], "high");

    let events = [key("N").to_vec(), key("N").into(), key("N").into()].concat();
    let options = ["--size", "300x200", "--screenshot-at-end", "debug.png"];
    screen.play("lit.json", &options, &events).end();
    assert_eq!(screen.state("debug.json")["look"]["debug_view"], "perceptual-roughness");
    screen.assert_renders_again("debug");
}

#[test]
fn two_hundred_sizes_cost_nothing() {
    let Some(screen) = Screen::open() else { return };
    let mut random = 0x2545_f491_4f6c_dd1d_u64;
    let mut side = || {
        // xorshift64 (Marsaglia 2003).
        random ^= random << 13;
        random ^= random >> 7;
        random ^= random << 17;
        1 + (random % 500) as u32
    };
    let sizes = |count: usize, side: &mut dyn FnMut() -> u32| -> Vec<String> {
        (0..count).map(|i| if i % 20 == 7 { resize(1, 1) } else { resize(side(), side()) }).collect()
    };
    let rest = || [vec![resize(300, 200)], key("F12").into(), key("Escape").into()].concat();
    let events = [sizes(60, &mut side), rest(), vec![hold(2)], sizes(140, &mut side), rest(), vec![hold(300)]];
    let window = screen.play(&asset("spheres.glb"), &[], &events.concat());
    let mut memory = ["spheres-1.json", "spheres-2.json"].map(|saved| {
        wait_for(saved, || screen.path(saved).exists().then_some(()));
        window.resident_kb()
    });
    println!("resident after 60 and after 200 sizes: {memory:?} kB");
    screen.assert_renders_again("spheres-2");
    assert_eq!(screen.picture("spheres-1.png"), screen.picture("spheres-2.png"));
    memory[0] += 64 << 10;
    assert!(memory[1] < memory[0], "memory grows with every size: {memory:?} kB");
}

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
    let floats = [[0.0_f32, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let bytes: Vec<u8> = floats.iter().flatten().flat_map(|value| value.to_le_bytes()).collect();
    std::fs::write(screen.path("corners.bin"), bytes).unwrap();
    std::fs::write(screen.path("image.png"), b"\x89PNG\r\n\x1a\nand no more").unwrap();
    let model = serde_json::json!({
        "asset": { "version": "2.0" }, "scenes": [{ "nodes": [0] }], "nodes": [{ "mesh": 0 }],
        "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0, "TEXCOORD_0": 1 }, "material": 0 }] }],
        "materials": [{ "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 } } }],
        "textures": [{ "source": 0 }], "images": [{ "uri": "image.png" }],
        "accessors": [
            { "bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0] },
            { "bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC2" },
        ],
        "bufferViews": [{ "buffer": 0, "byteLength": 36 }, { "buffer": 0, "byteLength": 24 }],
        "buffers": [{ "uri": "corners.bin", "byteLength": 36 }],
    });
    std::fs::write(screen.path("damaged.gltf"), model.to_string()).unwrap();
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
fn the_truth_comes_beside_the_picture() {
    let Some(screen) = Screen::open() else { return };
    let (width, height) = (300, 240);
    let events = [
        key("F12").into(),
        key("Escape").into(),
        key("R").into(),
        // The figures come with the first samples; from then on errors are shown.
        click("truth/errors", 0.05).into(),
        vec![r#""pointer-left""#.into(), hold(300)],
    ];
    let _window = screen.play(&asset("spheres.glb"), &["--size", "300x240"], &events.concat());
    wait_for("the picture", || screen.path("spheres-1.json").exists().then_some(()));
    let picture = image::DynamicImage::from(screen.picture("spheres-1.png")).to_rgb8();
    // Above the figures, on both sides of the line: the picture, and colours that are not the picture's.
    let shares = || {
        let shown = screen.pixels(width, height);
        [0..width / 2 - 4, width / 2 + 4..width].map(|columns| {
            let places = (0..height / 2).flat_map(|y| columns.clone().map(move |x| (x, y)));
            let same = |&(x, y): &(usize, usize)| {
                let at = 3 * (y * width + x);
                picture.get_pixel(x as u32, y as u32).0 == shown[at..at + 3]
            };
            places.clone().filter(same).count() as f64 / places.count() as f64
        })
    };
    wait_for("the errors", || {
        let [left, right] = shares();
        (left == 1.0 && right < 0.1).then_some(())
    });
}

#[test]
fn a_model_that_changes_is_read_again() {
    let Some(screen) = Screen::open() else { return };
    std::fs::copy(asset("spheres.glb"), screen.path("model.glb")).unwrap();
    let events = [drag(), key("F12").into(), key("Escape").into(), vec![hold(15)]].concat();
    let options = ["--watch", "--size", "300x200", "--screenshot-at-end", "after.png"];
    let window = screen.play("model.glb", &options, &events);
    wait_for("the first picture", || screen.path("model-1.json").exists().then_some(()));
    std::fs::copy(asset("showcase.glb"), screen.path("new.glb")).unwrap();
    std::fs::rename(screen.path("new.glb"), screen.path("model.glb")).unwrap();
    window.end();
    assert_ne!(screen.picture("model-1.png"), screen.picture("after.png"));
    assert_eq!(screen.state("model-1.json"), screen.state("after.json"));
    screen.assert_renders_again("after");
}

#[test]
fn a_device_that_is_lost_comes_back_with_the_same_picture() {
    let Some(screen) = Screen::open() else { return };
    let events = [drag(), key("F12").into(), key("Escape").into(), vec![r#""lose-device""#.into()]].concat();
    let options = ["--size", "300x200", "--screenshot-at-end", "again.png"];
    screen.play(&asset("spheres.glb"), &options, &events).end();
    assert_eq!(screen.picture("spheres-1.png"), screen.picture("again.png"));
    assert_eq!(screen.state("spheres-1.json"), screen.state("again.json"));
    screen.assert_renders_again("again");
}

#[test]
fn real_input_is_recorded_and_plays_again() {
    let Some(screen) = Screen::open() else { return };
    let (model, size) = (asset("spheres.glb"), ["--size", "300x200"]);
    let mut window = screen.view(&[&[&model, "--record", "record.jsonl"], &size[..]].concat());
    let id = wait_for("a window", || {
        window.assert_runs();
        Some(screen.xdotool(&["search", "--name", "Specula"])).filter(|id| !id.is_empty())
    });
    // Hidden and shown again while it may still be loading.
    screen.xdotool(&["windowunmap", "--sync", &id, "windowmap", "--sync", &id, "windowfocus", &id]);
    screen.xdotool(&["mousemove", "150", "100", "mousedown", "1", "mousemove", "180", "120", "mouseup", "1"]);
    screen.xdotool(&["click", "4", "key", "t", "key", "F12"]);
    wait_for("the saved state", || {
        // There is no picture before the model is there.
        if !screen.path("spheres-1.json").exists() {
            screen.xdotool(&["key", "F12"]);
            std::thread::sleep(std::time::Duration::from_millis(500));
        }
        screen.path("spheres-1.json").exists().then_some(())
    });
    screen.xdotool(&["key", "ctrl+q"]);
    window.end();
    assert_eq!(screen.state("spheres-1.json")["look"]["tone_map"], "aces");
    screen.assert_renders_again("spheres-1");
    let options = ["--replay", "record.jsonl", "--screenshot-at-end", "again.png"];
    screen.view(&[&[model.as_str()], &size[..], &options].concat()).end();
    let [first, again] = ["spheres-1.json", "again.json"].map(|name| screen.state(name));
    assert_eq!(first["look"], again["look"]);
}

#[test]
fn without_a_window_system_there_is_one_line() {
    let mut command = program();
    command.args(["view", &asset("spheres.glb")]);
    for name in ["DISPLAY", "WAYLAND_DISPLAY", "WAYLAND_SOCKET"] {
        command.env_remove(name);
    }
    let output = command.output().unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(said.lines().count() == 1 && said.contains("specula render"), "{said}");
}
