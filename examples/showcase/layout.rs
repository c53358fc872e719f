//! Where things stand in the showcase, and how much sky they take from the floor. Metres, +Y up, front toward +Z.

use super::geometry::{STEP_PROFILE, trefoil};
use super::materials::ROUGHNESS_STEPS;
use glam::{DVec2, DVec3};
use std::f64::consts::{PI, TAU};

/// The round steps in the middle: axis through (x, z), `(radius, top)` from the lowest to the highest.
pub(crate) const STEPS_CENTER: DVec2 = DVec2::new(0.0, -0.35);
pub(crate) const STEPS: [DVec2; 3] = [DVec2::new(1.20, 0.13), DVec2::new(0.92, 0.26), DVec2::new(0.64, 0.40)];

pub(crate) const SPHERE_RADIUS: f64 = 0.105;
/// Distances from the axis of the rows of spheres, on the two lower steps and before them, from the upper to the lower.
const ROW_RADII: [f64; 3] = [0.785, 1.065, 1.345];
const SPHERE_SPACING: f64 = 0.262;

pub(crate) const KNOT_SIZE: f64 = 0.53;
pub(crate) const KNOT_TUBE: f64 = 0.088;

pub(crate) const HALO_RADIUS: f64 = 0.88;
pub(crate) const HALO_TUBE: f64 = 0.022;
/// Behind the axis of the steps.
pub(crate) const HALO_Z: f64 = -0.42;

pub(crate) const CUBE_HALF: f64 = 0.22;
pub(crate) const CUBE_CENTER: DVec2 = DVec2::new(-1.36, 0.66);
pub(crate) const CUBE_TURN_DEGREES: f64 = 28.0;

pub(crate) const GLASS_RADIUS: f64 = 0.27;
pub(crate) const GLASS_CENTER: DVec2 = DVec2::new(1.38, 0.66);

/// Upright panels behind the steps, on the left and on the right; both turn toward the middle.
pub(crate) const PANEL_HALF: DVec3 = DVec3::new(0.46, 0.46, 0.035);
pub(crate) const PANEL_CENTERS: [DVec2; 2] = [DVec2::new(-1.52, -0.85), DVec2::new(1.52, -0.85)];
pub(crate) const PANEL_TURNS_DEGREES: [f64; 2] = [24.0, -24.0];

/// The occlusion picture spans this square around the origin, seen from above with -Z at its top.
const OCCLUSION_HALF_SPAN: f64 = 2.2;

/// Texture coordinates of a place on the ground.
pub(crate) fn ground_uv(place: DVec2) -> DVec2 {
    place / (2.0 * OCCLUSION_HALF_SPAN) + 0.5
}

/// The places of a row's spheres on the ground, from left to right.
pub(crate) fn row_places(row: usize) -> [DVec2; ROUGHNESS_STEPS] {
    let radius = ROW_RADII[row];
    std::array::from_fn(|i| {
        let angle = (i as f64 - 0.5 * (ROUGHNESS_STEPS - 1) as f64) * SPHERE_SPACING / radius;
        STEPS_CENTER + radius * DVec2::new(angle.sin(), angle.cos())
    })
}

/// Height of the ground `radius` away from the axis of the steps.
pub(crate) fn ground_height(radius: f64) -> f64 {
    STEPS.iter().rev().find(|step| radius < step.x).map_or(0.0, |step| step.y)
}

/// The height of the row's ground.
pub(crate) fn row_height(row: usize) -> f64 {
    ground_height(ROW_RADII[row])
}

/// The share of a clear sky's light that reaches the ground around the steps, at `uv` of [`ground_uv`]; in [0, 1].
pub(crate) fn ground_openness(uv: DVec2) -> f64 {
    openness((uv - 0.5) * (2.0 * OCCLUSION_HALF_SPAN), 0.0)
}

