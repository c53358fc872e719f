//! What the last frame took, and what the scene uses and so is paid for.

use super::{overlay, rows};
use crate::app::desk::Desk;
use crate::app::gui::name_place;
use crate::app::keys::Action;
use crate::app::stage::Stage;
use crate::app::timing::FrameTiming;
use crate::gpu_scene::GpuScene;
use crate::renderer::FrameStats;
use crate::scene::Scene;
use egui::{Align2, Grid};

/// What the last frame consisted of and took, over the picture.
pub(super) fn show(ui: &egui::Ui, desk: &Desk, stage: &Stage) {
    if !desk.viewer.interface.statistics {
        return;
    }
    let Some(stats) = &stage.stats else { return };
    let [width, height] = desk.viewer.state.size_px;
    overlay::float(ui, "statistics", Align2::LEFT_BOTTOM, |ui| {
        ui.label(stage.gpu.description());
        ui.label(format!("{width} x {height}, {} path, frame {}", stats.path.name(), stage.frames));
        ui.label(format!("{} draws, {} triangles, {} pipelines", stats.draws, stats.triangles, stats.pipelines.len()));
        stage.timing.iter().for_each(|timing| times(ui, timing, stage.is_software()));
    });
}

/// The part of the panel: the same times, and the certificate.
pub(super) fn part(ui: &mut egui::Ui, desk: &mut Desk, stage: &Stage) {
    let mut timed = desk.viewer.interface.statistics;
    if rows::switch(ui, ("time frames, and wait for each", "statistics/time"), &mut timed) {
        desk.viewer.act(Action::Statistics);
    }
    stage.timing.iter().for_each(|timing| times(ui, timing, stage.is_software()));
    let (Some(shown), Some(uploaded)) = (&desk.viewer.shown, &stage.uploaded) else { return };
    ui.label(stage.gpu.description());
    scene(ui, &shown.scene, uploaded);
    stage.stats.iter().for_each(|stats| frame(ui, stats));
    if !desk.about.extensions_used.is_empty() {
        ui.label(format!("extensions: {}", desk.about.extensions_used.join(", ")));
    }
    for warning in desk.about.warnings.iter().chain(&uploaded.warnings) {
        ui.colored_label(ui.visuals().warn_fg_color, warning);
    }
}

/// A table of times. They are of the last frame that was drawn: nothing is drawn to measure it, but once.
fn times(ui: &mut egui::Ui, timing: &FrameTiming, is_software: bool) {
    let FrameTiming { recording_ms, device_ms, processor_ms, passes } = timing;
    let table = Grid::new("times").num_columns(2).show(ui, |ui| {
        let mut row = |name: &str, ms: f64| {
            ui.label(name);
            ui.monospace(format!("{ms:8.2} ms"));
            ui.end_row();
        };
        row("recording commands", *recording_ms);
        row("until the device is done", *device_ms);
        processor_ms.iter().for_each(|ms| row("processor time, all threads", *ms));
        for pass in passes.iter().flatten() {
            row(&format!("pass {}", pass.name), pass.ms);
        }
    });
    name_place(&table.response, "statistics/times");
    ui.weak(match passes {
        Some(_) if is_software => "passes by the driver's clock, the one on the wall",
        Some(_) => "passes by the device's own clock",
        None => "this device has no clock that passes could be timed by",
    });
}

fn scene(ui: &mut egui::Ui, scene: &Scene, uploaded: &GpuScene) {
    let mebibytes = |bytes: u64| bytes as f64 / f64::from(1 << 20);
    let bytes = uploaded.bytes;
    ui.label(format!(
        "{} nodes, {} meshes, {} materials, {} images",
        scene.nodes.len(),
        scene.meshes.len(),
        scene.materials.len(),
        scene.images.len()
    ));
    ui.label(format!(
        "on the device: geometry {:.1} MiB, textures {:.1} MiB, environment {:.1} MiB",
        mebibytes(bytes.geometry),
        mebibytes(bytes.textures),
        mebibytes(bytes.environment)
    ));
}

fn frame(ui: &mut egui::Ui, stats: &FrameStats) {
    ui.label(format!("{} path, {} draws, {} triangles", stats.path.name(), stats.draws, stats.triangles));
    ui.label(format!(
        "left out of {} placements: {} beside the picture, {} between samples, {} behind others",
        stats.placements.all, stats.placements.outside, stats.placements.between_samples, stats.placements.hidden
    ));
    ui.label(format!("{} shaders, with no more than these features:", stats.pipelines.len()));
    for pipeline in stats.pipelines.iter() {
        ui.weak(pipeline);
    }
}
