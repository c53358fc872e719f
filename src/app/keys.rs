//! What keys do. F3D's, where it has one for the same.

use super::camera::Side;

/// What a key or a button of the panel asks for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Action {
    Help,
    Panel,
    Statistics,
    Axes,
    Inspector,
    Truth,
    Side(Side),
    Orthographic,
    FileCamera,
    Fly,
    DebugView { backward: bool },
    ToneMap,
    Quality,
    Background,
    Exposure { up: bool },
    Light { up: bool },
    Neighbour { backward: bool },
    Reload,
    Screenshot,
    SaveState,
    Fullscreen,
    StoreBookmark(u8),
    Bookmark(u8),
    Close,
    Quit,
}

/// What else has to be held.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum With {
    Nothing,
    Shift,
    Ctrl,
}

struct Binding {
    key: &'static str,
    with: With,
    action: Action,
    help: &'static str,
}

const fn key(key: &'static str, action: Action, help: &'static str) -> Binding {
    Binding { key, with: With::Nothing, action, help }
}

const fn shift(key: &'static str, action: Action, help: &'static str) -> Binding {
    Binding { key, with: With::Shift, action, help }
}

const fn ctrl(key: &'static str, action: Action, help: &'static str) -> Binding {
    Binding { key, with: With::Ctrl, action, help }
}

/// All of them. Those with the same text follow each other and share a line of the help.
const BINDINGS: &[Binding] = &[
    key("H", Action::Help, "this help"),
    key("P", Action::Panel, "panel"),
    key("Z", Action::Statistics, "statistics"),
    key("X", Action::Axes, "axes of the world"),
    key("I", Action::Inspector, "what made the pixel under the cursor"),
    key("R", Action::Truth, "reference renderer beside the picture"),
    key("Enter", Action::Side(Side::Default), "show everything"),
    key("1", Action::Side(Side::Front), "from the front, right, top, and isometric"),
    key("3", Action::Side(Side::Right), "from the front, right, top, and isometric"),
    key("7", Action::Side(Side::Top), "from the front, right, top, and isometric"),
    key("9", Action::Side(Side::Isometric), "from the front, right, top, and isometric"),
    key("5", Action::Orthographic, "orthographic"),
    key("C", Action::FileCamera, "cameras of the file"),
    key("V", Action::Fly, "fly: W A S D, Q and E for down and up, Shift for faster"),
    key("N", Action::DebugView { backward: false }, "debug views, onward and back"),
    shift("N", Action::DebugView { backward: true }, "debug views, onward and back"),
    key("T", Action::ToneMap, "tone map"),
    key("Y", Action::Quality, "quality of light from the environment"),
    key("J", Action::Background, "background"),
    key("=", Action::Exposure { up: true }, "exposure, by a third of a stop"),
    key("-", Action::Exposure { up: false }, "exposure, by a third of a stop"),
    key("L", Action::Light { up: true }, "light of the environment"),
    shift("L", Action::Light { up: false }, "light of the environment"),
    key("ArrowLeft", Action::Neighbour { backward: true }, "the models of the folder"),
    key("ArrowRight", Action::Neighbour { backward: false }, "the models of the folder"),
    key("ArrowUp", Action::Reload, "read the model again"),
    key("F12", Action::Screenshot, "picture, and the state that makes it again"),
    ctrl("S", Action::SaveState, "the state alone; dropped on the window, it is opened"),
    key("F11", Action::Fullscreen, "the whole screen"),
    key("F1", Action::Bookmark(1), "back to a bookmark"),
    key("F2", Action::Bookmark(2), "back to a bookmark"),
    key("F3", Action::Bookmark(3), "back to a bookmark"),
    key("F4", Action::Bookmark(4), "back to a bookmark"),
    shift("F1", Action::StoreBookmark(1), "put the camera there"),
    shift("F2", Action::StoreBookmark(2), "put the camera there"),
    shift("F3", Action::StoreBookmark(3), "put the camera there"),
    shift("F4", Action::StoreBookmark(4), "put the camera there"),
    key("Escape", Action::Close, "close what is open, stop flying"),
    ctrl("Q", Action::Quit, "quit"),
];

/// What the mouse does, for the help.
pub(super) const MOUSE: &[(&str, &str)] = &[
    ("drag", "turn"),
    ("Shift drag, middle drag", "move"),
    ("right drag, wheel, pinch", "nearer and farther, toward the cursor"),
    ("Shift wheel, two fingers", "move"),
    ("double click, middle click", "look at this point"),
    ("Ctrl click", "the material of this point, in the panel"),
    ("Shift right drag", "turn the environment"),
    ("drop", "open a model, or light it with a panorama"),
];

/// What a key asks for. `name` is that of the key without Shift: `A`, `1`, `Enter`.
pub(super) fn action(name: &str, shift: bool, ctrl: bool) -> Option<Action> {
    let with = match (shift, ctrl) {
        (false, false) => With::Nothing,
        (true, false) => With::Shift,
        (_, true) => With::Ctrl,
    };
    BINDINGS.iter().find(|binding| binding.key == name && binding.with == with).map(|binding| binding.action)
}

/// Keys and what they do, for people.
pub(super) fn help() -> Vec<(String, &'static str)> {
    let mut lines: Vec<(String, &'static str)> = Vec::new();
    for Binding { key, with, help, .. } in BINDINGS {
        let key = key.strip_prefix("Arrow").unwrap_or(key);
        let held = match with {
            With::Nothing => "",
            With::Shift => "Shift+",
            With::Ctrl => "Ctrl+",
        };
        match lines.last_mut() {
            // `Shift+F1 F2` has Shift held for both.
            Some((keys, text)) if text == help => {
                let held = if keys.starts_with(held) { "" } else { held };
                *keys += &format!(" {held}{key}");
            }
            _ => lines.push((format!("{held}{key}"), help)),
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_key_does_two_things() {
        for (i, a) in BINDINGS.iter().enumerate() {
            assert!(BINDINGS[i + 1..].iter().all(|b| (a.key, a.with) != (b.key, b.with)), "{}", a.key);
            // Flying has these.
            assert!(!["W", "A", "S", "D", "Q", "E"].contains(&a.key) || a.with == With::Ctrl, "{}", a.key);
        }
    }

    #[test]
    fn keys_are_found_and_explained() {
        assert_eq!(action("H", false, false), Some(Action::Help));
        assert_eq!(action("N", true, false), Some(Action::DebugView { backward: true }));
        assert_eq!(action("H", false, true), None);
        let help = help();
        assert!(help.iter().any(|(keys, _)| keys == "1 3 7 9"), "{help:?}");
        assert!(help.iter().any(|(keys, _)| keys == "N Shift+N"), "{help:?}");
    }
}
