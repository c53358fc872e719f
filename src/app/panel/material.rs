//! Materials, with everything about them that can be changed.

use super::rows;
use crate::app::desk::Desk;
use crate::app::edit::{AlphaEdit, MaterialEdit};
use crate::app::gui::name_place;
use crate::app::shown::Shown;
use crate::scene::{Disney, Material, TextureSlot};
use egui::ComboBox;
use std::collections::BTreeMap;
use std::f32::consts::PI;

pub(super) fn show(ui: &mut egui::Ui, desk: &mut Desk) {
    let Some(shown) = &desk.viewer.shown else { return };
    let count = shown.scene.materials.len();
    let name = |index: usize| {
        let name = shown.original(index).and_then(|material| material.name.clone());
        name.unwrap_or_else(|| format!("material {index}"))
    };
    let chosen = &mut desk.viewer.interface.material;
    *chosen = (*chosen).min(count.saturating_sub(1));
    let combo = ComboBox::from_id_salt("material").width(240.0).selected_text(name(*chosen)).show_ui(ui, |ui| {
        for index in 0..count {
            let row = ui.selectable_value(chosen, index, name(index));
            name_place(&row, format!("material/{index}"));
        }
    });
    name_place(&combo.response, "material");
    let (index, edits) = (*chosen, &mut desk.viewer.state.materials);
    let Some(original) = shown.original(index) else { return };
    let mut edit = edits.get(&index).cloned().unwrap_or_else(|| MaterialEdit::of(original));
    let mut changed = standard(ui, &mut edit, original, has_tangents(shown, index));
    changed |= alpha(ui, &mut edit);
    changed |= disney(ui, &mut edit);
    changed |= textures(ui, &mut edit, original);
    if changed {
        edits.insert(index, edit);
    }
    let reset = ui.add_enabled(edits.contains_key(&index), egui::Button::new("as in the file"));
    name_place(&reset, "material/reset");
    if reset.clicked() {
        edits.remove(&index);
    }
}

/// Whether some surface of the material knows a direction along itself.
fn has_tangents(shown: &Shown, material: usize) -> bool {
    let mut primitives = shown.scene.meshes.iter().flat_map(|mesh| &mesh.primitives);
    primitives.any(|primitive| primitive.material == material && primitive.tangents.is_some())
}

fn standard(ui: &mut egui::Ui, edit: &mut MaterialEdit, original: &Material, tangents: bool) -> bool {
    let [r, g, b, a] = edit.base_color;
    let (mut color, mut opacity) = ([r, g, b], a);
    let mut changed = rows::color(ui, ("base colour", "material/base-color"), &mut color);
    changed |= rows::number(ui, ("alpha", "material/alpha"), &mut opacity, 0.0..=1.0);
    edit.base_color = [color[0], color[1], color[2], opacity];
    changed |= rows::number(ui, ("metallic", "material/metallic"), &mut edit.metallic, 0.0..=1.0);
    let name = ("perceptual roughness", "material/perceptual-roughness");
    changed |= rows::number(ui, name, &mut edit.perceptual_roughness, 0.0..=1.0);
    if original.texture(TextureSlot::Normal).is_some() {
        changed |= rows::number(ui, ("normal scale", "material/normal-scale"), &mut edit.normal_scale, -2.0..=2.0);
    }
    if original.texture(TextureSlot::Occlusion).is_some() {
        let strength = &mut edit.occlusion_strength;
        changed |= rows::number(ui, ("occlusion strength", "material/occlusion"), strength, 0.0..=1.0);
    }
    changed |= emission(ui, edit);
    if edit.disney.is_none() {
        changed |= rows::number(ui, ("index of refraction", "material/ior"), &mut edit.ior, 1.0..=3.0);
        changed |= rows::number(ui, ("specular", "material/specular"), &mut edit.specular, 0.0..=1.0);
        changed |= rows::color(ui, ("specular colour", "material/specular-color"), &mut edit.specular_color);
        ui.add_enabled_ui(tangents, |ui| {
            let strength = &mut edit.anisotropy_strength;
            changed |= rows::number(ui, ("anisotropy", "material/anisotropy"), strength, 0.0..=1.0);
            let rotation = &mut edit.anisotropy_rotation_rad;
            changed |=
                rows::number(ui, ("anisotropy rotation, rad", "material/anisotropy-rotation"), rotation, -PI..=PI);
        });
    }
    changed |= rows::switch(ui, ("double sided", "material/double-sided"), &mut edit.double_sided);
    changed | rows::switch(ui, ("unlit", "material/unlit"), &mut edit.unlit)
}

