//! What the suite is compared with: the figures of an earlier run, or another program that runs in turn with this one.

use super::child_failed;
use crate::cli::clock::{Basis, median};
use crate::cli::error::CliError;
use serde::Serialize;
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// Rounds in which both programs run, each with its share of the frames.
const ROUNDS: u32 = 5;

/// Where the figures of the other side come from.
pub(super) enum Baseline {
    /// A report of the suite, and its name.
    Figures(Value),
    /// A program with this command line.
    Program(PathBuf),
}

/// A scene beside the baseline.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub(super) struct Comparison {
    /// Medians of the time that counts, ms.
    pub(super) baseline_ms: f64,
    pub(super) ms: f64,
    /// This program over the other.
    pub(super) ratio: f64,
}

impl Comparison {
    pub(super) fn new(ms: f64, baseline_ms: f64) -> Self {
        Self { baseline_ms, ms, ratio: ms / baseline_ms }
    }
}

impl Baseline {
    /// Reads a .json file; takes anything else for a program.
    pub(super) fn open(path: &Path) -> Result<Self, CliError> {
        let problem = |what: &str| CliError::Usage(format!("--baseline {}: {what}", path.display()));
        if !path.is_file() {
            return Err(problem("there is no such file; name a specula program, or what --suite --stats has written"));
        }
        if path.extension().is_none_or(|extension| !extension.eq_ignore_ascii_case("json")) {
            return Ok(Self::Program(path.to_owned()));
        }
        let bytes = std::fs::read(path).map_err(|error| problem(&error.to_string()))?;
        let report: Value = serde_json::from_slice(&bytes).map_err(|error| problem(&format!("no JSON: {error}")))?;
        if report["schema"] != super::report::SCHEMA {
            return Err(problem(&format!("not a report of the suite: its schema is not {}", super::report::SCHEMA)));
        }
        Ok(Self::Figures(report))
    }

    /// The other program, if it is one.
    pub(super) fn program(&self) -> Option<&Path> {
        match self {
            Self::Figures(_) => None,
            Self::Program(path) => Some(path),
        }
    }

    /// The scene `name`, of which this program has measured `ms` in this process. `None` where the other side has no such
    /// scene or not this time.
    ///
    /// # Errors
    /// When a program cannot be started, or fails.
    pub(super) fn compare(
        &self,
        (name, ms): (&str, Option<f64>),
        (frames, basis): (u32, Basis),
        driver: &[String],
    ) -> Result<Option<Comparison>, CliError> {
        match self {
            Self::Figures(report) => {
                Ok(ms.zip(median_of(report, name, basis)).map(|(ms, other)| Comparison::new(ms, other)))
            }
            Self::Program(other) => {
                let own = std::env::current_exe().map_err(|error| CliError::Usage(error.to_string()))?;
                let (mut own_ms, mut other_ms) = (Vec::new(), Vec::new());
                for round in 0..ROUNDS {
                    let run = |program: &Path| run_scene(program, name, (frames.div_ceil(ROUNDS), basis), driver);
                    if round % 2 == 0 {
                        own_ms.extend(run(&own)?);
                        other_ms.extend(run(other)?);
                    } else {
                        other_ms.extend(run(other)?);
                        own_ms.extend(run(&own)?);
                    }
                }
                let medians = median(own_ms.into_iter()).zip(median(other_ms.into_iter()));
                Ok(medians.map(|(ms, other)| Comparison::new(ms, other)))
            }
        }
    }
}

fn scene_of<'r>(report: &'r Value, name: &str) -> Option<&'r Value> {
    report["scenes"].as_array()?.iter().find(|scene| scene["name"] == name)
}

fn median_of(report: &Value, name: &str, basis: Basis) -> Option<f64> {
    scene_of(report, name)?["median"][basis.field()].as_f64()
}

/// The times of the frames of one scene that another process draws, ms.
fn run_scene(
    program: &Path,
    name: &str,
    (frames, basis): (u32, Basis),
    driver: &[String],
) -> Result<Vec<f64>, CliError> {
    let mut command = Command::new(program);
    command.args(["bench", "--suite", name, "--frames", &frames.to_string(), "--no-floor", "--json", "--quiet"]);
    let done = command.args(driver).stdin(Stdio::null()).output();
    let done = done.map_err(|error| CliError::Usage(format!("{}: {error}", program.display())))?;
    if !done.status.success() {
        return Err(child_failed(program, &done.stderr));
    }
    let report: Value = serde_json::from_slice(&done.stdout)
        .map_err(|error| CliError::Usage(format!("{}: its report is no JSON: {error}", program.display())))?;
    let frames = scene_of(&report, name).and_then(|scene| scene["frames"].as_array());
    Ok(frames.into_iter().flatten().filter_map(|frame| frame[basis.field()].as_f64()).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn figures_of_an_earlier_run_are_found_by_the_scenes_name() {
        let report = json!({"scenes": [{"name": "a", "median": {"wall_ms": 4.0, "cpu_ms": null}}]});
        let baseline = Baseline::Figures(report);
        let compare = |name, basis| baseline.compare((name, Some(5.0)), (1, basis), &[]).unwrap();
        assert_eq!(compare("a", Basis::Wall), Some(Comparison { baseline_ms: 4.0, ms: 5.0, ratio: 1.25 }));
        assert_eq!((compare("a", Basis::Cpu), compare("b", Basis::Wall)), (None, None));
    }
}
