//! What is said when a file is wrong: one line that names the file, the place, the problem and the way out.

use std::fmt::{self, Display};

/// Where in a file something is wrong.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Place {
    /// The file as a whole: it is missing, unreadable or of an unknown kind.
    File,
    /// A JSON pointer (RFC 6901) into the glTF document; the document itself is `/`.
    Pointer(String),
    /// Offset from the start of the file.
    Byte(u64),
}

/// A file that cannot be used. Displays as one line: `FILE: PLACE: what is wrong; what to do`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ImportError {
    pub source_name: String,
    pub place: Place,
    pub problem: String,
    pub advice: String,
}

/// Something in a file that was ignored or replaced. Displays as one line: `FILE: PLACE: what was done`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Warning {
    pub source_name: String,
    pub place: Place,
    pub problem: String,
}

impl std::error::Error for ImportError {}

impl Display for ImportError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write_place(f, &self.source_name, &self.place)?;
        write!(f, "{}; {}", one_line(&self.problem), one_line(&self.advice))
    }
}

impl Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write_place(f, &self.source_name, &self.place)?;
        f.write_str(&one_line(&self.problem))
    }
}

fn write_place(f: &mut fmt::Formatter<'_>, source_name: &str, place: &Place) -> fmt::Result {
    write!(f, "{}: ", one_line(source_name))?;
    match place {
        Place::File => Ok(()),
        Place::Pointer(pointer) => write!(f, "{}: ", one_line(pointer)),
        Place::Byte(offset) => write!(f, "byte {offset}: "),
    }
}

/// Control characters and line separators become spaces: names, uris and decoder messages come from strangers.
fn one_line(text: &str) -> String {
    text.chars().map(|c| if c.is_control() || matches!(c, '\u{2028}' | '\u{2029}') { ' ' } else { c }).collect()
}

/// A string of the file, fit for a message: quoted, escaped and not longer than a line.
pub(super) fn quote(text: &str) -> String {
    const LONGEST: usize = 120;
    let shown: String = text.chars().take(LONGEST).collect();
    let ellipsis = if shown.len() < text.len() { "..." } else { "" };
    format!("\"{}{ellipsis}\"", shown.escape_debug())
}

/// What to do about a document that breaks the specification.
pub(super) const EXPORT_AGAIN: &str = "export the file again, or see what a glTF validator says of it";

/// An error whose file is known only to the caller.
#[derive(Debug)]
pub(super) struct Fault {
    place: Place,
    problem: String,
    advice: String,
}

impl Fault {
    pub(super) fn at(pointer: impl Display, problem: impl Into<String>) -> Self {
        Self { place: Place::Pointer(pointer.to_string()), problem: problem.into(), advice: EXPORT_AGAIN.into() }
    }

    pub(super) fn at_byte(offset: u64, problem: impl Into<String>) -> Self {
        Self { place: Place::Byte(offset), problem: problem.into(), advice: EXPORT_AGAIN.into() }
    }

    pub(super) fn of_file(problem: impl Into<String>, advice: impl Into<String>) -> Self {
        Self { place: Place::File, problem: problem.into(), advice: advice.into() }
    }

    /// Replaces the general advice.
    pub(super) fn advise(mut self, advice: impl Into<String>) -> Self {
        self.advice = advice.into();
        self
    }

    pub(super) fn in_file(self, source_name: &str) -> ImportError {
        let Self { place, problem, advice } = self;
        ImportError { source_name: source_name.into(), place, problem, advice }
    }
}

/// Warnings in the order in which they came up.
#[derive(Debug, Default)]
pub(super) struct Notes(Vec<(String, String)>);

impl Notes {
    pub(super) fn add(&mut self, pointer: impl Display, problem: impl Into<String>) {
        self.0.push((pointer.to_string(), problem.into()));
    }

    pub(super) fn append(&mut self, mut later: Self) {
        self.0.append(&mut later.0);
    }

    pub(super) fn in_file(self, source_name: &str) -> Vec<Warning> {
        let name =
            |(pointer, problem)| Warning { source_name: source_name.into(), place: Place::Pointer(pointer), problem };
        self.0.into_iter().map(name).collect()
    }
}
