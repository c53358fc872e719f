//! Bytes from outside the document: data URIs, and files that lie in the model's folder. Nothing else is ever opened.

use super::error::{Fault, quote};
use super::limits::Budget;
use base64::Engine;
use base64::alphabet;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};
use percent_encoding::percent_decode_str;
use std::fs::{self, File};
use std::io::Read;
use std::path::{Component, Path, PathBuf};

/// Where a document's uris lead.
#[derive(Debug)]
pub(super) struct Resources<'a> {
    /// The model's folder, with symbolic links resolved; `None` for a model that did not come from a file.
    folder: Option<PathBuf>,
    budget: &'a Budget,
}

const STAY_INSIDE: &str = "put the file next to the model and refer to it by a relative uri";

impl<'a> Resources<'a> {
    pub(super) fn new(folder: Option<&Path>, budget: &'a Budget) -> Self {
        let resolve = |folder: &Path| {
            // The parent of a bare file name is the empty path.
            fs::canonicalize(if folder.as_os_str().is_empty() { Path::new(".") } else { folder }).ok()
        };
        Self { folder: folder.and_then(resolve), budget }
    }

    /// The bytes behind `uri`, which the document gives at `pointer`.
    pub(super) fn load(&self, uri: &str, pointer: &str) -> Result<Vec<u8>, Fault> {
        match data_of(uri) {
            Some(data) => self.decode_data(data, pointer),
            None => self.read_file(uri, pointer),
        }
    }

    /// The file that `uri` names; `None` where it holds its bytes itself.
    pub(super) fn file(&self, uri: &str, pointer: &str) -> Result<Option<PathBuf>, Fault> {
        if data_of(uri).is_some() { Ok(None) } else { self.resolve(uri, pointer).map(Some) }
    }

    /// How many bytes `uri` takes as it is encoded; 0 where it cannot be followed.
    pub(super) fn length(&self, uri: &str) -> u64 {
        let length_of_file = || fs::metadata(self.resolve(uri, "").ok()?).ok().map(|file| file.len());
        data_of(uri).map_or_else(|| length_of_file().unwrap_or(0), |data| data.len() as u64)
    }

    /// The part of a data URI after `data:` (RFC 2397).
    fn decode_data(&self, rest: &str, pointer: &str) -> Result<Vec<u8>, Fault> {
        let Some((media, data)) = rest.split_once(',') else {
            return Err(Fault::at(pointer, "the data URI has no comma before its data"));
        };
        self.budget.take(data.len() as u64, 1, pointer)?;
        if !media.trim_end().to_ascii_lowercase().ends_with(";base64") {
            return Ok(percent_decode_str(data).collect());
        }
        let lenient = GeneralPurposeConfig::new().with_decode_padding_mode(DecodePaddingMode::Indifferent);
        GeneralPurpose::new(&alphabet::STANDARD, lenient)
            .decode(data)
            .map_err(|error| Fault::at(pointer, format!("the base64 of the data URI is broken: {error}")))
    }

    fn read_file(&self, uri: &str, pointer: &str) -> Result<Vec<u8>, Fault> {
        let path = self.resolve(uri, pointer)?;
        let unreadable = |error: std::io::Error| {
            Fault::at(pointer, format!("{} cannot be read: {error}", quote(uri)))
                .advise("check that the file is readable")
        };
        let length = fs::metadata(&path).map_err(unreadable)?.len();
        self.budget.take(length, 1, pointer)?;
        let mut bytes = Vec::new();
        // A file that grows while it is read gives no more than was budgeted.
        File::open(&path).map_err(unreadable)?.take(length).read_to_end(&mut bytes).map_err(unreadable)?;
        Ok(bytes)
    }

    /// The regular file inside the model's folder that `uri` names.
    fn resolve(&self, uri: &str, pointer: &str) -> Result<PathBuf, Fault> {
        let refuse = |problem: &str| Fault::at(pointer, format!("{} {problem}", quote(uri))).advise(STAY_INSIDE);
        let decoded = percent_decode_str(uri)
            .decode_utf8()
            .map_err(|_| refuse("is not UTF-8 once its percent signs are decoded"))?;
        if scheme(uri).is_some() || scheme(&decoded).is_some() {
            return Err(refuse("has a scheme other than data:"));
        }
        let relative = Path::new(decoded.as_ref());
        let rooted = |part: Component<'_>| matches!(part, Component::RootDir | Component::Prefix(_));
        if relative.components().any(rooted) || decoded.starts_with(['/', '\\']) {
            return Err(refuse("is an absolute path"));
        }
        let Some(folder) = &self.folder else {
            return Err(
                refuse("names a file, but the model has no folder").advise("give the model as a file, or as one .glb")
            );
        };
        let path = fs::canonicalize(folder.join(relative)).map_err(|error| {
            refuse(&format!("cannot be found: {error}")).advise("put the file where the uri says, next to the model")
        })?;
        if !path.starts_with(folder) {
            return Err(refuse("leads out of the model's folder"));
        }
        // Devices and pipes need never end.
        if !path.is_file() {
            return Err(refuse("is not a regular file"));
        }
        Ok(path)
    }
}

/// What stands after `data:` in a data URI.
fn data_of(uri: &str) -> Option<&str> {
    let scheme = scheme(uri).filter(|scheme| scheme.eq_ignore_ascii_case("data"))?;
    Some(&uri[scheme.len() + 1..])
}

/// The scheme of a uri, without its colon (RFC 3986, 3.1). A drive letter counts as one.
fn scheme(uri: &str) -> Option<&str> {
    let (scheme, _) = uri.split_once(':')?;
    let legal = |c: char| c.is_ascii_alphanumeric() || matches!(c, '+' | '-' | '.');
    (scheme.starts_with(|c: char| c.is_ascii_alphabetic()) && scheme.chars().all(legal)).then_some(scheme)
}
