//! Pictures and the states that make them again, in files.

use super::shown::is_file;
use super::stage::Stage;
use super::state::ViewerState;
use crate::output;
use std::path::{Path, PathBuf};

/// Saves what the stage shows under `path`, and beside it, as .json, the state that makes it again.
///
/// # Errors
/// When there is no picture yet, or a file cannot be written: one line for people.
pub(super) fn picture(stage: &Stage, state: &ViewerState, path: &Path) -> Result<(), String> {
    let pixels = stage.pixels().map_err(|error| error.to_string())?;
    let pixels = pixels.ok_or("there is no picture yet")?;
    let [width, height] = state.size_px;
    let png = output::png(width, height, &pixels)?;
    output::write(path, &png).map_err(|error| error.to_string())?;
    self::state(state, &path.with_extension("json"))
}

/// Saves a state, with the files that it names by their absolute paths.
///
/// # Errors
/// When the file cannot be written: one line for people.
pub(super) fn state(state: &ViewerState, path: &Path) -> Result<(), String> {
    let mut state = state.clone();
    let absolute = |path: &Path| path.canonicalize().unwrap_or_else(|_| path.to_owned());
    state.model = state.model.as_deref().map(absolute);
    if is_file(&state.environment.source) {
        state.environment.source = absolute(Path::new(&state.environment.source)).to_string_lossy().into_owned();
    }
    output::write(path, state.to_json().as_bytes()).map_err(|error| error.to_string())
}

/// A name for a picture of a model, or for its state, that no file in the current folder has yet.
pub(super) fn free_name(model: Option<&Path>, extension: &str) -> PathBuf {
    let stem = model.and_then(Path::file_stem).map_or("specula".into(), |stem| stem.to_string_lossy());
    let names = (1..).map(|number| PathBuf::from(format!("{stem}-{number}.{extension}")));
    let is_free = |name: &PathBuf| !name.exists() && !name.with_extension("json").exists();
    names.into_iter().find(is_free).unwrap_or_default()
}
