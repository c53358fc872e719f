//! What is looked at: a model, its materials, and the light on it.

use super::environment::{CacheArgs, EnvironmentArgs};
use super::error::CliError;
use super::light::LightArgs;
use super::overrides;
use super::parallel::beside;
use super::stats::Stopwatch;
use crate::import::{Choice, ImportOptions, Imported, model_from_path, model_from_slice};
use crate::progress::Progress;
use crate::scene::{Environment, Scene};
use std::io::Read;
use std::path::{Path, PathBuf};

#[derive(Debug, PartialEq, clap::Args)]
pub(super) struct SubjectArgs {
    /// glTF model (.gltf or .glb); - reads it from stdin.
    #[arg(required = true)]
    model: Option<PathBuf>,
    /// Which scene of the file, by number or name, instead of its default.
    #[arg(long, value_name = "N|NAME")]
    scene: Option<String>,
    /// Which variant of its materials (KHR_materials_variants), by number or name, instead of those without any.
    #[arg(long, value_name = "N|NAME")]
    variant: Option<String>,
    /// Set a number of materials: their name or index (* stands for any text), a parameter, and its value. A disney.*
    /// parameter turns a material into a Disney one; colours are #rrggbb or r,g,b; a texture of the parameter goes.
    #[arg(long = "override", value_name = "NAME.PARAMETER=VALUE")]
    overrides: Vec<String>,
    #[command(flatten)]
    environment: EnvironmentArgs,
    #[command(flatten)]
    lights: LightArgs,
}

/// A scene with its lights and environment, and the file that it comes from.
pub(super) struct Loaded {
    pub(super) scene: Scene,
    pub(super) warnings: Vec<String>,
    pub(super) scene_names: Vec<Option<String>>,
    pub(super) scene_index: Option<usize>,
    pub(super) variant_names: Vec<String>,
    pub(super) extensions_used: Vec<String>,
}

impl SubjectArgs {
    /// The file that was named.
    pub(super) fn given_model(&self) -> Option<&Path> {
        self.model.as_deref()
    }

    /// The file; stdin where none was named.
    pub(super) fn model(&self) -> &Path {
        self.given_model().unwrap_or(Path::new("-"))
    }

    /// Whether the panorama is a file of the user's.
    pub(super) fn has_panorama(&self) -> bool {
        self.environment.is_file()
    }

    /// Whether prefiltered panoramas are kept.
    pub(super) fn cache(&self) -> &CacheArgs {
        &self.environment.cache
    }

    /// Whether the lights that were asked for are such, of which the flags' types know nothing.
    ///
    /// # Errors
    /// One line with the first that is none.
    pub(super) fn check_lights(&self) -> Result<(), CliError> {
        self.lights.parse().map(drop)
    }

    /// Keeps prefiltered panoramas as `cache` says.
    pub(super) fn set_cache(&mut self, cache: &CacheArgs) {
        self.environment.cache = cache.clone();
    }

    /// Whether the other has the same model, materials and lights, whatever its surroundings.
    pub(super) fn has_model_of(&self, other: &Self) -> bool {
        self.model == other.model
            && self.scene == other.scene
            && self.variant == other.variant
            && self.overrides == other.overrides
            && self.lights == other.lights
    }

    /// All flags but the model, as text: the same text is the same picture of the same files.
    pub(super) fn settings(&self) -> String {
        let Self { scene, variant, overrides, environment, lights, .. } = self;
        let surroundings = (&environment.env, environment.env_rotation, environment.env_intensity);
        format!("{scene:?} {variant:?} {overrides:?} {surroundings:?} {lights:?}")
    }

    /// What lights the scene from around, without the rest.
    ///
    /// # Errors
    /// When a flag is out of range, or the panorama cannot be read.
    pub(super) fn load_environment(&self) -> Result<Option<Environment>, CliError> {
        self.environment.load()
    }

    /// What lights the scene from around, as it was asked for: a file, or the name of a built-in environment.
    pub(super) fn environment_source(&self) -> &str {
        &self.environment.env
    }

    /// What lights the scene from around, as it was asked for, without the folder of a file.
    pub(super) fn environment_name(&self) -> &str {
        let name = Path::new(&self.environment.env).file_name().and_then(|name| name.to_str());
        name.unwrap_or(&self.environment.env)
    }

    /// The scene with its lights and environment, and what is to be warned of. Textures that its materials never sample
    /// are left out.
    ///
    /// # Errors
    /// When a flag is malformed, or the model or the panorama cannot be read.
    pub(super) fn load(&self, progress: &dyn Progress, watch: &Stopwatch) -> Result<(Scene, Vec<String>), CliError> {
        // An override may have a use for what was not sampled before it.
        let sampled_textures_only = self.overrides.is_empty();
        let Loaded { scene, warnings, .. } = self.load_textures(sampled_textures_only, progress, watch)?;
        Ok((scene, warnings))
    }

    /// The same with all textures that the materials have, and what the file says of itself.
    ///
    /// # Errors
    /// As [`Self::load`].
    pub(super) fn load_with_file(&self, progress: &dyn Progress, watch: &Stopwatch) -> Result<Loaded, CliError> {
        self.load_textures(false, progress, watch)
    }

    fn load_textures(
        &self,
        sampled_textures_only: bool,
        progress: &dyn Progress,
        watch: &Stopwatch,
    ) -> Result<Loaded, CliError> {
        let lights = self.lights.parse()?;
        let (imported, environment) = beside(
            || watch.time("decode", || self.import(sampled_textures_only, progress)),
            || watch.time("environment decode", || self.environment.load()),
        );
        let Imported { mut scene, warnings, scene_names, scene_index, variant_names, extensions_used } = imported?;
        let mut warnings: Vec<String> = warnings.iter().map(ToString::to_string).collect();
        overrides::apply(&mut scene, &self.overrides)?;
        scene.environment = environment?;
        for light in lights {
            warnings.extend(light.note);
            scene.add_light(light.light, light.position_in_world, light.direction_in_world);
        }
        Ok(Loaded { scene, warnings, scene_names, scene_index, variant_names, extensions_used })
    }

    fn import(&self, sampled_textures_only: bool, progress: &dyn Progress) -> Result<Imported, CliError> {
        let [scene, variant] = [&self.scene, &self.variant].map(|wish| {
            wish.as_ref().map(|wish| wish.parse().map_or_else(|_| Choice::Name(wish.clone()), Choice::Index))
        });
        load_model(
            self.model(),
            &ImportOptions { scene, variant, sampled_textures_only, progress, ..Default::default() },
        )
    }
}

/// The model of a file, or of stdin for `-`.
pub(super) fn load_model(path: &Path, options: &ImportOptions<'_>) -> Result<Imported, CliError> {
    if path != Path::new("-") {
        return Ok(model_from_path(path, options)?);
    }
    let mut bytes = Vec::new();
    let read = std::io::stdin().lock().read_to_end(&mut bytes);
    read.map_err(|error| CliError::Usage(format!("stdin: cannot read the model: {error}")))?;
    Ok(model_from_slice(&bytes, "stdin", None, options)?)
}
