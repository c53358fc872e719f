//! Punctual lights in photometric units (KHR_lights_punctual).

use super::{Node, Scene, SpotCone};
use crate::math::color::luminance;
use crate::radiometry::{Illuminance, Luminance, LuminousFlux, LuminousIntensity, RadiometryError, solid_angle};
use glam::{DMat4, DQuat, DVec3};
use std::f64::consts::PI;

/// The shape of a punctual light's emission. All emit toward the node's local -Z where they have a direction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum LightKind {
    /// Intensity in cd, the same in all directions.
    Point { range_m: Option<f64> },
    /// Intensity in cd inside the inner cone, falling to zero at the outer cone; half angles.
    Spot { range_m: Option<f64>, inner_cone_rad: f64, outer_cone_rad: f64 },
    /// Illuminance in lux on a surface that faces the light.
    Directional,
}

/// A light without a place.
#[derive(Debug, Clone, PartialEq)]
pub struct Light {
    pub name: Option<String>,
    pub kind: LightKind,
    /// Linear Rec.709, multiplied with `intensity`.
    pub color: DVec3,
    /// Candela for point and spot lights, lux for directional ones.
    pub intensity: f64,
}

/// A light with its place and direction in the world. Directions point from the light into the scene.
#[derive(Debug, Clone, PartialEq)]
pub struct LightInWorld {
    pub kind: LightKind,
    /// `color * intensity`: cd or lux per channel.
    pub intensity: DVec3,
    pub position_in_world: DVec3,
    pub direction_in_world: DVec3,
}

impl LightInWorld {
    /// Where the light ends, metres; `None` where it does not, or so far out that 32-bit floats have no number for it.
    pub fn finite_range_m(&self) -> Option<f64> {
        let range_m = match self.kind {
            LightKind::Point { range_m } | LightKind::Spot { range_m, .. } => range_m?,
            LightKind::Directional => return None,
        };
        (inverse_square(range_m) > 0.0).then_some(range_m)
    }

    /// Whether a point in the world is within the light's range and, of a spot light, inside of its outer cone. A
    /// directional light reaches everything.
    pub fn reaches(&self, point_in_world: DVec3) -> bool {
        let from_light = point_in_world - self.position_in_world;
        let is_in_cone = match self.kind {
            LightKind::Spot { outer_cone_rad, .. } => {
                from_light.normalize().dot(self.direction_in_world) > outer_cone_rad.cos()
            }
            LightKind::Point { .. } | LightKind::Directional => true,
        };
        is_in_cone && self.finite_range_m().is_none_or(|range_m| from_light.length() < range_m)
    }

    /// One over the square of [`Self::finite_range_m`], 1/m^2; 0 without.
    pub fn inverse_range_squared(&self) -> f32 {
        self.finite_range_m().map_or(0.0, inverse_square)
    }
}

fn inverse_square(range_m: f64) -> f32 {
    (1.0 / (range_m * range_m)) as f32
}

/// White lights of known strength. All of these fail only where the light is too strong for 32-bit floats.
impl Light {
    /// A point light that emits `flux` in all: I = Phi / 4 pi.
    pub fn point_from_flux(flux: LuminousFlux) -> Result<Self, RadiometryError> {
        Self::point_from_intensity(flux.isotropic_intensity())
    }

    /// A point light of the same intensity in all directions.
    pub fn point_from_intensity(intensity: LuminousIntensity) -> Result<Self, RadiometryError> {
        Self::white(LightKind::Point { range_m: None }, intensity.as_candelas())
    }

    /// A spot light that emits `flux` in all, smooth edge included: I = Phi over [`SpotCone::effective_solid_angle`].
    ///
    /// Not Phi / pi, which keeps the brightness when the cone changes, and not Phi over the solid angle of the outer
    /// cone, which loses what the edge absorbs.
    pub fn spot_from_flux(flux: LuminousFlux, cone: SpotCone) -> Result<Self, RadiometryError> {
        Self::spot_from_intensity(flux / cone.effective_solid_angle(), cone)
    }

    /// A spot light of this intensity inside its inner cone.
    pub fn spot_from_intensity(intensity: LuminousIntensity, cone: SpotCone) -> Result<Self, RadiometryError> {
        let (inner_cone_rad, outer_cone_rad) = (cone.inner_rad(), cone.outer_rad());
        Self::white(LightKind::Spot { range_m: None, inner_cone_rad, outer_cone_rad }, intensity.as_candelas())
    }

