//! What lies before the user: a model, the light on it, and what is being fetched.

use super::folder::{self, Kind};
use super::loading::{LoadedLight, LoadedModel, Loading, Part, Wake, Wanted, WantedLight, WantedModel};
use super::panel::Inspected;
use super::recent::Recent;
use super::saving;
use super::shaders::{Shaders, is_of_shaders};
use super::shown::{Shown, is_file, view_of};
use super::stage::Stage;
use super::state::ViewerState;
use super::truth::Truth;
use super::viewer::{Effect, Viewer};
use super::watch::ModelWatch;
use crate::cache::EnvironmentCache;
use crate::capture::CaptureError;
use crate::gpu_scene::TextureLevels;
use crate::scene::{Channel, Scene, View};
use crate::shader::ShaderSources;
use std::convert::identity;
use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};

/// What a file says of itself.
#[derive(Debug, Clone, Default)]
pub(super) struct About {
    pub(super) warnings: Vec<String>,
    pub(super) variants: Vec<String>,
    pub(super) extensions_used: Vec<String>,
}

/// What is being typed.
#[derive(Debug, Clone, Default)]
pub(super) struct Texts {
    pub(super) model: String,
    pub(super) panorama: String,
}

/// What comes back when the model of a sketch turns out to be damaged.
struct Before {
    state: ViewerState,
    shown: Option<Shown>,
}

/// What a desk has beside its state.
#[derive(Debug, Clone, Default)]
pub(super) struct DeskOptions {
    /// Whether files are read again when they change.
    pub(super) watch: bool,
    /// Where prefiltered panoramas and the list of recent files are kept.
    pub(super) cache: Option<PathBuf>,
    /// Shaders in place of those that are built in.
    pub(super) shaders: Option<PathBuf>,
}

/// Models, light and jobs around a [`Viewer`].
pub(super) struct Desk {
    pub(super) viewer: Viewer,
    pub(super) about: About,
    pub(super) texts: Texts,
    /// What was open.
    pub(super) recent: Recent,
    pub(super) inspected: Inspected,
    pub(super) loading: Option<Loading>,
    light: Option<LoadedLight>,
    /// A model that waits for its light, and whether it is a sketch.
    arrived: Option<(LoadedModel, bool)>,
    /// What was there before the sketch that is shown.
    before: Option<Before>,
    pub(super) truth: Option<Truth>,
    /// A state that was opened, until its model is there.
    coming: Option<ViewerState>,
    /// What is to be said as soon as there is something to see.
    note: Option<String>,
    pub(super) shaders: Option<Shaders>,
    cache: Option<EnvironmentCache>,
    /// Whether a model is read again when its files change.
    watches: bool,
    watch: Option<ModelWatch>,
    /// Of the device, once that is open.
    pub(super) max_side: Arc<OnceLock<u32>>,
    wake: Wake,
}

impl Desk {
    /// Begins to fetch what `state` names.
    pub(super) fn new(state: ViewerState, options: DeskOptions, wake: Wake) -> Self {
        let (viewer, max_side) = (Viewer::new(state), Arc::default());
        let DeskOptions { watch: watches, cache: folder, shaders } = options;
        let (recent, problem) = Recent::read(folder.as_ref().map(|folder| folder.join("recent.json")));
        let (shaders, unwatched) = shaders.map(|folder| Shaders::new(folder, watches, Arc::clone(&wake))).unzip();
        let mut desk = Self {
            viewer,
            about: About::default(),
            texts: Texts::default(),
            recent,
            inspected: Inspected::default(),
            loading: None,
            light: None,
            arrived: None,
            before: None,
            truth: None,
            coming: None,
            note: problem.or(unwatched.flatten()),
            shaders,
            cache: folder.as_deref().map(EnvironmentCache::below),
            watches,
            watch: None,
            max_side,
            wake,
        };
        match desk.viewer.state.model.clone() {
            Some(model) => desk.open(&model),
            None => {
                desk.viewer.interface.message = desk.note.take();
                desk.fetch(None);
            }
        }
        desk
    }

    /// Begins to read a model, the first one of a folder, or the one of a state. What is open stays until it is there.
    pub(super) fn open(&mut self, path: &Path) {
        self.coming = None;
        self.forget(Kind::Model, path);
        let opened = if folder::is_state(path) { self.open_state(path) } else { folder::model_of(path) };
        match opened {
            Ok(path) => {
                let variant = self.coming.as_ref().and_then(|coming| coming.variant.clone());
                self.fetch(Some(WantedModel { path, variant }));
            }
            Err(problem) => self.say(problem),
        }
    }

    /// The model of a state, which is shown as the state has it when it is there.
    fn open_state(&mut self, path: &Path) -> Result<PathBuf, String> {
        let state = ViewerState::read(path).map_err(|error| error.to_string())?;
        let model = state.model.clone().ok_or_else(|| format!("{}: it names no model", path.display()))?;
        self.coming = Some(state);
        Ok(model)
    }

