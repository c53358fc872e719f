//! What lies before the user: a model, the light on it, and what is being fetched.

use super::folder;
use super::loading::{Loaded, LoadedLight, LoadedModel, Loading, Wake, Wanted, WantedLight};
use super::panel::Inspected;
use super::shown::{Shown, view_of};
use super::stage::Stage;
use super::state::ViewerState;
use super::truth::Truth;
use super::viewer::{Effect, Viewer};
use super::watch::Watch;
use crate::capture::CaptureError;
use crate::output;
use crate::scene::{Channel, View};
use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};

/// What a file says of itself.
#[derive(Debug, Clone, Default)]
pub(super) struct About {
    pub(super) warnings: Vec<String>,
    pub(super) extensions_used: Vec<String>,
}

/// What is being typed.
#[derive(Debug, Clone, Default)]
pub(super) struct Texts {
    pub(super) model: String,
    pub(super) panorama: String,
}

/// Models that are remembered while the window is open.
const RECENT: usize = 12;

/// Models, light and jobs around a [`Viewer`].
pub(super) struct Desk {
    pub(super) viewer: Viewer,
    pub(super) about: About,
    pub(super) texts: Texts,
    /// The material that the panel shows.
    pub(super) material: usize,
    /// Models that were open, the last one first.
    pub(super) recent: Vec<PathBuf>,
    pub(super) inspected: Inspected,
    pub(super) loading: Option<Loading>,
    light: Option<LoadedLight>,
    pub(super) truth: Option<Truth>,
    /// Whether a model is read again when its files change.
    watches: bool,
    watch: Option<Watch>,
    /// Of the device, once that is open.
    pub(super) max_side: Arc<OnceLock<u32>>,
    wake: Wake,
}

impl Desk {
    /// Begins to fetch what `state` names.
    pub(super) fn new(state: ViewerState, watches: bool, wake: Wake) -> Self {
        let (viewer, max_side) = (Viewer::new(state), Arc::default());
        let mut desk = Self {
            viewer,
            about: About::default(),
            texts: Texts::default(),
            material: 0,
            recent: Vec::new(),
            inspected: Inspected::default(),
            loading: None,
            light: None,
            truth: None,
            watches,
            watch: None,
            max_side,
            wake,
        };
        match desk.viewer.state.model.clone() {
            Some(model) => desk.open(&model),
            None => desk.fetch(None),
        }
        desk
    }

    /// Begins to read a model, or the first one of a folder. What is open stays until it is there.
    pub(super) fn open(&mut self, path: &Path) {
        match folder::model_of(path) {
            Ok(model) => self.fetch(Some(model)),
            Err(problem) => self.say(problem),
        }
    }

    fn fetch(&mut self, model: Option<PathBuf>) {
        let light = self.wanted_light();
        let light = (self.light.as_ref().map(|light| &light.wanted) != Some(&light)).then_some(light);
        let wanted = Wanted { model, light };
        self.loading = Some(Loading::start(wanted, Arc::clone(&self.max_side), Arc::clone(&self.wake)));
    }

    fn wanted_light(&self) -> WantedLight {
        let state = &self.viewer.state;
        let source = match (state.look.debug_view, state.environment.source.as_str()) {
            // Surfaces that nothing lights have no lobes to show.
            (Some(Channel::Furnace), "black") => "white",
            (_, source) => source,
        };
        WantedLight { source: source.to_owned(), suns: state.look.quality.parts_suns() }
    }

    /// Shows a line of text.
    pub(super) fn say(&mut self, message: String) {
        self.viewer.interface.message = Some(message);
    }

    /// Does what the viewer cannot do by itself. Whether to go on.
    pub(super) fn effect(&mut self, effect: Effect, stage: Option<&Stage>) -> bool {
        match effect {
            Effect::Open(path) => self.open(&path),
            Effect::Neighbour { backward } => {
                let Some(model) = self.viewer.state.model.clone() else { return true };
                match folder::neighbour(&model, backward) {
                    Ok(other) => self.open(&other),
                    Err(problem) => self.say(problem),
                }
            }
            Effect::Reload => {
                if let Some(model) = self.viewer.state.model.clone() {
                    self.fetch(Some(model));
                }
            }
            Effect::Screenshot => {
                let path = self.free_name();
                if let Some(stage) = stage {
                    match self.screenshot(stage, &path) {
                        Ok(()) => self.say(format!("saved {} and its state, .json", path.display())),
                        Err(problem) => self.say(problem),
                    }
                }
            }
            Effect::Quit => return false,
        }
        true
    }

    /// Puts what has been read before the user, and begins to read what is missing.
    pub(super) fn turn(&mut self, stage: &mut Stage) {
        if let Some(loaded) = self.loading.as_ref().and_then(Loading::poll) {
            self.loading = None;
            self.take(loaded, stage);
        }
        if self.watch.as_ref().is_some_and(Watch::has_changed) {
            self.effect(Effect::Reload, None);
        }
        let wanted = self.wanted_light();
        let has = self.light.as_ref().is_some_and(|light| light.wanted == wanted);
        let comes = self.loading.as_ref().and_then(|loading| loading.wanted.light.as_ref()) == Some(&wanted);
        if !has && !comes {
            let model = self.loading.as_ref().and_then(|loading| loading.wanted.model.clone());
            self.fetch(model);
        }
        if let Some(shown) = &mut self.viewer.shown
            && let Err(error) = stage.follow(shown, &self.viewer.state)
        {
            self.fail(&error);
        }
    }

