//! Cameras of the document. What no picture can be taken with is replaced, with a warning.

use super::error::{Fault, Notes};
use crate::scene::{Camera, Projection};
use glam::DMat4;
use gltf::json::camera::{Orthographic, Perspective, Type};
use gltf::json::validation::Checked;
use gltf::json::{self, Root};

const FALLBACK_FOV_Y_RAD: f64 = std::f64::consts::FRAC_PI_4;
const FALLBACK_HEIGHT_M: f64 = 2.0;
const FALLBACK_NEAR_M: f64 = 0.01;
const FALLBACK_DEPTH_M: f64 = 1000.0;

/// All cameras of the document, without a place.
pub(super) fn import(root: &Root, notes: &mut Notes) -> Result<Vec<Camera>, Fault> {
    root.cameras
        .iter()
        .enumerate()
        .map(|(index, camera)| convert(camera, &format!("/cameras/{index}"), notes))
        .collect()
}

fn convert(json: &json::Camera, here: &str, notes: &mut Notes) -> Result<Camera, Fault> {
    let (projection, near_m, far_m) = match (&json.type_, &json.perspective, &json.orthographic) {
        (Checked::Valid(Type::Perspective), Some(lens), _) => perspective(lens, &format!("{here}/perspective"), notes),
        (Checked::Valid(Type::Orthographic), _, Some(lens)) => {
            orthographic(lens, &format!("{here}/orthographic"), notes)
        }
        (Checked::Invalid, ..) => return Err(Fault::at(format_args!("{here}/type"), "is not a type of camera")),
        _ => return Err(Fault::at(here, "lacks the object that its type names")),
    };
    Ok(Camera { name: json.name.clone(), projection, near_m, far_m, world_from_view: DMat4::IDENTITY })
}

fn perspective(json: &Perspective, here: &str, notes: &mut Notes) -> (Projection, f64, f64) {
    let mut pick = |value: f32, good: bool, otherwise: f64, name: &str| pick(value, good, otherwise, here, name, notes);
    let fov_y_rad = pick(json.yfov, json.yfov > 0.0 && json.yfov < std::f32::consts::PI, FALLBACK_FOV_Y_RAD, "yfov");
    let near_m = pick(json.znear, json.znear > 0.0 && json.znear.is_finite(), FALLBACK_NEAR_M, "znear");
    let far_m = match json.zfar {
        Some(far) => pick(far, f64::from(far) > near_m, f64::INFINITY, "zfar"),
        None => f64::INFINITY,
    };
    (Projection::Perspective { fov_y_rad }, near_m, far_m)
}

fn orthographic(json: &Orthographic, here: &str, notes: &mut Notes) -> (Projection, f64, f64) {
    let mut pick = |value: f32, good: bool, otherwise: f64, name: &str| pick(value, good, otherwise, here, name, notes);
    // Negative magnification is not forbidden; it would mirror the picture.
    let height = 2.0 * json.ymag.abs();
    let height_m = pick(height, height > 0.0 && height.is_finite(), FALLBACK_HEIGHT_M, "ymag");
    let near_m = pick(json.znear, json.znear >= 0.0 && json.znear.is_finite(), 0.0, "znear");
    let far_good = f64::from(json.zfar) > near_m && json.zfar.is_finite();
    let far_m = pick(json.zfar, far_good, near_m + FALLBACK_DEPTH_M, "zfar");
    (Projection::Orthographic { height_m }, near_m, far_m)
}

fn pick(value: f32, good: bool, otherwise: f64, here: &str, name: &str, notes: &mut Notes) -> f64 {
    if good {
        return f64::from(value);
    }
    notes.add(format_args!("{here}/{name}"), format!("{value} is out of range and counts as {otherwise}"));
    otherwise
}
