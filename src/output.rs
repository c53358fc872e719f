//! Writing files: whole or not at all.

use std::borrow::Cow;
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

/// A temporary file that is readable by whom the user's umask allows, as any other new file.
fn new_file_in(folder: &Path) -> std::io::Result<tempfile::NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".specula-").suffix(".tmp");
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
}
