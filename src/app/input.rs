//! What users do, as plain data: from the window, or from a recording.

use glam::DVec2;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// Pixels that a touch pad scrolls for a line of a wheel.
pub(super) const PIXELS_PER_LINE: f64 = 40.0;

/// One thing that happened. Places are in pixels of the window, from its top left corner.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum InputEvent {
    Pointer {
        x: f64,
        y: f64,
    },
    PointerLeft,
    Button {
        button: Button,
        pressed: bool,
    },
    /// Lines of a wheel, or what a touch pad makes of them; up and left are above 0.
    Wheel {
        x: f64,
        y: f64,
    },
    /// Two fingers on a touch pad: what the picture grows by.
    Pinch {
        factor: f64,
    },
    Key {
        key: String,
        pressed: bool,
        text: Option<String>,
    },
    Modifiers(Modifiers),
    /// A file or a folder that was dropped on the window.
    Drop {
        path: PathBuf,
    },
    /// Time that passes while a key that moves the camera is held.
    Pass {
        seconds: f64,
    },
    /// The window got another size, in pixels. In a recording that is played: it is asked for.
    Resize {
        width: u32,
        height: u32,
    },
    /// Only in recordings: the pointer goes to a part of the panel, by its name; (0.5, 0.5) is the middle of it.
    PointAt {
        widget: String,
        x: f64,
        y: f64,
    },
    /// Only in recordings: nothing is done for so long.
    Hold {
        seconds: f64,
    },
    /// Only in recordings: the device is destroyed, as a driver does that fails.
    LoseDevice,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Button {
    Left,
    Middle,
    Right,
}

/// Keys that are held beside others.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Modifiers {
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub shift: bool,
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub ctrl: bool,
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub alt: bool,
}

/// An event and when it was, seconds since the window appeared. A recording has one a line.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Recorded {
    pub at_s: f64,
    pub event: InputEvent,
}

/// The events of a recording.
///
/// # Errors
/// The number of the line that is none, and why.
pub fn parse_recording(text: &str) -> Result<Vec<Recorded>, String> {
    let lines = text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty());
    lines
        .map(|(index, line)| serde_json::from_str(line).map_err(|error| format!("line {}: {error}", index + 1)))
        .collect()
}

/// What is held, and where the pointer is: what events leave behind.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Held {
    pub pointer_px: Option<DVec2>,
    pub modifiers: Modifiers,
    /// The buttons that were pressed on the picture, first to last.
    pub buttons: Vec<Button>,
    /// Names of keys that are down.
    pub keys: std::collections::BTreeSet<String>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn recordings_are_read_as_they_were_written() {
        let events = [
            InputEvent::Pointer { x: 1.5, y: 2.0 },
            InputEvent::Button { button: Button::Middle, pressed: true },
            InputEvent::Modifiers(Modifiers { shift: true, ..Modifiers::default() }),
            InputEvent::Key { key: "F12".into(), pressed: true, text: None },
            InputEvent::Drop { path: "a b.glb".into() },
            InputEvent::LoseDevice,
        ];
        let recorded = events.map(|event| Recorded { at_s: 0.25, event });
        let lines: Vec<String> = recorded.iter().map(|event| serde_json::to_string(event).unwrap()).collect();
        assert_eq!(parse_recording(&(lines.join("\n\n") + "\n")).unwrap(), recorded);
        assert!(parse_recording("\n{\"at_s\": 0}").unwrap_err().starts_with("line 2: "));
    }
}
