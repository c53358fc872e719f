//! Goldens of cases that a suite has no more: nobody would see that they are there.

use super::golden;
use super::suite::Suite;
use crate::cli::error::CliError;
use std::collections::HashSet;
use std::path::{Path, PathBuf};

impl Suite {
    /// Goldens that this suite has drawn, by what stands beside them, and that are of none of its cases; sorted. Of those that
    /// another suite keeps in the same folder, or that came from elsewhere, nothing is known.
    pub(super) fn unused_goldens(&self) -> Vec<PathBuf> {
        let ids: HashSet<&str> = self.cases.iter().map(|case| case.id.as_str()).collect();
        let is_unused = |path: &PathBuf| {
            golden::recorded(path).is_some_and(|(suite, case)| {
                // A picture that was moved by hand is of the case that its name says.
                suite == self.name && !ids.contains(case.as_str()) && path.ends_with(format!("{case}.png"))
            })
        };
        let mut unused: Vec<PathBuf> = pictures(self.goldens_folder()).into_iter().filter(is_unused).collect();
        unused.sort();
        unused
    }

    /// Removes them with what stands beside them.
    ///
    /// # Errors
    /// When one cannot be removed; those before it are gone.
    pub(super) fn remove_unused_goldens(&self) -> Result<Vec<PathBuf>, CliError> {
        let unused = self.unused_goldens();
        for path in &unused {
            // What stands beside it last: without that it would belong to nobody.
            for path in [path.clone(), path.with_extension("json")] {
                std::fs::remove_file(&path)
                    .map_err(|error| CliError::Usage(format!("{}: cannot be removed: {error}", path.display())))?;
            }
        }
        Ok(unused)
    }
}

/// All PNGs of a folder and those in it. Links are not followed.
fn pictures(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
        let path = entry.path();
        match entry.file_type() {
            Ok(kind) if kind.is_dir() => found.append(&mut pictures(&path)),
            Ok(kind) if kind.is_file() && path.extension().is_some_and(|ending| ending == "png") => found.push(path),
            _ => {}
        }
    }
    found
}
