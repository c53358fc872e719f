//! Flat things that emit and receive.

use super::error::RadiometryError;
use super::geometry::{Area, unit};
use glam::DVec3;

/// Sides at right angles may differ from it by this much, as a cosine: what f32 input leaves.
const RIGHT_ANGLE_TOLERANCE: f64 = 1e-6;

/// A flat rectangle in space, in metres. Its front is where `edge_u` turns to `edge_v` counter-clockwise.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rectangle {
    corner: DVec3,
    edge_u: DVec3,
    edge_v: DVec3,
    normal: DVec3,
}

impl Rectangle {
    /// From one corner and the two edges that leave it, at right angles to each other.
    pub fn new(corner: DVec3, edge_u: DVec3, edge_v: DVec3) -> Result<Self, RadiometryError> {
        RadiometryError::check(corner.is_finite(), "corner", corner.length(), "finite coordinates, in m")?;
        let (u, v) = (unit("edge u", edge_u)?, unit("edge v", edge_v)?);
        let cosine = u.dot(v);
        RadiometryError::check(
            cosine.abs() <= RIGHT_ANGLE_TOLERANCE,
            "cosine between the edges",
            cosine,
            "0, a right angle",
        )?;
        Ok(Self { corner, edge_u, edge_v, normal: u.cross(v).normalize() })
    }

    /// A square of `side_m` metres about `center` whose front looks along `normal`.
    pub fn square(center: DVec3, normal: DVec3, side_m: f64) -> Result<Self, RadiometryError> {
        let (u, v) = unit("normal", normal)?.any_orthonormal_pair();
        let (edge_u, edge_v) = (u * side_m, v * side_m);
        Self::new(center - 0.5 * (edge_u + edge_v), edge_u, edge_v)
    }

    /// Unit vector away from the front.
    pub fn normal(&self) -> DVec3 {
        self.normal
    }

    pub fn area(&self) -> Area {
        Area::raw(self.edge_u.length() * self.edge_v.length())
    }

    /// Counter-clockwise as seen from the front.
    pub fn corners(&self) -> [DVec3; 4] {
        let (a, u, v) = (self.corner, self.edge_u, self.edge_v);
        [a, a + u, a + u + v, a + v]
    }

    /// The point at `s` along the first edge and `t` along the second, each in [0, 1].
    pub fn point(&self, s: f64, t: f64) -> DVec3 {
        self.corner + s * self.edge_u + t * self.edge_v
    }

    pub(super) fn edges(&self) -> (DVec3, DVec3) {
        (self.edge_u, self.edge_v)
    }
}

/// A small piece of a surface that light falls on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Receiver {
    position: DVec3,
    normal: DVec3,
}

impl Receiver {
    /// `position` in metres, `normal` of any length above 0.
    pub fn new(position: DVec3, normal: DVec3) -> Result<Self, RadiometryError> {
        RadiometryError::check(position.is_finite(), "position", position.length(), "finite coordinates, in m")?;
        Ok(Self { position, normal: unit("normal", normal)? })
    }

    pub fn position(&self) -> DVec3 {
        self.position
    }

    /// Unit vector.
    pub fn normal(&self) -> DVec3 {
        self.normal
    }
}
