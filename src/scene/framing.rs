//! Cameras that show a whole scene.

use super::{Background, Camera, Geometry, Projection, Scene, ToneMap, View};
use glam::{DVec2, DVec3, UVec2, Vec3, Vec3Swizzles as _};
use std::f64::consts::PI;

/// The orbit that shows most of most models, a little from the right and from above: theta and phi in radians.
pub const DEFAULT_ORBIT_RAD: (f64, f64) = (25.0 * PI / 180.0, 75.0 * PI / 180.0);
/// Vertical field of view of a framed picture, radians: long enough not to distort.
pub const DEFAULT_FOV_RAD: f64 = 35.0 * PI / 180.0;

/// Empty margin around a framed scene, as a fraction of the picture on each side.
const MARGIN: f64 = 0.05;

/// A view direction on the orbit around a target.
///
/// `theta_rad` turns about +Y from +Z toward +X, `phi_rad` is the angle from +Y. Returns the unit vector from the
/// target toward the camera.
pub fn orbit_direction(theta_rad: f64, phi_rad: f64) -> DVec3 {
    let (sin_theta, cos_theta) = theta_rad.sin_cos();
    let (sin_phi, cos_phi) = phi_rad.sin_cos();
    DVec3::new(sin_phi * sin_theta, cos_phi, sin_phi * cos_theta)
}

/// Where a camera stands so that the whole scene is in the picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Framing {
    /// The point that the camera looks at, in world space.
    pub target: DVec3,
    /// Distance of the camera from the target, metres.
    pub distance_m: f64,
    /// Vertical extent of the scene as seen, with margins, metres.
    pub height_m: f64,
    /// Radius of a sphere around the target that holds the scene, metres.
    pub radius_m: f64,
}

/// Frames `points` from the direction `toward_camera` (unit): the closest camera that sees all of them.
///
/// Each side of the picture gives one half-space that moves with the camera, so the optimum is closed-form: for the
/// horizontal sides with half-angle tangent t, `x <= cx + (cz - z) t` and its mirror image.
pub fn frame_points(
    points: impl Iterator<Item = DVec3> + Clone,
    toward_camera: DVec3,
    fov_y_rad: f64,
    size_px: UVec2,
) -> Option<Framing> {
    let basis = Camera::look_at(toward_camera, DVec3::ZERO, DVec3::Y, Projection::Perspective { fov_y_rad }, 1.0, 2.0);
    let view_from_world = basis.world_from_view.inverse();
    let aspect = f64::from(size_px.x) / f64::from(size_px.y);
    let tangent = DVec2::new(aspect, 1.0) * (0.5 * fov_y_rad).tan() * (1.0 - 2.0 * MARGIN);

    let (mut high, mut low) = (DVec2::NEG_INFINITY, DVec2::NEG_INFINITY);
    let (mut min, mut max) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for point in points.clone() {
        let p = view_from_world.transform_vector3(point);
        high = high.max(p.truncate() + p.z * tangent);
        low = low.max(-p.truncate() + p.z * tangent);
        (min, max) = (min.min(p), max.max(p));
    }
    if !(min.is_finite() && max.is_finite()) {
        return None;
    }
    let eye = (0.5 * (high - low)).extend(((high + low) / (2.0 * tangent)).max_element());
    let middle = 0.5 * (min.z + max.z);
    let target = basis.world_from_view.transform_vector3(eye.truncate().extend(middle));
    let radius_m = points.map(|point| point.distance(target)).fold(0.0, f64::max).max(1e-6);
    let extent = (max - min).truncate();
    let height_m = extent.y.max(extent.x / aspect) / (1.0 - 2.0 * MARGIN);
    // A single point has no size: any distance shows it.
    let distance_m = (eye.z - middle).max(1e-3 * radius_m);
    Some(Framing { target, distance_m, height_m: height_m.max(1e-6), radius_m })
}

/// Frames everything that is placed in `scene`; an empty scene is framed as a ball of one metre.
pub fn frame_scene(scene: &Scene, toward_camera: DVec3, fov_y_rad: f64, size_px: UVec2) -> Framing {
    frame_or_ball(&points_in_world(scene), toward_camera, fov_y_rad, size_px)
}

