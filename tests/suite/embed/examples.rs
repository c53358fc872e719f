//! The examples of embedding, as their readers run them.

use crate::support::gpu;
use glam::UVec2;
use specula::gpu::formats::Precision;
use specula::scene::Scene;

#[cfg(feature = "view")]
#[path = "../../../examples/embed_egui.rs"]
mod embed_egui;
#[path = "../../../examples/embed_encode.rs"]
mod embed_encode;
#[path = "../../../examples/embed_texture.rs"]
mod embed_texture;
#[path = "../../../examples/minimal.rs"]
mod minimal;
#[path = "../../../examples/offscreen_server.rs"]
mod offscreen_server;
#[path = "../../../examples/procedural.rs"]
mod procedural;
#[path = "../../../examples/split_screen.rs"]
mod split_screen;

fn texel(picture: &[u8], width: u32, at: UVec2) -> [u8; 4] {
    let at = 4 * (at.y * width + at.x) as usize;
    picture[at..at + 4].try_into().unwrap()
}

#[test]
fn minimal_shows_a_model() {
    let picture = minimal::picture("assets/showcase.glb".as_ref(), 48).unwrap();
    assert!(picture.chunks_exact(4).filter(|texel| texel[3] == 255 && texel[1] > 40).count() > 300);
}

#[test]
fn a_model_hides_and_is_hidden_in_a_host_s_frame() {
    let gpu = gpu(Precision::Half);
    let with = embed_encode::picture(&gpu, &embed_encode::balls()).unwrap();
    let without =
        embed_encode::picture(&gpu, &Scene { nodes: vec![], roots: vec![], ..embed_encode::balls() }).unwrap();
    let all = || (0..embed_encode::SIZE_PX.y).flat_map(|y| (0..embed_encode::SIZE_PX.x).map(move |x| UVec2::new(x, y)));
    let width = embed_encode::SIZE_PX.x;
    let changed = all().filter(|&at| texel(&with, width, at) != texel(&without, width, at)).count();
    assert!(changed > 10_000, "{changed} pixels show the balls");
    // Of the pillars: blue stands before the gold ball, green stands in the red one, and yellow behind the steel one.
    let is_of = |picture: &[u8], at, channel: usize, other: usize| {
        let [r, g, b, _] = texel(picture, width, at).map(i32::from);
        let rgb = [r, g, b];
        rgb[channel] > rgb[other] + 60 && rgb[channel] > rgb[3 - channel - other] + 30
    };
    let count = |picture: &[u8], channel, other| all().filter(|&at| is_of(picture, at, channel, other)).count();
    let [green, green_alone] = [&with, &without].map(|picture| count(picture, 1, 0));
    println!("{green} of {green_alone} green pixels");
    assert!(green > 200 && green + 200 < green_alone, "{green} of {green_alone} pixels of the green pillar");
}

#[cfg(feature = "view")]
#[test]
fn egui_lays_a_model_out_among_its_widgets() {
    use embed_egui::{Desk, SIZE_PX, Widgets};
    let gpu = gpu(Precision::Half);
    let model = || specula::import::model_from_path("assets/showcase.glb".as_ref(), &Default::default()).unwrap().scene;
    let mut desk = Desk::new(&gpu, &model()).unwrap();
    let mut picture = |turn_rad, exposure_ev| desk.picture(&gpu, &Widgets { turn_rad, exposure_ev }).unwrap();
    let [front, turned, bright] = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)].map(|(turn, exposure)| picture(turn, exposure));
    assert!(picture(0.0, 0.0) == front, "nothing of the frames before is left");
    let mut nothing = model();
    nothing.nodes.iter_mut().for_each(|node| node.mesh = None);
    let nothing =
        Desk::new(&gpu, &nothing).unwrap().picture(&gpu, &Widgets { turn_rad: 0.0, exposure_ev: 0.0 }).unwrap();
    // The parts that egui gives to its panel and to the model, and the middle of the window over that.
    let differing = |a: &[u8], b: &[u8], x: std::ops::Range<u32>, y: std::ops::Range<u32>| {
        let all = y.flat_map(|y| x.clone().map(move |x| UVec2::new(x, y)));
        all.filter(|&at| texel(a, SIZE_PX.x, at) != texel(b, SIZE_PX.x, at)).count()
    };
    for (other, least) in [(&nothing, 6000), (&turned, 3000), (&bright, 6000)] {
        let of_model = differing(&front, other, 160..480, 0..270);
        assert!(of_model > least, "{of_model} pixels of the model are others");
        assert_eq!(differing(&front, other, 340..440, 200..230), 0, "the window hides the model");
    }
    assert_eq!(differing(&front, &nothing, 0..140, 0..270), 0, "the panel is egui's alone");
    assert_eq!(gpu.check(), Ok(()));
}

