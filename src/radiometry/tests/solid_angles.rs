//! Solid angles against other closed forms and against each other.

use super::super::*;
use glam::{DQuat, DVec3};
use std::f64::consts::PI;

fn meters(value: f64) -> Distance {
    Distance::from_meters(value).unwrap()
}

/// The sum over the corners of atan(xy / (d sqrt(x^2 + y^2 + d^2))) (Khadjavi 1968), for sides along x and y at z = d.
fn rectangle_by_arctangents((x0, x1): (f64, f64), (y0, y1): (f64, f64), d: f64) -> f64 {
    let corner = |x: f64, y: f64| (x * y / (d * (x * x + y * y + d * d).sqrt())).atan();
    corner(x1, y1) - corner(x0, y1) - corner(x1, y0) + corner(x0, y0)
}

fn rectangle_at((x0, x1): (f64, f64), (y0, y1): (f64, f64), d: f64) -> Rectangle {
    Rectangle::new(DVec3::new(x0, y0, d), DVec3::X * (x1 - x0), DVec3::Y * (y1 - y0)).unwrap()
}

#[test]
fn cones_discs_and_spheres() {
    assert!((solid_angle::cone(PI).unwrap().as_steradians() - 4.0 * PI).abs() < 1e-14);
    assert!((solid_angle::cone(PI / 2.0).unwrap().as_steradians() - 2.0 * PI).abs() < 1e-14);
    for (radius, distance) in [(1.0, 2.0), (3.0, 0.1), (1e-3, 50.0)] {
        let disc = solid_angle::disc(meters(radius), meters(distance)).as_steradians();
        let textbook = 2.0 * PI * (1.0 - distance / f64::hypot(radius, distance));
        // The textbook's form loses digits that a small angle needs; 1e-15 of 2 pi is what it has.
        assert!((disc - textbook).abs() < 1e-14, "{disc} {textbook}");
    }
    // From far away a disc is its area over the square of the distance.
    let far = solid_angle::disc(meters(1.0), meters(1e8)).as_steradians();
    assert!((far / (PI * 1e-16) - 1.0).abs() < 1e-15);
    // A sphere covers what the cone of its tangents does, and a point on it sees half of everything.
    let sphere = solid_angle::sphere(meters(1.0), meters(2.0)).unwrap().as_steradians();
    assert!((sphere - solid_angle::cone(PI / 6.0).unwrap().as_steradians()).abs() < 1e-15);
    let touching = solid_angle::sphere(meters(2.0), meters(2.0)).unwrap();
    assert_eq!(touching, SolidAngle::HEMISPHERE);
    let inside = solid_angle::sphere(meters(3.0), meters(2.0)).unwrap_err();
    assert_eq!((inside.parameter, inside.value), ("radius over distance", 1.5));
    // pi sin^2 is less than the solid angle: towards its edge the sphere is seen more slantingly.
    let projected = solid_angle::sphere_projected(meters(1.0), meters(2.0)).unwrap().as_steradians();
    assert!((projected - PI / 4.0).abs() < 1e-15);
    let tangents = solid_angle::cone_projected(PI / 6.0).unwrap();
    assert!((tangents.as_steradians() - projected).abs() < 1e-15);
    assert_eq!(solid_angle::cone_projected(PI / 2.0).unwrap(), ProjectedSolidAngle::HEMISPHERE);
    assert_eq!(solid_angle::cone_projected(1.6).unwrap_err().parameter, "half angle");
}

#[test]
fn rectangles_on_and_off_the_axis() {
    let cases = [
        ((-1.0, 1.0), (-1.0, 1.0), 1.0),
        ((-0.5, 0.5), (-2.0, 2.0), 3.0),
        ((2.0, 5.0), (-1.0, 0.5), 0.7),
        ((-4.0, -3.0), (6.0, 6.5), 2.0),
    ];
    for (x, y, d) in cases {
        let expected = rectangle_by_arctangents(x, y, d);
        for height in [d, -d] {
            let found = solid_angle::rectangle(&rectangle_at(x, y, height), DVec3::ZERO).as_steradians();
            // Measured 1e-16 at most; a last digit more for another libm.
            assert!((found - expected).abs() < 1e-15, "{x:?} {y:?} {height}: {found} {expected}");
        }
    }
    // Close to its middle, and so to the side that the two triangles share, their denominators cancel: measured 3e-12.
    let close = solid_angle::rectangle(&rectangle_at((-10.0, 10.0), (-10.0, 10.0), 1e-3), DVec3::ZERO);
    let expected = rectangle_by_arctangents((-10.0, 10.0), (-10.0, 10.0), 1e-3);
    assert!((close.as_steradians() - expected).abs() < 1e-11, "{close} {expected}");
    // A face of a cube, from its centre: a sixth of everything.
    let face = solid_angle::rectangle(&rectangle_at((-1.0, 1.0), (-1.0, 1.0), 1.0), DVec3::ZERO);
    assert!((face.as_steradians() - 4.0 * PI / 6.0).abs() < 1e-15);
}

#[test]
fn small_far_slanted_rectangles_keep_their_digits() {
    // 1 mm2, 10 km away, far off the axis: area cos / r^2, to (1e-3 / 1e4)^2.
    let position = DVec3::new(6e3, 7e3, 4e3);
    let (x, y) = ((position.x - 5e-4, position.x + 5e-4), (position.y - 5e-4, position.y + 5e-4));
    let expected = 1e-6 * position.z / position.length().powi(3);
    let found = solid_angle::rectangle(&rectangle_at(x, y, position.z), DVec3::ZERO).as_steradians();
    let by_arctangents = rectangle_by_arctangents(x, y, position.z);
    // Measured 3.6e-10, the rounding of the corners to 1e-12 m; 4e-2 by arctangents.
    assert!((found / expected - 1.0).abs() < 2e-9, "{:e}", found / expected - 1.0);
    assert!((by_arctangents / expected - 1.0).abs() > 1e-3, "{:e}", by_arctangents / expected - 1.0);
}

#[test]
fn triangles_tile_and_turn() {
    // An octant of the sphere.
    let octant = solid_angle::triangle([DVec3::X, DVec3::Y, DVec3::Z], DVec3::ZERO);
    assert!((octant.as_steradians() - PI / 2.0).abs() < 1e-15);
    // A closed surface is seen in all directions from inside, however skewed it is, and at any scale.
    let corners = [
        DVec3::new(3.0, 0.1, 0.2),
        DVec3::new(-1.0, 2.0, 0.5),
        DVec3::new(-0.7, -2.5, 0.1),
        DVec3::new(0.3, 0.2, -5.0),
    ];
    let faces = [[0, 1, 2], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
    let inside = (corners[0] + corners[1] + corners[2] + 0.2 * corners[3]) / 3.2;
    for (scale, turn) in [(1.0, 0.0), (1e-150, 1.0), (1e150, 2.0)] {
        let rotation = DQuat::from_axis_angle(DVec3::new(0.6, 0.0, 0.8), turn);
        let placed = corners.map(|corner| rotation * (corner * scale));
        let angles = faces
            .map(|face| solid_angle::triangle(face.map(|i| placed[i]), rotation * (inside * scale)).as_steradians());
        let sum: f64 = angles.iter().sum();
        assert!((sum - 4.0 * PI).abs() < 1e-13, "scale {scale:e}: {sum}");
    }
    // From its own plane a triangle is a line.
    assert_eq!(solid_angle::triangle([DVec3::X, DVec3::Y, DVec3::X * 2.0], DVec3::ZERO).as_steradians(), 0.0);
}
