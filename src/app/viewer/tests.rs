use super::*;
use crate::app::input::Modifiers;
use crate::scene::shapes::sphere;
use crate::scene::{Material, Mesh, Node, Quality, Scene};
use glam::DMat4;

fn viewer() -> Viewer {
    let scene = Scene {
        nodes: vec![Node { mesh: Some(0), parent_from_node: DMat4::IDENTITY, ..Node::default() }],
        roots: vec![0],
        meshes: vec![Mesh { name: None, primitives: vec![sphere(1.0, 16, 0)] }],
        materials: vec![Material::default()],
        ..Scene::default()
    };
    let mut viewer = Viewer::new(ViewerState { size_px: [400, 300], ..ViewerState::default() });
    viewer.shown = Some(Shown::new(scene, &viewer.state));
    viewer
}

/// Feeds events, a tenth of a second apart.
fn feed(viewer: &mut Viewer, events: &[InputEvent]) -> Vec<Effect> {
    events.iter().zip(0..).flat_map(|(event, i)| viewer.input(event, 0.1 * f64::from(i), Claims::default())).collect()
}

fn pointer(x: f64, y: f64) -> InputEvent {
    InputEvent::Pointer { x, y }
}

fn button(button: Button, pressed: bool) -> InputEvent {
    InputEvent::Button { button, pressed }
}

fn press(key: &str) -> InputEvent {
    InputEvent::Key { key: key.into(), pressed: true, text: None }
}

fn release(key: &str) -> InputEvent {
    InputEvent::Key { key: key.into(), pressed: false, text: None }
}

fn orbit(viewer: &Viewer) -> crate::app::camera::Orbit {
    viewer.state.camera.orbit(&viewer.shown.as_ref().unwrap().around)
}

#[test]
fn drags_turn_move_and_zoom() {
    use Button::{Left, Middle, Right};
    let home = orbit(&viewer());
    let after = |which: Button| {
        let mut viewer = viewer();
        feed(&mut viewer, &[pointer(100.0, 100.0), button(which, true), pointer(150.0, 80.0), button(which, false)]);
        feed(&mut viewer, &[pointer(10.0, 10.0)]);
        orbit(&viewer)
    };
    let turned = after(Left);
    assert!(turned.target == home.target && turned.theta_rad < home.theta_rad && turned.phi_rad > home.phi_rad);
    let panned = after(Middle);
    assert!(panned.target != home.target && panned.theta_rad == home.theta_rad);
    assert_eq!(panned.distance_m, home.distance_m);
    // Upward is nearer.
    assert!(after(Right).distance_m < home.distance_m);
}

#[test]
fn touch_pads_zoom_and_move() {
    let home = orbit(&viewer());
    let after = |events: &[InputEvent]| {
        let mut viewer = viewer();
        feed(&mut viewer, &[&[pointer(200.0, 150.0)], events].concat());
        orbit(&viewer)
    };
    let pinched = after(&[InputEvent::Pinch { factor: 2.0 }]);
    assert!((pinched.distance_m / home.distance_m - 0.5).abs() < 1e-12);
    assert!(after(&[InputEvent::Wheel { x: 0.0, y: -1.0 }]).distance_m > home.distance_m);
    let shift = InputEvent::Modifiers(Modifiers { shift: true, ..Modifiers::default() });
    let moved = after(&[shift, InputEvent::Wheel { x: 1.0, y: -0.5 }]);
    // As far as a drag over the same pixels.
    let button = |pressed| button(Button::Middle, pressed);
    let dragged = after(&[button(true), pointer(240.0, 130.0), button(false)]);
    assert!((moved.target() - dragged.target()).length() < 1e-9, "{moved:?} {dragged:?}");
    assert_eq!((moved.distance_m, moved.theta_rad), (home.distance_m, home.theta_rad));
}

#[test]
fn clicks_do_not_turn_and_double_clicks_focus() {
    let mut viewer = viewer();
    let home = orbit(&viewer);
    let click = [button(Button::Left, true), pointer(201.0, 150.0), button(Button::Left, false)];
    feed(&mut viewer, &[pointer(200.0, 150.0)]);
    feed(&mut viewer, &click);
    assert_eq!(orbit(&viewer), home);
    feed(&mut viewer, &click);
    let focused = orbit(&viewer);
    assert!((focused.target().length() - 1.0).abs() < 0.02, "not on the ball: {:?}", focused.target);
    assert!((focused.distance_m / home.distance_m - 0.5).abs() < 1e-9);
    // Beside the ball there is nothing to look at.
    feed(&mut viewer, &[pointer(2.0, 2.0), button(Button::Middle, true), button(Button::Middle, false)]);
    assert_eq!(orbit(&viewer), focused);
}

