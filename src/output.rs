//! Writing files: whole or not at all.

use std::borrow::Cow;
use std::fs::TryLockError;
use std::io::Write;
use std::path::{Path, PathBuf};

/// Why there is no file.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{path}: cannot write: {reason}", path = .path.display())]
pub(crate) struct WriteError {
    pub path: PathBuf,
    pub reason: String,
}

/// PNG of straight-alpha sRGB; three channels when every pixel is opaque.
pub(crate) fn png(width: u32, height: u32, rgba: &[u8]) -> Result<Vec<u8>, String> {
    png_with_texts(width, height, rgba, &[])
}

/// The same with texts, each under a Latin-1 keyword of 1 to 79 characters (iTXt, PNG 11.3.3.4).
pub(crate) fn png_with_texts(width: u32, height: u32, rgba: &[u8], texts: &[(&str, &str)]) -> Result<Vec<u8>, String> {
    let opaque = rgba.chunks_exact(4).all(|pixel| pixel[3] == 255);
    let without_alpha = || rgba.chunks_exact(4).flat_map(|pixel| [pixel[0], pixel[1], pixel[2]]).collect();
    let pixels: Cow<'_, [u8]> = if opaque { Cow::Owned(without_alpha()) } else { Cow::Borrowed(rgba) };
    let mut bytes = Vec::new();
    let mut encoder = ::png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(if opaque { ::png::ColorType::Rgb } else { ::png::ColorType::Rgba });
    encoder.set_depth(::png::BitDepth::Eight);
    encoder.set_compression(::png::Compression::Fast);
    encoder.set_filter(::png::Filter::Adaptive);
    let write = |mut encoder: ::png::Encoder<'_, &mut Vec<u8>>| -> Result<(), ::png::EncodingError> {
        for (keyword, text) in texts {
            encoder.add_itxt_chunk((*keyword).to_owned(), (*text).to_owned())?;
        }
        let mut writer = encoder.write_header()?;
        writer.write_image_data(&pixels)?;
        writer.finish()
    };
    write(encoder).map_err(|error| error.to_string())?;
    Ok(bytes)
}

/// Writes `bytes` to `path`, or to stdout for `-`. A file appears under its name only when it is complete.
pub(crate) fn write(path: &Path, bytes: &[u8]) -> Result<(), WriteError> {
    let failed = |error: std::io::Error| WriteError { path: path.to_owned(), reason: error.to_string() };
    if path == Path::new("-") {
        let mut stdout = std::io::stdout().lock();
        return stdout.write_all(bytes).and_then(|()| stdout.flush()).map_err(failed);
    }
    if path.is_dir() {
        return Err(WriteError { path: path.to_owned(), reason: "it is a folder; name a file in it".into() });
    }
    let folder = path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let mut file = new_file_in(folder).map_err(failed)?;
    file.write_all(bytes).and_then(|()| file.as_file().sync_all()).map_err(failed)?;
    file.persist(path).map_err(|error| failed(error.error))?;
    Ok(())
}

/// How the names of temporary files begin and end.
const TEMPORARY: (&str, &str) = (".specula-", ".tmp");

/// A temporary file that is readable by whom the user's umask allows, as any other new file. It is locked as long as it is
/// open, so that [`clear_stale`] of a neighbour leaves it alone.
fn new_file_in(folder: &Path) -> std::io::Result<tempfile::NamedTempFile> {
    loop {
        let file = unlocked_file_in(folder)?;
        match file.as_file().try_lock() {
            // A neighbour has taken it for a stale one, in the moment before it was locked.
            Err(TryLockError::WouldBlock) => {}
            Ok(()) if !file.path().exists() => {}
            // Where files cannot be locked, none is ever cleared.
            Ok(()) | Err(TryLockError::Error(_)) => return Ok(file),
        }
    }
}

