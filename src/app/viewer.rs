//! What users do to a state: plain functions, without a window.

use super::camera::Pose;
use super::folder::{Kind, Listing};
use super::input::{Button, Held, InputEvent, PIXELS_PER_LINE};
use super::keys::{self, Action};
use super::named;
use super::shown::{GREY, Shown, is_file};
use super::state::{BackgroundState, ViewerState};
use glam::{DVec2, DVec3, UVec2};
use std::path::PathBuf;

/// Two clicks are a double click within this time.
const DOUBLE_CLICK_S: f64 = 0.4;
/// A press that moves less is a click.
const CLICK_PX: f64 = 4.0;
/// The line between picture and truth can be taken from this far.
const SPLIT_GRIP_PX: f64 = 6.0;
/// What the distance is multiplied with for a line of the wheel.
const ZOOM_PER_LINE: f64 = 0.9;
/// Lines of a wheel that a drag over the height of the picture stands for.
const LINES_PER_HEIGHT: f64 = 20.0;
/// Radii of the scene that are flown in a second.
const FLIGHT_PER_S: f64 = 0.6;
/// Keys that fly, and where to: right, up and forward.
const FLIGHT: [(&str, DVec3); 6] =
    [("W", DVec3::Z), ("S", DVec3::NEG_Z), ("A", DVec3::NEG_X), ("D", DVec3::X), ("E", DVec3::Y), ("Q", DVec3::NEG_Y)];

/// What the window has to do, beyond drawing the state.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Effect {
    /// A file or a folder.
    Open(PathBuf),
    Neighbour {
        backward: bool,
    },
    Reload,
    /// Another variant of the model's materials.
    Variant(Option<String>),
    Screenshot,
    /// The state alone.
    SaveState,
    Fullscreen,
    Quit,
}

/// What is open beside the picture; no picture depends on it.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Interface {
    pub panel: bool,
    pub help: bool,
    pub statistics: bool,
    pub axes: bool,
    /// The material that the panel shows.
    pub material: usize,
    pub inspector: bool,
    pub truth: bool,
    /// Where the truth begins, as a share of the width.
    pub split: f64,
    /// Errors as colours in place of the truth.
    pub errors: bool,
    pub fly: bool,
    /// For the user to read.
    pub message: Option<String>,
    /// Where a file is looked for.
    pub browser: Option<Listing>,
}

impl Default for Interface {
    fn default() -> Self {
        Self {
            panel: false,
            help: false,
            statistics: false,
            axes: false,
            material: 0,
            inspector: false,
            truth: false,
            split: 0.5,
            errors: false,
            fly: false,
            message: None,
            browser: None,
        }
    }
}

/// Who gets an event besides the picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Claims {
    /// The pointer is on something that floats over the picture.
    pub pointer: bool,
    /// Someone types.
    pub keyboard: bool,
}

/// A state, the model that it shows, and what is being done to it.
#[derive(Debug, Default)]
pub(super) struct Viewer {
    pub state: ViewerState,
    pub shown: Option<Shown>,
    pub interface: Interface,
    held: Held,
    press: Option<Press>,
    last_click: Option<(f64, DVec2)>,
}

#[derive(Debug, Clone, Copy)]
struct Press {
    at_px: DVec2,
    moved: bool,
    on_split: bool,
}

impl Viewer {
    pub(super) fn new(state: ViewerState) -> Self {
        Self { state, ..Self::default() }
    }

    /// The events that let go of all that is held, for when nobody will say so.
    pub(super) fn releases(&self) -> Vec<InputEvent> {
        let key = |key: &String| InputEvent::Key { key: key.clone(), pressed: false, text: None };
        let button = |button: &Button| InputEvent::Button { button: *button, pressed: false };
        self.held.keys.iter().map(key).chain(self.held.buttons.iter().map(button)).collect()
    }

    /// The pixel of the picture under the cursor.
    pub(super) fn pixel(&self) -> Option<UVec2> {
        let at = self.held.pointer_px.filter(|at| at.min_element() >= 0.0)?.as_uvec2();
        at.cmplt(self.state.size_px()).all().then_some(at)
    }

    /// Whether time moves the camera.
    pub(super) fn is_flying(&self) -> bool {
        self.interface.fly && FLIGHT.iter().any(|(key, _)| self.held.keys.contains(*key))
    }

