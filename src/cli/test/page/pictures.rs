//! Which pictures a page has in it.

use super::super::blobs::{self, Role};
use super::super::report::{CaseReport, Kind};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use std::path::Path;

/// A picture in the page.
pub(super) struct Picture {
    /// As page.js knows it.
    pub(super) role: &'static str,
    pub(super) label: &'static str,
    /// Where its file is.
    pub(super) remark: String,
    pub(super) uri: String,
    pub(super) width: u32,
    pub(super) height: u32,
}

/// The pictures of a case.
pub(super) struct Shown {
    pub(super) pictures: Vec<Picture>,
    /// Why others are not among them, a line each.
    pub(super) remarks: Vec<String>,
}

/// What there is room for. Cases come worst first, so that those have their pictures.
pub(super) struct Budget<'a> {
    folder: &'a Path,
    left_bytes: u64,
}

/// For the script and for people.
const fn names(role: Role, kind: Kind) -> (&'static str, &'static str) {
    match role {
        Role::Golden => ("golden", if matches!(kind, Kind::Reference) { "Truth" } else { "Golden" }),
        Role::Actual => ("actual", "This run"),
        Role::Difference => ("difference", "Difference, scaled"),
        Role::HeatMap => ("heat", "FLIP error"),
    }
}

impl<'a> Budget<'a> {
    /// `folder` has the report.
    pub(super) fn new(folder: &'a Path, limit_bytes: u64) -> Self {
        Self { folder, left_bytes: limit_bytes }
    }

    /// All pictures of the case that can be read, or none.
    pub(super) fn take(&mut self, case: &CaseReport) -> Shown {
        let (mut files, mut remarks) = (Vec::new(), Vec::new());
        for role in Role::ALL {
            match blobs::read(self.folder, case, role) {
                Ok(bytes) => files.extend(bytes.map(|bytes| (role, bytes))),
                // A report without a picture is better than none.
                Err(error) => remarks.push(error.to_string()),
            }
        }
        let bytes: u64 = files.iter().map(|(_, bytes)| encoded_length(bytes)).sum();
        if bytes > self.left_bytes {
            // The next ones may be smaller, but better than this one they are not.
            self.left_bytes = 0;
            let places = files.iter().filter_map(|(role, _)| place(self.folder, case, *role));
            let places = places.collect::<Vec<_>>().join(", ");
            remarks.push(format!("The page is full (--page-limit); the pictures are {places}"));
            return Shown { pictures: Vec::new(), remarks };
        }
        self.left_bytes -= bytes;
        let mut pictures = Vec::new();
        for (role, bytes) in files {
            let ((role_name, label), remark) =
                (names(role, case.kind), place(self.folder, case, role).unwrap_or_default());
            match png_size(&bytes) {
                Some((width, height)) => {
                    let uri = format!("data:image/png;base64,{}", STANDARD.encode(&bytes));
                    pictures.push(Picture { role: role_name, label, remark, uri, width, height });
                }
                None => remarks.push(format!("{remark} is no PNG")),
            }
        }
        if pictures.iter().any(|picture| picture.role == "golden") && case.paths.actual.is_none() {
            remarks.extend(case.provenance.is_some().then(|| "This run drew the golden, bit for bit.".into()));
        }
        Shown { pictures, remarks }
    }
}

/// Of the data in the page.
fn encoded_length(bytes: &[u8]) -> u64 {
    bytes.len().div_ceil(3) as u64 * 4
}

/// The file of a picture, as it is best found.
fn place(folder: &Path, case: &CaseReport, role: Role) -> Option<String> {
    let own = role.path(case).map(Path::to_owned);
    let path = own.or_else(|| role.blob(&case.blobs).as_ref().map(|hash| folder.join(blobs::file_of(hash))));
    path.map(|path| path.display().to_string())
}

/// Width and height of a PNG (PNG 5.2 and 11.2.2).
fn png_size(bytes: &[u8]) -> Option<(u32, u32)> {
    let header = bytes.strip_prefix(b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR")?;
    let number = |at: usize| Some(u32::from_be_bytes(header.get(at..at + 4)?.try_into().ok()?));
    Some((number(0)?, number(4)?)).filter(|&(width, height)| width > 0 && height > 0)
}
