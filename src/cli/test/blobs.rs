//! Pictures beside a report, named by their content: they go where the report goes, and equal ones are one file.

use super::report::{Blobs, CaseReport, Status, SuiteReport};
use crate::cli::error::CliError;
use crate::cli::output::write_in_folders;
use std::path::{Path, PathBuf};

/// Folder of the pictures, beside the report.
const FOLDER: &str = "blobs";

/// What a picture of a case is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Role {
    Golden,
    Actual,
    Difference,
    HeatMap,
}

impl Role {
    pub(super) const ALL: [Self; 4] = [Self::Golden, Self::Actual, Self::Difference, Self::HeatMap];

    /// The hash of the picture in this role.
    pub(super) fn blob(self, blobs: &Blobs) -> &Option<String> {
        match self {
            Self::Golden => &blobs.golden,
            Self::Actual => &blobs.actual,
            Self::Difference => &blobs.difference,
            Self::HeatMap => &blobs.heat_map,
        }
    }

    fn blob_mut(self, blobs: &mut Blobs) -> &mut Option<String> {
        match self {
            Self::Golden => &mut blobs.golden,
            Self::Actual => &mut blobs.actual,
            Self::Difference => &mut blobs.difference,
            Self::HeatMap => &mut blobs.heat_map,
        }
    }

    /// The file with the picture in this role, by its own name.
    pub(super) fn path(self, case: &CaseReport) -> Option<&Path> {
        let paths = &case.paths;
        match self {
            // Of a new case this is where the golden will be; that of a case in error may be the error.
            Self::Golden if matches!(case.status, Status::New | Status::Error) => None,
            Self::Golden => paths.golden.as_deref(),
            Self::Actual => paths.actual.as_deref(),
            Self::Difference => paths.difference.as_deref(),
            Self::HeatMap => paths.heat_map.as_deref(),
        }
    }
}

/// A picture of a case of the report in `folder`.
///
/// # Errors
/// When there should be one and it cannot be read, or is not what the report says.
pub(super) fn read(folder: &Path, case: &CaseReport, role: Role) -> Result<Option<Vec<u8>>, CliError> {
    let problem =
        |path: &Path, reason: &str| CliError::Usage(format!("{}: of the case {:?}: {reason}", path.display(), case.id));
    let read = |path: &Path| std::fs::read(path).map_err(|error| problem(path, &format!("cannot read it: {error}")));
    let Some(hash) = role.blob(&case.blobs) else { return role.path(case).map(read).transpose() };
    if hash.len() != 2 * blake3::OUT_LEN || !hash.bytes().all(|byte| byte.is_ascii_hexdigit()) {
        return Err(problem(folder, &format!("{hash:?} is no hash of a picture")));
    }
    let path = folder.join(file_of(hash));
    let bytes = read(&path)?;
    if blake3::hash(&bytes).to_hex().as_str() == hash {
        Ok(Some(bytes))
    } else {
        Err(problem(&path, "it is not what its name says; run the case again"))
    }
}

/// Relative to the report.
pub(super) fn file_of(hash: &str) -> PathBuf {
    Path::new(FOLDER).join(format!("{hash}.png"))
}

/// Puts the pictures of the report in `from` below `to`, where they become blobs of the report.
///
/// # Errors
/// When a picture cannot be read or written.
pub(super) fn gather(report: &mut SuiteReport, from: &Path, to: &Path) -> Result<(), CliError> {
    for case in &mut report.cases {
        for role in Role::ALL {
            if let Some(bytes) = read(from, case, role)? {
                *role.blob_mut(&mut case.blobs) = Some(put(to, &bytes)?);
            }
        }
    }
    Ok(())
}

/// Writes a blob, unless it is there, and returns its hash.
fn put(folder: &Path, bytes: &[u8]) -> Result<String, CliError> {
    let hash = blake3::hash(bytes).to_hex().to_string();
    let path = folder.join(file_of(&hash));
    // What is there under this name is whole, as it was renamed to it; what a disk has damaged since is made good.
    if std::fs::read(&path).is_ok_and(|there| there == bytes) {
        return Ok(hash);
    }
    write_in_folders(&path, bytes)?;
    Ok(hash)
}

#[cfg(test)]
mod tests {
    use super::super::report::tests::example;
    use super::*;

    #[test]
    fn pictures_go_where_the_report_goes() {
        let folder = tempfile::tempdir().unwrap();
        let [first, second, third] = ["1", "2", "3"].map(|name| folder.path().join(name));
        let picture = folder.path().join("a.png");
        std::fs::write(&picture, b"a picture").unwrap();
        let mut report = example();
        for case in &mut report.cases {
            case.paths.golden = Some(picture.clone());
        }
        report.cases[1].paths.actual = Some(picture.clone());
        gather(&mut report, &first, &second).unwrap();
        std::fs::remove_file(&picture).unwrap();
        gather(&mut report, &second, &third).unwrap();
        for role in [Role::Golden, Role::Actual] {
            assert_eq!(read(&third, &report.cases[1], role).unwrap().unwrap(), b"a picture");
        }
        assert_eq!(read(&third, &report.cases[1], Role::Difference).unwrap(), None);
        assert_eq!(std::fs::read_dir(third.join(FOLDER)).unwrap().count(), 1, "equal pictures are one file");
        let new = report.cases.iter().find(|case| case.status == Status::New).unwrap();
        assert!(new.blobs.is_empty(), "there is no golden yet");
    }

    #[test]
    fn blobs_are_what_their_names_say() {
        let folder = tempfile::tempdir().unwrap();
        let mut case = example().cases.remove(1);
        let hash = put(folder.path(), b"a picture").unwrap();
        let path = folder.path().join(file_of(&hash));
        case.blobs.actual = Some(hash);
        std::fs::write(&path, b"a pic").unwrap();
        assert!(read(folder.path(), &case, Role::Actual).unwrap_err().to_string().contains("not what its name says"));
        put(folder.path(), b"a picture").unwrap();
        assert!(read(folder.path(), &case, Role::Actual).is_ok(), "what was damaged is written again");
        std::fs::remove_file(&path).unwrap();
        assert!(read(folder.path(), &case, Role::Actual).unwrap_err().to_string().contains("cannot read it"));
        case.blobs.actual = Some("../../secret".into());
        assert!(read(folder.path(), &case, Role::Actual).unwrap_err().to_string().contains("no hash"));
    }
}