/// Frames all that `scene` shows while it turns about the vertical axis through `axis`, so that one distance does for a
/// whole turn.
pub fn frame_turning(scene: &Scene, axis: DVec3, toward_camera: DVec3, fov_y_rad: f64, size_px: UVec2) -> Framing {
    let swept = swept(&points_in_world(scene), axis);
    frame_or_ball(&swept, toward_camera, fov_y_rad, size_px)
}

/// The middle of the box around everything that is placed in `scene`; the origin where nothing is.
pub fn middle(scene: &Scene) -> DVec3 {
    let points = points_in_world(scene).into_iter();
    let (min, max) = points.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(min, max), p| (min.min(p), max.max(p)));
    let middle = 0.5 * (min + max);
    if middle.is_finite() { middle } else { DVec3::ZERO }
}

/// Slices of a turning body, and points around each.
const SLICES: usize = 64;
const AROUND: u32 = 48;

/// Points around the body that `points` fill when they turn about the vertical axis: each slice as its widest ring, drawn
/// around by a polygon.
fn swept(points: &[DVec3], axis: DVec3) -> Vec<DVec3> {
    let heights = points.iter().map(|point| point.y);
    let (low, high) = heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), y| (low.min(y), high.max(y)));
    let mut slices: [Option<(f64, f64, f64)>; SLICES] = [None; SLICES];
    for point in points {
        let share = (point.y - low) / (high - low).max(f64::MIN_POSITIVE);
        let slice = &mut slices[((share * SLICES as f64) as usize).min(SLICES - 1)];
        let radius = (point - axis).xz().length();
        let (y_low, y_high, widest) = slice.unwrap_or((point.y, point.y, radius));
        *slice = Some((y_low.min(point.y), y_high.max(point.y), widest.max(radius)));
    }
    // The corners of a polygon around a circle are farther out than that.
    let corner = 1.0 / (PI / f64::from(AROUND)).cos();
    let ring = |(y_low, y_high, radius): (f64, f64, f64)| {
        (0..AROUND).flat_map(move |k| {
            let (sin, cos) = (2.0 * PI * f64::from(k) / f64::from(AROUND)).sin_cos();
            [y_low, y_high].map(|y| DVec3::new(axis.x + sin * radius * corner, y, axis.z + cos * radius * corner))
        })
    };
    slices.into_iter().flatten().flat_map(ring).collect()
}

fn points_in_world(scene: &Scene) -> Vec<DVec3> {
    let instances = scene.instances();
    let of_instance = |instance: &super::Instance| {
        let primitives = scene.meshes[instance.mesh].primitives.iter();
        let positions = primitives.flat_map(|primitive| &primitive.positions);
        let place = |position: &Vec3| instance.world_from_object.transform_point3(position.as_dvec3());
        positions.map(place).collect::<Vec<_>>()
    };
    instances.iter().flat_map(of_instance).collect()
}

fn frame_or_ball(points: &[DVec3], toward_camera: DVec3, fov_y_rad: f64, size_px: UVec2) -> Framing {
    let ball = [DVec3::X, DVec3::NEG_X, DVec3::Y, DVec3::NEG_Y, DVec3::Z, DVec3::NEG_Z];
    frame_points(points.iter().copied(), toward_camera, fov_y_rad, size_px)
        .or_else(|| frame_points(ball.into_iter(), toward_camera, fov_y_rad, size_px))
        .unwrap_or(Framing { target: DVec3::ZERO, distance_m: 3.0, height_m: 2.0, radius_m: 1.0 })
}

/// A picture of the whole scene from the default orbit, on dark grey.
pub fn default_view(scene: &Scene, size_px: UVec2) -> View {
    let (theta_rad, phi_rad) = DEFAULT_ORBIT_RAD;
    let direction = orbit_direction(theta_rad, phi_rad);
    let framing = frame_scene(scene, direction, DEFAULT_FOV_RAD, size_px);
    let eye = framing.target + direction * framing.distance_m;
    let (near_m, far_m) = framing.near_far_m(eye);
    let projection = Projection::Perspective { fov_y_rad: DEFAULT_FOV_RAD };
    View {
        camera: Camera::look_at(eye, framing.target, DVec3::Y, projection, near_m, far_m),
        size_px,
        exposure_ev: 0.0,
        tone_map: ToneMap::default(),
        background: Background::Color(Vec3::splat(0.16)),
        background_blur: 0.0,
        energy_compensation: true,
        geometry: Geometry::default(),
        quality: Default::default(),
        term: None,
        channel: None,
    }
}

