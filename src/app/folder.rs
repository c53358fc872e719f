//! Folders and the files in them that can be opened.

use std::path::{Path, PathBuf};

/// What a file is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Model,
    Panorama,
}

impl Kind {
    /// Whether a file is one, by its name.
    pub(super) fn is_of(self, path: &Path) -> bool {
        let extension = path.extension().map(|extension| extension.to_string_lossy().to_lowercase());
        match self {
            Self::Model => matches!(extension.as_deref(), Some("gltf" | "glb")),
            Self::Panorama => matches!(extension.as_deref(), Some("hdr" | "exr")),
        }
    }
}

/// Whether a file is a state that the viewer has saved, by its name.
pub fn is_state(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("json"))
}

/// What can be gone to or opened from a folder, each by name.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Listing {
    pub(super) kind: Kind,
    /// Absolute.
    pub(super) folder: PathBuf,
    /// Without the hidden ones.
    pub(super) folders: Vec<PathBuf>,
    pub(super) files: Vec<PathBuf>,
}

impl Listing {
    /// Of a folder, and the files of a kind that are right in it.
    ///
    /// # Errors
    /// When the folder cannot be read: one line for people.
    pub(super) fn new(folder: &Path, kind: Kind) -> Result<Self, String> {
        let folder = folder.canonicalize().map_err(|error| unreadable(folder, &error))?;
        let is_hidden = |path: &Path| path.file_name().is_some_and(|name| name.to_string_lossy().starts_with('.'));
        let (folders, files): (Vec<_>, Vec<_>) = entries(&folder)?.into_iter().partition(|path| path.is_dir());
        Ok(Self {
            kind,
            folders: folders.into_iter().filter(|path| !is_hidden(path)).collect(),
            files: files.into_iter().filter(|path| kind.is_of(path) && path.is_file()).collect(),
            folder,
        })
    }

    /// The first of these folders that can be read.
    pub(super) fn of_any<'a>(folders: impl IntoIterator<Item = &'a Path>, kind: Kind) -> Result<Self, String> {
        let first = folders.into_iter().find_map(|folder| Self::new(folder, kind).ok());
        first.map_or_else(|| Self::new(Path::new("."), kind), Ok)
    }
}

fn unreadable(folder: &Path, error: &std::io::Error) -> String {
    format!("{}: cannot read: {error}", folder.display())
}

/// By name.
fn entries(folder: &Path) -> Result<Vec<PathBuf>, String> {
    let entries = std::fs::read_dir(folder).map_err(|error| unreadable(folder, &error))?;
    let mut paths: Vec<PathBuf> = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
    paths.sort();
    Ok(paths)
}

/// The models right in `folder`, by name.
///
/// # Errors
/// When the folder cannot be read: one line for people.
pub(super) fn models(folder: &Path) -> Result<Vec<PathBuf>, String> {
    let is_model = |path: &PathBuf| Kind::Model.is_of(path) && path.is_file();
    Ok(entries(folder)?.into_iter().filter(is_model).collect())
}

/// The model that a file or a folder stands for.
///
/// # Errors
/// When a folder cannot be read or holds no model.
pub(super) fn model_of(path: &Path) -> Result<PathBuf, String> {
    if !path.is_dir() {
        return Ok(path.to_owned());
    }
    let first = models(path)?.into_iter().next();
    first.ok_or_else(|| format!("{}: there is no .gltf or .glb in this folder", path.display()))
}

/// The model of the same folder that comes after `path`, or before it, from the end on to the other end.
///
/// # Errors
/// When the folder cannot be read or holds no other model.
pub(super) fn neighbour(path: &Path, backward: bool) -> Result<PathBuf, String> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let models = models(folder)?;
    let here = models.iter().position(|model| model.file_name() == path.file_name());
    let next = match (here, backward) {
        (Some(here), false) => here + 1,
        (Some(here), true) => here + models.len() - 1,
        (None, _) => 0,
    };
    let other = models.get(next % models.len().max(1)).filter(|other| other.file_name() != path.file_name());
    other.cloned().ok_or_else(|| format!("{}: there is no other model in this folder", folder.display()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arrows_walk_around_a_folder() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        assert!(model_of(folder.path()).unwrap_err().contains("no .gltf or .glb"));
        for name in ["b.glb", "a.gltf", "c.GLB", "notes.txt"] {
            std::fs::write(path(name), "").unwrap();
        }
        assert_eq!(model_of(folder.path()).unwrap(), path("a.gltf"));
        assert_eq!(neighbour(&path("a.gltf"), false).unwrap(), path("b.glb"));
        assert_eq!(neighbour(&path("a.gltf"), true).unwrap(), path("c.GLB"));
        assert_eq!(neighbour(&path("c.GLB"), false).unwrap(), path("a.gltf"));
        assert!(neighbour(&path("no/such.glb"), false).unwrap_err().contains("cannot read"));
    }

    #[test]
    fn folders_are_listed_by_what_is_wanted() {
        let folder = tempfile::tempdir().unwrap();
        let root = folder.path().canonicalize().unwrap();
        for name in ["models", ".hidden", "looks-like.glb"] {
            std::fs::create_dir(root.join(name)).unwrap();
        }
        for name in ["b.GLB", "a.gltf", "sky.exr", "dawn.HDR", "notes.txt"] {
            std::fs::write(root.join(name), "").unwrap();
        }
        let names = |paths: &[PathBuf]| -> Vec<String> {
            paths.iter().map(|path| path.strip_prefix(&root).unwrap().display().to_string()).collect()
        };
        let models = Listing::new(&root, Kind::Model).unwrap();
        assert_eq!(names(&models.folders), ["looks-like.glb", "models"]);
        assert_eq!(names(&models.files), ["a.gltf", "b.GLB"]);
        assert_eq!(names(&Listing::new(&root, Kind::Panorama).unwrap().files), ["dawn.HDR", "sky.exr"]);
        let missing = root.join("missing");
        assert!(Listing::new(&missing, Kind::Model).unwrap_err().contains("missing: cannot read"));
        assert_eq!(Listing::of_any([missing.as_path(), &root], Kind::Model).unwrap(), models);
    }
}
