//! Files that were open, over sessions.

use super::folder::Kind;
use crate::output;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// Files of a kind that are remembered.
const REMEMBERED: usize = 12;
/// Name and version of the layout of the file.
const SCHEMA: &str = "specula-recent/1";

/// Models and panoramas that were open, the last one first. Windows that are open at the same time share the file: it is
/// read before it is written.
#[derive(Debug, Default)]
pub(super) struct Recent {
    /// Where they are kept; `None` keeps them for as long as the window is open.
    file: Option<PathBuf>,
    lists: Lists,
}

/// As the file holds them. A path that is no text is not kept.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Lists {
    schema: String,
    models: Vec<PathBuf>,
    panoramas: Vec<PathBuf>,
}

impl Default for Lists {
    fn default() -> Self {
        Self { schema: SCHEMA.into(), models: Vec::new(), panoramas: Vec::new() }
    }
}

impl Lists {
    fn of(&self, kind: Kind) -> &[PathBuf] {
        match kind {
            Kind::Model => &self.models,
            Kind::Panorama => &self.panoramas,
        }
    }

    fn of_mut(&mut self, kind: Kind) -> &mut Vec<PathBuf> {
        match kind {
            Kind::Model => &mut self.models,
            Kind::Panorama => &mut self.panoramas,
        }
    }
}

impl Recent {
    /// What is remembered in a file, and what is wrong with that, if it is damaged: one line for people. Then it counts as
    /// empty, and the next file that is opened replaces it.
    pub(super) fn read(file: Option<PathBuf>) -> (Self, Option<String>) {
        let (lists, problem) = match file.as_deref().map(lists_of) {
            Some(Ok(lists)) => (lists, None),
            Some(Err(problem)) => (Lists::default(), Some(problem)),
            None => (Lists::default(), None),
        };
        (Self { file, lists }, problem)
    }

    pub(super) fn of(&self, kind: Kind) -> &[PathBuf] {
        self.lists.of(kind)
    }

    /// A file was opened.
    ///
    /// # Errors
    /// When that cannot be written down: one line for people, once. From then on nothing is written.
    pub(super) fn opened(&mut self, kind: Kind, path: &Path) -> Result<(), String> {
        let path = path.canonicalize().unwrap_or_else(|_| path.to_owned());
        self.change(kind, |list| {
            list.retain(|other| *other != path);
            list.insert(0, path);
            list.truncate(REMEMBERED);
        })
    }

    /// A file that is no more is not offered again.
    ///
    /// # Errors
    /// As [`Self::opened`].
    pub(super) fn forget(&mut self, kind: Kind, path: &Path) -> Result<(), String> {
        if self.of(kind).iter().any(|other| other == path) {
            self.change(kind, |list| list.retain(|other| other != path))
        } else {
            Ok(())
        }
    }

    fn change(&mut self, kind: Kind, change: impl FnOnce(&mut Vec<PathBuf>)) -> Result<(), String> {
        // Another window may have written since; what is damaged is replaced.
        if let Some(Ok(lists)) = self.file.as_deref().map(lists_of) {
            self.lists = lists;
        }
        change(self.lists.of_mut(kind));
        let Some(file) = &self.file else { return Ok(()) };
        let written = write(file, &self.lists);
        if written.is_err() {
            self.file = None;
        }
        written.map_err(|problem| format!("recent files are not kept: {problem}"))
    }
}

/// The lists of a file; of one that is not there, empty ones.
fn lists_of(file: &Path) -> Result<Lists, String> {
    let damaged = |problem: String| format!("{}: the list of recent files is ignored: {problem}", file.display());
    let bytes = match std::fs::read(file) {
        Ok(bytes) => bytes,
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(Lists::default()),
        Err(error) => return Err(damaged(format!("cannot read: {error}"))),
    };
    let lists: Lists = serde_json::from_slice(&bytes).map_err(|error| damaged(error.to_string()))?;
    if lists.schema == SCHEMA { Ok(lists) } else { Err(damaged(format!("its schema is not {SCHEMA}"))) }
}

fn write(file: &Path, lists: &Lists) -> Result<(), String> {
    let is_text = |path: &&PathBuf| path.to_str().is_some();
    let texts = |kind| lists.of(kind).iter().filter(is_text).cloned().collect();
    let lists = Lists { models: texts(Kind::Model), panoramas: texts(Kind::Panorama), schema: lists.schema.clone() };
    let json = serde_json::to_string_pretty(&lists).map_err(|error| error.to_string())?;
    let folder = file.parent().unwrap_or(Path::new("."));
    std::fs::create_dir_all(folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    output::write(file, (json + "\n").as_bytes()).map_err(|error| error.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(recent: &Recent, kind: Kind) -> Vec<String> {
        recent.of(kind).iter().map(|path| path.file_name().unwrap().to_string_lossy().into_owned()).collect()
    }

    #[test]
    fn what_was_open_is_known_to_the_next_session() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("new/recent.json");
        let (mut first, problem) = Recent::read(Some(file.clone()));
        assert_eq!(problem, None);
        for name in ["a.glb", "b.glb", "a.glb"] {
            first.opened(Kind::Model, Path::new(name)).unwrap();
        }
        // A window beside it.
        let (mut second, _) = Recent::read(Some(file.clone()));
        second.opened(Kind::Panorama, Path::new("sky.hdr")).unwrap();
        first.opened(Kind::Model, Path::new("c.glb")).unwrap();
        let (third, problem) = Recent::read(Some(file.clone()));
        assert_eq!((names(&third, Kind::Model), problem), (["c.glb", "a.glb", "b.glb"].map(String::from).into(), None));
        assert_eq!(names(&third, Kind::Panorama), ["sky.hdr"]);
        for number in 0..20 {
            first.opened(Kind::Model, Path::new(&format!("{number}.glb"))).unwrap();
        }
        first.forget(Kind::Model, Path::new("19.glb")).unwrap();
        let (last, _) = Recent::read(Some(file));
        assert_eq!((last.of(Kind::Model).len(), names(&last, Kind::Model)[0].as_str()), (REMEMBERED - 1, "18.glb"));
    }

    #[test]
    fn damaged_lists_count_as_empty_and_are_replaced() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("recent.json");
        let other = r#"{"schema":"specula-recent/2","models":[],"panoramas":[]}"#;
        for damaged in ["", "{", "[1]", "\0\u{1}", other] {
            std::fs::write(&file, damaged).unwrap();
            let (mut recent, problem) = Recent::read(Some(file.clone()));
            let problem = problem.unwrap();
            assert!(problem.contains("recent files is ignored") && !problem.contains('\n'), "{problem}");
            assert!(recent.of(Kind::Model).is_empty());
            recent.opened(Kind::Model, Path::new("a.glb")).unwrap();
            assert_eq!(Recent::read(Some(file.clone())).1, None);
        }
    }

    #[test]
    fn nothing_is_kept_without_a_place() {
        let (mut recent, problem) = Recent::read(None);
        recent.opened(Kind::Model, Path::new("a.glb")).unwrap();
        assert_eq!((recent.of(Kind::Model).len(), problem), (1, None));
        // A place where no folder can be is told of once.
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("file"), "").unwrap();
        let (mut recent, problem) = Recent::read(Some(folder.path().join("file/recent.json")));
        assert!(problem.is_some() || cfg!(windows), "a file is no folder");
        assert!(recent.opened(Kind::Model, Path::new("a.glb")).unwrap_err().contains("are not kept"));
        recent.opened(Kind::Model, Path::new("b.glb")).unwrap();
        assert_eq!(names(&recent, Kind::Model), ["b.glb", "a.glb"]);
    }
}
