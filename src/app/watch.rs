//! Files that are looked after: a model and what it is made of.

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

/// Looks after one model, until it is dropped.
pub(super) struct Watch {
    pub(super) model: PathBuf,
    changed: Arc<AtomicBool>,
    /// Ends the thread when it goes.
    _watcher: RecommendedWatcher,
}

impl Watch {
    /// # Errors
    /// One line, when the system does not look after files here.
    pub(super) fn new(model: &Path, wake: Wake) -> Result<Self, String> {
        let failed = |error: notify::Error| format!("{}: cannot be watched: {error}", model.display());
        let files = files_of(model);
        let folders: BTreeSet<PathBuf> = files.iter().filter_map(|file| Some(file.parent()?.to_owned())).collect();
        let (send, events) = channel();
        let mut watcher = notify::recommended_watcher(move |event: notify::Result<Event>| {
            let is_ours = |path: &PathBuf| files.contains(path);
            let writes = |event: &Event| !event.kind.is_access() && event.paths.iter().any(is_ours);
            if event.as_ref().is_ok_and(writes) {
                // The thread ends only after this.
                let _ = send.send(());
            }
        })
        .map_err(failed)?;
        // The folders and not the files: many programs replace a file by another of the same name.
        folders.iter().try_for_each(|folder| watcher.watch(folder, RecursiveMode::NonRecursive)).map_err(failed)?;
        let changed = Arc::new(AtomicBool::new(false));
        let flag = Arc::clone(&changed);
        std::thread::spawn(move || tell_when_quiet(&events, &flag, &wake));
        Ok(Self { model: model.to_owned(), changed, _watcher: watcher })
    }

    /// Whether the files are others than when this was asked before.
    pub(super) fn has_changed(&self) -> bool {
        self.changed.swap(false, Ordering::Relaxed)
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
