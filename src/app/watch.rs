//! Files that are looked after: a model and what it is made of, shaders.

use super::loading::Wake;
use notify::{Event, RecommendedWatcher, RecursiveMode, Watcher};
use percent_encoding::percent_decode_str;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, channel};
use std::time::Duration;

/// A file is read when nothing has been written for so long: programs write in pieces.
const QUIET: Duration = Duration::from_millis(200);

/// Looks after files, until it is dropped.
pub(super) struct Watch {
    changed: Arc<AtomicBool>,
    /// Ends the thread when it goes.
    _watcher: RecommendedWatcher,
}

/// Looks after a model, and after the files that it names.
pub(super) struct ModelWatch {
    files: BTreeSet<PathBuf>,
    watch: Watch,
}

impl Watch {
    /// After the files in these folders that are meant. `what` is what they are of.
    ///
    /// # Errors
    /// One line, when the system does not look after files here.
    fn new(
        (what, folders, mode): (&Path, &BTreeSet<PathBuf>, RecursiveMode),
        is_meant: impl Fn(&Path) -> bool + Send + 'static,
        wake: Wake,
    ) -> Result<Self, String> {
        let failed = |error: notify::Error| format!("{}: cannot be watched: {error}", what.display());
        let (send, events) = channel();
        let mut watcher = notify::recommended_watcher(move |event: notify::Result<Event>| {
            let writes = |event: &Event| !event.kind.is_access() && event.paths.iter().any(|path| is_meant(path));
            if event.as_ref().is_ok_and(writes) {
                // The thread ends only after this.
                let _ = send.send(());
            }
        })
        .map_err(failed)?;
        folders.iter().try_for_each(|folder| watcher.watch(folder, mode)).map_err(failed)?;
        let changed = Arc::new(AtomicBool::new(false));
        let flag = Arc::clone(&changed);
        std::thread::spawn(move || tell_when_quiet(&events, &flag, &wake));
        Ok(Self { changed, _watcher: watcher })
    }

    /// After all WGSL files of a folder, however deep.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub(super) fn of_shaders(folder: &Path, wake: Wake) -> Result<Self, String> {
        let is_shader = |path: &Path| path.extension().is_some_and(|extension| extension == "wgsl");
        Self::new((folder, &[folder.to_owned()].into(), RecursiveMode::Recursive), is_shader, wake)
    }

    /// Whether the files are others than when this was asked before.
    pub(super) fn has_changed(&self) -> bool {
        self.changed.swap(false, Ordering::Relaxed)
    }
}

impl ModelWatch {
    /// # Errors
    /// One line, when the system does not look after files here.
    fn new(model: &Path, files: BTreeSet<PathBuf>, wake: Wake) -> Result<Self, String> {
        // The folders and not the files: many programs replace a file by another of the same name.
        let folders = files.iter().filter_map(|file| Some(file.parent()?.to_owned())).collect();
        let meant = files.clone();
        let is_meant = move |path: &Path| meant.contains(path);
        Ok(Self { files, watch: Watch::new((model, &folders, RecursiveMode::NonRecursive), is_meant, wake)? })
    }

    /// Looks after a model from now on, which may name other files than it did; what has changed is not forgotten.
    ///
    /// # Errors
    /// One line, when the system does not look after files here.
    pub(super) fn follow(watch: &mut Option<Self>, model: &Path, wake: Wake) -> Result<(), String> {
        let files = files_of(model);
        if watch.as_ref().is_none_or(|watch| watch.files != files) {
            *watch = Some(Self::new(model, files, wake)?);
        }
        Ok(())
    }

    /// Whether the files are others than when this was asked before.
    pub(super) fn has_changed(&self) -> bool {
        self.watch.has_changed()
    }
}

fn tell_when_quiet(events: &Receiver<()>, changed: &AtomicBool, wake: &Wake) {
    while events.recv().is_ok() {
        while events.recv_timeout(QUIET).is_ok() {}
        changed.store(true, Ordering::Relaxed);
        wake();
    }
}

/// The model, and the files that a .gltf names, by absolute paths.
fn files_of(model: &Path) -> BTreeSet<PathBuf> {
    let model = model.canonicalize().unwrap_or_else(|_| model.to_owned());
    let folder = model.parent().unwrap_or(Path::new("."));
    let json: serde_json::Value =
        std::fs::read(&model).ok().and_then(|bytes| serde_json::from_slice(&bytes).ok()).unwrap_or_default();
    let named = ["buffers", "images"].into_iter().filter_map(|list| json.get(list)?.as_array()).flatten();
    let uris = named.filter_map(|entry| entry.get("uri")?.as_str()).filter(|uri| !uri.starts_with("data:"));
    let path = |uri: &str| folder.join(percent_decode_str(uri).decode_utf8_lossy().as_ref());
    uris.map(path).chain([model.clone()]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_files_of_a_model_are_known() {
        let folder = tempfile::tempdir().unwrap();
        let root = folder.path().canonicalize().unwrap();
        let gltf = r#"{"buffers":[{"uri":"a%20b.bin"},{"uri":"data:,x"}],"images":[{"uri":"textures/c.png"},{}]}"#;
        std::fs::write(root.join("model.gltf"), gltf).unwrap();
        let expected = ["a b.bin", "model.gltf", "textures/c.png"].map(|name| root.join(name));
        assert_eq!(files_of(&root.join("model.gltf")), expected.into());
    }
}