/// Removes the temporary files that processes have left in the folder when they were killed: the system has let go of
/// their locks. What cannot be removed is in nobody's way.
pub(crate) fn clear_stale(folder: &Path) {
    clear(folder, false);
}

/// The same with the folders in it, however deep; links are not followed.
pub(crate) fn clear_stale_below(folder: &Path) {
    clear(folder, true);
}

fn clear(folder: &Path, with_folders: bool) {
    let Ok(entries) = std::fs::read_dir(folder) else { return };
    for entry in entries.flatten() {
        let name = entry.file_name();
        let is_ours = name.to_str().is_some_and(|name| name.starts_with(TEMPORARY.0) && name.ends_with(TEMPORARY.1));
        match entry.file_type() {
            Ok(kind) if kind.is_dir() && with_folders => clear(&entry.path(), true),
            Ok(kind) if kind.is_file() && is_ours => remove_unlocked(&entry.path()),
            _ => {}
        }
    }
}

/// Removes a file that nobody has locked, while it is locked itself.
fn remove_unlocked(path: &Path) {
    // Locks over a network want files that are open for writing.
    if let Ok(file) = std::fs::OpenOptions::new().write(true).open(path)
        && file.try_lock().is_ok()
    {
        // That it is gone, or is not ours to remove, is no fault.
        let _ = std::fs::remove_file(path);
    }
}

fn unlocked_file_in(folder: &Path) -> std::io::Result<tempfile::NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(TEMPORARY.0).suffix(TEMPORARY.1);
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(std::fs::Permissions::from_mode(0o666));
    }
    builder.tempfile_in(folder)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_replaced_whole_and_nothing_is_left_beside_it() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("out.png");
        write(&path, b"first").unwrap();
        write(&path, b"second").unwrap();
        assert_eq!(std::fs::read(&path).unwrap(), b"second");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
        assert!(write(&folder.path().join("no/such/folder.png"), b"").is_err());
        assert!(write(folder.path(), b"").is_err());
    }

    #[test]
    fn stale_files_go_and_those_of_a_neighbour_stay() {
        let folder = tempfile::tempdir().unwrap();
        let below = folder.path().join("a/b");
        std::fs::create_dir_all(&below).unwrap();
        let path = |name: &str| below.join(name);
        for name in [".specula-x1.tmp", ".specula-x2.tmp", "other.tmp", ".specula-x.png", "a.png"] {
            std::fs::write(path(name), b"half a pic").unwrap();
        }
        let live = new_file_in(&below).unwrap();
        clear_stale(folder.path());
        assert!(path(".specula-x1.tmp").exists(), "a folder in the folder is none of its business");
        clear_stale_below(folder.path());
        let mut left: Vec<_> = std::fs::read_dir(&below).unwrap().map(|entry| entry.unwrap().path()).collect();
        left.sort();
        let mut expected = [".specula-x.png", "a.png", "other.tmp"].map(path).to_vec();
        expected.push(live.path().to_owned());
        expected.sort();
        assert_eq!(left, expected);
        live.persist(path("done.png")).unwrap();
        assert!(path("done.png").exists());
        clear_stale_below(&folder.path().join("none"));
    }

    #[test]
    fn nothing_is_lost_while_a_neighbour_clears() {
        let folder = tempfile::tempdir().unwrap();
        let is_done = std::sync::atomic::AtomicBool::new(false);
        std::thread::scope(|scope| {
            let clear = || {
                while !is_done.load(std::sync::atomic::Ordering::Relaxed) {
                    clear_stale(folder.path());
                }
            };
            scope.spawn(clear);
            scope.spawn(clear);
            for index in 0..300 {
                let path = folder.path().join(format!("{index}.png"));
                write(&path, &[index as u8; 64]).unwrap();
                assert_eq!(std::fs::read(&path).unwrap(), [index as u8; 64]);
            }
            is_done.store(true, std::sync::atomic::Ordering::Relaxed);
        });
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 300);
    }
}
