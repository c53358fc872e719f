//! Which quantities of a material are not what they were.

use super::gather::{COVERAGE, FAULTS};
use super::sketch::distance;
use super::{MaterialIngredients, Quantity};
use crate::scene::Input;

/// Less than this of a quantity is not told: two steps of a texel, and what drivers round otherwise.
const SAME: f64 = 2e-3;

/// The same where other pixels show the material, whose means are then of other points.
const SAME_IN_MOTION: f64 = 0.03;

/// Where a quantity belongs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Class {
    Fault,
    Geometry,
    Input,
    Light,
}

/// The class of a quantity by its name.
pub(super) fn class(name: &str) -> Class {
    let input = Input::ALL.into_iter().find(|input| input.name() == name);
    match input {
        None if name == FAULTS => Class::Fault,
        None if name == COVERAGE => Class::Geometry,
        None => Class::Light,
        Some(
            Input::VertexNormal
            | Input::GeometricNormal
            | Input::Tangent
            | Input::Uv
            | Input::Position
            | Input::Depth
            | Input::NoV,
        ) => Class::Geometry,
        Some(_) => Class::Input,
    }
}

/// What a quantity is computed from: where that has moved, the quantity follows.
fn causes(name: &str) -> &'static [&'static str] {
    match name {
        "alphas" => &["perceptual-roughness"],
        "f0" => &["base-color", "metallic"],
        "normal" => &["vertex-normal", "position"],
        "vertex-normal" => &["position"],
        "nov" => &["normal", "vertex-normal", "position"],
        "geometric-normal" | "depth" | "uv" | "tangent" => &["position", COVERAGE],
        "position" => &[COVERAGE],
        _ => &[],
    }
}

/// A quantity that is not what it was.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Move {
    pub(super) name: String,
    pub(super) was: [f64; 3],
    pub(super) is: [f64; 3],
    /// Root mean square of the difference, pixel by pixel; `None` where other pixels show the material.
    pub(super) rms: Option<f64>,
    /// Root mean square of the quantity itself, before or now.
    pub(super) scale: f64,
}

impl Move {
    /// Whether the means tell it.
    pub(super) fn is_in_mean(&self) -> bool {
        let moved = self.was.iter().zip(self.is).any(|(was, is)| (was - is).abs() > SAME_IN_MOTION * self.scale);
        moved || self.rms.is_none()
    }
}

/// Whether other pixels show the material than before.
pub(super) fn is_in_motion(then: &MaterialIngredients, now: &MaterialIngredients) -> bool {
    let same_middle = then.center_px.iter().zip(now.center_px).all(|(then, now)| (then - now).abs() < 1e-6);
    then.pixels != now.pixels || !same_middle
}

/// All quantities of a material that have moved, but those that follow from others. `in_dark` says that one of the pictures has no light, for which nothing of a material is read.
pub(super) fn moves(then: &MaterialIngredients, now: &MaterialIngredients, in_dark: bool) -> Vec<Move> {
    let in_motion = is_in_motion(then, now);
    let nothing = |name: &str| Quantity { name: name.into(), mean: [0.0; 3], spread: [0.0; 3], sketch: None };
    let gone = then.quantities.iter().filter(|quantity| now.quantity(&quantity.name).is_none());
    let names = now.quantities.iter().chain(gone).map(|quantity| quantity.name.as_str());
    let brightest = [then, now].into_iter().flat_map(|of| &of.quantities).filter(|q| class(&q.name) == Class::Light);
    let brightest = brightest.map(magnitude).fold(0.0, f64::max);
    let mut found: Vec<Move> = Vec::new();
    for name in names {
        let of = |of: &MaterialIngredients| of.quantity(name).cloned().unwrap_or_else(|| nothing(name));
        let (was, is) = (of(then), of(now));
        let own = magnitude(&was).max(magnitude(&is));
        let far = distance(&was, &is, now.measured);
        let rms = (!in_motion).then_some(far);
        // A lobe that is a thousandth of the light is no news.
        let against = if class(name) == Class::Light { brightest } else { own };
        let moments = |of: fn(&Quantity) -> [f64; 3]| {
            of(&was).iter().zip(of(&is)).any(|(was, is)| (was - is).abs() > SAME_IN_MOTION * against)
        };
        let has_moved = match (class(name), rms) {
            _ if in_dark && !is_read_in_dark(name) => false,
            (Class::Fault, _) => was.mean.iter().zip(is.mean).any(|(was, is)| is > *was),
            // What is not read of a surface is not there.
            (Class::Geometry, _) if is_of_textures(name) && (was.is_nothing() || is.is_nothing()) => false,
            // Where a surface is elsewhere in the picture, all of this is elsewhere.
            (Class::Geometry, None) => false,
            (_, None) => name != Input::Normal.name() && (moments(|of| of.mean) || moments(|of| of.spread)),
            (_, Some(rms)) => rms > SAME * against,
        };
        if has_moved {
            found.push(Move { name: name.into(), was: was.mean, is: is.mean, rms, scale: own });
        }
    }
    let moved: Vec<String> = found.iter().map(|found| found.name.clone()).collect();
    let follows = |found: &Move| causes(&found.name).iter().any(|cause| moved.iter().any(|name| name == cause));
    found.retain(|found| !follows(found));
    found
}

fn is_read_in_dark(name: &str) -> bool {
    [COVERAGE, FAULTS, "position", "depth", "geometric-normal", "emissive"].contains(&name)
        || class(name) == Class::Light
}

/// Read only where a texture is.
fn is_of_textures(name: &str) -> bool {
    name == Input::Uv.name() || name == Input::Tangent.name()
}

/// Root mean square of a quantity.
fn magnitude(quantity: &Quantity) -> f64 {
    quantity.mean.iter().chain(&quantity.spread).map(|number| number * number).sum::<f64>().sqrt()
}