    fn take(&mut self, loaded: Loaded, stage: &mut Stage) {
        let mut is_relit = false;
        match loaded.light {
            Some(Ok(light)) => {
                self.light = Some(light);
                is_relit = true;
            }
            Some(Err(problem)) => {
                self.say(problem);
                let before = self.light.as_ref().map(|light| light.wanted.source.clone());
                self.viewer.state.environment.source = before.unwrap_or_else(|| "neutral".into());
            }
            None => {}
        }
        match loaded.model {
            Some(Ok(model)) => self.show(model, stage),
            Some(Err(problem)) => self.say(problem),
            None => {}
        }
        let panorama = self.light.as_ref().and_then(|light| light.panorama.clone());
        let (image, maps) = panorama.unzip();
        if let (Some(shown), true) = (&mut self.viewer.shown, is_relit) {
            shown.surround(image, &self.viewer.state);
            if let Err(error) = stage.relight(shown, &self.viewer.state, maps) {
                self.fail(&error);
            }
        }
    }

    fn show(&mut self, model: LoadedModel, stage: &mut Stage) {
        let LoadedModel { path, scene, warnings, extensions_used, levels } = model;
        let state = &mut self.viewer.state;
        // Read again, or named by a state that was opened: what was changed stays.
        if state.model.as_ref() != Some(&path) {
            *state = state.for_model(&path);
        }
        let mut shown = Shown::new(scene, state);
        if state.camera.pose.is_none() {
            state.camera.pose = Some(super::camera::Pose::Orbit(shown.around.home));
        }
        let (image, maps) = self.light.as_ref().and_then(|light| light.panorama.clone()).unzip();
        shown.surround(image, state);
        let opened = stage.open(&mut shown, state, Some(levels), maps);
        let mut message = None;
        if self.watches && self.watch.as_ref().is_none_or(|watch| watch.model != path) {
            match Watch::new(&path, Arc::clone(&self.wake)) {
                Ok(watch) => self.watch = Some(watch),
                Err(problem) => message = Some(problem),
            }
        }
        self.recent.retain(|other| *other != path);
        self.recent.insert(0, path);
        self.recent.truncate(RECENT);
        self.about = About { warnings, extensions_used };
        self.viewer.interface.message = message;
        self.viewer.shown = Some(shown);
        if let Err(error) = opened {
            self.fail(&error);
        }
    }

    /// Puts what is shown on another device.
    pub(super) fn move_to(&mut self, stage: &mut Stage) {
        // Its pictures are on the one that is gone.
        self.truth = None;
        let (_, maps) = self.light.as_ref().and_then(|light| light.panorama.clone()).unzip();
        if let Some(shown) = &mut self.viewer.shown
            && let Err(error) = stage.open(shown, &self.viewer.state, None, maps)
        {
            self.fail(&error);
        }
    }

    /// Tells of an error, here and on stderr. Whether it was not known yet.
    pub(super) fn fail(&mut self, error: &CaptureError) -> bool {
        let message = error.to_string();
        let is_new = self.viewer.interface.message.as_ref() != Some(&message);
        if is_new {
            eprintln!("specula: {message}");
            self.say(message);
        }
        is_new
    }

    /// Keeps the truth beside the picture, where that is wanted.
    pub(super) fn turn_truth(&mut self, stage: &mut Stage, view: &View) {
        let wanted = self.viewer.interface.truth;
        self.truth = self.truth.take().filter(|truth| wanted && truth.is_of(stage, view));
        let (true, None, Some(shown)) = (wanted, &self.truth, &self.viewer.shown) else {
            self.truth.iter_mut().for_each(Truth::turn);
            return;
        };
        match Truth::start(stage, &shown.scene, view, Arc::clone(&self.wake)) {
            Ok(truth) => self.truth = truth,
            Err(error) => {
                self.fail(&error);
            }
        }
    }

    /// The picture to draw.
    pub(super) fn view(&self) -> Option<View> {
        Some(view_of(&self.viewer.state, &self.viewer.shown.as_ref()?.around))
    }

    /// Saves the picture under `path`, and beside it, as .json, the state that makes it again.
    ///
    /// # Errors
    /// When there is no picture yet, or a file cannot be written: one line for people.
    pub(super) fn screenshot(&self, stage: &Stage, path: &Path) -> Result<(), String> {
        let pixels = stage.pixels().map_err(|error| error.to_string())?;
        let pixels = pixels.filter(|_| self.viewer.shown.is_some()).ok_or("there is no picture yet")?;
        let mut state = self.viewer.state.clone();
        let absolute = |path: &Path| path.canonicalize().unwrap_or_else(|_| path.to_owned());
        state.model = state.model.as_deref().map(absolute);
        if super::shown::is_file(&state.environment.source) {
            state.environment.source = absolute(Path::new(&state.environment.source)).to_string_lossy().into_owned();
        }
        let [width, height] = state.size_px;
        let png = output::png(width, height, &pixels)?;
        let state_path = path.with_extension("json");
        output::write(path, &png).map_err(|error| error.to_string())?;
        output::write(&state_path, state.to_json().as_bytes()).map_err(|error| error.to_string())
    }

    /// A name for a picture that no file has yet, in the current folder.
    fn free_name(&self) -> PathBuf {
        let model = self.viewer.state.model.as_deref().and_then(Path::file_stem);
        let stem = model.map_or("specula".into(), |stem| stem.to_string_lossy().into_owned());
        let names = (1..).map(|number| PathBuf::from(format!("{stem}-{number}.png")));
        let is_free = |name: &PathBuf| !name.exists() && !name.with_extension("json").exists();
        names.into_iter().find(is_free).unwrap_or_default()
    }
}
