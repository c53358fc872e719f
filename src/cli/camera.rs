//! Flags that place the camera.

use super::error::CliError;
use crate::scene::framing::{
    DEFAULT_FOV_RAD, DEFAULT_ORBIT_RAD, Framing, frame_scene, frame_turning, middle, orbit_direction,
};
use crate::scene::{Camera, Projection, Scene};
use glam::{DVec3, UVec2};
use std::str::FromStr;

#[derive(Debug, clap::Args)]
#[command(next_help_heading = "Camera")]
pub(super) struct CameraArgs {
    /// auto frames the whole scene; a number or a name picks a camera of the file.
    #[arg(long, value_name = "auto|N|NAME", default_value = "auto")]
    camera: String,
    /// Stand on an orbit: THETA turns about +Y from +Z toward +X, PHI is measured from +Y, RADIUS is in metres or in
    /// percent of the distance that frames the scene.
    #[arg(long, value_name = "THETA,PHI[,RADIUS]", allow_hyphen_values = true)]
    orbit: Option<Orbit>,
    /// The point to orbit, instead of the middle of the scene.
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true)]
    target: Option<Point>,
    /// Stand here.
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, conflicts_with = "orbit")]
    eye: Option<Point>,
    /// Look here, from --eye.
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, requires = "eye")]
    look_at: Option<Point>,
    /// Vertical field of view.
    #[arg(long, value_name = "DEGREES")]
    fov: Option<f64>,
    /// Orthographic projection; HEIGHT of the picture in metres, or all of the scene.
    #[arg(long, value_name = "HEIGHT", num_args = 0..=1, default_missing_value = "0", conflicts_with = "fov")]
    ortho: Option<f64>,
}

/// Three numbers separated by commas.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Point(pub(super) DVec3);

impl FromStr for Point {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers = numbers(text)?;
        match numbers[..] {
            [x, y, z] => Ok(Self(DVec3::new(x, y, z))),
            _ => Err(format!("expected three numbers X,Y,Z, found {}", numbers.len())),
        }
    }
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Radius {
    Meters(f64),
    OfFraming(f64),
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct Orbit {
    theta_rad: f64,
    phi_rad: f64,
    radius: Radius,
}

impl FromStr for Orbit {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let mut parts = text.splitn(3, ',');
        let mut angle = |name| -> Result<f64, String> {
            let part = parts.next().ok_or_else(|| format!("{name} is missing"))?;
            Ok(number(part)?.to_radians())
        };
        let (theta_rad, phi_rad) = (angle("THETA")?, angle("PHI")?);
        let radius = match parts.next().map(str::trim) {
            None => Radius::OfFraming(1.0),
            Some(part) => match part.strip_suffix('%') {
                Some(percent) => Radius::OfFraming(number(percent)? / 100.0),
                None => Radius::Meters(number(part)?),
            },
        };
        let (Radius::Meters(size) | Radius::OfFraming(size)) = radius;
        if size > 0.0 { Ok(Self { theta_rad, phi_rad, radius }) } else { Err("RADIUS must be above 0".into()) }
    }
}

/// A finite number, spaces around it allowed.
pub(super) fn number(text: &str) -> Result<f64, String> {
    let text = text.trim();
    match text.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        _ => Err(format!("`{text}` is not a finite number")),
    }
}

fn numbers(text: &str) -> Result<Vec<f64>, String> {
    text.split(',').map(number).collect()
}

impl CameraArgs {
    /// What stands for the camera in names of files.
    pub(super) fn name(&self) -> &str {
        match (self.orbit, self.eye) {
            _ if self.camera != "auto" => &self.camera,
            (Some(_), _) => "orbit",
            (_, Some(_)) => "eye",
            (None, None) => "auto",
        }
    }

    /// The camera for a picture of `size_px`. On a turntable it has turned by `turn_rad` about the vertical axis through
    /// the point that it orbits, counter-clockwise from above, and is where all turns have the whole scene in the picture.
    ///
    /// # Errors
    /// When a flag is out of range, or the file has no such camera.
    pub(super) fn camera(&self, scene: &Scene, size_px: UVec2, turn_rad: Option<f64>) -> Result<Camera, CliError> {
        self.check()?;
        let point = |point: Option<Point>| point.map(|Point(point)| point);
        let axis = || point(self.target).or(point(self.look_at)).unwrap_or_else(|| middle(scene));
        let turned = turn_rad.map(|angle_rad| (axis(), angle_rad));
        let camera = if self.camera == "auto" {
            self.placed(scene, size_px, turned.map(|(axis, _)| axis))?
        } else {
            self.camera_of_file(scene)?
        };
        Ok(match turned {
            Some((axis, angle_rad)) => camera.turned(axis, angle_rad),
            None => camera,
        })
    }

