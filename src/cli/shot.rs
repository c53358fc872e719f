//! What one picture is drawn by: the flags of `specula render` without what belongs to a run or to a file.

use super::debug_view;
use super::driver::FrameArgs;
use super::subject::SubjectArgs;
use super::truth::TruthArgs;
use super::view::ViewArgs;
use crate::scene::Channel;
use clap::{Args, CommandFactory, Parser};
use std::path::Path;

/// The flags of a picture, wherever they are written.
#[derive(Debug, Parser)]
#[command(no_binary_name = true, disable_help_flag = true)]
pub(super) struct ShotArgs {
    #[command(flatten)]
    pub(super) subject: SubjectArgs,
    #[command(flatten)]
    pub(super) view: ViewArgs,
    #[command(flatten)]
    pub(super) frame: FrameArgs,
    #[command(flatten)]
    pub(super) truth: TruthArgs,
    #[arg(long, value_parser = debug_view::parse)]
    pub(super) debug_view: Option<Channel>,
}

/// What the rasteriser draws a picture by.
#[derive(Debug, Clone, Copy)]
pub(super) struct Shot<'a> {
    pub(super) subject: &'a SubjectArgs,
    pub(super) view: &'a ViewArgs,
    pub(super) frame: &'a FrameArgs,
    pub(super) debug_view: Option<Channel>,
}

impl ShotArgs {
    pub(super) fn shot(&self) -> Shot<'_> {
        Shot { subject: &self.subject, view: &self.view, frame: &self.frame, debug_view: self.debug_view }
    }
}

/// Flags that are no part of a picture: they belong to a run, or write a file.
const NOT_OF_SHOTS: [&str; 2] = ["no-cache", "error-image"];

/// Names of the flags that a picture can have.
pub(super) fn names() -> Vec<String> {
    let command = ShotArgs::command();
    let long = command.get_arguments().filter_map(|argument| argument.get_long().map(str::to_owned));
    long.filter(|name| !NOT_OF_SHOTS.contains(&name.as_str())).collect()
}

/// Whether the flag is of the reference renderer alone.
pub(super) fn is_of_reference(name: &str) -> bool {
    TruthArgs::augment_args(clap::Command::new("")).get_arguments().any(|argument| argument.get_long() == Some(name))
}

/// What `specula render` makes of the arguments.
///
/// # Errors
/// The flag that is wrong, if it is one, and the problem in one line.
pub(super) fn parse(model: &Path, arguments: &[String]) -> Result<ShotArgs, (Option<String>, String)> {
    // Behind the flags: a name that begins with a dash is no flag there.
    let positional = ["--".to_owned(), model.display().to_string()];
    ShotArgs::try_parse_from(arguments.iter().chain(&positional)).map_err(|error| {
        let text = error.to_string();
        let line = text.lines().next().unwrap_or_default().trim_start_matches("error: ").to_owned();
        let flag = names().into_iter().find(|name| {
            let flag = format!("--{name}");
            line.split(['\'', ' ']).any(|word| word == flag)
        });
        (flag, line)
    })
}

/// As a flag is typed, value after `=`; the path of a panorama as one that begins in `folder`.
pub(super) fn argument(name: &str, value: Option<&str>, folder: Option<&Path>) -> String {
    match (value, folder) {
        (None, _) => format!("--{name}"),
        (Some(file), Some(folder)) if name == "env" && !["neutral", "white", "black"].contains(&file) => {
            format!("--env={}", folder.join(file).display())
        }
        (Some(value), _) => format!("--{name}={value}"),
    }
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
        for name in ["output", "adapter", "renderer", "no-cache", "error-image", "help", "json", "frames", "manifest"] {
            assert!(!names.iter().any(|known| known == name), "{name} is no part of a picture");
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
