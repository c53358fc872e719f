//! TOML whose every part knows its line, and of which nothing is overlooked.

use crate::cli::error::CliError;
use std::cell::Cell;
use std::ops::Range;
use toml::de::{DeTable, DeValue};
use toml::{Spanned, de};

/// The text of a file and its name.
#[derive(Debug, Clone, Copy)]
pub(super) struct Source<'a> {
    pub(super) file: &'a str,
    pub(super) text: &'a str,
}

impl Source<'_> {
    /// Line of a byte, from 1.
    pub(super) fn line(&self, byte: usize) -> usize {
        1 + self.text.as_bytes().iter().take(byte).filter(|byte| **byte == b'\n').count()
    }

    /// `suite.toml:12: what is wrong`.
    pub(super) fn error(&self, line: usize, problem: impl std::fmt::Display) -> CliError {
        CliError::Usage(format!("{}:{line}: {problem}", self.file))
    }

    /// # Errors
    /// When the text is no TOML, or has a key twice.
    pub(super) fn parse(&self) -> Result<Spanned<DeTable<'_>>, CliError> {
        DeTable::parse(self.text).map_err(|error: de::Error| {
            let line = self.line(error.span().map_or(0, |span| span.start));
            let message = error.message().split_whitespace().collect::<Vec<_>>().join(" ");
            self.error(line, message)
        })
    }
}

/// A table and which of its keys were asked for.
#[derive(Debug)]
pub(super) struct Table<'a> {
    source: Source<'a>,
    /// What it is called in messages: `[suite]`.
    pub(super) name: String,
    pub(super) line: usize,
    entries: Vec<Value<'a>>,
    taken: Vec<Cell<bool>>,
}

/// A value, its key and its place.
#[derive(Debug, Clone)]
pub(super) struct Value<'a> {
    source: Source<'a>,
    pub(super) key: String,
    pub(super) line: usize,
    value: &'a DeValue<'a>,
}

impl<'a> Table<'a> {
    pub(super) fn new(source: Source<'a>, name: &str, span: Range<usize>, table: &'a DeTable<'a>) -> Self {
        let mut in_order: Vec<_> = table.iter().collect();
        in_order.sort_by_key(|(key, _)| key.span().start);
        let entry = |(key, value): (&'a Spanned<de::DeString<'a>>, &'a Spanned<DeValue<'a>>)| Value {
            source,
            key: key.get_ref().to_string(),
            line: source.line(key.span().start),
            value: value.get_ref(),
        };
        let entries: Vec<_> = in_order.into_iter().map(entry).collect();
        let taken = vec![Cell::new(false); entries.len()];
        Self { source, name: name.to_owned(), line: source.line(span.start), entries, taken }
    }

    /// The value of a key, which counts as known from now on.
    pub(super) fn take(&self, key: &str) -> Option<&Value<'a>> {
        let index = self.entries.iter().position(|entry| entry.key == key)?;
        self.taken[index].set(true);
        Some(&self.entries[index])
    }

    /// Values whose keys nobody has taken, in the order of the file.
    pub(super) fn rest(&self) -> impl Iterator<Item = &Value<'a>> {
        self.entries.iter().zip(&self.taken).filter(|(_, taken)| !taken.get()).map(|(entry, _)| entry)
    }

    /// # Errors
    /// When there is a key that nobody has taken.
    pub(super) fn finish(&self, known: &[&str]) -> Result<(), CliError> {
        match self.rest().next() {
            Some(unknown) => Err(self.unknown(unknown, known)),
            None => Ok(()),
        }
    }

    /// What to say of a key that is none of the `known`.
    pub(super) fn unknown(&self, value: &Value<'_>, known: &[&str]) -> CliError {
        let problem = format!("`{}` is no key of {}; there are {}", value.key, self.name, known.join(", "));
        self.source.error(value.line, problem)
    }

    pub(super) fn error(&self, problem: impl std::fmt::Display) -> CliError {
        self.source.error(self.line, problem)
    }
}

impl<'a> Value<'a> {
    pub(super) fn error(&self, problem: impl std::fmt::Display) -> CliError {
        self.source.error(self.line, problem)
    }

    /// `suite.toml:12`.
    pub(super) fn place(&self) -> String {
        format!("{}:{}", self.source.file, self.line)
    }

    fn expected(&self, what: &str) -> CliError {
        self.error(format!("`{}` has to be {what}, not a TOML {}", self.key, self.value.type_str()))
    }

