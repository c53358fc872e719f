//! The models of a folder.

use std::path::{Path, PathBuf};

fn is_model(path: &Path) -> bool {
    let extension = path.extension().map(|extension| extension.to_string_lossy().to_lowercase());
    matches!(extension.as_deref(), Some("gltf" | "glb"))
}

/// The models right in `folder`, by name.
///
/// # Errors
/// When the folder cannot be read: one line for people.
pub(super) fn models(folder: &Path) -> Result<Vec<PathBuf>, String> {
    let entries = std::fs::read_dir(folder).map_err(|error| format!("{}: cannot read: {error}", folder.display()))?;
    let mut models: Vec<PathBuf> =
        entries.filter_map(|entry| Some(entry.ok()?.path())).filter(|path| is_model(path) && path.is_file()).collect();
    models.sort();
    Ok(models)
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
}
