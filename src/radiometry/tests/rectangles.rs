//! Irradiance from rectangles: Lambert's closed form against quadrature; flux through two apertures.

use super::super::irradiance::{by_quadrature, etendue, from_rectangle};
use super::super::*;
use glam::DVec3;
use std::f64::consts::PI;

/// A receiver at the origin that looks up, under or beside rectangles that look at it or not.
fn cases() -> Vec<(&'static str, Rectangle, DVec3)> {
    let square = |center: [f64; 3], normal: [f64; 3], side| {
        Rectangle::square(DVec3::from(center), DVec3::from(normal), side).unwrap()
    };
    let up = DVec3::Y;
    vec![
        ("far ahead", square([0.0, 50.0, 0.0], [0.0, -1.0, 0.0], 1.0), up),
        ("above", square([0.0, 1.0, 0.0], [0.0, -1.0, 0.0], 1.0), up),
        ("aside and tilted", square([2.0, 3.0, -1.0], [-1.0, -2.0, 0.3], 2.5), up),
        ("a wall that crosses the horizon", square([3.0, 0.5, 0.0], [-1.0, 0.0, 0.0], 4.0), up),
        ("a tilted wall that crosses the horizon", square([1.5, 0.3, 0.4], [-1.0, -0.4, 0.2], 2.0), up),
        ("one corner above the horizon", square([2.0, -1.2, 0.0], [-1.0, 0.1, 0.3], 2.0), DVec3::new(0.1, 1.0, 0.05)),
        ("one corner below the horizon", square([2.0, 1.2, 0.0], [-1.0, 0.1, 0.3], 2.0), DVec3::new(0.1, 1.0, 0.05)),
        ("a millimetre above", square([0.2, 1e-3, 0.1], [0.0, -1.0, 0.0], 1.0), up),
        ("1000 km away", square([6e5, 8e5, -1e4], [-1.0, -1.0, 0.0], 1.0), up),
        ("a strip", Rectangle::new(DVec3::new(-5.0, 2.0, 1.0), DVec3::X * 10.0, DVec3::Z * 0.01).unwrap(), up),
    ]
}

#[test]
fn lamberts_polygon_formula_agrees_with_quadrature() {
    let radiance = Luminance::from_nits(1000.0).unwrap();
    for (name, rectangle, normal) in cases() {
        let receiver = Receiver::new(DVec3::ZERO, normal).unwrap();
        let closed = from_rectangle(&rectangle, radiance, &receiver);
        let estimate = by_quadrature(&rectangle, |_| radiance, &receiver, 1e-9);
        let error = estimate.value / closed - 1.0;
        // Measured 3.7e-13 at most, 3.2e-11 at 1000 km, where Lambert's sum cancels; margin 5.
        let bound = if name == "1000 km away" { 1.5e-10 } else { 2e-12 };
        assert!(error.abs() < bound, "{name}: {closed} {} {error:e}", estimate.value);
        assert!(estimate.error / closed < 1e-8, "{name}: {}", estimate.error);
        assert!(closed > Illuminance::ZERO, "{name}: {closed}");
    }
}

#[test]
fn closed_forms_of_view_factors() {
    // A square of side 2 a, seen from h below its centre: E / L = 4 A/sqrt(1 + A^2) atan(A / sqrt(1 + A^2)), A = a/h: four
    // quarters of the textbook's plane element below a corner (Siegel and Howell 1972).
    let (half, height) = (0.7, 1.3);
    let (x, root) = (half / height, f64::hypot(1.0, half / height));
    let expected = 4.0 * (x / root) * (x / root).atan();
    let square = Rectangle::square(DVec3::Y * height, DVec3::NEG_Y, 2.0 * half).unwrap();
    let seen = solid_angle::polygon_projected(&square.corners(), &Receiver::new(DVec3::ZERO, DVec3::Y).unwrap());
    assert!((seen.as_steradians() - expected).abs() < 1e-15, "{seen} {expected}");
    // A plane without end fills the hemisphere; seen edge-on, half of it.
    let plane = Rectangle::square(DVec3::Y, DVec3::NEG_Y, 1e9).unwrap().corners();
    let facing = solid_angle::polygon_projected(&plane, &Receiver::new(DVec3::ZERO, DVec3::Y).unwrap());
    let sideways = solid_angle::polygon_projected(&plane, &Receiver::new(DVec3::ZERO, DVec3::X).unwrap());
    assert!((facing.as_steradians() - PI).abs() < 1e-8 && (sideways.as_steradians() - PI / 2.0).abs() < 1e-8);
}

