//! What the scene uses, and so what is paid for.

use crate::app::desk::Desk;
use crate::app::stage::Stage;

pub(super) fn show(ui: &mut egui::Ui, desk: &Desk, stage: &Stage) {
    let (Some(shown), Some(uploaded)) = (&desk.viewer.shown, &stage.uploaded) else { return };
    let scene = &shown.scene;
    ui.label(stage.gpu.description());
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
    if let Some(stats) = &stage.stats {
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
    if !desk.about.extensions_used.is_empty() {
        ui.label(format!("extensions: {}", desk.about.extensions_used.join(", ")));
    }
    for warning in desk.about.warnings.iter().chain(&uploaded.warnings) {
        ui.colored_label(ui.visuals().warn_fg_color, warning);
    }
}
