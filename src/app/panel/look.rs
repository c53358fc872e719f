//! How the picture is made of light, and from where.

use super::rows;
use crate::app::camera::{Pose, Side};
use crate::app::desk::Desk;
use crate::app::gui::name_place;
use crate::app::keys::Action;
use crate::app::shown::GREY;
use crate::app::state::BackgroundState;
use crate::scene::{Channel, Input, Scene};

pub(super) fn picture(ui: &mut egui::Ui, desk: &mut Desk) {
    let look = &mut desk.viewer.state.look;
    rows::number(ui, ("exposure, EV", "look/exposure"), &mut look.exposure_ev, -8.0..=8.0);
    rows::choice(ui, ("tone map", "look/tone-map"), &mut look.tone_map);
    rows::choice(ui, ("quality", "look/quality"), &mut look.quality);
    rows::choice(ui, ("debug view", "look/debug-view"), &mut look.debug_view);
    if let (Some(Channel::UvChecker | Channel::Input(Input::Uv)), Some(shown)) = (look.debug_view, &desk.viewer.shown) {
        without_coordinates(ui, &shown.scene);
    }
    rows::choice(ui, ("geometry factor", "look/geometry"), &mut look.geometry);
    rows::switch(ui, ("energy compensation", "look/energy"), &mut look.energy_compensation);
    background(ui, &mut look.background);
    rows::number(ui, ("background blur", "look/background-blur"), &mut look.background_blur, 0.0..=1.0);
}

/// What a chart of texture coordinates does not show.
fn without_coordinates(ui: &mut egui::Ui, scene: &Scene) {
    let reads =
        |material: usize| scene.materials.get(material).is_some_and(|material| material.textures().next().is_some());
    let primitives = || scene.meshes.iter().flat_map(|mesh| &mesh.primitives);
    let without = primitives().filter(|primitive| primitive.uvs.is_empty() || !reads(primitive.material)).count();
    if without > 0 {
        let text = ui.weak(format!(
            "{without} of {} primitives have no texture coordinates, or no texture that reads them",
            primitives().count()
        ));
        name_place(&text, "look/without-coordinates");
    }
}

fn background(ui: &mut egui::Ui, background: &mut BackgroundState) {
    let name = |background: &BackgroundState| match background {
        BackgroundState::Auto => "automatic",
        BackgroundState::Transparent => "transparent",
        BackgroundState::Environment => "environment",
        BackgroundState::Color(_) => "colour",
    };
    let color = if let BackgroundState::Color(color) = background { *color } else { [GREY; 3] };
    egui::ComboBox::from_label("background").selected_text(name(background)).show_ui(ui, |ui| {
        let choices = [
            BackgroundState::Auto,
            BackgroundState::Transparent,
            BackgroundState::Environment,
            BackgroundState::Color(color),
        ];
        for choice in choices {
            ui.selectable_value(background, choice, name(&choice));
        }
    });
    if let BackgroundState::Color(color) = background {
        let mut codes = color.map(|value| (value * 255.0).round() as u8);
        if ui.color_edit_button_srgb(&mut codes).changed() {
            *color = codes.map(|code| f32::from(code) / 255.0);
        }
    }
}

pub(super) fn camera(ui: &mut egui::Ui, desk: &mut Desk) {
    let camera = &mut desk.viewer.state.camera;
    rows::number(ui, ("field of view, degrees", "camera/fov"), &mut camera.fov_deg, 5.0..=120.0);
    let (mut orthographic, mut fly) = (camera.orthographic, desk.viewer.interface.fly);
    if rows::switch(ui, ("orthographic", "camera/orthographic"), &mut orthographic) {
        desk.viewer.act(Action::Orthographic);
    }
    if rows::switch(ui, ("fly", "camera/fly"), &mut fly) {
        desk.viewer.act(Action::Fly);
    }
    ui.horizontal_wrapped(|ui| {
        let sides = [
            ("all", Side::Default),
            ("front", Side::Front),
            ("right", Side::Right),
            ("top", Side::Top),
            ("isometric", Side::Isometric),
        ];
        for (label, side) in sides {
            let button = ui.button(label);
            name_place(&button, format!("camera/{label}"));
            if button.clicked() {
                desk.viewer.act(Action::Side(side));
            }
        }
    });
    let Some(shown) = &desk.viewer.shown else { return };
    let pose = &mut desk.viewer.state.camera.pose;
    for (index, camera) in shown.around.cameras.iter().enumerate() {
        let name = camera.name.clone().unwrap_or_else(|| format!("camera {index}"));
        if ui.selectable_label(*pose == Some(Pose::File(index)), name).clicked() {
            *pose = Some(Pose::File(index));
        }
    }
}
