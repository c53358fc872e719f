//! A look around in folders, for a model or a panorama.

use super::overlay::float;
use crate::app::desk::Desk;
use crate::app::folder::{Kind, Listing};
use crate::app::gui::name_place;
use crate::app::viewer::Effect;
use egui::{Align2, ScrollArea};
use std::path::{Path, PathBuf};

/// Begins to look for a file, where the last one of its kind is.
pub(super) fn open(desk: &mut Desk, kind: Kind) {
    let state = &desk.viewer.state;
    let (model, panorama) = (state.model.as_deref(), Path::new(&state.environment.source));
    let last = match kind {
        Kind::Model => model,
        Kind::Panorama => Some(panorama).filter(|path| kind.is_of(path)).or(model),
    };
    match Listing::of_any(last.and_then(Path::parent), kind) {
        Ok(listing) => desk.viewer.interface.browser = Some(listing),
        Err(problem) => desk.say(problem),
    }
}

/// What was clicked on.
enum Chosen {
    Folder(PathBuf),
    File(PathBuf),
    Nothing,
}

pub(super) fn show(ui: &egui::Ui, desk: &mut Desk, effects: &mut Vec<Effect>) {
    let Some(listing) = &desk.viewer.interface.browser else { return };
    let kind = listing.kind;
    let height = ui.ctx().content_rect().height() - 140.0;
    let chosen = float(ui, "browser", Align2::LEFT_CENTER, |ui| {
        ui.set_width(320.0);
        let mut chosen = None;
        ui.horizontal(|ui| {
            ui.label(match kind {
                Kind::Model => "open a model",
                Kind::Panorama => "light with a panorama",
            });
            if button(ui, "close", "browser-close") {
                chosen = Some(Chosen::Nothing);
            }
        });
        ui.label(listing.folder.display().to_string());
        // Otherwise it would stay as low as the folder before was.
        let files = ScrollArea::vertical().max_height(height).min_scrolled_height(height);
        files.auto_shrink([false, true]).show(ui, |ui| {
            if let (Some(parent), true) = (listing.folder.parent(), button(ui, "..", "browser/..")) {
                chosen = Some(Chosen::Folder(parent.to_owned()));
            }
            for folder in &listing.folders {
                if row(ui, folder, "/") {
                    chosen = Some(Chosen::Folder(folder.clone()));
                }
            }
            for file in &listing.files {
                if row(ui, file, "") {
                    chosen = Some(Chosen::File(file.clone()));
                }
            }
        });
        chosen
    });
    let browser = &mut desk.viewer.interface.browser;
    match chosen {
        Some(Chosen::Folder(folder)) => match Listing::new(&folder, kind) {
            Ok(listing) => *browser = Some(listing),
            Err(problem) => desk.say(problem),
        },
        Some(Chosen::File(file)) => {
            *browser = None;
            match kind {
                Kind::Model => effects.push(Effect::Open(file)),
                Kind::Panorama => desk.viewer.state.environment.source = file.to_string_lossy().into_owned(),
            }
        }
        Some(Chosen::Nothing) => *browser = None,
        None => {}
    }
}

fn row(ui: &mut egui::Ui, path: &Path, after: &str) -> bool {
    let name = path.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
    button(ui, &format!("{name}{after}"), &format!("browser/{name}"))
}

fn button(ui: &mut egui::Ui, label: &str, place: &str) -> bool {
    let button = ui.button(label);
    name_place(&button, place);
    button.clicked()
}
