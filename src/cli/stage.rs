//! Pictures of many views on one device. What consecutive ones share is loaded once.

use super::environment::{CacheArgs, bake_maps};
use super::error::CliError;
use super::shot::Shot;
use super::stats::Stopwatch;
use super::subject::SubjectArgs;
use crate::app::{in_units, light_furnace, picture};
use crate::capture::{CaptureError, CaptureOptions, CaptureTarget, CapturedFrame, Wanted, submit};
use crate::gpu::{Gpu, Uploads};
use crate::gpu_scene::GpuScene;
use crate::import::model_files;
use crate::progress::Progress;
use crate::renderer::{PathChoice, Renderer};
use crate::scene::{Channel, EnvironmentMaps, RadianceImage, Scene, View};
use glam::UVec2;
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::rc::Rc;

/// Prefiltered environments that are kept for later pictures, of some 25 MB each.
const MAPS_KEPT: usize = 4;

/// A device, and what was loaded for the last picture.
pub(super) struct Stage<'a> {
    gpu: &'a Gpu,
    cache: &'a CacheArgs,
    pub(super) progress: &'a dyn Progress,
    renderer: Renderer,
    subject: Option<(&'a SubjectArgs, Subject)>,
    maps: Vec<((String, bool), Rc<EnvironmentMaps>)>,
    target: Option<((UVec2, CaptureOptions), CaptureTarget)>,
    hashes: HashMap<PathBuf, [u8; 32]>,
}

/// A scene with its light, and what the device has of it.
struct Subject {
    scene: Scene,
    hash: String,
    uploaded: Vec<(Uploaded, GpuScene)>,
}

/// How a scene is on the device.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Uploaded {
    /// Suns are parted from the environment.
    suns: bool,
    /// More than the forward path can be taken.
    paths: bool,
    /// A white environment stands in for one that is missing.
    white: bool,
}

impl<'a> Stage<'a> {
    pub(super) fn new(gpu: &'a Gpu, cache: &'a CacheArgs, progress: &'a dyn Progress) -> Self {
        let renderer = Renderer::new(&gpu.device, &gpu.queue).with_uploads(Uploads::Bounded);
        Self { gpu, cache, progress, renderer, subject: None, maps: Vec::new(), target: None, hashes: HashMap::new() }
    }

    /// Loads the model and its light, unless that is what the picture before had.
    ///
    /// # Errors
    /// When one of them cannot be read.
    pub(super) fn load(&mut self, args: &'a SubjectArgs) -> Result<(), CliError> {
        if self.subject.as_ref().is_some_and(|(loaded, _)| *loaded == args) {
            return Ok(());
        }
        // Its memory before that of the next.
        let scene = match self.subject.take() {
            Some((loaded, subject)) if loaded.has_model_of(args) => {
                Scene { environment: args.load_environment()?, ..subject.scene }
            }
            before => {
                drop(before);
                args.load(self.progress, &Stopwatch::default())?.0
            }
        };
        let hash = self.hash(args)?;
        self.subject = Some((args, Subject { scene, hash, uploaded: Vec::new() }));
        Ok(())
    }

    /// BLAKE3 of the hashes of all files in turn, or of the name of a built-in environment.
    fn hash(&mut self, args: &SubjectArgs) -> Result<String, CliError> {
        let mut hasher = blake3::Hasher::new();
        for file in model_files(args.model())? {
            hasher.update(&self.hash_of_file(&file)?);
        }
        let environment = args.environment_source();
        if args.has_panorama() {
            hasher.update(&self.hash_of_file(Path::new(environment))?);
        } else {
            hasher.update(environment.as_bytes());
        }
        Ok(hasher.finalize().to_hex().to_string())
    }

    /// BLAKE3 of a file, read once.
    ///
    /// # Errors
    /// When it cannot be read.
    pub(super) fn hash_of_file(&mut self, path: &Path) -> Result<[u8; 32], CliError> {
        if let Some(hash) = self.hashes.get(path) {
            return Ok(*hash);
        }
        let bytes = std::fs::read(path)
            .map_err(|error| CliError::Usage(format!("{}: cannot be read: {error}", path.display())))?;
        let hash = *blake3::hash(&bytes).as_bytes();
        self.hashes.insert(path.to_owned(), hash);
        Ok(hash)
    }

    /// The scene that is loaded.
    ///
    /// # Errors
    /// When none is.
    pub(super) fn scene(&self) -> Result<&Scene, CliError> {
        self.subject.as_ref().map(|(_, subject)| &subject.scene).ok_or_else(nothing_is_loaded)
    }

