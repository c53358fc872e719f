//! Light from around, and the lights of the file.

use super::{browser, recent, rows};
use crate::app::desk::Desk;
use crate::app::folder::Kind;
use crate::app::gui::name_place;
use crate::scene::LightKind;

pub(super) fn environment(ui: &mut egui::Ui, desk: &mut Desk) {
    let environment = &mut desk.viewer.state.environment;
    ui.horizontal(|ui| {
        for source in ["neutral", "white", "black"] {
            let button = ui.selectable_label(environment.source == source, source);
            name_place(&button, format!("environment/{source}"));
            if button.clicked() {
                environment.source = source.into();
            }
        }
    });
    if crate::app::shown::is_file(&environment.source) {
        let name = std::path::Path::new(&environment.source).file_name();
        let name = name.map_or_else(String::new, |name| name.to_string_lossy().into_owned());
        ui.label(name).on_hover_text(&environment.source);
    }
    ui.horizontal(|ui| {
        let field = ui.add(egui::TextEdit::singleline(&mut desk.texts.panorama).hint_text("path of an .hdr or .exr"));
        name_place(&field, "environment/path");
        let button = ui.button("light");
        name_place(&button, "environment/light");
        let entered = field.lost_focus() && ui.input(|input| input.key_pressed(egui::Key::Enter));
        if (button.clicked() || entered) && !desk.texts.panorama.trim().is_empty() {
            environment.source = desk.texts.panorama.trim().to_owned();
        }
    });
    ui.horizontal(|ui| {
        let browse = ui.button("look for a panorama");
        name_place(&browse, "environment/browse");
        if browse.clicked() {
            browser::open(desk, Kind::Panorama);
        }
        if let Some(path) = recent::menu(ui, desk, Kind::Panorama) {
            desk.viewer.state.environment.source = path.to_string_lossy().into_owned();
        }
    });
    let environment = &mut desk.viewer.state.environment;
    rows::number(ui, ("rotation, degrees", "environment/rotation"), &mut environment.rotation_deg, 0.0..=360.0);
    rows::factor(ui, ("intensity", "environment/intensity"), &mut environment.intensity, 0.001..=100.0);
}

pub(super) fn lights(ui: &mut egui::Ui, desk: &mut Desk) {
    let Some(shown) = &desk.viewer.shown else { return };
    if shown.scene.lights.is_empty() {
        ui.label("The file has none.");
    }
    let factors = &mut desk.viewer.state.light_factors;
    for (index, light) in shown.scene.lights.iter().enumerate() {
        let (kind, unit) = match light.kind {
            LightKind::Point { .. } => ("point", "cd"),
            LightKind::Spot { .. } => ("spot", "cd"),
            LightKind::Directional => ("directional", "lux"),
        };
        let name = light.name.as_deref().unwrap_or("unnamed");
        ui.label(format!("{name}: {kind}, {:.4} {unit}", light.intensity));
        let mut factor = factors.get(&index).copied().unwrap_or(1.0);
        let place = format!("lights/{index}");
        if rows::number(ui, ("times", &place), &mut factor, 0.0..=4.0) {
            factors.insert(index, factor);
        }
    }
}
