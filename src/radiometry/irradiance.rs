//! What a rectangle sends to a point and through an aperture, in closed form and by quadrature.

use super::geometry::{Cosine, Etendue};
use super::quantity::{Irradiance, Radiance};
use super::shapes::{Receiver, Rectangle};
use super::solid_angle::polygon_projected;
use super::system::System;
use crate::math::quadrature::GaussLegendre;
use glam::DVec3;

/// Nodes of the rule that is then refined by halving.
const NODES: usize = 8;

/// A number found by quadrature.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate<Q> {
    pub value: Q,
    /// A bound on the error of `value`, unless the integrand has structure that the rule did not meet.
    pub error: Q,
}

/// E = L Omega_p of a rectangle whose front has the same radiance in all directions: Lambert's closed form.
pub fn from_rectangle<S: System>(source: &Rectangle, radiance: Radiance<S>, receiver: &Receiver) -> Irradiance<S> {
    radiance * polygon_projected(&source.corners(), receiver)
}

/// E = int L cos cos' / r^2 dA over the source's front, for a radiance that depends on the angle of emission.
///
/// `radiance` gets the cosine between the emitted ray and the source's normal. `relative_tolerance`, such as 1e-9, is of
/// the irradiance. The integral stops at the receiver's horizon, where the integrand has a kink.
pub fn by_quadrature<S: System>(
    source: &Rectangle,
    radiance: impl Fn(Cosine) -> Radiance<S>,
    receiver: &Receiver,
    relative_tolerance: f64,
) -> Estimate<Irradiance<S>> {
    let from_receiver = |point: DVec3| point - receiver.position();
    let height_m = -source.normal().dot(from_receiver(source.point(0.0, 0.0)));
    if height_m <= 0.0 {
        return Estimate { value: Irradiance::ZERO, error: Irradiance::ZERO };
    }
    let integrand = |s: f64, t: f64| {
        let ray = from_receiver(source.point(s, t));
        let distance_m = ray.length();
        let cos_emitted = (height_m / distance_m).min(1.0);
        let cos_received = (receiver.normal().dot(ray) / distance_m).max(0.0);
        radiance(Cosine::raw(cos_emitted)).value() * cos_emitted * cos_received / (distance_m * distance_m)
    };
    let (u, v) = source.edges();
    let horizon = Horizon {
        at_corner: receiver.normal().dot(from_receiver(source.point(0.0, 0.0))),
        along_u: receiver.normal().dot(u),
        along_v: receiver.normal().dot(v),
    };
    let rule = GaussLegendre::new(NODES);
    // The inner integral must be smoother than the outer one's tolerance.
    let inner_tolerance = 0.01 * relative_tolerance;
    let column = |s: f64| {
        let (t0, t1) = horizon.above(s);
        rule.integrate_adaptively(t0, t1, inner_tolerance, |t| integrand(s, t)).0
    };
    let (mut sum, mut error) = (0.0, 0.0);
    for (s0, s1) in horizon.pieces() {
        let (piece, piece_error) = rule.integrate_adaptively(s0, s1, relative_tolerance, column);
        (sum, error) = (sum + piece, error + piece_error);
    }
    let area = source.area().as_square_meters();
    Estimate { value: Irradiance::raw(sum * area), error: Irradiance::raw((error + inner_tolerance * sum) * area) }
}

/// Height above a receiver's horizon over a rectangle, which is linear: `at_corner + s along_u + t along_v`.
struct Horizon {
    at_corner: f64,
    along_u: f64,
    along_v: f64,
}

impl Horizon {
    /// Where the horizon crosses the two edges along u, the limits of the inner integral have kinks.
    fn pieces(&self) -> impl Iterator<Item = (f64, f64)> {
        let crossing = |height: f64| (-height / self.along_u).clamp(0.0, 1.0);
        let crossings = [crossing(self.at_corner), crossing(self.at_corner + self.along_v)];
        let mut cuts = [0.0, 0.0, 0.0, 1.0];
        if self.along_u != 0.0 {
            (cuts[1], cuts[2]) = (crossings[0].min(crossings[1]), crossings[0].max(crossings[1]));
        }
        (0..3).map(move |i| (cuts[i], cuts[i + 1])).filter(|(a, b)| a < b)
    }

    /// The range of t that is above the horizon.
    fn above(&self, s: f64) -> (f64, f64) {
        let height = self.at_corner + s * self.along_u;
        if self.along_v == 0.0 {
            return if height > 0.0 { (0.0, 1.0) } else { (0.0, 0.0) };
        }
        let crossing = (-height / self.along_v).clamp(0.0, 1.0);
        if self.along_v > 0.0 { (crossing, 1.0) } else { (0.0, crossing) }
    }
}

/// Etendue of the beams from one rectangle's front to another's: what uniform radiance is multiplied with to give flux.
///
/// G = int int cos cos' / r^2 dA dA', the same from either end. With it the flux through two apertures is L G however far
/// apart they are, which is what it means that radiance is constant along a ray. `relative_tolerance` such as 1e-9.
pub fn etendue(from: &Rectangle, to: &Rectangle, relative_tolerance: f64) -> Etendue {
    let rule = GaussLegendre::new(NODES);
    let corners = to.corners();
    let seen_from = |position: DVec3| {
        // The normal is of unit length and the position inside a rectangle that was checked.
        Receiver::new(position, from.normal())
            .map_or(0.0, |receiver| polygon_projected(&corners, &receiver).as_steradians())
    };
    let column =
        |s: f64| rule.integrate_adaptively(0.0, 1.0, 0.01 * relative_tolerance, |t| seen_from(from.point(s, t))).0;
    let (mean, _) = rule.integrate_adaptively(0.0, 1.0, relative_tolerance, column);
    Etendue::raw(mean * from.area().as_square_meters())
}
