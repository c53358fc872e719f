//! Pictures of many cases on one device. What consecutive cases share is loaded once.

use super::golden;
use super::report::Kind;
use super::suite::{Case, CaseArgs};
use crate::app::{in_units, picture};
use crate::capture::{CaptureError, CaptureOptions, CaptureTarget, CapturedFrame, Wanted, submit};
use crate::cli::environment::{CacheArgs, bake_maps};
use crate::cli::error::CliError;
use crate::cli::stats::Stopwatch;
use crate::cli::subject::SubjectArgs;
use crate::gpu::{Gpu, Uploads};
use crate::gpu_scene::GpuScene;
use crate::import::model_files;
use crate::progress::Progress;
use crate::reference::color::to_srgb8;
use crate::reference::estimate;
use crate::renderer::{PathChoice, Renderer};
use crate::scene::{Background, Channel, EnvironmentMaps, RadianceImage, Scene, View};
use glam::UVec2;
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::rc::Rc;
use std::time::Instant;

/// Prefiltered environments that are kept for later cases, of some 25 MB each.
const MAPS_KEPT: usize = 4;

/// The picture of a case.
#[derive(Debug)]
pub(super) struct Drawn {
    pub(super) size_px: UVec2,
    /// sRGB with straight alpha.
    pub(super) rgba: Vec<u8>,
    /// [`golden::picture_hash`] of it.
    pub(super) picture_hash: String,
    /// Of a furnace, cd/m2.
    pub(super) radiance: Option<RadianceImage>,
    /// Where the radiance is no number or infinite, of which the display shows nothing: targets hold neither.
    pub(super) fault: Option<String>,
    /// Of the model, what it refers to, and the environment.
    pub(super) scene_hash: String,
    /// What the reference renderer makes of the same view, for a case that asks.
    pub(super) truth: Option<Vec<u8>>,
    /// Most pixels by which a repetition differs.
    pub(super) differing_when_repeated: Option<usize>,
    pub(super) load_ms: f64,
    pub(super) draw_ms: f64,
}

/// A device, and what was loaded for the last case.
pub(super) struct Stage<'a> {
    gpu: &'a Gpu,
    cache: &'a CacheArgs,
    progress: &'a dyn Progress,
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
    /// By whether suns are parted from the environment, and whether more than the forward path is wanted.
    uploaded: Vec<((bool, bool), GpuScene)>,
}

impl<'a> Stage<'a> {
    pub(super) fn new(gpu: &'a Gpu, cache: &'a CacheArgs, progress: &'a dyn Progress) -> Self {
        let renderer = Renderer::new(&gpu.device, &gpu.queue).with_uploads(Uploads::Bounded);
        Self { gpu, cache, progress, renderer, subject: None, maps: Vec::new(), target: None, hashes: HashMap::new() }
    }

    /// The picture of a case, drawn `times` times from the upload on. If it is not the `known` one, by its hash, its
    /// radiance is searched for faults.
    ///
    /// # Errors
    /// When the model or the environment cannot be read, or the device fails.
    pub(super) fn draw(&mut self, case: &'a Case, times: u32, known: Option<&str>) -> Result<Drawn, CliError> {
        let start = Instant::now();
        let args = &case.args;
        self.load(&args.subject)?;
        let view = self.view(args)?;
        let scene = self.upload(args, &view)?;
        let load_ms = milliseconds(start);
        let start = Instant::now();
        let wanted =
            Wanted { radiance: case.kind == Kind::Furnace || view.channel.is_some(), display: view.channel.is_none() };
        let (rgba, radiance) = pixels(self.frame(args, &view, scene, wanted)?, &view);
        let draw_ms = milliseconds(start);
        let size_px = view.size_px;
        let picture_hash = golden::picture_hash(size_px.x, size_px.y, &rgba);
        let fault = if known == Some(&picture_hash) { None } else { self.fault(args, &view, scene)? };
        let mut differing_when_repeated = (times > 1).then_some(0);
        for _ in 1..times {
            let again = self.draw_anew(args, &view, wanted, &rgba)?;
            differing_when_repeated = differing_when_repeated.max(Some(again));
        }
        let truth = (case.kind == Kind::Reference).then(|| self.trace(args, &view)).flatten();
        let scene_hash = self.subject.as_ref().map(|(_, subject)| subject.hash.clone()).unwrap_or_default();
        Ok(Drawn {
            size_px,
            rgba,
            picture_hash,
            radiance,
            fault,
            scene_hash,
            truth,
            differing_when_repeated,
            load_ms,
            draw_ms,
        })
    }

    /// Shades once more, to find out where the radiance is no number before it is clamped.
    fn fault(&mut self, args: &CaseArgs, view: &View, scene: usize) -> Result<Option<String>, CliError> {
        let view = View { channel: Some(Channel::Nan), background: Background::Transparent, ..view.clone() };
        let frame = self.frame(args, &view, scene, Wanted { radiance: true, display: false })?;
        Ok(frame.radiance.as_ref().and_then(golden::fault))
    }