    pub(super) fn string(&self) -> Result<&'a str, CliError> {
        self.value.as_str().ok_or_else(|| self.expected("a string"))
    }

    /// A whole number from 1 up.
    pub(super) fn count(&self) -> Result<u64, CliError> {
        let number = self.value.as_integer().filter(|integer| integer.radix() == 10);
        let number = number.and_then(|integer| integer.as_str().parse().ok()).filter(|number| *number > 0);
        number.ok_or_else(|| self.expected("a whole number from 1 up"))
    }

    /// A local date, as year, month and day.
    pub(super) fn date(&self) -> Result<(u16, u8, u8), CliError> {
        let date = self.value.as_datetime().and_then(|datetime| datetime.date);
        date.map(|date| (date.year, date.month, date.day)).ok_or_else(|| self.expected("a date such as 2030-01-31"))
    }

    pub(super) fn table(&self) -> Result<Table<'a>, CliError> {
        self.table_called(&format!("`{}`", self.key))
    }

    /// The table, with another name in messages.
    pub(super) fn table_called(&self, name: &str) -> Result<Table<'a>, CliError> {
        let table = self.value.as_table().ok_or_else(|| self.expected("a table"))?;
        let named = Table::new(self.source, name, 0..0, table);
        Ok(Table { line: self.line, ..named })
    }

    /// The values of an array, each with its own line.
    pub(super) fn array(&self) -> Result<Vec<Self>, CliError> {
        let array = self.value.as_array().ok_or_else(|| self.expected("an array"))?;
        let entry = |value: &'a Spanned<DeValue<'a>>| Self {
            source: self.source,
            key: self.key.clone(),
            line: self.source.line(value.span().start),
            value: value.get_ref(),
        };
        Ok(array.iter().map(entry).collect())
    }

    pub(super) fn strings(&self) -> Result<Vec<(&'a str, Self)>, CliError> {
        self.array()?.into_iter().map(|value| Ok((value.string()?, value))).collect()
    }

    pub(super) fn boolean(&self) -> Option<bool> {
        self.value.as_bool()
    }

    pub(super) fn is_array(&self) -> bool {
        self.value.is_array()
    }

    /// A string, or a number as it is written.
    pub(super) fn text(&self) -> Option<String> {
        match self.value {
            DeValue::String(text) => Some(text.to_string()),
            DeValue::Integer(number) => Some(number.to_string()),
            DeValue::Float(number) => Some(number.to_string()),
            _ => None,
        }
    }

    pub(super) fn is_number(&self) -> bool {
        self.value.is_integer() || self.value.is_float()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn everything_has_its_line() {
        let text = "a = 1\n[suite]\nname = 'x'\nlist = [\n  'p',\n  2.50,\n]\nday = 2030-01-31\n";
        let source = Source { file: "s.toml", text };
        let parsed = source.parse().unwrap();
        let root = Table::new(source, "the file", 0..0, parsed.get_ref());
        assert_eq!(root.take("a").unwrap().count().unwrap(), 1);
        let suite = root.take("suite").unwrap().table().unwrap();
        root.finish(&[]).unwrap();
        assert_eq!((suite.line, suite.take("name").unwrap().string().unwrap()), (2, "x"));
        let list = suite.take("list").unwrap().array().unwrap();
        assert_eq!(
            list.iter().map(|value| (value.line, value.text().unwrap())).collect::<Vec<_>>(),
            [(5, "p".to_owned()), (6, "2.50".to_owned())]
        );
        let unknown = suite.finish(&["name"]).unwrap_err().to_string();
        assert_eq!(unknown, "s.toml:8: `day` is no key of `suite`; there are name");
        assert_eq!(suite.take("day").unwrap().date().unwrap(), (2030, 1, 31));
        suite.finish(&[]).unwrap();
        let wrong = list[0].count().unwrap_err().to_string();
        assert_eq!(wrong, "s.toml:5: `list` has to be a whole number from 1 up, not a TOML string");
    }

    #[test]
    fn broken_text_is_one_line_with_its_place() {
        for (text, line) in [("a = \n", 1), ("[suite]\nname = 'x'\nname = 'y'\n", 3), ("a = 1\nb\n", 2)] {
            let error = Source { file: "s.toml", text }.parse().unwrap_err().to_string();
            assert!(error.starts_with(&format!("s.toml:{line}: ")) && !error.contains('\n'), "{text}: {error}");
        }
    }
}
