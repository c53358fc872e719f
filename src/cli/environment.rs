//! Flags that light the scene from around.

use super::error::CliError;
use crate::bake::environment::{self, BakeOptions};
use crate::bake::studio;
use crate::import::environment_from_path;
use crate::progress::Progress;
use crate::scene::{Environment, EnvironmentImage, EnvironmentMaps, Quality, Scene};
use glam::Vec3;
use std::path::Path;

#[derive(Debug, clap::Args)]
#[command(next_help_heading = "Environment")]
pub(super) struct EnvironmentArgs {
    /// Panorama (.hdr or .exr), or one of: neutral (a built-in studio), white, black.
    #[arg(long, value_name = "FILE|neutral|white|black", default_value = "neutral")]
    pub(super) env: String,
    /// Turn the panorama about +Y.
    #[arg(long, value_name = "DEGREES", default_value_t = 0.0, allow_negative_numbers = true)]
    pub(super) env_rotation: f64,
    /// Scale its radiance.
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0)]
    pub(super) env_intensity: f64,
}

impl EnvironmentArgs {
    /// Whether the panorama is a file of the user's.
    pub(super) fn is_file(&self) -> bool {
        !matches!(self.env.as_str(), "neutral" | "white" | "black")
    }

    /// The environment, without the cost of one that is black.
    pub(super) fn load(&self) -> Result<Option<Environment>, CliError> {
        if !(self.env_rotation.is_finite() && self.env_intensity.is_finite() && self.env_intensity >= 0.0) {
            return Err(CliError::Usage(
                "--env-rotation and --env-intensity take finite numbers, the latter from 0 up".into(),
            ));
        }
        let image = match self.env.as_str() {
            "black" => return Ok(None),
            "white" => EnvironmentImage::constant(Vec3::ONE),
            "neutral" => studio::studio(),
            path => environment_from_path(Path::new(path))?,
        };
        let rotation_rad = self.env_rotation.to_radians();
        Ok(Some(Environment { rotation_rad, intensity: self.env_intensity, ..Environment::new(image) }))
    }
}

/// The prefiltered environment of the scene, if it lights anything.
pub(super) fn bake_maps(scene: &Scene, quality: Quality, progress: &dyn Progress) -> Option<EnvironmentMaps> {
    let options = BakeOptions { suns: quality.parts_suns(), ..Default::default() };
    let environment = scene.environment.as_ref().filter(|environment| environment.intensity > 0.0)?;
    Some(environment::bake(&environment.image, &options, progress))
}