    /// A camera that no file has; before an axis it is far enough away for all turns about that.
    fn placed(&self, scene: &Scene, size_px: UVec2, axis: Option<DVec3>) -> Result<Camera, CliError> {
        let fov_y_rad = self.fov.map_or(DEFAULT_FOV_RAD, f64::to_radians);
        let (theta_rad, phi_rad) = DEFAULT_ORBIT_RAD;
        let default = Orbit { theta_rad, phi_rad, radius: Radius::OfFraming(1.0) };
        let orbit = self.orbit.unwrap_or(default);
        let direction = orbit_direction(orbit.theta_rad, orbit.phi_rad);
        let framing = match axis {
            Some(axis) => frame_turning(scene, axis, direction, fov_y_rad, size_px),
            None => frame_scene(scene, direction, fov_y_rad, size_px),
        };
        let (eye, target) = match self.eye {
            Some(Point(eye)) => (eye, self.look_at.map_or(framing.target, |Point(at)| at)),
            None => {
                let target = self.target.map_or(framing.target, |Point(at)| at);
                let distance = match orbit.radius {
                    Radius::Meters(meters) => meters,
                    Radius::OfFraming(share) => share * framing.distance_m,
                };
                (target + direction * distance, target)
            }
        };
        if eye == target {
            return Err(CliError::Usage("--eye and --look-at are the same point; move one of them".into()));
        }
        Ok(self.place(&framing, eye, target, fov_y_rad))
    }

    fn place(&self, framing: &Framing, eye: DVec3, target: DVec3, fov_y_rad: f64) -> Camera {
        let (near, far) = framing.near_far_m(eye);
        let projection = match self.ortho {
            None => Projection::Perspective { fov_y_rad },
            Some(0.0) => Projection::Orthographic { height_m: framing.height_m },
            Some(height_m) => Projection::Orthographic { height_m },
        };
        // Looking straight up or down, the top of the picture is where the camera would come from.
        let along = (target - eye).normalize();
        let up = if along.y.abs() > 1.0 - 1e-9 { DVec3::Z * along.y.signum() } else { DVec3::Y };
        Camera::look_at(eye, target, up, projection, near, far)
    }

    fn check(&self) -> Result<(), CliError> {
        if self.fov.is_some_and(|fov| !(fov > 0.0 && fov < 180.0)) {
            return Err(CliError::Usage("--fov takes degrees between 0 and 180".into()));
        }
        if self.ortho.is_some_and(|height| !(height >= 0.0 && height.is_finite())) {
            return Err(CliError::Usage("--ortho takes a height above 0 in metres".into()));
        }
        Ok(())
    }

    fn camera_of_file(&self, scene: &Scene) -> Result<Camera, CliError> {
        let cameras = scene.cameras_in_world();
        let by_number = self.camera.parse::<usize>().ok().and_then(|index| cameras.get(index));
        let by_name = || cameras.iter().find(|camera| camera.name.as_deref() == Some(self.camera.as_str()));
        by_number.or_else(by_name).cloned().ok_or_else(|| {
            let names = cameras.iter().enumerate();
            let names: Vec<String> = names
                .map(|(index, camera)| format!("{index} ({})", camera.name.as_deref().unwrap_or("unnamed")))
                .collect();
            let found =
                if names.is_empty() { "the file has none".into() } else { format!("it has {}", names.join(", ")) };
            CliError::Usage(format!("--camera {}: no such camera in the file; {found}; or use auto", self.camera))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn orbits_parse() {
        let orbit: Orbit = "30,75,105%".parse().unwrap();
        assert_eq!(orbit.radius, Radius::OfFraming(1.05));
        assert_eq!("0,90,3".parse::<Orbit>().unwrap().radius, Radius::Meters(3.0));
        assert_eq!("0,90".parse::<Orbit>().unwrap().radius, Radius::OfFraming(1.0));
        for bad in ["", "1", "1,x", "1,2,0", "1,2,-5%", "nan,1", "1,2,3,4"] {
            assert!(bad.parse::<Orbit>().is_err(), "{bad}");
        }
    }

    #[test]
    fn points_parse() {
        assert_eq!("1, -2.5,3e2".parse::<Point>().unwrap(), Point(DVec3::new(1.0, -2.5, 300.0)));
        assert!("1,2".parse::<Point>().unwrap_err().contains("three"));
        assert!("1,2,inf".parse::<Point>().is_err());
    }
}
