//! Reading models and panoramas beside the window.

use super::shown::environment_image;
use crate::bake::environment::{BakeOptions, bake, sketch};
use crate::cache::EnvironmentCache;
use crate::gpu_scene::TextureLevels;
use crate::import::{Choice, ImportError, ImportOptions, Imported, model_from_path};
use crate::parallel::beside;
use crate::progress::Progress;
use crate::scene::{EnvironmentImage, EnvironmentMaps, Scene};
use std::path::PathBuf;
use std::sync::mpsc::{Receiver, Sender, TryRecvError, channel};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};
use std::time::{Duration, Instant};

/// What is to be read.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Wanted {
    /// `None` keeps the model that is open.
    pub(super) model: Option<WantedModel>,
    /// `None` keeps the light that is there.
    pub(super) light: Option<WantedLight>,
}

/// A model and which variant of its materials.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct WantedModel {
    pub(super) path: PathBuf,
    /// `None` takes the materials that are named without any.
    pub(super) variant: Option<String>,
}

/// A panorama and how it is baked.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct WantedLight {
    pub(super) source: String,
    /// Whether its suns are parted from it.
    pub(super) suns: bool,
}

/// A model as its file has it.
pub(super) struct LoadedModel {
    pub(super) wanted: WantedModel,
    pub(super) scene: Scene,
    pub(super) warnings: Vec<String>,
    /// Variants of its materials.
    pub(super) variant_names: Vec<String>,
    pub(super) extensions_used: Vec<String>,
    pub(super) levels: TextureLevels,
}

/// A panorama and what is made of it for shading; `None` is black.
pub(super) struct LoadedLight {
    pub(super) wanted: WantedLight,
    pub(super) panorama: Option<(Arc<EnvironmentImage>, Arc<EnvironmentMaps>)>,
    /// The maps are those of a sketch, and better ones will come.
    pub(super) is_rough: bool,
}

/// What has been read, or why not, in one line. Sketches come before what they are of, if they come.
pub(super) enum Part {
    /// A model whose images are not decoded yet.
    Sketch(LoadedModel),
    Model(Result<LoadedModel, String>),
    /// A light that is not prefiltered yet but roughly.
    RoughLight(LoadedLight),
    Light(Result<LoadedLight, String>),
}

/// Wakes the window.
pub(super) type Wake = Arc<dyn Fn() + Send + Sync>;

/// A job that runs beside the window. Dropped, its result is thrown away.
pub(super) struct Loading {
    pub(super) wanted: Wanted,
    /// What has not come yet.
    missing: Wanted,
    progress: Arc<Shared>,
    parts: Receiver<Part>,
    seen: Sender<()>,
}

/// How far a job is.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Stage {
    pub(super) name: String,
    pub(super) total: u64,
    pub(super) done: u64,
}

/// A rough light is waited for to be seen no longer than this: a window that is hidden shows nothing.
const UNTIL_SEEN: Duration = Duration::from_secs(2);

/// The window is woken to show progress no more often than this.
const BETWEEN_LOOKS: Duration = Duration::from_millis(50);

struct Shared {
    stage: Mutex<(Stage, Option<Instant>)>,
    wake: Wake,
}

impl Shared {
    fn update(&self, change: impl FnOnce(&mut Stage)) {
        let mut stage = self.stage.lock().unwrap_or_else(PoisonError::into_inner);
        change(&mut stage.0);
        if stage.1.is_none_or(|last| last.elapsed() >= BETWEEN_LOOKS) {
            stage.1 = Some(Instant::now());
            drop(stage);
            (self.wake)();
        }
    }
}

impl Progress for Shared {
    fn begin(&self, name: &str, total: u64) {
        self.update(|stage| *stage = Stage { name: name.to_owned(), total, done: 0 });
    }

    fn advance(&self, steps: u64) {
        self.update(|stage| stage.done += steps);
    }

    fn expect(&self, total: u64) {
        self.update(|stage| stage.total = total);
    }
}

