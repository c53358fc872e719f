//! Where the picture is taken from, and what moves it there: plain functions of numbers.

use super::state::CameraState;
use crate::scene::framing::{DEFAULT_ORBIT_RAD, Framing, frame_scene, near_far_m, orbit_direction};
use crate::scene::{Camera, Projection, Scene};
use glam::{DVec2, DVec3, UVec2};
use serde::{Deserialize, Serialize};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// A full turn is dragged across this many heights of the picture.
const TURN_HEIGHTS: f64 = 2.0;
/// The nearest that a camera gets to its target, as a share of the scene's radius.
const NEAREST: f64 = 1e-5;
/// The farthest, in the same unit.
const FARTHEST: f64 = 1e4;

/// A place to look from.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Pose {
    Orbit(Orbit),
    /// A camera of the file, by number.
    File(usize),
}

/// A camera that looks at a target, with the horizon level.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Orbit {
    /// In the world, metres.
    pub target: [f64; 3],
    /// About +Y, from +Z toward +X.
    pub theta_rad: f64,
    /// From +Y, in [0, pi].
    pub phi_rad: f64,
    /// From the target to the eye, metres.
    pub distance_m: f64,
}

/// What a camera has to know of a scene.
#[derive(Debug, Clone, PartialEq)]
pub struct Surroundings {
    /// Middle of the box around the scene, in the world, metres.
    pub center: DVec3,
    /// Of a ball about it that holds the scene, metres; above 0.
    pub radius_m: f64,
    /// Frames the whole scene in the picture that was opened first.
    pub home: Orbit,
    /// The cameras of the file.
    pub cameras: Vec<Camera>,
}

impl Surroundings {
    pub fn of(scene: &Scene, fov_rad: f64, size_px: UVec2) -> Self {
        let (theta_rad, phi_rad) = DEFAULT_ORBIT_RAD;
        let Framing { target, distance_m, .. } =
            frame_scene(scene, orbit_direction(theta_rad, phi_rad), fov_rad, size_px);
        let bounds = scene.bounds();
        let (center, radius_m) =
            if bounds.is_empty() { (DVec3::ZERO, 1.0) } else { (bounds.center(), 0.5 * bounds.diagonal()) };
        let home = Orbit { target: target.to_array(), theta_rad, phi_rad, distance_m };
        Self { center, radius_m: radius_m.max(1e-6), home, cameras: scene.cameras_in_world() }
    }

    fn limit_m(&self, distance_m: f64) -> f64 {
        distance_m.clamp(NEAREST * self.radius_m, FARTHEST * self.radius_m)
    }
}

/// Directions to look from that have a key.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    Front,
    Right,
    Top,
    Isometric,
    Default,
}

impl Side {
    /// Theta and phi.
    fn angles_rad(self) -> (f64, f64) {
        match self {
            Self::Front => (0.0, FRAC_PI_2),
            Self::Right => (FRAC_PI_2, FRAC_PI_2),
            Self::Top => (0.0, 0.0),
            // The three axes are equally long in the picture.
            Self::Isometric => (0.25 * PI, 2.0_f64.sqrt().atan()),
            Self::Default => DEFAULT_ORBIT_RAD,
        }
    }
}

impl Pose {
    pub fn is_valid(&self) -> bool {
        match self {
            Self::File(_) => true,
            Self::Orbit(Orbit { target, theta_rad, phi_rad, distance_m }) => {
                let numbers = [theta_rad, distance_m];
                target.iter().chain(numbers).all(|number| number.is_finite())
                    && (0.0..=PI).contains(phi_rad)
                    && *distance_m > 0.0
            }
        }
    }
}

impl Orbit {
    pub fn target(&self) -> DVec3 {
        DVec3::from_array(self.target)
    }

    /// Unit vector from the target to the eye.
    pub fn direction(&self) -> DVec3 {
        orbit_direction(self.theta_rad, self.phi_rad)
    }

    pub fn eye(&self) -> DVec3 {
        self.target() + self.direction() * self.distance_m
    }

    /// Upward in the picture; also where the camera looks straight down.
    fn up(&self) -> DVec3 {
        orbit_direction(self.theta_rad, self.phi_rad - FRAC_PI_2)
    }

