//! Short texts over the picture.

use crate::app::desk::Desk;
use crate::app::gui::name_place;
use crate::app::keys;
use crate::app::truth::{Figures, Truth};
use egui::{Align2, Area, Color32, FontId, Frame, Grid, Id, ProgressBar, RichText, ScrollArea, Stroke, vec2};
use glam::DVec3;

/// What needs less floats beside the panel, points.
const ROOM: f32 = 360.0;

/// Something small that floats at a side of the picture.
pub(super) fn float<R>(ui: &egui::Ui, name: &str, at: Align2, content: impl FnOnce(&mut egui::Ui) -> R) -> R {
    let inward = vec2(-12.0 * at.x().to_sign(), -12.0 * at.y().to_sign());
    // Where the panel leaves no room, it is covered: what does not fit would be cut off.
    let beside_panel = Some(ui.available_rect_before_wrap()).filter(|room| room.width() >= ROOM);
    let area = Area::new(Id::unique(name)).anchor(at, inward).order(egui::Order::Foreground);
    let area = area.constrain_to(beside_panel.unwrap_or_else(|| ui.ctx().content_rect()));
    area.show(ui.ctx(), |ui| Frame::popup(ui.style()).show(ui, content).inner).inner
}

/// What is being read, and how far it is.
pub(super) fn progress(ui: &egui::Ui, desk: &Desk) {
    let Some(loading) = &desk.loading else { return };
    let stage = loading.stage();
    let name = loading.wanted.model.as_ref().and_then(|model| model.path.file_name());
    let name = name.map_or_else(|| "light".into(), |name| name.to_string_lossy().into_owned());
    // Until there is something to look at, this is all there is.
    let at = if desk.viewer.shown.is_some() { Align2::CENTER_BOTTOM } else { Align2::CENTER_CENTER };
    float(ui, "progress", at, |ui| {
        ui.set_width(280.0);
        ui.label(format!("{name}: {}", if stage.name.is_empty() { "reading" } else { &stage.name }));
        let share = if stage.total > 0 { stage.done as f32 / stage.total as f32 } else { 0.0 };
        ui.add(ProgressBar::new(share.min(1.0)).desired_height(6.0));
    });
}

/// What the viewer has to say, and what is wrong with shaders that are worked on, for as long as it is.
pub(super) fn message(ui: &egui::Ui, desk: &mut Desk) {
    let message = desk.viewer.interface.message.as_ref();
    let of_shaders = desk.shaders.as_ref().and_then(|shaders| shaders.problem.as_ref());
    if message.or(of_shaders).is_none() {
        return;
    }
    let closed = float(ui, "message", Align2::CENTER_TOP, |ui| {
        ui.set_max_width(640.0);
        if let Some(problem) = of_shaders {
            let text = ui.colored_label(ui.visuals().error_fg_color, problem);
            name_place(&text, "message/shaders");
        }
        let row = message.map(|message| {
            ui.horizontal(|ui| {
                ui.label(message);
                let button = ui.small_button("close");
                name_place(&button, "message/close");
                button.clicked()
            })
        });
        row.is_some_and(|row| row.inner)
    });
    if closed {
        desk.viewer.interface.message = None;
    }
}

/// Keys and what they do.
pub(super) fn help(ui: &egui::Ui, desk: &Desk) {
    if !desk.viewer.interface.help {
        return;
    }
    float(ui, "help", Align2::CENTER_CENTER, |ui| {
        let height = ui.ctx().content_rect().height() - 60.0;
        let lines = keys::MOUSE.iter().map(|(what, text)| ((*what).to_owned(), *text)).chain(keys::help());
        ScrollArea::vertical().max_height(height).min_scrolled_height(height).show(ui, |ui| {
            Grid::new("help").num_columns(2).striped(true).show(ui, |ui| {
                for (what, text) in lines {
                    ui.label(RichText::new(what).strong());
                    ui.label(text);
                    ui.end_row();
                }
            });
        });
    });
}

/// Half the width of the axes, points.
const AXES: f32 = 36.0;

/// Where the axes of the world point, at the side that the panel leaves free.
pub(super) fn axes(ui: &egui::Ui, desk: &Desk) {
    let (true, Some(view)) = (desk.viewer.interface.axes, desk.view()) else { return };
    let from_world = view.camera.world_from_view.inverse();
    // The inspector has the corner.
    let at = if desk.viewer.interface.inspector { Align2::LEFT_CENTER } else { Align2::LEFT_TOP };
    float(ui, "axes", at, |ui| {
        let (area, _) = ui.allocate_exact_size(vec2(2.4 * AXES, 2.4 * AXES), egui::Sense::hover());
        let axis = |direction: DVec3, name, color| (from_world.transform_vector3(direction), name, color);
        let mut axes = [
            axis(DVec3::X, "X", Color32::from_rgb(230, 80, 80)),
            axis(DVec3::Y, "Y", Color32::from_rgb(90, 200, 90)),
            axis(DVec3::Z, "Z", Color32::from_rgb(90, 140, 250)),
        ];
        // The nearest last.
        axes.sort_by(|(a, ..), (b, ..)| a.z.total_cmp(&b.z));
        for (way, name, color) in axes {
            let tip = area.center() + AXES * vec2(way.x as f32, -way.y as f32);
            ui.painter().line_segment([area.center(), tip], Stroke::new(2.0, color));
            let beyond = area.center() + 1.15 * (tip - area.center());
            ui.painter().text(beyond, Align2::CENTER_CENTER, name, FontId::proportional(11.0), color);
        }
    });
}

/// How far the picture is from the truth beside it.
pub(super) fn truth(ui: &egui::Ui, desk: &mut Desk) {
    if !desk.viewer.interface.truth {
        return;
    }
    let figures = desk.truth.as_ref().and_then(Truth::figures);
    let errors = &mut desk.viewer.interface.errors;
    float(ui, "truth", Align2::CENTER_BOTTOM, |ui| {
        ui.set_width(290.0);
        let Some(Figures { samples, noise, error, is_bound }) = figures else {
            ui.label("the reference renderer takes its first samples");
            return;
        };
        let at_most = if is_bound { "at most " } else { "" };
        ui.label(format!("left: rasteriser, {at_most}{:.2} % off (RMS)", 100.0 * error));
        ui.label(format!("right: reference, {samples} samples, {:.2} % noise", 100.0 * noise));
        let switch = ui.checkbox(errors, "errors as colours, white from 10 %");
        name_place(&switch, "truth/errors");
    });
}