impl Loading {
    /// Starts to read. `max_side` is the largest texture of the device, once that is open.
    pub(super) fn start(
        wanted: Wanted,
        max_side: Arc<OnceLock<u32>>,
        cache: Option<EnvironmentCache>,
        wake: Wake,
    ) -> Self {
        let progress = Arc::new(Shared { stage: Mutex::default(), wake: Arc::clone(&wake) });
        let (send, parts) = channel();
        let (seen, is_seen) = channel();
        let (job, shared) = (wanted.clone(), Arc::clone(&progress));
        std::thread::spawn(move || {
            let give = |part| {
                // Nobody waits for a job that was replaced by another.
                let _ = send.send(part);
                wake();
            };
            let until_seen = move || {
                // Whatever the answer, it is time to go on.
                let _ = is_seen.recv_timeout(UNTIL_SEEN);
            };
            load(&job, (&max_side, until_seen), cache.as_ref(), (&*shared, &give));
        });
        Self { missing: wanted.clone(), wanted, progress, parts, seen }
    }

    pub(super) fn stage(&self) -> Stage {
        self.progress.stage.lock().unwrap_or_else(PoisonError::into_inner).0.clone()
    }

    /// What has come since this was asked before.
    pub(super) fn poll(&mut self) -> Vec<Part> {
        let mut came = Vec::new();
        loop {
            let part = match self.parts.try_recv() {
                Ok(part) => part,
                Err(TryRecvError::Empty) => return came,
                Err(TryRecvError::Disconnected) => break,
            };
            match part {
                Part::Model(_) => self.missing.model = None,
                Part::Light(_) => self.missing.light = None,
                Part::Sketch(_) | Part::RoughLight(_) => {}
            }
            came.push(part);
        }
        let broken = || "reading the file has failed, please report it".to_owned();
        came.extend(self.missing.model.take().map(|_| Part::Model(Err(broken()))));
        came.extend(self.missing.light.take().map(|_| Part::Light(Err(broken()))));
        came
    }

    /// Tells the job that what it has given so far is on the screen.
    pub(super) fn is_seen(&self) {
        // It may have ended.
        let _ = self.seen.send(());
    }

    /// The model that has not come yet.
    pub(super) fn missing_model(&self) -> Option<&WantedModel> {
        self.missing.model.as_ref()
    }

    /// Whether a light has not come yet.
    pub(super) fn awaits_light(&self) -> bool {
        self.missing.light.is_some()
    }

    /// Whether all has come.
    pub(super) fn is_done(&self) -> bool {
        self.missing == Wanted { model: None, light: None }
    }
}

fn load(
    wanted: &Wanted,
    (max_side, until_seen): (&OnceLock<u32>, impl FnOnce() + Send),
    cache: Option<&EnvironmentCache>,
    (progress, give): (&dyn Progress, &(dyn Fn(Part) + Sync)),
) {
    let line = |error: ImportError| error.to_string();
    beside(
        || {
            if let Some(model) = &wanted.model {
                give(Part::Model(load_model(model, max_side, progress, give).map_err(line)));
            }
        },
        || {
            if let Some(light) = &wanted.light {
                give(Part::Light(load_light(light, (cache, until_seen), progress, give).map_err(line)));
            }
        },
    );
}

fn load_model(
    wanted: &WantedModel,
    max_side: &OnceLock<u32>,
    progress: &dyn Progress,
    give: &(dyn Fn(Part) + Sync),
) -> Result<LoadedModel, ImportError> {
    let levels = |scene: &Scene| TextureLevels::of(scene, *max_side.wait());
    let sketch = |scene: Scene| {
        let (levels, wanted) = (levels(&scene), wanted.clone());
        let (warnings, variant_names, extensions_used) = Default::default();
        give(Part::Sketch(LoadedModel { wanted, scene, warnings, variant_names, extensions_used, levels }));
    };
    let variant = wanted.variant.clone().map(Choice::Name);
    let options = ImportOptions { variant, progress, sketch: Some(&sketch), ..Default::default() };
    let Imported { scene, warnings, variant_names, extensions_used, .. } = model_from_path(&wanted.path, &options)?;
    let warnings = warnings.iter().map(ToString::to_string).collect();
    let (levels, wanted) = (levels(&scene), wanted.clone());
    Ok(LoadedModel { wanted, scene, warnings, variant_names, extensions_used, levels })
}