    fn right(&self) -> DVec3 {
        self.up().cross(self.direction())
    }

    /// An orbit about a point before `eye`.
    fn looking(eye: DVec3, forward: DVec3, distance_m: f64) -> Self {
        let back = -forward;
        Self {
            target: (eye + forward * distance_m).to_array(),
            theta_rad: back.x.atan2(back.z),
            phi_rad: back.y.clamp(-1.0, 1.0).acos(),
            distance_m,
        }
    }
}

impl CameraState {
    fn fov_rad(&self) -> f64 {
        self.fov_deg.to_radians()
    }

    /// Height at the distance of the target that the picture shows, metres.
    fn height_m(&self, distance_m: f64) -> f64 {
        2.0 * distance_m * (0.5 * self.fov_rad()).tan()
    }

    /// The orbit that shows what the camera shows now.
    pub fn orbit(&self, around: &Surroundings) -> Orbit {
        match self.pose {
            Some(Pose::Orbit(orbit)) => orbit,
            Some(Pose::File(index)) => around.cameras.get(index).map_or(around.home, |camera| {
                let (eye, forward) = (camera.position_in_world(), camera.forward_in_world());
                // The point of the line of sight that is nearest to the middle of the scene.
                let along = (around.center - eye).dot(forward);
                let distance_m = if along > 0.0 { along } else { around.radius_m };
                Orbit::looking(eye, forward, around.limit_m(distance_m))
            }),
            None => around.home,
        }
    }

    fn at(&self, orbit: Orbit) -> Self {
        let phi_rad = orbit.phi_rad.clamp(0.0, PI);
        Self { pose: Some(Pose::Orbit(Orbit { phi_rad, theta_rad: orbit.theta_rad % TAU, ..orbit })), ..*self }
    }

    /// The camera for a picture.
    pub fn camera(&self, around: &Surroundings) -> Camera {
        if let Some(Pose::File(index)) = self.pose
            && let Some(camera) = around.cameras.get(index)
        {
            return camera.clone();
        }
        let orbit = self.orbit(around);
        let (near_m, far_m) = near_far_m((around.center, around.radius_m), orbit.eye());
        // Whoever looks at a detail is near to it: the depth buffer is reversed float and holds that too.
        let near_m = near_m.min(0.05 * orbit.distance_m);
        let projection = if self.orthographic {
            Projection::Orthographic { height_m: self.height_m(orbit.distance_m) }
        } else {
            Projection::Perspective { fov_y_rad: self.fov_rad() }
        };
        let near_m = if self.orthographic { near_m.min(orbit.distance_m - around.radius_m) } else { near_m };
        Camera::look_at(orbit.eye(), orbit.target(), orbit.up(), projection, near_m, far_m)
    }

    /// Turns about the target by a drag of so many pixels.
    pub fn turned(&self, around: &Surroundings, drag_px: DVec2, size_px: UVec2) -> Self {
        let orbit = self.orbit(around);
        let turn = TAU / (TURN_HEIGHTS * f64::from(size_px.y.max(1))) * drag_px;
        self.at(Orbit { theta_rad: orbit.theta_rad - turn.x, phi_rad: orbit.phi_rad - turn.y, ..orbit })
    }

    /// Turns about the eye.
    pub fn looked(&self, around: &Surroundings, drag_px: DVec2, size_px: UVec2) -> Self {
        let orbit = self.orbit(around);
        let turn = self.fov_rad() / f64::from(size_px.y.max(1)) * drag_px;
        let phi_rad = (orbit.phi_rad - turn.y).clamp(0.0, PI);
        let turned = Orbit { theta_rad: orbit.theta_rad - turn.x, phi_rad, ..orbit };
        let target = (orbit.eye() - turned.direction() * orbit.distance_m).to_array();
        self.at(Orbit { target, ..turned })
    }

