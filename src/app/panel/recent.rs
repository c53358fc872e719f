//! Files that were open before, to be opened again.

use super::{browser, overlay};
use crate::app::desk::Desk;
use crate::app::folder::Kind;
use crate::app::gui::name_place;
use crate::app::viewer::Effect;
use egui::Align2;
use std::path::{Path, PathBuf};

/// A menu of them, but for the one that is open. The one that was chosen.
pub(super) fn menu(ui: &mut egui::Ui, desk: &Desk, kind: Kind) -> Option<PathBuf> {
    let open = match kind {
        Kind::Model => desk.viewer.state.model.clone(),
        Kind::Panorama => Some(PathBuf::from(&desk.viewer.state.environment.source)),
    };
    let open = open.and_then(|path| path.canonicalize().ok());
    let others: Vec<&PathBuf> = desk.recent.of(kind).iter().filter(|path| Some(*path) != open.as_ref()).collect();
    if others.is_empty() {
        return None;
    }
    let place = place(kind);
    let menu = ui.menu_button("recent", |ui| {
        let chosen = others.iter().find(|path| row(ui, path, place));
        if chosen.is_some() {
            ui.close();
        }
        chosen.map(|path| path.to_path_buf())
    });
    name_place(&menu.response, place);
    menu.inner.flatten()
}

fn place(kind: Kind) -> &'static str {
    match kind {
        Kind::Model => "file/recent",
        Kind::Panorama => "environment/recent",
    }
}

/// Whether the file was clicked on.
fn row(ui: &mut egui::Ui, path: &Path, place: &str) -> bool {
    let name = path.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
    let button = ui.button(&name).on_hover_text(path.display().to_string());
    name_place(&button, format!("{place}/{name}"));
    button.clicked()
}

/// What an empty window says, and what can be opened from it.
pub(super) fn welcome(ui: &egui::Ui, desk: &mut Desk, effects: &mut Vec<Effect>) {
    let has_browser = desk.viewer.interface.browser.is_some();
    if desk.viewer.shown.is_some() || desk.is_reading_model() || has_browser {
        return;
    }
    let mut wants_browser = false;
    overlay::float(ui, "welcome", Align2::CENTER_CENTER, |ui| {
        ui.set_width(280.0);
        ui.label("Drop a model (.gltf, .glb), a folder or a panorama (.hdr, .exr) here. H shows the keys.");
        let browse = ui.button("look for a model");
        name_place(&browse, "welcome/browse");
        wants_browser = browse.clicked();
        let recent = desk.recent.of(Kind::Model);
        if !recent.is_empty() {
            ui.separator();
            effects.extend(recent.iter().find(|path| row(ui, path, "welcome")).cloned().map(Effect::Open));
        }
    });
    if wants_browser {
        browser::open(desk, Kind::Model);
    }
}