    fn fetch(&mut self, model: Option<WantedModel>) {
        let light = self.wanted_light();
        let light = (!self.is_lit_by(&light)).then_some(light);
        let wanted = Wanted { model, light };
        let (max_side, wake) = (Arc::clone(&self.max_side), Arc::clone(&self.wake));
        self.loading = Some(Loading::start(wanted, max_side, self.cache.clone(), wake));
    }

    /// Begins to read the model that is open once more.
    fn fetch_again(&mut self, variant: Option<String>) {
        if let Some(path) = self.viewer.state.model.clone() {
            self.fetch(Some(WantedModel { path, variant }));
        }
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

    /// Whether this light is there, and not just roughly.
    fn is_lit_by(&self, wanted: &WantedLight) -> bool {
        self.light.as_ref().is_some_and(|light| light.wanted == *wanted && !light.is_rough)
    }

    /// Whether what is shown will look otherwise by itself: images or light are not there yet.
    fn is_provisional(&self) -> bool {
        self.before.is_some() || self.light.as_ref().is_some_and(|light| light.is_rough)
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
                let variant = self.viewer.state.variant.clone();
                self.fetch_again(variant);
            }
            Effect::Variant(variant) => self.fetch_again(variant),
            Effect::Screenshot if self.is_provisional() => {
                self.say("nothing is saved before textures and light are there".into());
            }
            Effect::Screenshot => {
                let path = saving::free_name(self.viewer.state.model.as_deref(), "png");
                if let Some(stage) = stage {
                    let saved = self.screenshot(stage, &path);
                    self.say(
                        saved.map_or_else(identity, |()| format!("saved {} and its state, .json", path.display())),
                    );
                }
            }
            Effect::SaveState => {
                let state = &self.viewer.state;
                let path = saving::free_name(state.model.as_deref(), "json");
                let saved = saving::state(state, &path);
                self.say(saved.map_or_else(identity, |()| format!("saved the state as {}", path.display())));
            }
            Effect::Fullscreen => {}
            Effect::Quit => return false,
        }
        true
    }

    /// Puts what has been read before the user, and begins to read what is missing.
    pub(super) fn turn(&mut self, stage: &mut Stage) {
        if let Some(loading) = &mut self.loading {
            let parts = loading.poll();
            if loading.is_done() {
                self.loading = None;
            }
            self.take(parts, stage);
        }
        if self.watch.as_ref().is_some_and(ModelWatch::has_changed) {
            self.effect(Effect::Reload, None);
        }
        let wanted = self.wanted_light();
        let comes = self.loading.as_ref().and_then(|loading| loading.wanted.light.as_ref()) == Some(&wanted);
        if !self.is_lit_by(&wanted) && !comes {
            let model = self.loading.as_ref().and_then(|loading| loading.missing_model().cloned());
            self.fetch(model);
        }
        if let Some(shown) = &mut self.viewer.shown
            && let Err(error) = stage.follow(shown, &self.viewer.state)
        {
            self.fail(&error);
        }
        self.try_shaders(stage);
    }

    /// Puts shaders to use that are others than before, if a picture can be made with them.
    fn try_shaders(&mut self, stage: &mut Stage) {
        let view = self.view();
        let (Some(shaders), Some(view), Some(_)) = (&mut self.shaders, view, &stage.uploaded) else { return };
        let Some(sources) = shaders.changed() else { return };
        let tried = stage.try_shaders(sources.clone(), &view);
        shaders.tried(sources, &tried);
        // What was made with the others.
        (self.truth, self.inspected) = (None, Inspected::default());
    }

    fn take(&mut self, parts: Vec<Part>, stage: &mut Stage) {
        let mut is_relit = false;
        for part in parts {
            match part {
                Part::RoughLight(light) => {
                    self.light = Some(light);
                    is_relit = true;
                }
                Part::Light(Ok(light)) => {
                    if is_file(&light.wanted.source) {
                        self.remember(Kind::Panorama, Path::new(&light.wanted.source));
                    }
                    self.light = Some(light);
                    is_relit = true;
                }
                Part::Light(Err(problem)) => {
                    self.forget(Kind::Panorama, Path::new(&self.viewer.state.environment.source.clone()));
                    self.say(problem);
                    let before = self.light.as_ref().map(|light| light.wanted.source.clone());
                    self.viewer.state.environment.source = before.unwrap_or_else(|| "neutral".into());
                }
                Part::Sketch(model) => self.arrived = Some((model, true)),
                Part::Model(Ok(model)) => self.arrived = Some((model, false)),
                Part::Model(Err(problem)) => {
                    (self.arrived, self.coming) = (None, None);
                    self.bring_back(stage);
                    self.say(problem);
                }
            }
        }
        let wanted = self.wanted_light();
        let has_light = self.light.as_ref().is_some_and(|light| light.wanted == wanted);
        if has_light || !self.loading.as_ref().is_some_and(Loading::awaits_light) {
            match self.arrived.take() {
                Some((model, false)) => return self.show(model, stage),
                Some((model, true)) if !self.is_open(&model.wanted.path) => return self.show_sketch(model, stage),
                _ => {}
            }
        }
        if is_relit {
            self.relight(stage);
        }
    }

    /// Lights what is shown anew.
    fn relight(&mut self, stage: &mut Stage) {
        let (image, maps) = self.light.as_ref().and_then(|light| light.panorama.clone()).unzip();
        if let Some(shown) = &mut self.viewer.shown {
            shown.surround(image, &self.viewer.state);
            if let Err(error) = stage.relight(shown, &self.viewer.state, maps) {
                self.fail(&error);
            }
        }
    }

    /// Whether a model is on its way.
    pub(super) fn is_reading_model(&self) -> bool {
        self.loading.as_ref().is_some_and(|loading| loading.missing_model().is_some())
    }

    /// Whether this model is shown, and with its images.
    fn is_open(&self, path: &Path) -> bool {
        let is_named = self.viewer.state.model.as_deref() == Some(path);
        is_named && self.viewer.shown.is_some() && self.before.is_none()
    }

    /// Puts a model before the user while its images are being decoded.
    fn show_sketch(&mut self, model: LoadedModel, stage: &mut Stage) {
        let state = self.viewer.state.clone();
        let opened = self.place(model.scene, &model.wanted, (model.levels, stage));
        let before = Before { state, shown: self.viewer.shown.replace(opened.0) };
        self.before.get_or_insert(before);
        if let Err(error) = opened.1 {
            self.fail(&error);
        }
    }

    /// What is shown now is on the screen.
    pub(super) fn is_seen(&self) {
        let is_first = self.viewer.shown.is_some() && self.is_provisional();
        if let (Some(loading), true) = (&self.loading, is_first) {
            loading.is_seen();
        }
    }

    /// Shows again what was shown before the sketch.
    fn bring_back(&mut self, stage: &mut Stage) {
        let Some(Before { state, shown }) = self.before.take() else { return };
        let size_px = self.viewer.state.size_px;
        (self.viewer.state, self.viewer.shown) = (ViewerState { size_px, ..state }, shown);
        stage.close();
        self.move_to(stage);
    }

    fn show(&mut self, model: LoadedModel, stage: &mut Stage) {
        let LoadedModel { wanted, scene, warnings, variant_names: variants, extensions_used, levels } = model;
        let (shown, opened) = self.place(scene, &wanted, (levels, stage));
        self.before = None;
        self.viewer.interface.message = self.note.take();
        if self.watches
            && let Err(problem) = ModelWatch::follow(&mut self.watch, &wanted.path, Arc::clone(&self.wake))
        {
            self.say(problem);
        }
        self.remember(Kind::Model, &wanted.path);
        self.about = About { warnings, variants, extensions_used };
        self.viewer.shown = Some(shown);
        if let Err(error) = opened {
            self.fail(&error);
        }
    }

    /// Puts a model and its light on the device, as the state shows it.
    fn place(
        &mut self,
        scene: Scene,
        WantedModel { path, variant }: &WantedModel,
        (levels, stage): (TextureLevels, &mut Stage),
    ) -> (Shown, Result<(), CaptureError>) {
        let state = &mut self.viewer.state;
        if let Some(coming) = self.coming.take_if(|coming| coming.model.as_ref() == Some(path)) {
            *state = ViewerState { size_px: state.size_px, ..coming };
        }
        // Read again, or named by a state that was opened: what was changed stays.
        if state.model.as_ref() != Some(path) {
            *state = state.for_model(path);
        }
        state.variant.clone_from(variant);
        let mut shown = Shown::new(scene, state);
        if state.camera.pose.is_none() {
            state.camera.pose = Some(super::camera::Pose::Orbit(shown.around.home));
        }
        let (image, maps) = self.light.as_ref().and_then(|light| light.panorama.clone()).unzip();
        shown.surround(image, state);
        let opened = stage.open(&mut shown, state, Some(levels), maps);
        (shown, opened)
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

    /// Keeps in mind that a file was opened.
    fn remember(&mut self, kind: Kind, path: &Path) {
        if let Err(problem) = self.recent.opened(kind, path) {
            self.say(problem);
        }
    }

    /// No longer offers a file that is not there any more.
    fn forget(&mut self, kind: Kind, path: &Path) {
        if !path.exists()
            && let Err(problem) = self.recent.forget(kind, path)
        {
            self.say(problem);
        }
    }

    /// What is done about an error of a frame. Whether it was not known yet.
    pub(super) fn frame_failed(&mut self, error: &CaptureError, stage: &mut Stage) -> bool {
        match &mut self.shaders {
            Some(shaders) if is_of_shaders(error) && shaders.are_in_use() => {
                shaders.give_up(error);
                stage.use_shaders(shaders.good.clone());
                true
            }
            _ => self.fail(error),
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

    /// Those that have made pictures.
    pub(super) fn good_shaders(&self) -> ShaderSources {
        self.shaders.as_ref().map_or_else(ShaderSources::default, |shaders| shaders.good.clone())
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
        self.viewer.shown.as_ref().ok_or("there is no picture yet")?;
        saving::picture(stage, &self.viewer.state, path)
    }
}