    /// Takes one event, `at_s` seconds after the window appeared.
    pub(super) fn input(&mut self, event: &InputEvent, at_s: f64, claims: Claims) -> Vec<Effect> {
        match event {
            InputEvent::Pointer { x, y } => {
                let to = DVec2::new(*x, *y);
                let from = self.held.pointer_px.replace(to);
                if let Some(from) = from {
                    self.drag(from, to);
                }
            }
            InputEvent::PointerLeft => self.held.pointer_px = None,
            InputEvent::Button { button, pressed: true } if !claims.pointer => self.press(*button, at_s),
            InputEvent::Button { button, pressed: false } => self.release(*button),
            InputEvent::Wheel { x, y } if !claims.pointer && self.held.modifiers.shift => {
                self.pan(PIXELS_PER_LINE * DVec2::new(*x, *y));
            }
            InputEvent::Wheel { y, .. } if !claims.pointer => self.zoom(ZOOM_PER_LINE.powf(*y)),
            InputEvent::Pinch { factor } if !claims.pointer && *factor > 0.0 => self.zoom(1.0 / factor),
            InputEvent::Modifiers(modifiers) => self.held.modifiers = *modifiers,
            InputEvent::Key { key, pressed: false, .. } => {
                self.held.keys.remove(key);
            }
            InputEvent::Key { key, pressed: true, .. } if !claims.keyboard => return self.key(key),
            InputEvent::Pass { seconds } => self.fly(*seconds),
            InputEvent::Drop { path } => return self.drop_file(path.clone()),
            InputEvent::Resize { width, height } => self.state.size_px = [(*width).max(1), (*height).max(1)],
            _ => {}
        }
        Vec::new()
    }

    fn press(&mut self, button: Button, at_s: f64) {
        let Some(at_px) = self.held.pointer_px else { return };
        let split_px = self.interface.split * f64::from(self.state.size_px[0]);
        let on_split = self.interface.truth && button == Button::Left && (at_px.x - split_px).abs() <= SPLIT_GRIP_PX;
        if button == Button::Left && self.held.modifiers.ctrl {
            return self.choose_material();
        }
        self.held.buttons.push(button);
        self.press = Some(Press { at_px, moved: false, on_split });
        if button == Button::Left && !on_split {
            let is_second = self
                .last_click
                .is_some_and(|(then_s, there)| at_s - then_s < DOUBLE_CLICK_S && there.distance(at_px) < CLICK_PX);
            self.last_click = (!is_second).then_some((at_s, at_px));
            if is_second {
                self.look_at(at_px, 2.0);
            }
        }
    }

    /// Shows the material under the cursor in the panel.
    fn choose_material(&mut self) {
        let (Some(pixel), Some(shown)) = (self.pixel(), &self.shown) else { return };
        if let Some(material) = shown.material_at(&self.state, pixel) {
            (self.interface.panel, self.interface.material) = (true, material);
        }
    }

    fn release(&mut self, button: Button) {
        self.held.buttons.retain(|held| *held != button);
        if let Some(press) = self.press.take()
            && button == Button::Middle
            && !press.moved
        {
            self.look_at(press.at_px, 1.0);
        }
    }

    fn drag(&mut self, from: DVec2, to: DVec2) {
        let (Some(button), Some(press)) = (self.held.buttons.first().copied(), &mut self.press) else { return };
        press.moved |= press.at_px.distance(to) >= CLICK_PX;
        let Press { moved, on_split, at_px } = *press;
        let (drag, size_px, shift) = (to - from, self.state.size_px(), self.held.modifiers.shift);
        if on_split {
            self.interface.split = (to.x / f64::from(size_px.x)).clamp(0.0, 1.0);
            return;
        }
        if !moved {
            return;
        }
        let Some(shown) = &self.shown else { return };
        let (camera, around) = (self.state.camera, &shown.around);
        match (button, shift) {
            (Button::Left, false) if self.interface.fly => self.state.camera = camera.looked(around, drag, size_px),
            (Button::Left, false) => self.state.camera = camera.turned(around, drag, size_px),
            (Button::Left, true) | (Button::Middle, _) => self.state.camera = camera.panned(around, drag, size_px),
            (Button::Right, false) => {
                let lines = LINES_PER_HEIGHT * drag.y / f64::from(size_px.y);
                self.state.camera = camera.zoomed(around, ZOOM_PER_LINE.powf(-lines), at_px, size_px);
            }
            (Button::Right, true) => {
                let turned = self.state.environment.rotation_deg + 360.0 * drag.x / f64::from(size_px.x);
                self.state.environment.rotation_deg = turned.rem_euclid(360.0);
            }
        }
    }

    fn zoom(&mut self, factor: f64) {
        let size_px = self.state.size_px();
        let cursor_px = self.held.pointer_px.unwrap_or(0.5 * size_px.as_dvec2());
        if let Some(shown) = &self.shown {
            self.state.camera = self.state.camera.zoomed(&shown.around, factor, cursor_px, size_px);
        }
    }

    fn pan(&mut self, drag_px: DVec2) {
        let size_px = self.state.size_px();
        if let Some(shown) = &self.shown {
            self.state.camera = self.state.camera.panned(&shown.around, drag_px, size_px);
        }
    }

    /// Looks at the surface that a pixel shows, if it shows one.
    fn look_at(&mut self, pixel: DVec2, closer: f64) {
        let Some(shown) = &self.shown else { return };
        if let Some(point) = shown.point_at(&self.state, pixel) {
            self.state.camera = self.state.camera.focused(&shown.around, point, closer);
        }
    }

