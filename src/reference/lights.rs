//! What punctual lights do to a point, as docs/model.md has it.

use crate::scene::{LightInWorld, LightKind};
use glam::DVec3;

/// Nearer than this, in metres, a light counts as this far away: the inverse square law has no end.
const SHORTEST_DISTANCE_M: f64 = 1e-2;

/// The inverse square law, 1/m2; `distance_m` is 0 or above.
pub fn distance_falloff(distance_m: f64) -> f64 {
    distance_m.max(SHORTEST_DISTANCE_M).powi(-2)
}

/// The window that ends a light at its range, in [0, 1] (KHR_lights_punctual, "Range Property"). No range, no end.
pub fn range_window(range_m: Option<f64>, distance_m: f64) -> f64 {
    let Some(range_m) = range_m else { return 1.0 };
    (1.0 - (distance_m.max(SHORTEST_DISTANCE_M) / range_m).powi(4)).clamp(0.0, 1.0)
}

/// Fall-off from the inner to the outer cone of a spot light, in [0, 1] (KHR_lights_punctual, "Inner and Outer Cone
/// Angles"). `cos_angle` is between the light's direction and the way from the light to the point.
pub fn spot_cone(inner_cone_rad: f64, outer_cone_rad: f64, cos_angle: f64) -> f64 {
    let (cos_inner, cos_outer) = (inner_cone_rad.cos(), outer_cone_rad.cos());
    ((cos_angle - cos_outer) / (cos_inner - cos_outer).max(1e-3)).clamp(0.0, 1.0).powi(2)
}

/// Light that arrives at a point from one direction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Incidence {
    /// Unit vector toward the light.
    pub direction_in_world: DVec3,
    /// Illuminance of a surface that faces the light, lux per channel.
    pub illuminance_lux: DVec3,
}

/// What `light` sends to `point_in_world`; `None` when the point is the light itself.
pub fn incidence(light: &LightInWorld, point_in_world: DVec3) -> Option<Incidence> {
    let to_light = light.position_in_world - point_in_world;
    let distance_m = to_light.length();
    let local = || to_light.try_normalize();
    let (direction_in_world, attenuation) = match light.kind {
        LightKind::Directional => (-light.direction_in_world, 1.0),
        LightKind::Point { range_m } => (local()?, distance_falloff(distance_m) * range_window(range_m, distance_m)),
        LightKind::Spot { range_m, inner_cone_rad, outer_cone_rad } => {
            let direction = local()?;
            let cone = spot_cone(inner_cone_rad, outer_cone_rad, -direction.dot(light.direction_in_world));
            (direction, distance_falloff(distance_m) * range_window(range_m, distance_m) * cone)
        }
    };
    Some(Incidence { direction_in_world, illuminance_lux: light.intensity * attenuation })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn light_falls_with_the_square_of_the_distance_and_ends_at_its_range() {
        assert!((distance_falloff(2.0) / distance_falloff(6.0) - 9.0).abs() < 1e-12);
        assert_eq!(distance_falloff(0.0), distance_falloff(1e-2));
        assert_eq!(range_window(Some(5.0), 5.0), 0.0);
        assert_eq!(range_window(Some(5.0), 7.0), 0.0);
        assert_eq!(range_window(None, 1e9), 1.0);
        assert!((range_window(Some(2.0), 1.0) - 15.0 / 16.0).abs() < 1e-15);
    }

    #[test]
    fn a_spot_is_full_inside_its_inner_cone_and_dark_outside_its_outer_one() {
        let (inner, outer) = (0.3_f64, 0.6_f64);
        assert_eq!(spot_cone(inner, outer, 0.2_f64.cos()), 1.0);
        assert_eq!(spot_cone(inner, outer, 0.7_f64.cos()), 0.0);
        let halfway = 0.5 * (inner.cos() + outer.cos());
        assert!((spot_cone(inner, outer, halfway) - 0.25).abs() < 1e-12);
        // Equal cones are a step and not a division by zero.
        assert_eq!(spot_cone(outer, outer, 0.5_f64.cos()), 1.0);
    }

    #[test]
    fn spots_shine_along_their_direction() {
        let kind = LightKind::Spot { range_m: None, inner_cone_rad: 0.3, outer_cone_rad: 0.6 };
        let light = LightInWorld {
            kind,
            intensity: DVec3::splat(8.0),
            position_in_world: DVec3::new(0.0, 2.0, 0.0),
            direction_in_world: DVec3::NEG_Y,
        };
        let below = incidence(&light, DVec3::ZERO).unwrap();
        assert_eq!(below.direction_in_world, DVec3::Y);
        assert!((below.illuminance_lux - DVec3::splat(2.0)).length() < 1e-12);
        let above = incidence(&light, DVec3::new(0.0, 4.0, 0.0)).unwrap();
        assert_eq!(above.illuminance_lux, DVec3::ZERO);
        assert_eq!(incidence(&light, light.position_in_world), None);
    }
}
