//! Reading models and panoramas beside the window.

use super::shown::environment_image;
use crate::bake::environment::{BakeOptions, bake};
use crate::cache::EnvironmentCache;
use crate::gpu_scene::TextureLevels;
use crate::import::{ImportError, ImportOptions, Imported, model_from_path};
use crate::parallel::beside;
use crate::progress::Progress;
use crate::scene::{EnvironmentImage, EnvironmentMaps, Scene};
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, TryRecvError, channel};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};
use std::time::{Duration, Instant};

/// What is to be read.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Wanted {
    /// `None` keeps the model that is open.
    pub(super) model: Option<PathBuf>,
    /// `None` keeps the light that is there.
    pub(super) light: Option<WantedLight>,
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
    pub(super) path: PathBuf,
    pub(super) scene: Scene,
    pub(super) warnings: Vec<String>,
    pub(super) extensions_used: Vec<String>,
    pub(super) levels: TextureLevels,
}

/// A panorama and what is made of it for shading; `None` is black.
pub(super) struct LoadedLight {
    pub(super) wanted: WantedLight,
    pub(super) panorama: Option<(Arc<EnvironmentImage>, Arc<EnvironmentMaps>)>,
}

/// What has been read, or why not, in one line.
pub(super) struct Loaded {
    pub(super) model: Option<Result<LoadedModel, String>>,
    pub(super) light: Option<Result<LoadedLight, String>>,
}

/// Wakes the window.
pub(super) type Wake = Arc<dyn Fn() + Send + Sync>;

/// A job that runs beside the window. Dropped, its result is thrown away.
pub(super) struct Loading {
    pub(super) wanted: Wanted,
    progress: Arc<Shared>,
    result: Receiver<Loaded>,
}

/// How far a job is.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Stage {
    pub(super) name: String,
    pub(super) total: u64,
    pub(super) done: u64,
}

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
    pub(super) fn start(wanted: Wanted, max_side: Arc<OnceLock<u32>>, wake: Wake) -> Self {
        let progress = Arc::new(Shared { stage: Mutex::default(), wake: Arc::clone(&wake) });
        let (send, result) = channel();
        let (job, shared) = (wanted.clone(), Arc::clone(&progress));
        std::thread::spawn(move || {
            let loaded = load(&job, &max_side, &*shared);
            // Nobody waits for a job that was replaced by another.
            let _ = send.send(loaded);
            wake();
        });
        Self { wanted, progress, result }
    }

    pub(super) fn stage(&self) -> Stage {
        self.progress.stage.lock().unwrap_or_else(PoisonError::into_inner).0.clone()
    }

    /// The result, once there is one.
    pub(super) fn poll(&self) -> Option<Loaded> {
        match self.result.try_recv() {
            Ok(loaded) => Some(loaded),
            Err(TryRecvError::Empty) => None,
            Err(TryRecvError::Disconnected) => {
                let broken = || "reading the file has failed, please report it".to_owned();
                let Wanted { model, light } = &self.wanted;
                Some(Loaded {
                    model: model.as_ref().map(|_| Err(broken())),
                    light: light.as_ref().map(|_| Err(broken())),
                })
            }
        }
    }
}

fn load(wanted: &Wanted, max_side: &OnceLock<u32>, progress: &dyn Progress) -> Loaded {
    let (model, light) = beside(
        || wanted.model.as_ref().map(|path| load_model(path, max_side, progress)),
        || wanted.light.as_ref().map(|light| load_light(light, progress)),
    );
    let line = |error: ImportError| error.to_string();
    Loaded { model: model.map(|model| model.map_err(line)), light: light.map(|light| light.map_err(line)) }
}

fn load_model(path: &Path, max_side: &OnceLock<u32>, progress: &dyn Progress) -> Result<LoadedModel, ImportError> {
    let Imported { scene, warnings, extensions_used, .. } =
        model_from_path(path, &ImportOptions { progress, ..Default::default() })?;
    let levels = TextureLevels::of(&scene, *max_side.wait());
    let warnings = warnings.iter().map(ToString::to_string).collect();
    Ok(LoadedModel { path: path.to_owned(), scene, warnings, extensions_used, levels })
}

fn load_light(wanted: &WantedLight, progress: &dyn Progress) -> Result<LoadedLight, ImportError> {
    let panorama = environment_image(&wanted.source)?.map(|image| {
        let options = BakeOptions { suns: wanted.suns, ..Default::default() };
        let maps = match EnvironmentCache::of_user() {
            Some(cache) => cache.bake(&image, &options, progress).0,
            None => bake(&image, &options, progress),
        };
        (Arc::new(image), Arc::new(maps))
    });
    Ok(LoadedLight { wanted: wanted.clone(), panorama })
}