impl Framing {
    /// Near and far planes that suit a camera at `eye`.
    pub fn near_far_m(&self, eye: DVec3) -> (f64, f64) {
        near_far_m((self.target, self.radius_m), eye)
    }
}

/// Near and far planes that suit a camera at `eye` before a sphere with this centre and radius: the depth buffer is
/// reversed float, so near may be generous.
pub fn near_far_m((center, radius_m): (DVec3, f64), eye: DVec3) -> (f64, f64) {
    let distance = eye.distance(center);
    let near = (1e-3 * radius_m).max(0.5 * (distance - radius_m));
    (near, distance + 2.0 * radius_m)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_turning_body_is_in_every_picture_and_nearly_fills_one() {
        let points: Vec<DVec3> = (0..300)
            .map(|i| {
                let t = f64::from(i);
                DVec3::new((t * 1.3).sin() * 3.0 + 5.0, (t * 0.7).cos(), (t * 2.1).sin() * 0.5)
            })
            .collect();
        let axis = DVec3::new(5.0, 9.0, 0.0);
        for (phi, size) in [(1.5, UVec2::new(400, 300)), (0.3, UVec2::new(300, 400))] {
            let (direction, fov_y_rad) = (orbit_direction(0.4, phi), 0.7);
            let framing = frame_points(swept(&points, axis).into_iter(), direction, fov_y_rad, size).unwrap();
            let eye = framing.target + direction * framing.distance_m;
            let projection = Projection::Perspective { fov_y_rad };
            let camera = Camera::look_at(eye, framing.target, DVec3::Y, projection, 0.1, 100.0);
            let farthest = |turn: u32| {
                let camera = camera.turned(axis, f64::from(turn).to_radians());
                let clip_from_world = camera.clip_from_view(size).as_dmat4() * camera.world_from_view.inverse();
                let ndc = points.iter().map(|point| clip_from_world.project_point3(*point).truncate().abs());
                ndc.map(DVec2::max_element).fold(0.0, f64::max)
            };
            let worst = (0..360).step_by(5).map(farthest).fold(0.0, f64::max);
            assert!((0.8..=1.0 - 2.0 * MARGIN + 1e-9).contains(&worst), "{worst}");
        }
    }

    #[test]
    fn framed_points_touch_the_margin_and_none_is_outside() {
        let points: Vec<DVec3> = (0..200)
            .map(|i| {
                let t = f64::from(i);
                DVec3::new((t * 1.3).sin() * 3.0 + 5.0, (t * 0.7).cos(), (t * 2.1).sin() * 0.5)
            })
            .collect();
        for (theta, phi, size) in [(0.0, 1.5, (400, 300)), (2.0, 0.4, (300, 400)), (-1.0, 2.6, (500, 100))] {
            let (direction, size) = (orbit_direction(theta, phi), UVec2::new(size.0, size.1));
            let fov_y_rad = 0.7;
            let framing = frame_points(points.iter().copied(), direction, fov_y_rad, size).unwrap();
            let eye = framing.target + direction * framing.distance_m;
            let (near, far) = framing.near_far_m(eye);
            let camera =
                Camera::look_at(eye, framing.target, DVec3::Y, Projection::Perspective { fov_y_rad }, near, far);
            let clip_from_world = camera.clip_from_view(size).as_dmat4() * camera.world_from_view.inverse();
            let ndc = points.iter().map(|point| {
                let clip = clip_from_world * point.extend(1.0);
                assert!(clip.z <= clip.w, "a point is in front of the near plane");
                (clip.truncate().truncate() / clip.w).abs()
            });
            let reach = ndc.fold(DVec2::ZERO, DVec2::max);
            assert!((reach.max_element() - 0.9).abs() < 1e-3, "{reach}");
        }
    }

    #[test]
    fn orbit_angles_follow_the_convention() {
        assert!((orbit_direction(0.0, std::f64::consts::FRAC_PI_2) - DVec3::Z).length() < 1e-12);
        let right = orbit_direction(std::f64::consts::FRAC_PI_2, std::f64::consts::FRAC_PI_2);
        assert!((right - DVec3::X).length() < 1e-12);
    }
}
