//! Cameras: where the picture is taken from.

use glam::{DMat4, DVec2, DVec3, Mat4, UVec2};

/// How directions map to the picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Projection {
    /// `fov_y_rad`: full vertical angle. The far plane is at infinity.
    Perspective { fov_y_rad: f64 },
    /// `height_m`: vertical extent of the picture, in metres.
    Orthographic { height_m: f64 },
}

/// A camera of the file or of the user, without a place. It looks down its local -Z, +Y is up in the picture.
#[derive(Debug, Clone, PartialEq)]
pub struct Camera {
    pub name: Option<String>,
    pub projection: Projection,
    /// Distance of the near plane, metres; above 0 for perspective cameras.
    pub near_m: f64,
    /// Distance of the far plane, metres; used by orthographic cameras only.
    pub far_m: f64,
    /// Rigid transform: rotation and translation only.
    pub world_from_view: DMat4,
}

impl Camera {
    /// A camera at `eye` that looks at `target`. Any `up` works: one parallel to the line of sight is replaced.
    pub fn look_at(eye: DVec3, target: DVec3, up: DVec3, projection: Projection, near_m: f64, far_m: f64) -> Self {
        let backward = (eye - target).normalize_or(DVec3::Z);
        let right = up.cross(backward).normalize_or_zero();
        let right = if right == DVec3::ZERO { backward.any_orthonormal_vector() } else { right };
        let up = backward.cross(right);
        let world_from_view =
            DMat4::from_cols(right.extend(0.0), up.extend(0.0), backward.extend(0.0), eye.extend(1.0));
        Self { name: None, projection, near_m, far_m, world_from_view }
    }

    /// The same camera after a turn about the vertical axis through `axis`, counter-clockwise from above: from +Z toward
    /// +X.
    pub fn turned(&self, axis: DVec3, angle_rad: f64) -> Self {
        let turn = DMat4::from_translation(axis) * DMat4::from_rotation_y(angle_rad) * DMat4::from_translation(-axis);
        Self { world_from_view: turn * self.world_from_view, ..self.clone() }
    }

    pub fn position_in_world(&self) -> DVec3 {
        self.world_from_view.w_axis.truncate()
    }

    /// Unit vector along the line of sight.
    pub fn forward_in_world(&self) -> DVec3 {
        -self.world_from_view.z_axis.truncate()
    }

    /// Projection into WebGPU clip space with reversed depth: 1 at the near plane, 0 at infinity (perspective) or at the
    /// far plane (orthographic).
    pub fn clip_from_view(&self, size_px: UVec2) -> Mat4 {
        let aspect = f64::from(size_px.x) / f64::from(size_px.y);
        let clip_from_view = match self.projection {
            Projection::Perspective { fov_y_rad } => {
                let f = 1.0 / (0.5 * fov_y_rad).tan();
                DMat4::from_cols_array(&[
                    f / aspect,
                    0.,
                    0.,
                    0., //
                    0.,
                    f,
                    0.,
                    0., //
                    0.,
                    0.,
                    0.,
                    -1., //
                    0.,
                    0.,
                    self.near_m,
                    0.,
                ])
            }
            Projection::Orthographic { height_m } => {
                let depth = 1.0 / (self.far_m - self.near_m);
                DMat4::from_cols_array(&[
                    2.0 / (height_m * aspect),
                    0.,
                    0.,
                    0., //
                    0.,
                    2.0 / height_m,
                    0.,
                    0., //
                    0.,
                    0.,
                    depth,
                    0., //
                    0.,
                    0.,
                    self.far_m * depth,
                    1.,
                ])
            }
        };
        clip_from_view.as_mat4()
    }

    /// The ray through a point of the picture: `(origin, unit direction)` in world space.
    ///
    /// `pixel` counts from the top left corner, in pixels; (0.5, 0.5) is the centre of the first one.
    pub fn ray(&self, pixel: DVec2, size_px: UVec2) -> (DVec3, DVec3) {
        let size = size_px.as_dvec2();
        let ndc = DVec2::new(2.0 * pixel.x / size.x - 1.0, 1.0 - 2.0 * pixel.y / size.y);
        let aspect = size.x / size.y;
        let (origin, direction) = match self.projection {
            Projection::Perspective { fov_y_rad } => {
                let t = (0.5 * fov_y_rad).tan();
                (DVec3::ZERO, DVec3::new(ndc.x * t * aspect, ndc.y * t, -1.0))
            }
            Projection::Orthographic { height_m } => {
                (DVec3::new(ndc.x * 0.5 * height_m * aspect, ndc.y * 0.5 * height_m, 0.0), DVec3::NEG_Z)
            }
        };
        let direction = self.world_from_view.transform_vector3(direction).normalize();
        (self.world_from_view.transform_point3(origin), direction)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rays_project_back_to_their_pixel() {
        let size = UVec2::new(640, 360);
        for projection in [Projection::Perspective { fov_y_rad: 0.8 }, Projection::Orthographic { height_m: 3.0 }] {
            let camera =
                Camera::look_at(DVec3::new(3.0, 2.0, 5.0), DVec3::new(0.1, 0.2, 0.3), DVec3::Y, projection, 0.1, 100.0);
            let clip_from_world = camera.clip_from_view(size).as_dmat4() * camera.world_from_view.inverse();
            for pixel in [DVec2::new(0.5, 0.5), DVec2::new(320.0, 180.0), DVec2::new(600.25, 20.75)] {
                let (origin, direction) = camera.ray(pixel, size);
                let clip = clip_from_world * (origin + 4.0 * direction).extend(1.0);
                let ndc = clip.truncate() / clip.w;
                let back = DVec2::new((ndc.x + 1.0) * 0.5 * 640.0, (1.0 - ndc.y) * 0.5 * 360.0);
                assert!((back - pixel).length() < 1e-3, "{projection:?}: {pixel} came back as {back}");
                assert!(ndc.z > 0.0 && ndc.z < 1.0, "{projection:?}: depth {}", ndc.z);
            }
        }
    }
}
