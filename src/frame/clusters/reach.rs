//! Where a light sends anything at all.

use crate::scene::{LightInWorld, LightKind};
use glam::{DMat4, DVec3, Vec3};

/// What f32 makes of the end of a range or of a cone is farther out than this share of it by no means.
const MARGIN: f64 = 1e-5;

/// The part of space outside of which a light with a range sends exactly nothing (KHR_lights_punctual, "Range Property"
/// and "Inner and Outer Cone Angles").
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reach {
    position: DVec3,
    range_m: f64,
    /// Of a spot light: unit axis and half angle, which is pi/2 at most.
    cone: Option<(DVec3, f64)>,
}

impl Reach {
    /// `None` of a light without an end, or with one that is infinitely far for 32-bit floats. The position is taken
    /// relative to `origin_in_world`.
    pub fn new(light: &LightInWorld, origin_in_world: DVec3) -> Option<Self> {
        let range_m = light.finite_range_m()?;
        let cone = match light.kind {
            LightKind::Spot { outer_cone_rad, .. } => Some((light.direction_in_world, outer_cone_rad)),
            LightKind::Point { .. } | LightKind::Directional => None,
        };
        Some(Self { position: light.position_in_world - origin_in_world, range_m, cone })
    }

    /// The same with the camera at the origin.
    pub(super) fn in_view(&self, view_from_world: &DMat4) -> ReachInView {
        let apex = view_from_world.transform_point3(self.position);
        let range_m = self.range_m * (1.0 + MARGIN) + MARGIN * apex.length();
        let Some((axis, angle_rad)) = self.cone else {
            return ReachInView { center: apex.as_vec3(), radius_m: range_m as f32, cone: None };
        };
        let axis = view_from_world.transform_vector3(axis);
        // The smallest sphere around the sector. A wide one is all but a half of its sphere.
        let (sin, cos) = (angle_rad + MARGIN).sin_cos();
        let narrow = cos > std::f64::consts::FRAC_1_SQRT_2;
        let (along_m, radius_m) =
            if narrow { (0.5 * range_m / cos, 0.5 * range_m / cos) } else { (range_m * cos.max(0.0), range_m * sin) };
        let cone = Cone {
            apex: apex.as_vec3(),
            axis: axis.as_vec3(),
            sin: sin as f32,
            cos: cos as f32,
            range_m: range_m as f32,
        };
        let center = apex + along_m * axis;
        let radius_m = radius_m * (1.0 + MARGIN) + MARGIN * apex.length();
        ReachInView { center: center.as_vec3(), radius_m: radius_m as f32, cone: Some(cone) }
    }
}

/// A [`Reach`] in view space, a little larger than it is: a sphere, and for a spot light the cone in it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct ReachInView {
    pub(super) center: Vec3,
    pub(super) radius_m: f32,
    pub(super) cone: Option<Cone>,
}

impl ReachInView {
    /// Along the line of sight.
    pub(super) fn nearest_m(&self) -> f32 {
        -self.center.z - self.radius_m
    }

    pub(super) fn farthest_m(&self) -> f32 {
        -self.center.z + self.radius_m
    }
}

/// A part of a cone's axis, metres from the apex.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Stretch {
    from_m: f32,
    to_m: f32,
}

impl Stretch {
    /// What is left of it where `at_apex_m + slope t` is 0 or above.
    fn where_positive(self, at_apex_m: f32, slope: f32) -> Self {
        let root_m = -at_apex_m / slope;
        if slope > 0.0 {
            Self { from_m: self.from_m.max(root_m), ..self }
        } else if slope < 0.0 {
            Self { to_m: self.to_m.min(root_m), ..self }
        } else if at_apex_m < 0.0 {
            Self { to_m: f32::NEG_INFINITY, ..self }
        } else {
            self
        }
    }
}

/// A cone with a half angle of pi/2 at most.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Cone {
    apex: Vec3,
    axis: Vec3,
    sin: f32,
    cos: f32,
    range_m: f32,
}

impl Cone {
    /// The whole axis; `None` of cones so wide that their discs say little.
    pub(super) fn stretch(&self) -> Option<Stretch> {
        (self.cos > 0.4).then_some(Stretch { from_m: 0.0, to_m: self.range_m })
    }

    /// What is left of a stretch when only discs across the axis count that reach into the space between two planes:
    /// that in front of the first, whose signed distance is `normal . p + offset_m`, and that behind the second.
    pub(super) fn between(&self, stretch: Stretch, in_front_of: (Vec3, f32), behind: (Vec3, f32)) -> Stretch {
        let margin_m = MARGIN as f32 * (self.apex.length() + self.range_m);
        let spread = |along: f32| self.sin / self.cos * (1.0 - along * along).max(0.0).sqrt();
        let (normal, offset_m) = in_front_of;
        let along = normal.dot(self.axis);
        let at_apex_m = normal.dot(self.apex) + offset_m + margin_m;
        let stretch = stretch.where_positive(at_apex_m, along + spread(along));
        let (normal, offset_m) = behind;
        let along = normal.dot(self.axis);
        let at_apex_m = normal.dot(self.apex) + offset_m - margin_m;
        stretch.where_positive(-at_apex_m, spread(along) - along)
    }

    /// A sphere around a part of the cone; `None` where nothing is left of it.
    pub(super) fn bounding_sphere(&self, stretch: Stretch) -> Option<(Vec3, f32)> {
        let half_m = 0.5 * (stretch.to_m - stretch.from_m);
        let center = self.apex + self.axis * (stretch.from_m + half_m);
        (half_m >= 0.0).then(|| (center, half_m.hypot(stretch.to_m * self.sin / self.cos)))
    }

    /// Whether a sphere has no point in common with the cone. False of some that have none (Wronski 2017, "Cull that
    /// cone!").
    pub(super) fn misses(&self, center: Vec3, radius_m: f32) -> bool {
        let from_apex = center - self.apex;
        let along_m = from_apex.dot(self.axis);
        let across_m = (from_apex.length_squared() - along_m * along_m).max(0.0).sqrt();
        let outside_m = self.cos * across_m - self.sin * along_m;
        outside_m > radius_m || along_m > self.range_m + radius_m || along_m < -radius_m
    }
}
