//! Solid angles in closed form.

use super::error::RadiometryError;
use super::geometry::{Distance, ProjectedSolidAngle, SolidAngle};
use super::shapes::{Receiver, Rectangle};
use glam::DVec3;
use std::f64::consts::{FRAC_PI_2, PI};

/// Of a cone around its axis, `half_angle_rad` in [0, pi]: 2 pi (1 - cos a) = 4 pi sin^2(a/2), which does not cancel.
pub fn cone(half_angle_rad: f64) -> Result<SolidAngle, RadiometryError> {
    let expected = "an angle from 0 to pi, in rad";
    RadiometryError::check((0.0..=PI).contains(&half_angle_rad), "half angle", half_angle_rad, expected)?;
    Ok(SolidAngle::raw(4.0 * PI * (0.5 * half_angle_rad).sin().powi(2)))
}

/// Of a cone around a surface's normal, weighted with the cosine, `half_angle_rad` in [0, pi/2]: pi sin^2 a.
pub fn cone_projected(half_angle_rad: f64) -> Result<ProjectedSolidAngle, RadiometryError> {
    let expected = "an angle from 0 to pi/2, in rad";
    RadiometryError::check((0.0..=FRAC_PI_2).contains(&half_angle_rad), "half angle", half_angle_rad, expected)?;
    Ok(ProjectedSolidAngle::raw(PI * half_angle_rad.sin().powi(2)))
}

/// Of a disc of `radius`, seen from `distance` on its axis: 2 pi (1 - d / sqrt(d^2 + R^2)).
pub fn disc(radius: Distance, distance: Distance) -> SolidAngle {
    let (r, d) = (radius.as_meters(), distance.as_meters());
    SolidAngle::raw(4.0 * PI * (0.5 * r.atan2(d)).sin().powi(2))
}

/// Of a sphere of `radius` whose centre is at `distance`: 2 pi (1 - sqrt(1 - (R/d)^2)). From outside or its surface.
pub fn sphere(radius: Distance, distance: Distance) -> Result<SolidAngle, RadiometryError> {
    let sine = sphere_sine(radius, distance)?;
    Ok(SolidAngle::raw(2.0 * PI * sine * sine / (1.0 + (1.0 - sine * sine).sqrt())))
}

/// Of the same sphere, seen by a surface that faces it: pi (R/d)^2, the inverse square law in full.
pub fn sphere_projected(radius: Distance, distance: Distance) -> Result<ProjectedSolidAngle, RadiometryError> {
    sphere_sine(radius, distance).map(|sine| ProjectedSolidAngle::raw(PI * sine * sine))
}

fn sphere_sine(radius: Distance, distance: Distance) -> Result<f64, RadiometryError> {
    let sine = radius.as_meters() / distance.as_meters();
    RadiometryError::check(sine <= 1.0, "radius over distance", sine, "up to 1: a point outside of the sphere")
}

/// Of a rectangle, seen from any point, from its front or its back. 0 from points in its plane.
///
/// As two triangles: the usual sum of four arctangents, one a corner (Khadjavi 1968), cancels where the rectangle is far
/// from the axis through the point. Good to 1e-15 sr at its own size, 1e-11 sr at a twenty-thousandth of it.
pub fn rectangle(rectangle: &Rectangle, point: DVec3) -> SolidAngle {
    let [a, b, c, d] = rectangle.corners();
    SolidAngle::raw(triangle([a, b, c], point).as_steradians() + triangle([a, c, d], point).as_steradians())
}

/// Of a triangle, seen from any point, from its front or its back; corners in metres. 0 from points in its plane.
///
/// tan(Omega/2) = |a . (b x c)| / (abc + (a.b) c + (b.c) a + (c.a) b) (Van Oosterom and Strackee 1983, equation 8).
pub fn triangle(corners: [DVec3; 3], point: DVec3) -> SolidAngle {
    let [a, b, c] = corners.map(|corner| corner - point);
    // Vectors as large as galaxies would overflow when multiplied; an angle does not depend on the scale.
    let scale = [a, b, c].map(|vector| vector.abs().max_element()).into_iter().fold(f64::MIN_POSITIVE, f64::max);
    let [a, b, c] = [a, b, c].map(|vector| vector / scale);
    let (a_length, b_length, c_length) = (a.length(), b.length(), c.length());
    // a . (b x c) in the edges, which are exact where the triangle is small and far.
    let volume = a.dot((b - a).cross(c - a)).abs();
    let denominator = a_length * b_length * c_length + a.dot(b) * c_length + b.dot(c) * a_length + c.dot(a) * b_length;
    SolidAngle::raw(2.0 * volume.atan2(denominator))
}

/// Of a flat polygon's front, weighted with the cosine to the receiver's normal; what is below its horizon is cut off.
///
/// `corners` counter-clockwise as seen from the front, in metres; 0 for a receiver behind. Half the sum over the edges of
/// their angle as seen from the receiver, times the cosine between the normal of the edge's plane through the receiver
/// and its own normal (Lambert 1760; Baum, Rushmeier and Winget 1989).
pub fn polygon_projected(corners: &[DVec3], receiver: &Receiver) -> ProjectedSolidAngle {
    let relative: Vec<DVec3> = corners.iter().map(|&corner| corner - receiver.position()).collect();
    let visible = clip_to_horizon(&relative, receiver.normal());
    let edges = visible.iter().zip(visible.iter().cycle().skip(1));
    let sum: f64 = edges.map(|(&a, &b)| receiver.normal().dot(edge_vector(a, b))).sum();
    // Corners that run counter-clockwise for who sees the front give edge vectors away from the normal.
    ProjectedSolidAngle::raw((-0.5 * sum).clamp(0.0, PI))
}

/// Angle between `a` and `b`, along the unit normal of their plane; none where they are parallel.
fn edge_vector(a: DVec3, b: DVec3) -> DVec3 {
    // b - a keeps the digits that differ.
    let normal = a.cross(b - a);
    let sine = normal.length();
    if sine > 0.0 { normal * (sine.atan2(a.dot(b)) / sine) } else { DVec3::ZERO }
}

/// What of a polygon is on the side of the plane through the origin to which `normal` points (Sutherland and Hodgman
/// 1974).
fn clip_to_horizon(polygon: &[DVec3], normal: DVec3) -> Vec<DVec3> {
    let mut clipped = Vec::with_capacity(polygon.len() + 1);
    for (&a, &b) in polygon.iter().zip(polygon.iter().cycle().skip(1)) {
        let (height_a, height_b) = (a.dot(normal), b.dot(normal));
        if height_a >= 0.0 {
            clipped.push(a);
        }
        if (height_a > 0.0 && height_b < 0.0) || (height_a < 0.0 && height_b > 0.0) {
            clipped.push(a + (b - a) * (height_a / (height_a - height_b)));
        }
    }
    clipped
}