#[test]
fn nothing_arrives_from_behind_or_from_below() {
    let up = Receiver::new(DVec3::ZERO, DVec3::Y).unwrap();
    let radiance = Luminance::from_nits(1.0).unwrap();
    let back = Rectangle::square(DVec3::Y, DVec3::Y, 1.0).unwrap();
    let below = Rectangle::square(DVec3::NEG_Y, DVec3::Y, 1.0).unwrap();
    for rectangle in [back, below] {
        assert_eq!(from_rectangle(&rectangle, radiance, &up), Illuminance::ZERO);
        assert_eq!(by_quadrature(&rectangle, |_| radiance, &up, 1e-9).value, Illuminance::ZERO);
    }
}

#[test]
fn from_afar_a_rectangle_is_a_point() {
    // E = L A cos cos / r^2, off by the square of size over distance.
    let radiance = Radiance::from_watts_per_square_meter_steradian(6000.0).unwrap();
    let (place, normal) = (DVec3::new(300.0, 400.0, 0.0), DVec3::new(-1.0, -1.0, 0.0));
    let rectangle = Rectangle::square(place, normal, 0.1).unwrap();
    let receiver = Receiver::new(DVec3::ZERO, DVec3::Y).unwrap();
    let emitted = Cosine::between(normal, -place).unwrap();
    let received = Cosine::between(DVec3::Y, place).unwrap();
    let distance = Distance::from_meters(500.0).unwrap();
    let point = radiance.intensity_of(rectangle.area(), emitted).irradiance_at(distance, received);
    let error = from_rectangle(&rectangle, radiance, &receiver) / point - 1.0;
    // Measured 1.4e-8 and 1.8e-8; margin 3.
    assert!(error.abs() < 6e-8, "{error:e}");
    // The lecture's source, L = 6000 cos(theta), from the same place.
    let tinted = |cosine: Cosine| Radiance::from_watts_per_square_meter_steradian(6000.0 * cosine.get()).unwrap();
    let error = by_quadrature(&rectangle, tinted, &receiver, 1e-9).value / (point * emitted) - 1.0;
    assert!(error.abs() < 6e-8, "{error:e}");
}

#[test]
fn radiance_is_constant_along_a_ray() {
    // A lamp of 800 nits, and an eye that turns flux back into radiance: by its own area, and the projected solid angle
    // in which it sees the lamp. The lamp's end and the eye's are integrated apart.
    let radiance = Luminance::from_nits(800.0).unwrap();
    let lamp = Rectangle::square(DVec3::ZERO, DVec3::Z, 0.3).unwrap();
    for distance in [0.2, 1.0, 30.0, 1000.0] {
        let eye = Rectangle::square(DVec3::new(0.1, -0.05, distance), DVec3::new(0.2, 0.0, -1.0), 0.05).unwrap();
        let flux = radiance * etendue(&lamp, &eye, 1e-10);
        let measured = flux / etendue(&eye, &lamp, 1e-10);
        // Measured 2e-15 at most; margin 5.
        assert!((measured / radiance - 1.0).abs() < 1e-14, "{distance} m: {measured}, {:e}", measured / radiance - 1.0);
    }
}

#[test]
fn etendue_of_opposite_squares() {
    // Identical, parallel, directly opposed squares at X = side / distance: the textbook's view factor (Howell's
    // catalogue of configuration factors, C-11), times pi times the area.
    for x in [0.1_f64, 1.0, 5.0] {
        let q = 1.0 + x * x;
        let f = (2.0 / (PI * x * x))
            * ((q * q / (1.0 + 2.0 * x * x)).ln() / 2.0 + 2.0 * x * q.sqrt() * (x / q.sqrt()).atan()
                - 2.0 * x * x.atan());
        let one = Rectangle::square(DVec3::ZERO, DVec3::Z, x).unwrap();
        let other = Rectangle::square(DVec3::Z, DVec3::NEG_Z, x).unwrap();
        let found = etendue(&one, &other, 1e-10).as_square_meter_steradians();
        let expected = f * PI * x * x;
        // Measured 9e-13 at most, at X = 0.1 and mostly the textbook's cancellation.
        assert!((found / expected - 1.0).abs() < 5e-12, "X = {x}: {found} {expected} {:e}", found / expected - 1.0);
    }
}
