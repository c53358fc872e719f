//! Keys of a case that are flags of `specula render`.

use super::table::Value;
use crate::cli::error::CliError;
use crate::cli::shot;
use std::path::Path;

/// One flag with its values.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Flag {
    pub(super) name: String,
    pub(super) line: usize,
    /// One for each time that the flag is given; `None` for one without a value.
    values: Vec<Option<String>>,
}

impl Flag {
    /// A number or a string is a value; an array of numbers is one with commas, as `orbit = [30, 75]`; an array of
    /// strings gives the flag several times, as `light` can be; true gives it without a value.
    ///
    /// # Errors
    /// When the value is something else.
    pub(super) fn of(value: &Value<'_>) -> Result<Self, CliError> {
        let wrong = || value.error(format!("`{}` has to be a string, a number or an array of them", value.key));
        let values = match value.boolean() {
            Some(true) => vec![None],
            Some(false) => Vec::new(),
            None if value.is_array() => {
                let entries = value.array()?;
                let texts =
                    entries.iter().map(|entry| entry.text().ok_or_else(wrong)).collect::<Result<Vec<_>, _>>()?;
                if entries.iter().all(Value::is_number) && !entries.is_empty() {
                    vec![Some(texts.join(","))]
                } else {
                    texts.into_iter().map(Some).collect()
                }
            }
            None => vec![Some(value.text().ok_or_else(wrong)?)],
        };
        Ok(Self { name: value.key.clone(), line: value.line, values })
    }

    /// The value, for a flag that has one.
    pub(super) fn value(&self) -> Option<&str> {
        self.values.first().and_then(Option::as_deref)
    }

    /// As they would be typed, values after `=`.
    pub(super) fn arguments(&self) -> impl Iterator<Item = String> + '_ {
        self.values.iter().map(|value| shot::argument(&self.name, value.as_deref(), None))
    }

    /// The same with a panorama's path from where the program runs.
    pub(super) fn arguments_from(&self, folder: &Path) -> Vec<String> {
        self.values.iter().map(|value| shot::argument(&self.name, value.as_deref(), Some(folder))).collect()
    }
}
