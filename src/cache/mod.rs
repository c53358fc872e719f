//! Prefiltered environments in files, from one run of a program to the next.
//!
//! [`EnvironmentCache::bake`] is [`environment::bake`] with a memory: it gives the same bits, and no state of the folder
//! makes it fail. A file is found by the hash of everything that its content depends on, and believed only if its
//! checksum is right; whatever else lies there counts as nothing.

mod folder;
mod format;
mod key;
mod store;
#[cfg(test)]
mod tests;

use crate::bake::environment::{self, BakeOptions};
use crate::progress::Progress;
use crate::scene::{EnvironmentImage, EnvironmentMaps};
use key::Key;
use std::path::{Path, PathBuf};
use store::Store;

/// Bytes of files that a cache keeps unless told otherwise: more than fifty panoramas of 1024 x 512.
pub const DEFAULT_LIMIT_BYTES: u64 = 512 << 20;

/// Where what can be made anew is kept for whoever runs this process: `SPECULA_CACHE_DIR`, or else `specula` where the
/// system keeps caches: `$XDG_CACHE_HOME` or `~/.cache`, `~/Library/Caches`, `%LOCALAPPDATA%`. `None` where the environment
/// names none of them.
pub fn user_folder() -> Option<PathBuf> {
    folder::of_user(std::env::consts::OS, |name| std::env::var_os(name))
}

/// A folder with prefiltered environments. Threads and processes may share it.
#[derive(Debug, Clone)]
pub struct EnvironmentCache {
    store: Store,
}

/// Where maps have come from.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Outcome {
    /// From a file.
    Hit,
    /// They were baked, and the next run finds them.
    Stored,
    /// They were baked and could not be stored, for this reason.
    Unavailable(String),
}

impl EnvironmentCache {
    /// Keeps files in `folder`, which is made when it is first written to. Where they exceed `limit_bytes`, those that
    /// were used longest ago go; files of other names are left alone.
    pub fn in_folder(folder: impl Into<PathBuf>, limit_bytes: u64) -> Self {
        Self { store: Store { folder: folder.into(), limit_bytes } }
    }

    /// The cache of whoever runs this process, in its place below [`user_folder`].
    pub fn of_user() -> Option<Self> {
        user_folder().map(|folder| Self::below(&folder))
    }

    /// The cache that has its place below a folder for all that a user's programs keep, of [`DEFAULT_LIMIT_BYTES`].
    pub fn below(folder: &Path) -> Self {
        Self::in_folder(folder.join("environments"), DEFAULT_LIMIT_BYTES)
    }

    /// The maps of [`environment::bake`], if there is a file of them.
    pub fn find(&self, image: &EnvironmentImage, options: &BakeOptions) -> Option<EnvironmentMaps> {
        self.store.load(&Key::of(image, options))
    }

    /// The maps of [`environment::bake`], from a file if there is one. A file that is truncated or altered is replaced.
    pub fn bake(
        &self,
        image: &EnvironmentImage,
        options: &BakeOptions,
        progress: &dyn Progress,
    ) -> (EnvironmentMaps, Outcome) {
        let key = Key::of(image, options);
        if let Some(maps) = self.store.load(&key) {
            return (maps, Outcome::Hit);
        }
        let maps = environment::bake(image, options, progress);
        let outcome = match self.store.save(&key, &maps) {
            Ok(()) => Outcome::Stored,
            Err(reason) => Outcome::Unavailable(format!("{}: {reason}", self.store.folder.display())),
        };
        (maps, outcome)
    }
}
