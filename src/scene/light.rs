//! Punctual lights in photometric units (KHR_lights_punctual).

use glam::{DMat4, DVec3};

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

impl Light {
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