#[test]
fn what_a_host_draws_is_on_a_screen_of_ours() {
    let gpu = gpu(Precision::Half);
    let mut room = embed_texture::Room::new(&gpu).unwrap();
    let pictures = [0.0, 0.8, 0.0].map(|angle| room.picture(&gpu, angle).unwrap());
    assert!(pictures[0] == pictures[2]);
    assert_eq!(room.scene.uploads(), 1);
    let size = embed_texture::SIZE_PX;
    let all = || (0..size.y).flat_map(|y| (0..size.x).map(move |x| UVec2::new(x, y)));
    let changed = |at: &UVec2| texel(&pictures[0], size.x, *at) != texel(&pictures[1], size.x, *at);
    let changed: Vec<UVec2> = all().filter(changed).collect();
    // The screen's part of the picture; its light is none of the room's.
    let is_on_screen = |at: &UVec2| (125..345).contains(&at.x) && (70..200).contains(&at.y);
    assert!(changed.len() > 1000 && changed.iter().all(is_on_screen), "{} pixels", changed.len());
    // The host's sky: blue above, dark below.
    let [above, below] = [UVec2::new(240, 4), UVec2::new(240, 265)].map(|at| texel(&pictures[0], size.x, at));
    assert!(above[2] > above[0] && above[2] > below[2] + 40, "{above:?}, {below:?}");
}

#[test]
fn ten_thousand_bodies_move_without_an_upload() {
    let gpu = gpu(Precision::Half);
    let mut field = procedural::Field::new(&gpu).unwrap();
    let mut pictures = Vec::new();
    for seconds in [0.0, 0.4, 0.0] {
        field.place(seconds).unwrap();
        pictures.push(field.picture(&gpu).unwrap());
    }
    assert!(pictures[0] != pictures[1] && pictures[0] == pictures[2]);
    let stats = field.record(&gpu).unwrap().1;
    assert_eq!((field.scene.uploads(), stats.draws, stats.placements.all), (1, 1, 10_000));
}

#[test]
fn a_split_screen_shows_four_sides() {
    let gpu = gpu(Precision::Half);
    let picture = split_screen::picture(&gpu).unwrap();
    let (size, part) = (split_screen::SIZE_PX, split_screen::PART_PX);
    let parts: Vec<Vec<[u8; 4]>> = (0..4)
        .map(|i| UVec2::new(i % 2, i / 2) * (part + 2))
        .map(|at| (0..part.y).flat_map(move |y| (0..part.x).map(move |x| at + UVec2::new(x, y))))
        .map(|pixels| pixels.map(|at| texel(&picture, size.x, at)).collect())
        .collect();
    for (i, part) in parts.iter().enumerate() {
        assert!(part.iter().all(|texel| texel[3] == 255), "the panorama fills part {i}");
        assert!(!parts[..i].contains(part), "part {i} is like another");
    }
    let gap = (0..size.x).map(|x| texel(&picture, size.x, UVec2::new(x, part.y)));
    assert!(gap.into_iter().all(|texel| texel == [0, 0, 0, 255]));
}

#[test]
fn a_server_holds_no_more_after_many_pictures() {
    let gpu = gpu(Precision::Half);
    let mut server = offscreen_server::Server::new(&gpu);
    let mut sizes = Vec::new();
    let mut pictures = Vec::new();
    for round in 0..4 {
        for job in 0..12 {
            let picture = server.picture(&gpu, job).unwrap();
            match round {
                0 => pictures.push(picture),
                _ => assert!(picture == pictures[job as usize], "job {job} in round {round}"),
            }
        }
        gpu.wait().unwrap();
        sizes.push(offscreen_server::allocated_bytes(&gpu));
    }
    println!("{sizes:?}");
    assert!(sizes.iter().all(|size| *size == sizes[0]), "{sizes:?}");
    assert!((1..pictures.len()).all(|job| !pictures[..job].contains(&pictures[job])));
}
