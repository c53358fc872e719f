//! Lights of KHR_lights_punctual.

use super::error::{Fault, Notes};
use super::extensions::{self, Lights, PunctualKind, PunctualLight};
use crate::scene::{Light, LightKind};
use glam::DVec3;
use gltf::json::Root;
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

/// All lights of the document.
pub(super) fn import(root: &Root, notes: &mut Notes) -> Result<Vec<Light>, Fault> {
    let raw = root.extensions.as_ref().map(|raw| &raw.others);
    let Lights { lights } = extensions::find(raw, "KHR_lights_punctual", "")?.unwrap_or_default();
    let convert = |(index, light)| convert(light, &format!("/extensions/KHR_lights_punctual/lights/{index}"), notes);
    Ok(lights.into_iter().enumerate().map(convert).collect())
}

fn convert(json: PunctualLight, here: &str, notes: &mut Notes) -> Light {
    let mut not_negative = |value: f32, name: &str| {
        let clamped = value.clamp(0.0, f32::MAX);
        if clamped != value {
            notes.add(format_args!("{here}/{name}"), format!("{value} is out of range and counts as {clamped}"));
        }
        f64::from(clamped)
    };
    let color = DVec3::from_array(json.color.map(|x| not_negative(x, "color")));
    let intensity = not_negative(json.intensity, "intensity");
    let range_m = match json.range.map(f64::from) {
        Some(range) if !(range > 0.0 && range.is_finite()) => {
            notes.add(format_args!("{here}/range"), format!("{range} is no distance; the light has no range"));
            None
        }
        range => range,
    };
    let kind = match json.kind {
        PunctualKind::Directional => LightKind::Directional,
        PunctualKind::Point => LightKind::Point { range_m },
        PunctualKind::Spot => {
            let (inner, outer) = (f64::from(json.spot.inner_cone_angle), f64::from(json.spot.outer_cone_angle));
            let (inner_cone_rad, outer_cone_rad) = cone(inner, outer, here, notes);
            LightKind::Spot { range_m, inner_cone_rad, outer_cone_rad }
        }
    };
    Light { name: json.name, kind, color, intensity }
}

/// 0 <= inner < outer <= pi/2, as the extension demands.
fn cone(inner: f64, outer: f64, here: &str, notes: &mut Notes) -> (f64, f64) {
    // Half a turn as f32 is a little more than pi/2 as f64.
    let outer_in_range = if outer > 0.0 && outer.is_finite() { outer.min(FRAC_PI_2) } else { FRAC_PI_4 };
    let inner_in_range = inner.clamp(0.0, outer_in_range);
    let moved = (outer_in_range - outer).abs() > 1e-6 || (inner_in_range - inner).abs() > 1e-6;
    if moved || !outer.is_finite() {
        let problem =
            format!("cone {inner} to {outer} is out of range and counts as {inner_in_range} to {outer_in_range}");
        notes.add(format_args!("{here}/spot"), problem);
    }
    (inner_in_range, outer_in_range)
}