#[test]
fn the_panel_keeps_what_is_its_own() {
    let mut viewer = viewer();
    let before = viewer.state.clone();
    let claims = Claims { pointer: true, keyboard: true };
    let events =
        [pointer(9.0, 9.0), button(Button::Left, true), pointer(99.0, 9.0), InputEvent::Wheel { x: 0.0, y: 3.0 }];
    for event in events.iter().chain(&[button(Button::Left, false), press("T")]) {
        assert_eq!(viewer.input(event, 0.0, claims), []);
    }
    assert_eq!(viewer.state, before);
}

#[test]
fn keys_change_the_look_once_a_press() {
    let mut viewer = viewer();
    feed(&mut viewer, &[press("Y"), press("Y"), release("Y")]);
    assert_eq!(viewer.state.look.quality, Quality::High);
    feed(&mut viewer, &[press("N")]);
    assert_eq!(viewer.state.look.debug_view, crate::scene::Channel::by_name("base-color"));
    let shift = InputEvent::Modifiers(Modifiers { shift: true, ..Modifiers::default() });
    feed(&mut viewer, &[release("N"), shift, press("N")]);
    assert_eq!(viewer.state.look.debug_view, None);
    assert_eq!(feed(&mut viewer, &[InputEvent::Modifiers(Modifiers::default()), press("F12")]), [Effect::Screenshot]);
}

#[test]
fn materials_are_chosen_by_their_surfaces() {
    let mut viewer = viewer();
    let mut scene = viewer.shown.take().unwrap().scene;
    scene.materials.push(Material::default());
    scene.meshes[0].primitives[0].material = 1;
    viewer.shown = Some(Shown::new(scene, &viewer.state));
    let ctrl = InputEvent::Modifiers(Modifiers { ctrl: true, ..Modifiers::default() });
    let click = [button(Button::Left, true), button(Button::Left, false)];
    // Beside the ball there is none.
    feed(&mut viewer, &[&[ctrl, pointer(2.0, 2.0)], &click[..]].concat());
    assert_eq!((viewer.interface.panel, viewer.interface.material), (false, 0));
    let before = viewer.state.clone();
    feed(&mut viewer, &[&[pointer(200.0, 150.0)], &click[..], &[pointer(300.0, 99.0)]].concat());
    assert_eq!((viewer.interface.panel, viewer.interface.material), (true, 1));
    assert_eq!(viewer.state, before, "the camera has moved");
}

#[test]
fn flying_takes_keys_and_time() {
    let mut viewer = viewer();
    feed(&mut viewer, &[press("V"), press("W")]);
    assert!(viewer.is_flying());
    let before = orbit(&viewer);
    feed(&mut viewer, &[InputEvent::Pass { seconds: 0.5 }]);
    let moved = orbit(&viewer).eye() - before.eye();
    assert!((moved.normalize() + before.direction()).length() < 1e-9, "{moved}");
    feed(&mut viewer, &[release("W")]);
    assert!(!viewer.is_flying());
}

#[test]
fn what_is_held_can_be_let_go() {
    let mut viewer = viewer();
    feed(&mut viewer, &[press("V"), press("W"), pointer(9.0, 9.0), button(Button::Left, true)]);
    assert!(viewer.is_flying());
    let releases = viewer.releases();
    feed(&mut viewer, &releases);
    assert!(!viewer.is_flying() && viewer.releases().is_empty());
}

#[test]
fn bookmarks_and_dropped_files() {
    let mut viewer = viewer();
    let shift = |shift| InputEvent::Modifiers(Modifiers { shift, ..Modifiers::default() });
    let home = viewer.state.camera;
    feed(&mut viewer, &[shift(true), press("F1"), release("F1"), shift(false), press("7")]);
    assert_ne!(viewer.state.camera, home);
    feed(&mut viewer, &[press("F1")]);
    assert_eq!(viewer.state.camera, home);
    assert_eq!(feed(&mut viewer, &[InputEvent::Drop { path: "sky.HDR".into() }]), []);
    assert_eq!(viewer.state.environment.source, "sky.HDR");
    let open = feed(&mut viewer, &[InputEvent::Drop { path: "notes.txt".into() }]);
    assert_eq!(open, [Effect::Open("notes.txt".into())]);
}

#[test]
fn the_environment_turns_and_light_and_exposure_step() {
    let mut viewer = viewer();
    let shift = |shift| InputEvent::Modifiers(Modifiers { shift, ..Modifiers::default() });
    let right = |pressed| button(Button::Right, pressed);
    feed(&mut viewer, &[pointer(100.0, 100.0), shift(true), right(true), pointer(200.0, 100.0), right(false)]);
    assert!((viewer.state.environment.rotation_deg - 90.0).abs() < 1e-9, "a quarter of the width is a quarter turn");
    feed(&mut viewer, &[press("L"), release("L"), shift(false), press("="), release("="), press("="), press("T")]);
    assert!((viewer.state.environment.intensity - 0.8).abs() < 1e-12);
    assert!((viewer.state.look.exposure_ev - 2.0 / 3.0).abs() < 1e-6);
    assert_ne!(viewer.state.look.tone_map, crate::scene::ToneMap::default());
}
