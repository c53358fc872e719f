//! Keys of a case that are flags of `specula render`.

use super::table::Value;
use crate::cli::debug_view;
use crate::cli::driver::FrameArgs;
use crate::cli::error::CliError;
use crate::cli::subject::SubjectArgs;
use crate::cli::truth::TruthArgs;
use crate::cli::view::ViewArgs;
use crate::scene::Channel;
use clap::{Args, CommandFactory, Parser};
use std::path::Path;

/// What a case is drawn by: as `specula render` has it, without what belongs to a run or to a file.
#[derive(Debug, Parser)]
#[command(no_binary_name = true, disable_help_flag = true)]
pub(in crate::cli::test) struct CaseArgs {
    #[command(flatten)]
    pub(in crate::cli::test) subject: SubjectArgs,
    #[command(flatten)]
    pub(in crate::cli::test) view: ViewArgs,
    #[command(flatten)]
    pub(in crate::cli::test) frame: FrameArgs,
    #[command(flatten)]
    pub(in crate::cli::test) truth: TruthArgs,
    #[arg(long, value_parser = debug_view::parse)]
    pub(in crate::cli::test) debug_view: Option<Channel>,
}

/// Flags that are no part of a case: they belong to a run, or write a file.
const NOT_OF_CASES: [&str; 2] = ["no-cache", "error-image"];

/// Names of the flags that a case can have.
pub(super) fn names() -> Vec<String> {
    let command = CaseArgs::command();
    let long = command.get_arguments().filter_map(|argument| argument.get_long().map(str::to_owned));
    long.filter(|name| !NOT_OF_CASES.contains(&name.as_str())).collect()
}

/// Whether the flag is of the reference renderer alone.
pub(super) fn is_of_reference(name: &str) -> bool {
    TruthArgs::augment_args(clap::Command::new("")).get_arguments().any(|argument| argument.get_long() == Some(name))
}

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
        self.values.iter().map(|value| match value {
            Some(value) => format!("--{}={value}", self.name),
            None => format!("--{}", self.name),
        })
    }

    /// The same with a panorama's path from where the program runs.
    pub(super) fn arguments_from(&self, folder: &Path) -> Vec<String> {
        match self.value() {
            Some(file) if self.name == "env" && !["neutral", "white", "black"].contains(&file) => {
                vec![format!("--env={}", folder.join(file).display())]
            }
            _ => self.arguments().collect(),
        }
    }
}

/// What `specula render` makes of the arguments.
///
/// # Errors
/// The flag that is wrong, if it is one, and the problem in one line.
pub(super) fn parse(model: &Path, arguments: &[String]) -> Result<CaseArgs, (Option<String>, String)> {
    // Behind the flags: a name that begins with a dash is no flag there.
    let positional = ["--".to_owned(), model.display().to_string()];
    CaseArgs::try_parse_from(arguments.iter().chain(&positional)).map_err(|error| {
        let text = error.to_string();
        let line = text.lines().next().unwrap_or_default().trim_start_matches("error: ").to_owned();
        let flag = names().into_iter().find(|name| {
            let flag = format!("--{name}");
            line.split(['\'', ' ']).any(|word| word == flag)
        });
        (flag, line)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn flags_are_those_of_render() {
        let names = names();
        for name in ["size", "env", "orbit", "quality", "light", "override", "msaa", "debug-view", "samples"] {
            assert!(names.iter().any(|known| known == name), "{name} is missing in {names:?}");
        }
        for name in ["output", "adapter", "renderer", "no-cache", "error-image", "help", "json"] {
            assert!(!names.iter().any(|known| known == name), "{name} is no part of a case");
        }
        assert!(is_of_reference("samples") && is_of_reference("bounces") && !is_of_reference("size"));
    }

    #[test]
    fn what_is_wrong_is_named() {
        let parse = |flags: &[&str]| {
            let flags: Vec<String> = flags.iter().map(|flag| (*flag).to_owned()).collect();
            parse(Path::new("-odd.glb"), &flags)
        };
        assert_eq!(parse(&["--size=64x32", "--orbit=-30,75"]).unwrap().subject.model(), Path::new("-odd.glb"));
        let (flag, problem) = parse(&["--size=64"]).unwrap_err();
        assert_eq!(flag.as_deref(), Some("size"));
        assert!(problem.contains("'64'") && !problem.contains('\n'), "{problem}");
        assert_eq!(parse(&["--orbit=1,2", "--eye=0,0,1"]).unwrap_err().0.as_deref(), Some("orbit"));
    }
}