    /// BLAKE3 of the files of what is loaded: model, what it refers to, and environment.
    ///
    /// # Errors
    /// When nothing is.
    pub(super) fn scene_hash(&self) -> Result<&str, CliError> {
        self.subject.as_ref().map(|(_, subject)| subject.hash.as_str()).ok_or_else(nothing_is_loaded)
    }

    /// The view of what is loaded; of a turntable with the camera turned by an angle in radians.
    ///
    /// # Errors
    /// When a flag is out of range, or the camera cannot be placed.
    pub(super) fn view(&self, shot: Shot<'_>, turn_rad: Option<f64>) -> Result<View, CliError> {
        let view = shot.view.view(self.scene()?, shot.subject.has_panorama(), turn_rad)?;
        Ok(View { channel: shot.debug_view, ..view })
    }

    /// Forgets what is on the device, so that it is uploaded and drawn anew.
    pub(super) fn forget_uploads(&mut self) {
        self.target = None;
        if let Some((_, subject)) = &mut self.subject {
            subject.uploaded.clear();
        }
    }

    /// Which of the scenes on the device suits the view; uploads it if none does.
    ///
    /// # Errors
    /// When nothing is loaded, or the device fails.
    pub(super) fn upload(&mut self, shot: Shot<'_>, view: &View) -> Result<usize, CliError> {
        let paths = shot.frame.paths_on(self.gpu);
        self.renderer.set_paths(paths);
        let (_, subject) = self.subject.as_mut().ok_or_else(nothing_is_loaded)?;
        let white = view.channel == Some(Channel::Furnace) && subject.scene.lit_environment().is_none();
        let key = Uploaded { suns: view.quality.parts_suns(), paths: paths != PathChoice::Forward, white };
        if let Some(known) = subject.uploaded.iter().position(|(other, _)| *other == key) {
            return Ok(known);
        }
        // Other pictures of the scene have its own light.
        let own = subject.scene.environment.clone();
        light_furnace(&mut subject.scene, view.channel);
        let maps = self.maps(if white { "white" } else { shot.subject.environment_source() }, key.suns, view);
        let (_, subject) = self.subject.as_mut().ok_or_else(nothing_is_loaded)?;
        let Gpu { device, queue, .. } = self.gpu;
        let uploaded = self.renderer.upload(device, queue, &subject.scene, maps.as_deref());
        subject.scene.environment = own;
        subject.uploaded.push((key, uploaded.map_err(CaptureError::from)?));
        Ok(subject.uploaded.len() - 1)
    }

    /// The prefiltered environment of this name, where there is one.
    fn maps(&mut self, source: &str, suns: bool, view: &View) -> Option<Rc<EnvironmentMaps>> {
        let (_, subject) = self.subject.as_ref()?;
        subject.scene.lit_environment()?;
        let key = (source.to_owned(), suns);
        if let Some((_, maps)) = self.maps.iter().find(|(other, _)| *other == key) {
            return Some(Rc::clone(maps));
        }
        let maps = Rc::new(bake_maps(&subject.scene, view.quality, self.cache, self.progress)?.maps);
        if self.maps.len() == MAPS_KEPT {
            self.maps.remove(0);
        }
        self.maps.push((key, Rc::clone(&maps)));
        Some(maps)
    }

    /// Draws a view of one of the scenes on the device.
    ///
    /// # Errors
    /// When the device fails.
    pub(super) fn frame(
        &mut self,
        shot: Shot<'_>,
        view: &View,
        scene: usize,
        wanted: Wanted,
    ) -> Result<CapturedFrame, CliError> {
        let key = (view.size_px, shot.frame.capture_options());
        if self.target.as_ref().is_none_or(|(other, _)| *other != key) {
            self.target = Some((key, CaptureTarget::new(self.gpu, view, key.1)?));
        }
        let target = self.target.as_ref().map(|(_, target)| target);
        let scene = self.subject.as_mut().and_then(|(_, subject)| subject.uploaded.get_mut(scene));
        let (Some(target), Some((_, scene))) = (target, scene) else { return Err(nothing_is_loaded()) };
        Ok(submit(self.gpu, &mut self.renderer, scene, view, target, wanted)?.wait(self.gpu)?)
    }
}

/// Display values and radiance of a frame. A channel has no display values of its own.
pub(super) fn pixels(frame: CapturedFrame, view: &View) -> (Vec<u8>, Option<RadianceImage>) {
    match (view.channel, frame.radiance) {
        (Some(channel), Some(radiance)) => {
            let radiance = in_units(channel, radiance, view);
            (picture(channel, &radiance, view), Some(radiance))
        }
        (_, radiance) => (frame.display.unwrap_or_default(), radiance),
    }
}

/// A fault of ours that is told as an error, not as a panic.
fn nothing_is_loaded() -> CliError {
    CliError::Usage("a picture was drawn before it was loaded; please report this".into())
}
