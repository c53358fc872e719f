//! Files by key in one folder, the oldest of which go when they become too many.

use super::format;
use super::key::Key;
use crate::scene::EnvironmentMaps;
use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

const PREFIX: &str = ".unfinished-";
const SUFFIX: &str = ".maps";

/// Unfinished files older than this were left by a process that has died.
const LONGEST_WRITE: Duration = Duration::from_secs(3600);

#[derive(Debug, Clone)]
pub(super) struct Store {
    pub(super) folder: PathBuf,
    pub(super) limit_bytes: u64,
}

/// A file that this module has made.
struct Entry {
    path: PathBuf,
    bytes: u64,
    used: SystemTime,
}

impl Store {
    /// The maps that were saved under `key`, if their file is whole.
    pub(super) fn load(&self, key: &Key) -> Option<EnvironmentMaps> {
        let path = self.path(key);
        let (mut file, length) = open(&path, self.limit_bytes).ok()?;
        let maps = format::decode(key, &mut file, length)?;
        // Best effort: in a folder that may only be read, nothing is evicted either.
        let _ = File::options().append(true).open(&path).and_then(|file| file.set_modified(SystemTime::now()));
        Some(maps)
    }

    /// Saves `maps` under `key`: the file is there as a whole or not at all.
    pub(super) fn save(&self, key: &Key, maps: &EnvironmentMaps) -> io::Result<()> {
        let bytes = format::encode(key, maps);
        if bytes.len() as u64 > self.limit_bytes {
            return Err(io::Error::other("the environment exceeds the limit of the cache"));
        }
        fs::create_dir_all(&self.folder)?;
        let mut file = tempfile::Builder::new().prefix(PREFIX).suffix(SUFFIX).tempfile_in(&self.folder)?;
        // Not flushed to the disk: what a loss of power leaves has the wrong checksum.
        file.write_all(&bytes)?;
        let path = self.path(key);
        file.persist(&path).map_err(|error| error.error)?;
        self.evict(&path);
        Ok(())
    }

    fn path(&self, key: &Key) -> PathBuf {
        self.folder.join(key.hex() + SUFFIX)
    }

    /// Deletes the files that were used longest ago until the rest is within the limit, but not `kept`. What another
    /// process deletes first, or holds open, is its business.
    fn evict(&self, kept: &Path) {
        let Ok(listing) = fs::read_dir(&self.folder) else { return };
        let mut entries: Vec<Entry> = listing.flatten().filter_map(|file| entry(&file)).collect();
        entries.sort_by(|a, b| a.used.cmp(&b.used).then_with(|| a.path.cmp(&b.path)));
        let mut total: u64 = entries.iter().map(|entry| entry.bytes).sum();
        for entry in entries.iter().filter(|entry| entry.path != kept) {
            if total <= self.limit_bytes {
                break;
            }
            if fs::remove_file(&entry.path).is_ok() {
                total -= entry.bytes;
            }
        }
    }
}

/// What `file` is to eviction; an abandoned one counts as never used, one in the making not at all.
fn entry(file: &fs::DirEntry) -> Option<Entry> {
    let name = file.file_name().into_string().ok()?;
    let metadata = file.metadata().ok().filter(fs::Metadata::is_file)?;
    let modified = metadata.modified().ok()?;
    let stem = name.strip_suffix(SUFFIX)?;
    let is_key = stem.len() == 64 && stem.bytes().all(|byte| byte.is_ascii_hexdigit());
    let is_abandoned = stem.starts_with(PREFIX) && modified.elapsed().is_ok_and(|age| age > LONGEST_WRITE);
    let used = if is_abandoned { SystemTime::UNIX_EPOCH } else { modified };
    (is_key || is_abandoned).then(|| Entry { path: file.path(), bytes: metadata.len(), used })
}

/// A file of at most `limit` bytes, and its length.
fn open(path: &Path, limit: u64) -> io::Result<(File, u64)> {
    // Looked at by name first: to open a pipe would wait for its other end.
    let metadata = fs::metadata(path)?;
    if !metadata.is_file() || metadata.len() > limit {
        return Err(io::Error::other("not a file of this cache"));
    }
    Ok((File::open(path)?, metadata.len()))
}
