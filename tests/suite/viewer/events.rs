//! Events of recordings, and files of the repository.

use std::path::Path;

pub(super) fn asset(name: &str) -> String {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("assets").join(name).to_string_lossy().into_owned()
}

pub(super) fn pointer(x: u32, y: u32) -> String {
    format!(r#"{{"pointer":{{"x":{x},"y":{y}}}}}"#)
}

pub(super) fn button(pressed: bool) -> String {
    format!(r#"{{"button":{{"button":"left","pressed":{pressed}}}}}"#)
}

pub(super) fn wheel(lines: i32) -> String {
    format!(r#"{{"wheel":{{"x":0,"y":{lines}}}}}"#)
}

/// A key goes down and up.
pub(super) fn key(name: &str) -> [String; 2] {
    [true, false].map(|pressed| format!(r#"{{"key":{{"key":"{name}","pressed":{pressed},"text":null}}}}"#))
}

pub(super) fn point_at(widget: &str, x: f64) -> String {
    format!(r#"{{"point-at":{{"widget":"{widget}","x":{x},"y":0.5}}}}"#)
}

/// The pointer goes to a part of the panel and clicks.
pub(super) fn click(widget: &str, x: f64) -> [String; 3] {
    [point_at(widget, x), button(true), button(false)]
}

pub(super) fn hold(seconds: u32) -> String {
    format!(r#"{{"hold":{{"seconds":{seconds}}}}}"#)
}

pub(super) fn drop_file(path: &str) -> String {
    format!(r#"{{"drop":{{"path":"{path}"}}}}"#)
}

pub(super) fn resize(width: u32, height: u32) -> String {
    format!(r#"{{"resize":{{"width":{width},"height":{height}}}}}"#)
}

/// From left to right over the picture, with the left button.
pub(super) fn drag() -> Vec<String> {
    vec![pointer(100, 150), button(true), pointer(140, 160), pointer(180, 140), button(false)]
}
