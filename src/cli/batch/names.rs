//! Names of the pictures of a sequence: `{model}_{view}_{frame:4}`.

use std::str::FromStr;

/// A name with places for what tells pictures apart.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct NamePattern(Vec<Piece>);

#[derive(Debug, Clone, PartialEq, Eq)]
enum Piece {
    Text(String),
    Model,
    View,
    /// With so many digits at least.
    Frame(usize),
}

/// Beyond all numbers of frames.
const MOST_DIGITS: usize = 10;

impl Default for NamePattern {
    fn default() -> Self {
        let text = |text: &str| Piece::Text(text.into());
        Self(vec![Piece::Model, text("_"), Piece::View, text("_"), Piece::Frame(4)])
    }
}

impl FromStr for NamePattern {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (mut pieces, mut rest) = (Vec::new(), text);
        while let Some((before, after)) = rest.split_once('{') {
            let (inside, after) = after.split_once('}').ok_or_else(|| format!("{text:?}: a {{ without a }}"))?;
            pieces.extend([Piece::Text(before.to_owned()), piece(inside)?]);
            rest = after;
        }
        pieces.push(Piece::Text(rest.to_owned()));
        let is_legal = |piece: &Piece| match piece {
            Piece::Text(text) => !text.contains(['/', '\\', '}', '\0']),
            _ => true,
        };
        if !pieces.iter().all(is_legal) {
            return Err(format!("{text:?} is the name of a file, without folders"));
        }
        if !pieces.iter().any(|piece| matches!(piece, Piece::Frame(_))) {
            return Err(format!("{text:?} has no {{frame}}, so that all pictures would have one name"));
        }
        Ok(Self(pieces))
    }
}

fn piece(name: &str) -> Result<Piece, String> {
    match (name, name.strip_prefix("frame:").map(str::parse)) {
        ("model", _) => Ok(Piece::Model),
        ("view", _) => Ok(Piece::View),
        ("frame", _) => Ok(Piece::Frame(1)),
        (_, Some(Ok(digits @ 1..=MOST_DIGITS))) => Ok(Piece::Frame(digits)),
        _ => Err(format!("{{{name}}} is unknown; there are {{model}}, {{view}}, {{frame}} and {{frame:4}}")),
    }
}

impl NamePattern {
    /// The name of a picture, without an ending.
    pub(super) fn name(&self, model: &str, view: &str, frame: u32) -> String {
        let text = |piece: &Piece| match piece {
            Piece::Text(text) => text.clone(),
            Piece::Model => legal(model),
            Piece::View => legal(view),
            Piece::Frame(digits) => format!("{frame:0digits$}"),
        };
        self.0.iter().map(text).collect()
    }
}

/// A stranger's name as part of a file's.
fn legal(name: &str) -> String {
    name.chars().map(|c| if c.is_alphanumeric() || "._-+".contains(c) { c } else { '_' }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_have_what_the_pattern_says() {
        let name = |pattern: &str| pattern.parse::<NamePattern>().unwrap().name("a b/c", "front", 7);
        assert_eq!(name("{model}_{view}_{frame:4}"), "a_b_c_front_0007");
        assert_eq!(NamePattern::default().name("a b/c", "front", 7), name("{model}_{view}_{frame:4}"));
        assert_eq!(name("x{frame}"), "x7");
        for bad in
            ["x", "{model}", "{frame", "frame}", "a/{frame}", "{frame:0}", "{frame:99}", "{frame:x}", "{time}{frame}"]
        {
            assert!(bad.parse::<NamePattern>().is_err(), "{bad}");
        }
    }
}
