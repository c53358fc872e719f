//! The nodes of the scene, and which of them are seen.

use crate::app::desk::Desk;
use crate::app::gui::name_place;
use crate::scene::Scene;
use egui::ScrollArea;

/// Indentation a level, points.
const INDENT: f32 = 12.0;
/// Deeper nodes are not moved further in: they would leave the panel.
const DEEPEST: usize = 12;

pub(super) fn show(ui: &mut egui::Ui, desk: &mut Desk) {
    let Some(shown) = &desk.viewer.shown else { return };
    let nodes = flat(&shown.scene);
    let hidden = &mut desk.viewer.state.hidden_nodes;
    let height = ui.spacing().interact_size.y;
    ui.horizontal(|ui| {
        ui.label(format!("{} nodes", nodes.len()));
        if !hidden.is_empty() && ui.button("show all").clicked() {
            hidden.clear();
        }
    });
    // Only the rows that are seen are laid out: scenes may have a hundred thousand.
    ScrollArea::vertical().id_salt("tree").max_height(260.0).show_rows(ui, height, nodes.len(), |ui, rows| {
        for &(index, depth) in &nodes[rows] {
            let node = &shown.scene.nodes[index];
            ui.horizontal(|ui| {
                ui.add_space(INDENT * depth.min(DEEPEST) as f32);
                let mut seen = !hidden.contains(&index);
                let name = node.name.clone().unwrap_or_else(|| format!("node {index}"));
                let text = egui::RichText::new(name);
                let text = if shown.has_content(index) { text } else { text.weak() };
                let switch = ui.checkbox(&mut seen, text);
                name_place(&switch, format!("scene/{index}"));
                if switch.changed() && !hidden.remove(&index) {
                    hidden.insert(index);
                }
            });
        }
    });
}

/// Every node and how deep it is, parents before children.
fn flat(scene: &Scene) -> Vec<(usize, usize)> {
    let mut pending: Vec<(usize, usize)> = scene.roots.iter().rev().map(|&root| (root, 0)).collect();
    let mut nodes = Vec::with_capacity(scene.nodes.len());
    while let Some((index, depth)) = pending.pop() {
        nodes.push((index, depth));
        pending.extend(scene.nodes[index].children.iter().rev().map(|&child| (child, depth + 1)));
    }
    nodes
}