fn load_light(
    wanted: &WantedLight,
    (cache, until_seen): (Option<&EnvironmentCache>, impl FnOnce()),
    progress: &dyn Progress,
    give: &(dyn Fn(Part) + Sync),
) -> Result<LoadedLight, ImportError> {
    let Some(image) = environment_image(&wanted.source)?.map(Arc::new) else {
        return Ok(LoadedLight { wanted: wanted.clone(), panorama: None, is_rough: false });
    };
    let light = |maps| {
        let panorama = Some((Arc::clone(&image), Arc::new(maps)));
        LoadedLight { wanted: wanted.clone(), panorama, is_rough: false }
    };
    let options = BakeOptions { suns: wanted.suns, ..Default::default() };
    if let Some(maps) = cache.and_then(|cache| cache.find(&image, &options)) {
        return Ok(light(maps));
    }
    give(Part::RoughLight(LoadedLight { is_rough: true, ..light(sketch(&image, &options)) }));
    // On few cores the first picture would take as long as both.
    until_seen();
    Ok(light(match cache {
        Some(cache) => cache.bake(&image, &options, progress).0,
        None => bake(&image, &options, progress),
    }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::progress::Silent;
    use std::path::Path;

    /// Names of the parts that a job gives, in their order.
    fn parts(work: impl FnOnce(&(dyn Fn(Part) + Sync))) -> Vec<(&'static str, Part)> {
        let given = Mutex::new(Vec::new());
        work(&|part| {
            let name = match part {
                Part::Sketch(_) => "sketch",
                Part::Model(_) => "model",
                Part::RoughLight(_) => "rough light",
                Part::Light(_) => "light",
            };
            given.lock().unwrap().push((name, part));
        });
        given.into_inner().unwrap()
    }

    #[test]
    fn a_sketch_comes_before_images_are_decoded() {
        let assets = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets");
        let [showcase, spheres] =
            ["showcase.glb", "spheres.glb"].map(|name| WantedModel { path: assets.join(name), variant: None });
        let max_side = OnceLock::from(4096);
        let given = parts(|give| {
            let model = load_model(&showcase, &max_side, &Silent, give).unwrap();
            give(Part::Model(Ok(model)));
        });
        let [("sketch", Part::Sketch(sketch)), ("model", Part::Model(Ok(model)))] = given.as_slice() else {
            panic!("{:?}", given.iter().map(|(name, _)| name).collect::<Vec<_>>())
        };
        assert_eq!(sketch.scene.images.len(), model.scene.images.len());
        assert!(sketch.scene.images.iter().all(|image| (image.width, image.height) == (4, 4)));
        assert!(model.scene.images.iter().all(|image| image.width > 4));
        let corners = |model: &LoadedModel| model.scene.meshes.iter().flat_map(|mesh| &mesh.primitives).count();
        assert_eq!(corners(sketch), corners(model));
        // Models without images have none.
        assert!(parts(|give| drop(load_model(&spheres, &max_side, &Silent, give).unwrap())).is_empty());
    }

    #[test]
    fn a_rough_light_comes_unless_the_maps_are_kept() {
        let folder = tempfile::tempdir().unwrap();
        let cache = EnvironmentCache::in_folder(folder.path(), 1 << 30);
        let wanted = WantedLight { source: "neutral".into(), suns: true };
        for (is_first, expected) in [(true, &["rough light"][..]), (false, &[])] {
            let mut is_awaited = false;
            let given = parts(|give| {
                let light = load_light(&wanted, (Some(&cache), || is_awaited = true), &Silent, give).unwrap();
                assert!(!light.is_rough && light.panorama.is_some());
            });
            assert_eq!(given.iter().map(|(name, _)| *name).collect::<Vec<_>>(), expected);
            assert_eq!(is_awaited, is_first);
        }
    }
}
