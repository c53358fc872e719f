//! Which of several things that a file has is meant.

use super::error::{Fault, quote};

/// One of the scenes or the variants of a file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Choice {
    /// From 0.
    Index(usize),
    /// The first of that name.
    Name(String),
}

/// Names of choices that are listed.
const LISTED: usize = 20;

impl Choice {
    /// Its place among the names, of which what has none is known by its number. `what` is said of one of them.
    pub(super) fn find(&self, what: &str, names: &[Option<&str>], pointer: &str) -> Result<usize, Fault> {
        let (found, wish) = match self {
            Self::Index(index) => (Some(*index).filter(|index| *index < names.len()), index.to_string()),
            Self::Name(name) => (names.iter().position(|other| *other == Some(name)), quote(name)),
        };
        found.ok_or_else(|| {
            let name = |(index, name): (usize, &Option<&str>)| name.map_or(index.to_string(), quote);
            let listed: Vec<String> = names.iter().take(LISTED).enumerate().map(name).collect();
            let advice =
                if listed.is_empty() { "choose none".into() } else { format!("choose one of: {}", listed.join(", ")) };
            Fault::at(pointer, format!("has no {what} {wish}")).advise(advice)
        })
    }
}
