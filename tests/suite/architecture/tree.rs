//! The repository as text: its files, what they import, and their words.

use std::path::Path;

/// A file and its path from the root of the repository, with forward slashes.
pub(super) struct File {
    pub(super) path: String,
    pub(super) text: String,
}

/// The text of a file at the root, where it exists.
pub(super) fn read(path: &str) -> Option<String> {
    std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join(path)).ok()
}

/// Whether a file or folder is there.
pub(super) fn exists(path: &str) -> bool {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path).exists()
}

/// All files below `folder` with the given extension, sorted.
pub(super) fn files(folder: &str, extension: &str) -> Vec<File> {
    let mut found = Vec::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join(&folder)).unwrap() {
            let entry = entry.unwrap();
            let path = format!("{folder}/{}", entry.file_name().to_str().unwrap());
            if entry.file_type().unwrap().is_dir() {
                folders.push(path);
            } else if path.rsplit_once('.').is_some_and(|(_, end)| end == extension) {
                found.push(File { text: std::fs::read_to_string(entry.path()).unwrap(), path });
            }
        }
    }
    assert!(!found.is_empty(), "{folder} holds no .{extension}");
    found.sort_by(|a, b| a.path.cmp(&b.path));
    found
}

impl File {
    /// The module of the crate that a file under `src/` belongs to: `scene` for `src/scene/light.rs`.
    pub(super) fn module(&self) -> &str {
        let inside = self.path.trim_start_matches("src/");
        inside.split_once('/').map_or(inside.trim_end_matches(".rs"), |(module, _)| module)
    }

    /// How many modules below the crate's root the file is.
    pub(super) fn depth(&self) -> usize {
        self.path.trim_start_matches("src/").trim_end_matches("/mod.rs").matches('/').count() + 1
    }

    /// The text without comments.
    pub(super) fn code(&self) -> String {
        self.text.lines().map(|line| line.split("//").next().unwrap_or_default()).collect::<Vec<_>>().join("\n")
    }

    /// The code before the unit tests.
    pub(super) fn shipped_code(&self) -> String {
        self.code().split("#[cfg(test)]\nmod ").next().unwrap_or_default().to_owned()
    }
}

/// The names that follow `prefix` in code, through braces: `a`, `c` and `f` of `crate::{a::B, c::{d, e}, f}`.
pub(super) fn names_after(code: &str, prefix: &str) -> Vec<String> {
    let is_name = |c: char| c.is_alphanumeric() || c == '_';
    let first_name = |text: &str| text.trim_start().split(|c| !is_name(c)).next().unwrap_or_default().to_owned();
    let mut names = Vec::new();
    for (at, _) in code.match_indices(prefix) {
        if code[..at].ends_with(is_name) {
            continue;
        }
        let rest = &code[at + prefix.len()..];
        match rest.strip_prefix('{') {
            Some(group) => names.extend(items_of_group(group).iter().map(|item| first_name(item))),
            None => names.push(first_name(rest)),
        }
    }
    names.retain(|name| !name.is_empty());
    names
}

/// The items of a brace group whose opening brace was cut off.
fn items_of_group(group: &str) -> Vec<&str> {
    let (mut depth, mut start, mut items) = (0, 0, Vec::new());
    for (at, c) in group.char_indices() {
        match c {
            '{' => depth += 1,
            '}' if depth == 0 => {
                items.push(&group[start..at]);
                break;
            }
            '}' => depth -= 1,
            ',' if depth == 0 => {
                items.push(&group[start..at]);
                start = at + 1;
            }
            _ => {}
        }
    }
    items
}

/// Identifiers and words, in order.
pub(super) fn words(text: &str) -> impl Iterator<Item = &str> {
    text.split(|c: char| !c.is_alphanumeric() && c != '_').filter(|word| !word.is_empty())
}

#[test]
fn imports_are_found_through_braces_and_macros() {
    let code =
        "use crate::{a::B, c::{d, e}, f};\nlet x = $crate::g::h(crate::i::J);\nuse mycrate::k;\nuse super::{l, m};";
    assert_eq!(names_after(code, "crate::"), ["a", "c", "f", "g", "i"]);
    assert_eq!(names_after(code, "super::"), ["l", "m"]);
    assert!(words("perceptual_roughness, of_it").eq(["perceptual_roughness", "of_it"]));
}
