//! Short texts over the picture.

use crate::app::desk::Desk;
use crate::app::gui::name_place;
use crate::app::keys;
use crate::app::stage::Stage;
use crate::app::truth::{Figures, Truth};
use egui::{Align2, Area, Frame, Grid, Id, ProgressBar, RichText, ScrollArea, vec2};

/// Something small that floats at a side of the window.
pub(super) fn float<R>(ui: &egui::Ui, name: &str, at: Align2, content: impl FnOnce(&mut egui::Ui) -> R) -> R {
    let inward = vec2(-12.0 * at.x().to_sign(), -12.0 * at.y().to_sign());
    let area = Area::new(Id::unique(name)).anchor(at, inward).order(egui::Order::Foreground);
    area.show(ui.ctx(), |ui| Frame::popup(ui.style()).show(ui, content).inner).inner
}

/// What is being read, and how far it is.
pub(super) fn progress(ui: &egui::Ui, desk: &Desk) {
    let Some(loading) = &desk.loading else { return };
    let stage = loading.stage();
    let name = loading.wanted.model.as_ref().and_then(|path| path.file_name());
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

/// What the viewer has to say.
pub(super) fn message(ui: &egui::Ui, desk: &mut Desk) {
    let Some(message) = desk.viewer.interface.message.clone() else { return };
    let closed = float(ui, "message", Align2::CENTER_TOP, |ui| {
        ui.horizontal(|ui| {
            ui.set_max_width(640.0);
            ui.label(message);
            let button = ui.small_button("close");
            name_place(&button, "message/close");
            button.clicked()
        })
        .inner
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

/// What the last frame consisted of.
pub(super) fn statistics(ui: &egui::Ui, desk: &Desk, stage: &Stage) {
    if !desk.viewer.interface.statistics {
        return;
    }
    let Some(stats) = &stage.stats else { return };
    let [width, height] = desk.viewer.state.size_px;
    float(ui, "statistics", Align2::LEFT_BOTTOM, |ui| {
        ui.label(stage.gpu.description());
        ui.label(format!("{width} x {height}, {} path, frame {}", stats.path.name(), stage.frames));
        if let Some(milliseconds) = stage.frame_ms {
            ui.label(format!("{milliseconds:.1} ms for the last frame that was timed"));
        }
        ui.label(format!("{} draws, {} triangles, {} pipelines", stats.draws, stats.triangles, stats.pipelines.len()));
    });
}