/// The same on the steps, at their own texture coordinates.
pub(crate) fn steps_openness(uv: DVec2) -> f64 {
    let step = ((uv.y * STEPS.len() as f64) as usize).min(STEPS.len() - 1);
    let along = uv.y * STEPS.len() as f64 - step as f64;
    let [foot, .., edge, inner] = STEP_PROFILE;
    if along < edge {
        // Feet of walls are darker: half of what they face is the corner.
        return 1.0 - 0.4 * (1.0 - ((along - foot) / (edge - foot)).max(0.0)).powi(2);
    }
    let inside = STEPS.get(step + 1).map_or(0.0, |next| next.x);
    let radius = STEPS[step].x + (inside - STEPS[step].x) * ((along - edge) / (inner - edge)).min(1.0);
    let (sin, cos) = (TAU * uv.x).sin_cos();
    openness(STEPS_CENTER + DVec2::new(sin, cos) * radius, STEPS[step].y)
}

/// The share of a clear sky's light that reaches level ground at `height`.
fn openness(place: DVec2, height: f64) -> f64 {
    let from_axis = place.distance(STEPS_CENTER);
    let mut open = 1.0;
    for step in STEPS.iter().filter(|step| step.y > height) {
        open *= 1.0 - wall(from_axis - step.x, step.y - height);
    }
    for row in 0..3 {
        for center in row_places(row) {
            open *= 1.0 - sphere(place.distance(center), SPHERE_RADIUS, row_height(row) + SPHERE_RADIUS - height);
        }
    }
    open *= 1.0 - 0.6 * sphere(place.distance(GLASS_CENTER), GLASS_RADIUS, GLASS_RADIUS - height);
    open *=
        1.0 - wall(to_box(place, CUBE_CENTER, CUBE_TURN_DEGREES, DVec2::splat(CUBE_HALF)), 2.0 * CUBE_HALF - height);
    for (center, turn) in PANEL_CENTERS.into_iter().zip(PANEL_TURNS_DEGREES) {
        let half = DVec2::new(PANEL_HALF.x, PANEL_HALF.z);
        open *= 1.0 - wall(to_box(place, center, turn, half), 2.0 * PANEL_HALF.y - height);
    }
    let below_knot = height == STEPS[STEPS.len() - 1].y;
    open * if below_knot { 1.0 - knot(place - STEPS_CENTER) } else { 1.0 }
}

/// Light that a sphere takes from level ground: the form factor (r / d)^2 cos theta; none from ground above its middle.
fn sphere(distance: f64, radius: f64, height: f64) -> f64 {
    let d2 = distance * distance + height * height;
    (radius * radius * height.max(0.0) / (d2 * d2.sqrt())).min(1.0)
}

/// Light that a long wall takes from level ground before it; inside, where nothing is seen, as much as at its foot.
fn wall(distance: f64, height: f64) -> f64 {
    if distance <= 0.0 { 0.5 } else { 0.5 * (1.0 - distance / distance.hypot(height)) }
}

/// The knot as a string of balls, each for the stretch of tube that falls to it.
fn knot(place: DVec2) -> f64 {
    const BALLS: usize = 96;
    let curve = trefoil(KNOT_SIZE);
    let point = |i: usize| curve(i as f64 / BALLS as f64);
    let lowest = (0..BALLS).map(|i| point(i).y).fold(f64::INFINITY, f64::min) - KNOT_TUBE;
    let taken: f64 = (0..BALLS)
        .map(|i| {
            let (center, stretch) = (point(i), point(i).distance(point(i + 1)));
            let balls = 2.0 * stretch / (PI * KNOT_TUBE);
            balls * sphere(place.distance(DVec2::new(center.x, center.z)), KNOT_TUBE, center.y - lowest)
        })
        .sum();
    taken.min(0.9)
}

/// Distance to a turned rectangle on the ground, 0 inside.
fn to_box(place: DVec2, center: DVec2, turn_degrees: f64, half: DVec2) -> f64 {
    // A turn about +Y takes +X toward -Z.
    let local = DVec2::from_angle(turn_degrees.to_radians()).rotate(place - center);
    (local.abs() - half).max(DVec2::ZERO).length()
}