    /// Moves so that the target follows a drag of so many pixels.
    pub fn panned(&self, around: &Surroundings, drag_px: DVec2, size_px: UVec2) -> Self {
        let orbit = self.orbit(around);
        let metres = self.height_m(orbit.distance_m) / f64::from(size_px.y.max(1)) * drag_px;
        let target = orbit.target() - orbit.right() * metres.x + orbit.up() * metres.y;
        self.at(Orbit { target: target.to_array(), ..orbit })
    }

    /// Multiplies the distance from the target; what is under `cursor_px` at the target's distance stays there.
    pub fn zoomed(&self, around: &Surroundings, factor: f64, cursor_px: DVec2, size_px: UVec2) -> Self {
        let orbit = self.orbit(around);
        let distance_m = around.limit_m(orbit.distance_m * factor);
        let factor = distance_m / orbit.distance_m;
        let from_center = (cursor_px - 0.5 * size_px.as_dvec2()) / f64::from(size_px.y.max(1));
        let metres = self.height_m(orbit.distance_m) * from_center;
        let offset = orbit.right() * metres.x - orbit.up() * metres.y;
        let target = orbit.target() + offset * (1.0 - factor);
        self.at(Orbit { target: target.to_array(), distance_m, ..orbit })
    }

    /// Looks at a point from where it looks at the target now, `closer` times as near.
    pub fn focused(&self, around: &Surroundings, point: DVec3, closer: f64) -> Self {
        let orbit = self.orbit(around);
        let distance_m = around.limit_m(orbit.distance_m / closer);
        self.at(Orbit { target: point.to_array(), distance_m, ..orbit })
    }

    /// Moves eye and target: rightward, upward and forward, in metres.
    pub fn flown(&self, around: &Surroundings, by_m: DVec3) -> Self {
        let orbit = self.orbit(around);
        let target = orbit.target() + orbit.right() * by_m.x + orbit.up() * by_m.y - orbit.direction() * by_m.z;
        self.at(Orbit { target: target.to_array(), ..orbit })
    }

    /// The whole scene from one side.
    pub fn from_side(&self, scene: &Scene, side: Side, size_px: UVec2) -> Self {
        let (theta_rad, phi_rad) = side.angles_rad();
        let framing = frame_scene(scene, orbit_direction(theta_rad, phi_rad), self.fov_rad(), size_px);
        let (target, mut distance_m) = (framing.target.to_array(), framing.distance_m);
        if self.orthographic {
            distance_m = framing.height_m / self.height_m(1.0);
        }
        self.at(Orbit { target, theta_rad, phi_rad, distance_m })
    }