/// A colour in [0, 1] and its strength.
fn emission(ui: &mut egui::Ui, edit: &mut MaterialEdit) -> bool {
    let strongest = edit.emissive_nits.into_iter().fold(0.0, f32::max);
    let mut strength = strongest;
    let mut color = if strongest > 0.0 { edit.emissive_nits.map(|channel| channel / strongest) } else { [1.0; 3] };
    let mut changed = rows::color(ui, ("emissive", "material/emissive"), &mut color);
    changed |= rows::number(ui, ("emission, cd/m2", "material/emission"), &mut strength, 0.0..=100.0);
    if changed {
        edit.emissive_nits = color.map(|channel| channel * strength);
    }
    changed
}

fn alpha(ui: &mut egui::Ui, edit: &mut MaterialEdit) -> bool {
    let before = edit.alpha;
    let name = |alpha: AlphaEdit| match alpha {
        AlphaEdit::Opaque => "opaque",
        AlphaEdit::Mask { .. } => "mask",
        AlphaEdit::Blend => "blend",
    };
    let combo = ComboBox::from_label("alpha mode").selected_text(name(edit.alpha)).show_ui(ui, |ui| {
        let cutoff = if let AlphaEdit::Mask { cutoff } = edit.alpha { cutoff } else { 0.5 };
        for choice in [AlphaEdit::Opaque, AlphaEdit::Mask { cutoff }, AlphaEdit::Blend] {
            let row = ui.selectable_value(&mut edit.alpha, choice, name(choice));
            name_place(&row, format!("material/alpha-mode/{}", name(choice)));
        }
    });
    name_place(&combo.response, "material/alpha-mode");
    if let AlphaEdit::Mask { cutoff } = &mut edit.alpha {
        rows::number(ui, ("cutoff", "material/cutoff"), cutoff, 0.0..=1.0);
    }
    edit.alpha != before
}

fn disney(ui: &mut egui::Ui, edit: &mut MaterialEdit) -> bool {
    let mut is_disney = edit.disney.is_some();
    let mut changed = rows::switch(ui, ("Disney BRDF", "material/disney"), &mut is_disney);
    if changed {
        let defaults = || crate::app::edit::named(&Disney::default());
        edit.disney = is_disney.then(defaults);
    }
    let parameters: &mut BTreeMap<String, f32> = match &mut edit.disney {
        Some(parameters) => parameters,
        None => return changed,
    };
    for name in Disney::NAMES {
        let value = parameters.entry(name.to_owned()).or_default();
        changed |= rows::number(ui, (&name.replace('_', " "), &format!("material/disney.{name}")), value, 0.0..=1.0);
    }
    changed
}

fn textures(ui: &mut egui::Ui, edit: &mut MaterialEdit, original: &Material) -> bool {
    let mut changed = false;
    for (slot, _) in original.textures() {
        let name = slot.name();
        let mut used = !edit.without_textures.contains(name);
        let label = format!("texture: {}", name.replace('_', " "));
        if rows::switch(ui, (&label, &format!("material/texture.{name}")), &mut used) {
            changed = true;
            if !edit.without_textures.remove(name) {
                edit.without_textures.insert(name.to_owned());
            }
        }
    }
    changed
}
