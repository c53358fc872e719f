//! The model that is open, and another one by its path.

use super::{browser, recent};
use crate::app::desk::Desk;
use crate::app::folder::Kind;
use crate::app::gui::name_place;
use crate::app::keys::Action;
use crate::app::viewer::Effect;
use std::path::PathBuf;

pub(super) fn show(ui: &mut egui::Ui, desk: &mut Desk, effects: &mut Vec<Effect>) {
    if let Some(model) = &desk.viewer.state.model {
        ui.label(model.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned()))
            .on_hover_text(model.display().to_string());
    }
    ui.horizontal(|ui| {
        let field = ui.add(egui::TextEdit::singleline(&mut desk.texts.model).hint_text("path of a model or a folder"));
        name_place(&field, "file/path");
        let open = ui.button("open");
        name_place(&open, "file/open");
        let entered = field.lost_focus() && ui.input(|input| input.key_pressed(egui::Key::Enter));
        if (open.clicked() || entered) && !desk.texts.model.trim().is_empty() {
            effects.push(Effect::Open(PathBuf::from(desk.texts.model.trim())));
        }
    });
    let browse = ui.button("look for a model");
    name_place(&browse, "file/browse");
    if browse.clicked() {
        browser::open(desk, Kind::Model);
    }
    ui.horizontal(|ui| {
        let buttons = [
            ("previous", Action::Neighbour { backward: true }),
            ("next", Action::Neighbour { backward: false }),
            ("reload", Action::Reload),
            ("save picture", Action::Screenshot),
        ];
        for (label, action) in buttons {
            let button = ui.button(label);
            name_place(&button, format!("file/{label}"));
            if button.clicked() {
                effects.extend(desk.viewer.act(action));
            }
        }
    });
    effects.extend(recent::menu(ui, desk, Kind::Model).map(Effect::Open));
    effects.extend(variants(ui, desk));
}

/// The variants of the model's materials, if it has any. Returns one that is chosen.
fn variants(ui: &mut egui::Ui, desk: &Desk) -> Option<Effect> {
    let (names, current) = (&desk.about.variants, &desk.viewer.state.variant);
    if names.is_empty() {
        return None;
    }
    let mut effect = None;
    ui.horizontal_wrapped(|ui| {
        ui.label("variant");
        for variant in std::iter::once(None).chain(names.iter().cloned().map(Some)) {
            let label = variant.as_deref().unwrap_or("none");
            let choice = ui.selectable_label(*current == variant, label);
            name_place(&choice, format!("variant/{label}"));
            if choice.clicked() {
                effect = Some(Effect::Variant(variant));
            }
        }
    });
    effect
}
