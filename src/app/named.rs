//! Choices in files, by the names that the command line has for them.

use crate::scene::{Channel, Geometry, Quality, ToneMap};
use serde::de::Error;
use serde::{Deserialize, Deserializer, Serializer};

/// One of a number of choices that have names.
pub(super) trait Named: Copy + 'static {
    fn choices() -> Vec<(&'static str, Self)>;

    fn name_of(self) -> &'static str
    where
        Self: PartialEq,
    {
        Self::choices().into_iter().find(|(_, choice)| *choice == self).map_or("", |(name, _)| name)
    }
}

impl Named for ToneMap {
    fn choices() -> Vec<(&'static str, Self)> {
        Self::ALL.map(|choice| (choice.name(), choice)).to_vec()
    }
}

impl Named for Quality {
    fn choices() -> Vec<(&'static str, Self)> {
        Self::ALL.map(|choice| (choice.name(), choice)).to_vec()
    }
}

impl Named for Geometry {
    fn choices() -> Vec<(&'static str, Self)> {
        Self::ALL.map(|choice| (choice.name(), choice)).to_vec()
    }
}

/// The picture is `none`.
impl Named for Option<Channel> {
    fn choices() -> Vec<(&'static str, Self)> {
        std::iter::once(("none", None)).chain(Channel::named().map(|(name, channel)| (name, Some(channel)))).collect()
    }
}

/// The choice after this one, or the one before it.
#[cfg(feature = "view")]
pub(super) fn next<T: Named + PartialEq>(current: T, backward: bool) -> T {
    let choices = T::choices();
    let index = choices.iter().position(|(_, choice)| *choice == current).unwrap_or(0);
    let step = if backward { choices.len() - 1 } else { 1 };
    choices[(index + step) % choices.len()].1
}

pub(super) fn serialize<T: Named + PartialEq, S: Serializer>(choice: &T, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(choice.name_of())
}

pub(super) fn deserialize<'de, T: Named, D: Deserializer<'de>>(deserializer: D) -> Result<T, D::Error> {
    let wanted = String::deserialize(deserializer)?;
    let choices = T::choices();
    let found = choices.iter().find(|(name, _)| *name == wanted).map(|(_, choice)| *choice);
    let names = || choices.iter().map(|(name, _)| *name).collect::<Vec<_>>().join(", ");
    found.ok_or_else(|| D::Error::custom(format!("`{wanted}` is none of {}", names())))
}