    /// The next camera of the file, or the orbit again after the last one.
    pub fn next_of_file(&self, around: &Surroundings) -> Self {
        let next = match self.pose {
            Some(Pose::File(index)) => index + 1,
            _ => 0,
        };
        Self { pose: (next < around.cameras.len()).then_some(Pose::File(next)), ..*self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::shapes::sphere;
    use crate::scene::{Material, Mesh, Node};
    use glam::DMat4;

    const SIZE: UVec2 = UVec2::new(640, 480);

    /// A ball of the given size.
    fn scene(radius: f32) -> Scene {
        Scene {
            nodes: vec![Node { mesh: Some(0), parent_from_node: DMat4::IDENTITY, ..Node::default() }],
            roots: vec![0],
            meshes: vec![Mesh { name: None, primitives: vec![sphere(radius, 8, 0)] }],
            materials: vec![Material::default()],
            ..Scene::default()
        }
    }

    fn around(scene: &Scene) -> Surroundings {
        Surroundings::of(scene, CameraState::default().fov_deg.to_radians(), SIZE)
    }

    /// Where a point of the world is in the picture, in pixels, and whether it is beyond the near plane.
    fn pixel(camera: &Camera, point: DVec3) -> (DVec2, bool) {
        let clip = camera.clip_from_view(SIZE).as_dmat4() * camera.world_from_view.inverse() * point.extend(1.0);
        let ndc = clip.truncate() / clip.w;
        (DVec2::new(ndc.x + 1.0, 1.0 - ndc.y) * 0.5 * SIZE.as_dvec2(), ndc.z >= 0.0 && ndc.z <= 1.0)
    }

    #[test]
    fn watch_parts_and_terrains_are_before_the_near_plane() {
        for radius in [5e-4_f32, 1.0, 5e3] {
            let scene = scene(radius);
            let around = around(&scene);
            for orthographic in [false, true] {
                let mut state = CameraState { orthographic, ..CameraState::default() };
                for side in [Side::Default, Side::Front, Side::Right, Side::Top, Side::Isometric] {
                    state = state.from_side(&scene, side, SIZE);
                    let surface = state.orbit(&around).direction() * f64::from(radius);
                    let (center, seen) = pixel(&state.camera(&around), surface);
                    assert!(seen, "{radius} m from {side:?}: the surface is cut away");
                    assert!((center - 0.5 * SIZE.as_dvec2()).length() < 8.0, "{side:?}: {center}");
                }
            }
        }
    }

    #[test]
    fn zooming_keeps_what_is_under_the_cursor() {
        let scene = scene(1.0);
        let around = around(&scene);
        for orthographic in [false, true] {
            let state = CameraState { orthographic, ..CameraState::default() };
            let cursor = DVec2::new(500.0, 90.0);
            let before = state.orbit(&around);
            let (origin, direction) = state.camera(&around).ray(cursor, SIZE);
            let along = (before.target() - origin).dot(before.direction()) / direction.dot(before.direction());
            let point = origin + along * direction;
            let zoomed = state.zoomed(&around, 0.5, cursor, SIZE);
            let (after, _) = pixel(&zoomed.camera(&around), point);
            assert!((after - cursor).length() < 1e-3, "{orthographic}: {after}");
            assert!((zoomed.orbit(&around).distance_m / before.distance_m - 0.5).abs() < 1e-12);
        }
    }

    #[test]
    fn panning_takes_the_target_along_and_turning_keeps_it() {
        let scene = scene(1.0);
        let (around, state) = (around(&scene), CameraState::default());
        let target = state.orbit(&around).target();
        let (before, _) = pixel(&state.camera(&around), target);
        let drag = DVec2::new(40.0, -25.0);
        let (after, _) = pixel(&state.panned(&around, drag, SIZE).camera(&around), target);
        assert!((after - before - drag).length() < 1e-3, "{after}");
        let turned = state.turned(&around, DVec2::new(1000.0, 5000.0), SIZE);
        let (after, _) = pixel(&turned.camera(&around), target);
        assert!((after - before).length() < 1e-3, "{after}");
        assert!(turned.pose.unwrap().is_valid(), "{turned:?}");
    }

    #[test]
    fn flying_turns_about_the_eye_and_moves_it() {
        let scene = scene(1.0);
        let (around, state) = (around(&scene), CameraState::default());
        let eye = state.orbit(&around).eye();
        let looked = state.looked(&around, DVec2::new(30.0, -60.0), SIZE);
        assert!((looked.orbit(&around).eye() - eye).length() < 1e-12);
        let flown = state.flown(&around, DVec3::new(0.0, 0.0, 0.5));
        let moved = flown.orbit(&around).eye() - eye;
        assert!((moved + 0.5 * state.orbit(&around).direction()).length() < 1e-12);
    }

    #[test]
    fn cameras_of_the_file_come_in_turn_and_can_be_left() {
        let mut scene = scene(1.0);
        let eye = DVec3::new(0.0, 1.0, 6.0);
        let projection = Projection::Perspective { fov_y_rad: 0.5 };
        scene.cameras.push(Camera::look_at(DVec3::ZERO, DVec3::NEG_Z, DVec3::Y, projection, 0.1, 10.0));
        let at = DMat4::from_translation(eye);
        scene.nodes.push(Node { camera: Some(0), parent_from_node: at, ..Node::default() });
        scene.roots.push(1);
        let around = around(&scene);
        let first = CameraState::default().next_of_file(&around);
        assert_eq!(first.pose, Some(Pose::File(0)));
        assert_eq!(first.camera(&around).position_in_world(), eye);
        let left = first.zoomed(&around, 1.0, 0.5 * SIZE.as_dvec2(), SIZE);
        assert!((left.orbit(&around).eye() - eye).length() < 1e-9);
        assert_eq!(first.next_of_file(&around).pose, None);
    }
}