    /// A directional light by what arrives at a surface that faces it.
    pub fn directional_from_illuminance(illuminance: Illuminance) -> Result<Self, RadiometryError> {
        Self::white(LightKind::Directional, illuminance.as_lux())
    }

    /// A round source at infinity, such as the sun, by its luminance and its angular diameter, above 0 and up to pi:
    /// E = L pi sin^2(diameter / 2). The light itself is then a direction without extent.
    pub fn directional_from_luminance(
        luminance: Luminance,
        angular_diameter_rad: f64,
    ) -> Result<Self, RadiometryError> {
        let in_domain = angular_diameter_rad > 0.0 && angular_diameter_rad <= PI;
        let expected = "an angle above 0 and up to pi, in rad";
        RadiometryError::check(in_domain, "angular diameter", angular_diameter_rad, expected)?;
        Self::directional_from_illuminance(luminance * solid_angle::cone_projected(0.5 * angular_diameter_rad)?)
    }

    /// The same light in another colour, linear Rec.709, each channel 0 or above and not all of them 0.
    ///
    /// The colour is scaled to a luminance of 1: it tints, and the lumens stay what they were. (A glTF file's colour is
    /// taken as it is and dims.)
    pub fn with_color(self, color: DVec3) -> Result<Self, RadiometryError> {
        let expected = "finite channels from 0 up, not all 0";
        let least = color.min_element();
        RadiometryError::check(color.is_finite() && least >= 0.0, "color", least, expected)?;
        let luminance = luminance(color);
        RadiometryError::check(luminance.is_normal(), "color", luminance, expected)?;
        let tinted = Self { color: color / luminance, ..self };
        check_strength((tinted.color * tinted.intensity).max_element())?;
        Ok(tinted)
    }

    /// The same light, ending at `range_m` metres by the window of KHR_lights_punctual, which costs flux further out.
    /// A directional light takes none.
    pub fn with_range(mut self, range_m: f64) -> Result<Self, RadiometryError> {
        let in_domain = range_m > 0.0 && range_m.is_finite();
        RadiometryError::check(in_domain, "range", range_m, "a finite number above 0, in m")?;
        match &mut self.kind {
            LightKind::Point { range_m: range } | LightKind::Spot { range_m: range, .. } => *range = Some(range_m),
            LightKind::Directional => {
                let expected = "no range for a directional light";
                return Err(RadiometryError { parameter: "range", value: range_m, expected });
            }
        }
        Ok(self)
    }

    fn white(kind: LightKind, intensity: f64) -> Result<Self, RadiometryError> {
        check_strength(intensity)?;
        Ok(Self { name: None, kind, color: DVec3::ONE, intensity })
    }

    /// Places the light; scale in the matrix has no effect on its range or strength.
    pub fn in_world(&self, world_from_node: &DMat4) -> LightInWorld {
        let direction = world_from_node.transform_vector3(DVec3::NEG_Z);
        LightInWorld {
            kind: self.kind,
            intensity: self.color * self.intensity,
            position_in_world: world_from_node.transform_point3(DVec3::ZERO),
            direction_in_world: direction.normalize_or(DVec3::NEG_Z),
        }
    }
}

impl Scene {
    /// Adds a light at a place in the world that shines along the unit vector `direction_in_world`. Point lights ignore
    /// the direction, directional ones the place.
    pub fn add_light(&mut self, light: Light, position_in_world: DVec3, direction_in_world: DVec3) {
        let rotation = DQuat::from_rotation_arc(DVec3::NEG_Z, direction_in_world);
        self.roots.push(self.nodes.len());
        self.nodes.push(Node {
            name: light.name.clone(),
            parent_from_node: DMat4::from_rotation_translation(rotation, position_in_world),
            light: Some(self.lights.len()),
            ..Default::default()
        });
        self.lights.push(light);
    }
}

/// Strengths that the GPU's floats hold.
fn check_strength(intensity: f64) -> Result<f64, RadiometryError> {
    let expected = "at most 3.4e38 cd or lux a channel, the largest 32-bit float";
    RadiometryError::check(intensity <= f64::from(f32::MAX), "strength of the light", intensity, expected)
}