    /// Uploads and draws once more; returns how many pixels differ.
    fn draw_anew(&mut self, args: &CaseArgs, view: &View, wanted: Wanted, rgba: &[u8]) -> Result<usize, CliError> {
        self.target = None;
        if let Some((_, subject)) = &mut self.subject {
            subject.uploaded.clear();
        }
        let scene = self.upload(args, view)?;
        let (again, _) = pixels(self.frame(args, view, scene, wanted)?, view);
        Ok(rgba.chunks_exact(4).zip(again.chunks_exact(4)).filter(|(a, b)| a != b).count())
    }

    /// Loads the model and its light, unless that is what the case before had.
    fn load(&mut self, args: &'a SubjectArgs) -> Result<(), CliError> {
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

    fn hash_of_file(&mut self, path: &Path) -> Result<[u8; 32], CliError> {
        if let Some(hash) = self.hashes.get(path) {
            return Ok(*hash);
        }
        let bytes = std::fs::read(path)
            .map_err(|error| CliError::Usage(format!("{}: cannot be read: {error}", path.display())))?;
        let hash = *blake3::hash(&bytes).as_bytes();
        self.hashes.insert(path.to_owned(), hash);
        Ok(hash)
    }

    fn view(&self, args: &CaseArgs) -> Result<View, CliError> {
        let scene = self.subject.as_ref().map(|(_, subject)| &subject.scene).ok_or_else(nothing_is_loaded)?;
        let view = args.view.view(scene, args.subject.has_panorama())?;
        Ok(View { channel: args.debug_view, ..view })
    }

    /// Which of the scenes on the device suits the view; uploads it if none does.
    fn upload(&mut self, args: &CaseArgs, view: &View) -> Result<usize, CliError> {
        let paths = args.frame.paths_on(self.gpu);
        self.renderer.set_paths(paths);
        let key = (view.quality.parts_suns(), paths != PathChoice::Forward);
        let (_, subject) = self.subject.as_ref().ok_or_else(nothing_is_loaded)?;
        if let Some(known) = subject.uploaded.iter().position(|(other, _)| *other == key) {
            return Ok(known);
        }
        let maps = self.maps(args, view);
        let (_, subject) = self.subject.as_mut().ok_or_else(nothing_is_loaded)?;
        let uploaded = self
            .renderer
            .upload(&self.gpu.device, &self.gpu.queue, &subject.scene, maps.as_deref())
            .map_err(CaptureError::from)?;
        subject.uploaded.push((key, uploaded));
        Ok(subject.uploaded.len() - 1)
    }

    /// The prefiltered environment, where there is one.
    fn maps(&mut self, args: &CaseArgs, view: &View) -> Option<Rc<EnvironmentMaps>> {
        let (_, subject) = self.subject.as_ref()?;
        subject.scene.lit_environment()?;
        let key = (args.subject.environment_source().to_owned(), view.quality.parts_suns());
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

    fn frame(&mut self, args: &CaseArgs, view: &View, scene: usize, wanted: Wanted) -> Result<CapturedFrame, CliError> {
        let key = (view.size_px, args.frame.capture_options());
        if self.target.as_ref().is_none_or(|(other, _)| *other != key) {
            self.target = Some((key, CaptureTarget::new(self.gpu, view, key.1)?));
        }
        let target = self.target.as_ref().map(|(_, target)| target);
        let scene = self.subject.as_mut().and_then(|(_, subject)| subject.uploaded.get_mut(scene));
        let (Some(target), Some((_, scene))) = (target, scene) else { return Err(nothing_is_loaded()) };
        Ok(submit(self.gpu, &mut self.renderer, scene, view, target, wanted)?.wait(self.gpu)?)
    }

    fn trace(&self, args: &CaseArgs, view: &View) -> Option<Vec<u8>> {
        let (_, subject) = self.subject.as_ref()?;
        let truth = estimate(&subject.scene, view, &args.truth.options(self.progress));
        Some(to_srgb8(&truth.radiance, view))
    }
}

/// Display values and radiance of a frame. A channel has no display values of its own.
fn pixels(frame: CapturedFrame, view: &View) -> (Vec<u8>, Option<RadianceImage>) {
    match (view.channel, frame.radiance) {
        (Some(channel), Some(radiance)) => {
            let radiance = in_units(channel, radiance, view);
            (picture(channel, &radiance, view), Some(radiance))
        }
        (_, radiance) => (frame.display.unwrap_or_default(), radiance),
    }
}

fn milliseconds(since: Instant) -> f64 {
    since.elapsed().as_secs_f64() * 1e3
}

/// A fault of ours that is told as an error, not as a panic.
fn nothing_is_loaded() -> CliError {
    CliError::Usage("a case was drawn before it was loaded; please report this".into())
}