    fn fly(&mut self, seconds: f64) {
        let Some(shown) = self.shown.as_ref().filter(|_| self.interface.fly) else { return };
        let way: DVec3 =
            FLIGHT.iter().filter(|(key, _)| self.held.keys.contains(*key)).map(|(_, direction)| *direction).sum();
        let faster = if self.held.modifiers.shift { 5.0 } else { 1.0 };
        let by_m = way.normalize_or_zero() * (FLIGHT_PER_S * faster * seconds * shown.around.radius_m);
        self.state.camera = self.state.camera.flown(&shown.around, by_m);
    }

    fn key(&mut self, key: &str) -> Vec<Effect> {
        let is_new = self.held.keys.insert(key.to_owned());
        let (shift, ctrl) = (self.held.modifiers.shift, self.held.modifiers.ctrl);
        match keys::action(key, shift, ctrl) {
            Some(action) if is_new => self.act(action),
            _ => Vec::new(),
        }
    }

    /// Does what a key asks for.
    pub(super) fn act(&mut self, action: Action) -> Vec<Effect> {
        let interface = &mut self.interface;
        let toggle = |switch: &mut bool| *switch = !*switch;
        match action {
            Action::Help => toggle(&mut interface.help),
            Action::Panel => toggle(&mut interface.panel),
            Action::Statistics => toggle(&mut interface.statistics),
            Action::Axes => toggle(&mut interface.axes),
            Action::Inspector => toggle(&mut interface.inspector),
            Action::Truth => toggle(&mut interface.truth),
            Action::Fly => toggle(&mut interface.fly),
            Action::Close => {
                let open = interface.help || interface.message.is_some() || interface.browser.is_some();
                (interface.help, interface.message, interface.browser) = (false, None, None);
                if !open {
                    (interface.fly, interface.truth, interface.inspector) = (false, false, false);
                }
            }
            Action::Neighbour { backward } => return vec![Effect::Neighbour { backward }],
            Action::Reload => return vec![Effect::Reload],
            Action::Screenshot => return vec![Effect::Screenshot],
            Action::SaveState => return vec![Effect::SaveState],
            Action::Fullscreen => return vec![Effect::Fullscreen],
            Action::Quit => return vec![Effect::Quit],
            _ => self.change(action),
        }
        Vec::new()
    }

    /// Actions that change the picture.
    fn change(&mut self, action: Action) {
        let (size_px, look) = (self.state.size_px(), &mut self.state.look);
        match action {
            Action::DebugView { backward } => look.debug_view = named::next(look.debug_view, backward),
            Action::ToneMap => look.tone_map = named::next(look.tone_map, false),
            Action::Quality => look.quality = named::next(look.quality, false),
            Action::Exposure { up } => look.exposure_ev += if up { 1.0 / 3.0 } else { -1.0 / 3.0 },
            Action::Light { up } => {
                let intensity = &mut self.state.environment.intensity;
                *intensity = (*intensity * if up { 1.25 } else { 0.8 }).clamp(1e-3, 1e3);
            }
            Action::Background => {
                let is_file = is_file(&self.state.environment.source);
                look.background = match look.background {
                    BackgroundState::Auto if is_file => BackgroundState::Color([GREY; 3]),
                    BackgroundState::Auto => BackgroundState::Environment,
                    BackgroundState::Environment => BackgroundState::Color([GREY; 3]),
                    BackgroundState::Color([r, ..]) if r < 0.5 => BackgroundState::Color([1.0; 3]),
                    BackgroundState::Color(_) => BackgroundState::Transparent,
                    BackgroundState::Transparent => BackgroundState::Auto,
                };
            }
            Action::Orthographic => {
                if let (Some(Pose::File(_)), Some(shown)) = (self.state.camera.pose, &self.shown) {
                    self.state.camera.pose = Some(Pose::Orbit(self.state.camera.orbit(&shown.around)));
                }
                self.state.camera.orthographic = !self.state.camera.orthographic;
            }
            Action::StoreBookmark(number) => {
                self.state.bookmarks.insert(number, self.state.camera);
            }
            Action::Bookmark(number) => {
                self.state.camera = self.state.bookmarks.get(&number).copied().unwrap_or(self.state.camera);
            }
            Action::Side(side) => {
                if let Some(shown) = &self.shown {
                    self.state.camera = self.state.camera.from_side(&shown.scene, side, size_px);
                }
            }
            Action::FileCamera => match &self.shown {
                Some(shown) if shown.around.cameras.is_empty() => {
                    self.interface.message = Some("the file has no cameras".into());
                }
                Some(shown) => self.state.camera = self.state.camera.next_of_file(&shown.around),
                None => {}
            },
            _ => {}
        }
    }

    fn drop_file(&mut self, path: PathBuf) -> Vec<Effect> {
        if !Kind::Panorama.is_of(&path) {
            return vec![Effect::Open(path)];
        }
        self.state.environment.source = path.to_string_lossy().into_owned();
        Vec::new()
    }
}

#[cfg(test)]
mod tests;
