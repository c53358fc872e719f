//! Shaders that are worked on: the files of a folder in place of those that are built in.

use super::loading::Wake;
use super::watch::Watch;
use crate::capture::CaptureError;
use crate::renderer::RenderError;
use crate::shader::{SOURCES, ShaderSources};
use std::path::{Path, PathBuf};

/// A folder of shaders, what of it is in use, and what is wrong with it.
pub(super) struct Shaders {
    folder: PathBuf,
    watch: Option<Watch>,
    is_new: bool,
    /// Those that have made a picture; at first the ones that are built in.
    pub(super) good: ShaderSources,
    /// Why the files as they are now are not in use, in one line.
    pub(super) problem: Option<String>,
}

impl Shaders {
    /// Those of a folder, which is looked after if `watches` says so; and why it is not, in one line.
    pub(super) fn new(folder: PathBuf, watches: bool, wake: Wake) -> (Self, Option<String>) {
        let watch = watches.then(|| Watch::of_shaders(&folder, wake)).transpose();
        let (watch, problem) = match watch {
            Ok(watch) => (watch, None),
            Err(problem) => (None, Some(problem)),
        };
        (Self { folder, watch, is_new: true, good: ShaderSources::default(), problem: None }, problem)
    }

    /// The files, where they are others than when this was asked before.
    pub(super) fn changed(&mut self) -> Option<ShaderSources> {
        let has_changed = self.watch.as_ref().is_some_and(Watch::has_changed);
        if !(std::mem::take(&mut self.is_new) || has_changed) {
            return None;
        }
        match read(&self.folder) {
            Ok(sources) => Some(sources),
            Err(problem) => {
                self.problem = Some(problem);
                None
            }
        }
    }

    /// A picture was made of these, or could not be.
    pub(super) fn tried(&mut self, sources: ShaderSources, tried: &Result<(), CaptureError>) {
        match tried {
            Ok(()) => (self.good, self.problem) = (sources, None),
            Err(error) => self.problem = Some(format!("{}; those before stay in use", reason(error))),
        }
    }

    /// Whether they are others than those that are built in.
    pub(super) fn are_in_use(&self) -> bool {
        self.good.are_changed()
    }

    /// What made pictures until now does not make this one: from now on it is what is built in.
    pub(super) fn give_up(&mut self, error: &CaptureError) {
        self.good = ShaderSources::default();
        self.problem = Some(format!("{}; those that are built in are used", reason(error)));
    }
}

/// Whether it is the shaders that are at fault, as far as can be told.
pub(super) fn is_of_shaders(error: &CaptureError) -> bool {
    matches!(error, CaptureError::Render(RenderError::Shader(_)))
}

/// File, line and fault, without the request to report it.
fn reason(error: &CaptureError) -> String {
    match error {
        CaptureError::Render(RenderError::Shader(error)) => format!("shaders/{error}"),
        error => error.to_string(),
    }
}

/// The shader files below a folder; what it lacks is built in.
///
/// # Errors
/// When a file cannot be read, or the folder has none that pictures are made of: one line for people.
pub fn read(folder: &Path) -> Result<ShaderSources, String> {
    let (mut sources, mut known, mut folders) = (ShaderSources::default(), 0, vec![folder.to_owned()]);
    while let Some(inner) = folders.pop() {
        let failed = |path: &Path, error: std::io::Error| format!("{}: cannot read: {error}", path.display());
        let entries = std::fs::read_dir(&inner).map_err(|error| failed(&inner, error))?;
        for path in entries.filter_map(|entry| Some(entry.ok()?.path())) {
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "wgsl") {
                let text = std::fs::read_to_string(&path).map_err(|error| failed(&path, error))?;
                let name = name_in(folder, &path);
                known += u32::from(SOURCES.iter().any(|(source, _)| *source == name));
                sources.insert(&name, text);
            }
        }
    }
    let problem =
        || format!("{}: holds no shader that pictures are made of, such as color/srgb.wgsl", folder.display());
    if known == 0 { Err(problem()) } else { Ok(sources) }
}

/// The path of a file from the folder on, as imports have it.
fn name_in(folder: &Path, path: &Path) -> String {
    let parts = path.strip_prefix(folder).unwrap_or(path).iter();
    parts.map(|part| part.to_string_lossy()).collect::<Vec<_>>().join("/")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_of_a_folder_replace_those_that_are_built_in() {
        let folder = tempfile::tempdir().unwrap();
        let problem = read(folder.path()).unwrap_err();
        assert!(problem.contains("holds no shader") && !problem.contains('\n'), "{problem}");
        std::fs::create_dir(folder.path().join("color")).unwrap();
        std::fs::write(folder.path().join("color/srgb.wgsl"), "// changed").unwrap();
        std::fs::write(folder.path().join("mine.wgsl"), "// new").unwrap();
        std::fs::write(folder.path().join("color/notes.txt"), "no shader").unwrap();
        let sources = read(folder.path()).unwrap();
        assert_eq!(sources.get("color/srgb.wgsl"), Some("// changed"));
        assert_eq!(sources.get("mine.wgsl"), Some("// new"));
        assert_eq!(sources.get("color/notes.txt"), None);
        assert_eq!(sources.get("pass/forward.wgsl"), ShaderSources::default().get("pass/forward.wgsl"));
        // Those of the repository are the ones that are built in.
        let own = read(&Path::new(env!("CARGO_MANIFEST_DIR")).join("shaders")).unwrap();
        for (name, text) in SOURCES {
            assert_eq!(own.get(name), Some(*text), "{name}");
        }
    }
}
