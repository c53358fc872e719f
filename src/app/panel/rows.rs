//! Rows of the panel: a name, and something to change.

use crate::app::gui::name_place;
use crate::app::named::Named;
use egui::{CollapsingHeader, ComboBox, Slider, SliderClamping};
use std::ops::RangeInclusive;

/// A foldable part. Whether it is open.
pub(super) fn part(ui: &mut egui::Ui, title: &str, open: bool, content: impl FnOnce(&mut egui::Ui)) -> bool {
    let header = CollapsingHeader::new(title).default_open(open).show(ui, content);
    name_place(&header.header_response, format!("part/{title}"));
    header.body_returned.is_some()
}

/// A number. `name` is shown, and `place` finds it.
pub(super) fn number<N: egui::emath::Numeric>(
    ui: &mut egui::Ui,
    (name, place): (&str, &str),
    value: &mut N,
    range: RangeInclusive<N>,
) -> bool {
    slider(ui, (name, place), Slider::new(value, range))
}

/// A number above 0 that spans decades.
pub(super) fn factor<N: egui::emath::Numeric>(
    ui: &mut egui::Ui,
    (name, place): (&str, &str),
    value: &mut N,
    range: RangeInclusive<N>,
) -> bool {
    slider(ui, (name, place), Slider::new(value, range).logarithmic(true))
}

fn slider(ui: &mut egui::Ui, (name, place): (&str, &str), slider: Slider<'_>) -> bool {
    // What lies beyond the ends stays as it is until it is moved.
    let response = ui.add(slider.clamping(SliderClamping::Edits).text(name));
    name_place(&response, place);
    response.changed()
}

/// One of a number of choices that have names.
pub(super) fn choice<T: Named + PartialEq>(ui: &mut egui::Ui, (name, place): (&str, &str), value: &mut T) -> bool {
    let before = *value;
    let combo = ComboBox::from_label(name).selected_text(value.name_of()).show_ui(ui, |ui| {
        for (label, other) in T::choices() {
            let row = ui.selectable_value(value, other, label);
            name_place(&row, format!("{place}/{label}"));
        }
    });
    name_place(&combo.response, place);
    *value != before
}

/// A colour: linear Rec.709 in [0, 1].
pub(super) fn color(ui: &mut egui::Ui, (name, place): (&str, &str), value: &mut [f32; 3]) -> bool {
    ui.horizontal(|ui| {
        let response = ui.color_edit_button_rgb(value);
        name_place(&response, place);
        ui.label(name);
        response.changed()
    })
    .inner
}

/// Something that is on or off.
pub(super) fn switch(ui: &mut egui::Ui, (name, place): (&str, &str), value: &mut bool) -> bool {
    let response = ui.checkbox(value, name);
    name_place(&response, place);
    response.changed()
}
