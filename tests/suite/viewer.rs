//! `specula view` in a real window, under an X server without a screen: input goes in, pictures come out.

mod events;
mod files;
mod screen;

use crate::support::program;
use events::{asset, button, click, drag, drop_file, hold, key, point_at, pointer, resize, wheel};
use screen::{Screen, wait_for};

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
fn every_parameter_of_a_material_is_edited() {
    let Some(screen) = Screen::open() else { return };
    image::RgbaImage::from_pixel(2, 2, image::Rgba([200, 200, 255, 255])).save(screen.path("flat.png")).unwrap();
    screen.write_triangle("triangle.gltf", &std::fs::read(screen.path("flat.png")).unwrap());
    let fold = ["part/File", "part/Picture", "part/Environment"].map(|part| click(part, 0.1)).concat();
    let edit = |names: &[&str]| -> Vec<String> {
        names.iter().flat_map(|name| click(&format!("material/{name}"), 0.15)).collect()
    };
    // The picker of a colour opens below its button, and closes when something else is clicked on.
    let pick = |name: &str| {
        let inside = format!(r#"{{"point-at":{{"widget":"material/{name}","x":2.0,"y":6.0}}}}"#);
        let click_here = || [button(true), button(false)];
        let open = [click(&format!("material/{name}"), 0.5).to_vec(), vec![hold(1), inside]].concat();
        [open, click_here().into(), vec![pointer(20, 20)], click_here().into()].concat()
    };
    let sliders =
        ["alpha", "metallic", "perceptual-roughness", "normal-scale", "occlusion", "emission", "ior", "specular"];
    let colors = ["base-color", "emissive", "specular-color"].map(pick).concat();
    let disney = specula::scene::Disney::NAMES.map(|name| format!("disney.{name}"));
    let events = [
        key("P").to_vec(),
        fold,
        vec![hold(1)],
        edit(&sliders),
        colors,
        edit(&["anisotropy", "anisotropy-rotation", "double-sided", "unlit", "unlit", "texture.normal"]),
        click("material/alpha-mode", 0.3).into(),
        vec![hold(1)],
        click("material/alpha-mode/blend", 0.5).into(),
        click("material/disney", 0.05).into(),
        vec![hold(1)],
        edit(&disney.each_ref().map(String::as_str)),
        edit(&["unlit"]),
    ];
    let options = ["--size", "640x1200", "--screenshot-at-end", "edited.png"];
    screen.play("triangle.gltf", &options, &events.concat()).end();
    let edited = screen.state("edited.json")["materials"]["0"].clone();
    let scene = specula::import::model_from_path(&screen.path("triangle.gltf"), &Default::default()).unwrap().scene;
    let own = serde_json::to_value(specula::app::MaterialEdit::of(&scene.materials[0])).unwrap();
    for (name, value) in own.as_object().unwrap() {
        assert_ne!(&edited[name], value, "{name} is as it was: {edited}");
    }
    let defaults = specula::scene::Disney::default();
    for name in specula::scene::Disney::NAMES {
        let value = edited["disney"][name].as_f64().unwrap() as f32;
        assert_ne!(Some(&mut { value }), defaults.clone().parameter_mut(name), "{name}: {edited}");
    }
    assert_eq!(edited["without_textures"], serde_json::json!(["normal"]));
    screen.assert_renders_again("edited");
}

#[test]
fn times_and_notes_are_shown_beside_the_picture() {
    let Some(screen) = Screen::open() else { return };
    let checker = (0..).zip(specula::scene::Channel::named()).find(|(_, (name, _))| *name == "uv-checker");
    let views = checker.map_or(0, |(index, _)| index + 1);
    let events = [
        key("Z").to_vec(),
        key("X").into(),
        // Times are there although nothing has changed, and for a picture that is made in memory.
        vec![point_at("statistics/times", 0.5)],
        key("P").into(),
        (0..views).flat_map(|_| key("N")).collect(),
        vec![point_at("look/without-coordinates", 0.5), point_at("statistics/times", 0.5)],
    ];
    let options = ["--size", "640x500", "--screenshot-at-end", "chart.png"];
    screen.play(&asset("spheres.glb"), &options, &events.concat()).end();
    assert_eq!(screen.state("chart.json")["look"]["debug_view"], "uv-checker");
    screen.assert_renders_again("chart");
    // What the reference renderer knows of a pixel, and at last what the shaders say.
    let events = [vec![pointer(150, 100)], key("I").into(), vec![point_at("inspector/by-shaders", 0.5)]].concat();
    screen.play(&asset("spheres.glb"), &["--size", "300x200"], &events).end();
}

#[test]
fn light_is_edited() {
    let Some(screen) = Screen::open() else { return };
    image::RgbaImage::from_pixel(2, 2, image::Rgba([200, 200, 255, 255])).save(screen.path("flat.png")).unwrap();
    screen.write_triangle("lamp.gltf", &std::fs::read(screen.path("flat.png")).unwrap());
    let events = [
        key("P").to_vec(),
        click("environment/white", 0.5).into(),
        click("environment/intensity", 0.15).into(),
        click("look/exposure", 0.2).into(),
        click("part/File", 0.1).into(),
        click("part/Materials", 0.1).into(),
        vec![hold(1)],
        click("part/Lights", 0.1).into(),
        vec![hold(1)],
        click("lights/0", 0.2).into(),
    ];
    let options = ["--size", "640x600", "--screenshot-at-end", "lit.png"];
    screen.play("lamp.gltf", &options, &events.concat()).end();
    screen.assert_renders_again("lit");
    let state = screen.state("lit.json");
    assert_eq!(state["environment"]["source"], "white");
    assert_ne!(state["environment"]["intensity"], 1.0, "{state}");
    assert_ne!(state["look"]["exposure_ev"], 0.0, "{state}");
    assert!(state["light_factors"]["0"].as_f64().is_some_and(|factor| factor != 1.0), "{state}");
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
        // Without a window manager, this is what is left of minimising: while sizes change, it is taken off and put back.
        let id = screen.xdotool(&["search", "--name", "Specula"]);
        for _ in 0..5 {
            screen.xdotool(&["windowunmap", "--sync", &id, "windowmap", "--sync", &id]);
        }
        window.resident_kb()
    });
    println!("resident after 60 and after 200 sizes: {memory:?} kB");
    screen.assert_renders_again("spheres-2");
    assert_eq!(screen.picture("spheres-1.png"), screen.picture("spheres-2.png"));
    memory[0] += 64 << 10;
    assert!(memory[1] < memory[0], "memory grows with every size: {memory:?} kB");
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
