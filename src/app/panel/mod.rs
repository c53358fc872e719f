//! What lies over the picture and beside it.

mod browser;
mod file;
mod inspector;
mod light;
mod look;
mod material;
mod overlay;
mod recent;
mod rows;
mod statistics;
mod tree;

pub(super) use inspector::Inspected;

use super::desk::Desk;
use super::stage::Stage;
use super::viewer::Effect;
use egui::{Panel, ScrollArea};

/// Draws all of it. What was asked for by it, and how wide the panel beside the picture is, in points.
pub(super) fn show(ui: &mut egui::Ui, desk: &mut Desk, stage: &Stage) -> (Vec<Effect>, f32) {
    let (mut effects, mut width, mut has_statistics) = (Vec::new(), 0.0, false);
    if desk.viewer.interface.panel {
        let panel = Panel::right("panel").default_size(320.0).show(ui, |ui| {
            let all = ScrollArea::vertical().auto_shrink(false);
            has_statistics = all.show(ui, |ui| side(ui, desk, stage, &mut effects)).inner;
        });
        width = panel.response.rect.width();
    }
    recent::welcome(ui, desk, &mut effects);
    overlay::progress(ui, desk);
    overlay::message(ui, desk);
    overlay::truth(ui, desk);
    overlay::axes(ui, desk);
    inspector::show(ui, desk, stage);
    if !has_statistics {
        statistics::show(ui, desk, stage);
    }
    overlay::help(ui, desk);
    browser::show(ui, desk, &mut effects);
    (effects, width)
}

/// The parts of the panel, each foldable. Whether the statistics, which come last, are open.
fn side(ui: &mut egui::Ui, desk: &mut Desk, stage: &Stage, effects: &mut Vec<Effect>) -> bool {
    rows::part(ui, "File", true, |ui| file::show(ui, desk, effects));
    rows::part(ui, "Picture", true, |ui| look::picture(ui, desk));
    rows::part(ui, "Camera", false, |ui| look::camera(ui, desk));
    rows::part(ui, "Environment", true, |ui| light::environment(ui, desk));
    rows::part(ui, "Lights", false, |ui| light::lights(ui, desk));
    rows::part(ui, "Scene", false, |ui| tree::show(ui, desk));
    rows::part(ui, "Materials", true, |ui| material::show(ui, desk));
    rows::part(ui, "Statistics", false, |ui| statistics::part(ui, desk, stage))
}
