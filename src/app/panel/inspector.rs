//! What made the pixel under the cursor: by the reference renderer, and the sum by the shaders.

use super::overlay::float;
use crate::app::desk::Desk;
use crate::app::gui::name_place;
use crate::app::stage::Stage;
use crate::capture::CaptureError;
use crate::reference::inspect::Inspector;
use crate::scene::{Scene, View};
use egui::{Align2, Grid};
use glam::{DVec3, UVec2, Vec4};
use std::time::Duration;

/// The pointer has to rest for so long: scenes may be large.
const REST_S: f64 = 0.15;
/// Samples of each technique for light from the environment.
const SAMPLES: u32 = 512;

/// What is known of a pixel.
#[derive(Debug, Clone, Default)]
pub(in crate::app) struct Inspected {
    pixel: UVec2,
    since_s: f64,
    /// The view and the version of the scene that the lines are of.
    of: Option<(View, u64)>,
    lines: Vec<(String, String)>,
    /// What the shaders make of it, once they were asked.
    by_shaders: Option<Vec4>,
}

impl Inspected {
    /// Asks the shaders about the pixel, where that has not been done. Whether there is something new to show.
    pub(in crate::app) fn ask(&mut self, stage: &mut Stage) -> Result<bool, CaptureError> {
        let (Some((view, _)), None) = (&self.of, self.by_shaders) else { return Ok(false) };
        self.by_shaders = stage.pixel(view, self.pixel)?;
        Ok(self.by_shaders.is_some())
    }
}

pub(super) fn show(ui: &egui::Ui, desk: &mut Desk, stage: &Stage) {
    let (true, Some(pixel), Some(view)) = (desk.viewer.interface.inspector, desk.viewer.pixel(), desk.view()) else {
        return;
    };
    let Some(shown) = &desk.viewer.shown else { return };
    let (now_s, inspected) = (ui.input(|input| input.time), &mut desk.inspected);
    if inspected.pixel != pixel {
        *inspected = Inspected { pixel, since_s: now_s, of: None, by_shaders: None, ..inspected.clone() };
    }
    let is_new = inspected.of.as_ref().is_none_or(|(of, version)| (of, *version) != (&view, stage.version));
    let rested_s = now_s - inspected.since_s;
    if is_new && rested_s < REST_S {
        ui.ctx().request_repaint_after(Duration::from_secs_f64((REST_S - rested_s).max(0.01)));
    } else if is_new {
        inspected.lines = lines(&shown.scene, &view, pixel);
        (inspected.of, inspected.by_shaders) = (Some((view, stage.version)), None);
    }
    float(ui, "inspector", Align2::LEFT_TOP, |ui| {
        Grid::new("inspector").num_columns(2).show(ui, |ui| {
            for (name, value) in &inspected.lines {
                ui.weak(name);
                ui.monospace(value);
                ui.end_row();
            }
            if let Some(radiance) = inspected.by_shaders.filter(|radiance| radiance.w > 0.0) {
                name_place(&ui.weak("by the shaders"), "inspector/by-shaders");
                ui.monospace(vector((radiance.truncate() / radiance.w).as_dvec3()));
                ui.end_row();
            }
        });
    });
}

fn vector(value: DVec3) -> String {
    format!("{:.4} {:.4} {:.4}", value.x, value.y, value.z)
}

/// Names and values.
fn lines(scene: &Scene, view: &View, pixel: UVec2) -> Vec<(String, String)> {
    let inspector = Inspector::new(scene, view);
    let (ray, layers) = inspector.layers(pixel);
    let mut lines = vec![("pixel".to_owned(), format!("{}, {}", pixel.x, pixel.y))];
    let mut add = |name: &str, value: String| lines.push((name.to_owned(), value));
    let Some(layer) = layers.first() else {
        add("environment, cd/m2", vector(inspector.background(&ray)));
        return lines;
    };
    let details = inspector.details(&layer.hit, &ray);
    let (surface, material) = (&details.surface, &details.surface.material);
    let (inputs, leaving) = (inspector.inputs(surface, &ray), inspector.leaving(surface, &ray, SAMPLES));
    let name = |name: &Option<String>| name.clone().unwrap_or_else(|| "unnamed".into());
    add("node", name(&scene.nodes[details.node].name));
    add("material", name(&scene.materials[details.material].name));
    add("position, m", vector(surface.position_in_world));
    add("normal", vector(surface.normal_in_world));
    add("base colour", vector(material.base_color));
    if !surface.unlit {
        add("metallic", format!("{:.4}", material.metallic));
        add("perceptual roughness", format!("{:.4}", material.perceptual_roughness));
        add("alphas", format!("{:.5} {:.5}", inputs.alphas.x, inputs.alphas.y));
        add("F0", vector(inputs.f0));
        add("occlusion", format!("{:.4}", surface.occlusion));
        add("N.V", format!("{:.4}", inputs.n_dot_v));
        let lights: DVec3 = leaving.lights.iter().flatten().sum();
        add("from lights, cd/m2", vector(lights));
        add("from the environment", vector(leaving.environment.mean.iter().sum()));
    }
    add("emitted", vector(leaving.emitted));
    add("all of it, cd/m2", vector(leaving.sum()));
    if layers.len() > 1 {
        add("surfaces behind", (layers.len() - 1).to_string());
    }
    lines
}
