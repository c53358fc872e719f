//! Flags that light the scene from around.

use super::error::CliError;
use crate::app::{environment_image, is_file};
use crate::bake::environment::{self, BakeOptions};
use crate::cache::{EnvironmentCache, Outcome};
use crate::progress::Progress;
use crate::scene::{Environment, EnvironmentImage, EnvironmentMaps, Quality, Scene};

#[derive(Debug, PartialEq, clap::Args)]
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
    #[command(flatten)]
    pub(super) cache: CacheArgs,
}

#[derive(Debug, Clone, Default, PartialEq, Eq, clap::Args)]
pub(super) struct CacheArgs {
    /// Prefilter the panorama anew, and keep nothing of it for the next time. The files that are kept are in the folder that
    /// SPECULA_CACHE_DIR names, or else in the system's place for caches.
    #[arg(long)]
    no_cache: bool,
}

/// A prefiltered environment, and what the cache had to do with it.
#[derive(Debug)]
pub(super) struct BakedEnvironment {
    pub(super) maps: EnvironmentMaps,
    pub(super) cache: CacheUse,
}

/// For people and for `--stats`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum CacheUse {
    Hit,
    Stored,
    /// Not wanted.
    Off,
    /// Wanted, and not possible for this reason.
    Unavailable(String),
}

impl CacheUse {
    pub(super) fn name(&self) -> &'static str {
        match self {
            Self::Hit => "hit",
            Self::Stored => "stored",
            Self::Off => "off",
            Self::Unavailable(_) => "unavailable",
        }
    }
}

impl From<Outcome> for CacheUse {
    fn from(outcome: Outcome) -> Self {
        match outcome {
            Outcome::Hit => Self::Hit,
            Outcome::Stored => Self::Stored,
            Outcome::Unavailable(reason) => Self::Unavailable(reason),
        }
    }
}

impl EnvironmentArgs {
    /// Whether the panorama is a file of the user's.
    pub(super) fn is_file(&self) -> bool {
        is_file(&self.env)
    }

    /// The environment, without the cost of one that is black.
    pub(super) fn load(&self) -> Result<Option<Environment>, CliError> {
        if !(self.env_rotation.is_finite() && self.env_intensity.is_finite() && self.env_intensity >= 0.0) {
            return Err(CliError::Usage(
                "--env-rotation and --env-intensity take finite numbers, the latter from 0 up".into(),
            ));
        }
        let Some(image) = environment_image(&self.env)? else { return Ok(None) };
        let rotation_rad = self.env_rotation.to_radians();
        Ok(Some(Environment { rotation_rad, intensity: self.env_intensity, ..Environment::new(image) }))
    }
}

/// The prefiltered environment of the scene, if it lights anything.
pub(super) fn bake_maps(
    scene: &Scene,
    quality: Quality,
    cache: &CacheArgs,
    progress: &dyn Progress,
) -> Option<BakedEnvironment> {
    let options = BakeOptions { suns: quality.parts_suns(), ..Default::default() };
    Some(bake_with(&scene.lit_environment()?.image, &options, cache, progress))
}

/// A panorama prefiltered within `options`, from the cache where that is wanted and possible.
pub(super) fn bake_with(
    image: &EnvironmentImage,
    options: &BakeOptions,
    cache: &CacheArgs,
    progress: &dyn Progress,
) -> BakedEnvironment {
    let without = |cache| BakedEnvironment { maps: environment::bake(image, options, progress), cache };
    match EnvironmentCache::of_user() {
        _ if cache.no_cache => without(CacheUse::Off),
        None => without(CacheUse::Unavailable("neither SPECULA_CACHE_DIR nor a home folder is set".into())),
        Some(cache) => {
            let (maps, outcome) = cache.bake(image, options, progress);
            BakedEnvironment { maps, cache: outcome.into() }
        }
    }
}
