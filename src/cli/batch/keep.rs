//! Pictures that say what they were drawn by, so that a run that is resumed leaves out what is done.

use crate::cli::output;
use serde::{Deserialize, Serialize};
use std::io::Cursor;
use std::path::Path;

/// Keyword of the record in a PNG.
const KEYWORD: &str = "specula:picture";

/// What a picture says of itself.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Record {
    /// Version of Specula.
    pub(super) version: String,
    /// As it was named.
    pub(super) model: String,
    /// BLAKE3 of all that decides the pixels: program, driver, files, settings, camera.
    pub(super) key: String,
}

/// BLAKE3 of texts, of which none can be taken for the end of the one before.
pub(super) fn key(texts: &[&str]) -> String {
    let mut hasher = blake3::Hasher::new();
    for text in texts {
        hasher.update(&(text.len() as u64).to_le_bytes()).update(text.as_bytes());
    }
    hasher.finalize().to_hex().to_string()
}

/// The PNG of a picture with its record.
///
/// # Errors
/// When it cannot be encoded.
pub(super) fn encode(width: u32, height: u32, rgba: &[u8], record: &Record) -> Result<Vec<u8>, String> {
    let text = serde_json::to_string(record).map_err(|error| error.to_string())?;
    output::png_with_texts(width, height, rgba, &[(KEYWORD, &text)])
}

/// Whether there is a whole picture with this record.
pub(super) fn is_done(path: &Path, record: &Record) -> bool {
    std::fs::read(path).is_ok_and(|bytes| recorded(&bytes).as_ref() == Some(record))
}

/// The record of a PNG, if that can be read to its end.
fn recorded(bytes: &[u8]) -> Option<Record> {
    let mut reader = png::Decoder::new(Cursor::new(bytes)).read_info().ok()?;
    let mut pixels = vec![0; reader.output_buffer_size()?];
    reader.next_frame(&mut pixels).ok()?;
    reader.finish().ok()?;
    let text = reader.info().utf8_text.iter().find(|text| text.keyword == KEYWORD)?.get_text().ok()?;
    serde_json::from_str(&text).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_is_done_when_it_is_whole_and_of_the_same_settings() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.png");
        let record = Record { version: "1".into(), model: "m.glb".into(), key: key(&["a", "b"]) };
        assert!(!is_done(&path, &record));
        let png = encode(8, 8, &[7; 256], &record).unwrap();
        std::fs::write(&path, &png).unwrap();
        assert!(is_done(&path, &record));
        for (a, b) in [(["ab", ""], "moved"), (["a", "c"], "other")] {
            assert!(!is_done(&path, &Record { key: key(&a), ..record.clone() }), "{b}");
        }
        for end in [png.len() - 1, png.len() - 20, 40, 0] {
            std::fs::write(&path, &png[..end]).unwrap();
            assert!(!is_done(&path, &record), "{end} of {} bytes", png.len());
        }
        std::fs::write(&path, output::png(8, 8, &[7; 256]).unwrap()).unwrap();
        assert!(!is_done(&path, &record), "a picture without a record");
    }
}
