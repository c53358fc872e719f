//! Cold starts: the program is started to render one picture, and tells what its stages take.

use super::super::report::time_text;
use super::scenes::helmet;
use crate::cli::clock::median;
use crate::cli::error::CliError;
use crate::cli::progress::StderrProgress;
use crate::progress::Progress;
use serde::Serialize;
use serde_json::Value;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Instant;

/// Starts that count at most, after one that leaves files in the system's memory.
const STARTS: u32 = 5;

/// What a start takes, medians.
#[derive(Debug, Serialize)]
pub(super) struct ColdStart {
    /// Of the whole process, on the wall.
    pub(super) wall_ms: f64,
    starts: u32,
    stages: Vec<ColdStage>,
    /// The same of another program, started in turn.
    pub(super) baseline_wall_ms: Option<f64>,
}

/// As `render --stats` has it; stages run beside each other.
#[derive(Debug, Serialize)]
struct ColdStage {
    stage: String,
    wall_ms: Option<f64>,
    cpu_ms: Option<f64>,
}

/// Starts `program`, and the baseline in turn, to render the sample model: `frames` times, but no more than a few.
///
/// # Errors
/// When a program cannot be started or fails. `Ok(Err)` is why there is nothing to render.
pub(super) fn cold_start(
    program: &Path,
    baseline: Option<&Path>,
    (frames, driver): (u32, &[String]),
    progress: &StderrProgress,
) -> Result<Result<ColdStart, String>, CliError> {
    let files = match helmet() {
        Ok(files) => files,
        Err(why) => return Ok(Err(why)),
    };
    let folder = tempfile::tempdir().map_err(|error| CliError::Usage(format!("no folder for pictures: {error}")))?;
    let starts = frames.min(STARTS);
    progress.begin("Cold starts", u64::from(starts + 1));
    let (mut walls, mut baseline_walls, mut stages) = (Vec::new(), Vec::new(), Vec::new());
    for start in 0..=starts {
        let (wall_ms, stats) = render(program, &files, driver, folder.path())?;
        let other = baseline.map(|other| render(other, &files, driver, folder.path())).transpose()?;
        if start > 0 {
            walls.push(wall_ms);
            stages.push(stats);
            baseline_walls.extend(other.map(|(wall_ms, _)| wall_ms));
        }
        progress.advance(1);
    }
    Ok(Ok(ColdStart {
        wall_ms: median(walls.into_iter()).unwrap_or(f64::NAN),
        starts,
        stages: medians(&stages),
        baseline_wall_ms: median(baseline_walls.into_iter()),
    }))
}

/// Wall time of the process, ms, and the stages that it reports.
fn render(
    program: &Path,
    [model, panorama]: &[std::path::PathBuf; 2],
    driver: &[String],
    folder: &Path,
) -> Result<(f64, Vec<Value>), CliError> {
    let [picture, stats] = ["a.png", "a.json"].map(|name| folder.join(name));
    let mut command = Command::new(program);
    command.arg("render").arg(model).arg("--env").arg(panorama).arg("-o").arg(&picture).arg("--stats").arg(&stats);
    command.args(["--size", "1024x1024", "--quiet"]).args(driver).stdin(Stdio::null()).stdout(Stdio::null());
    let start = Instant::now();
    let done = command.output().map_err(|error| CliError::Usage(format!("{}: {error}", program.display())))?;
    let wall_ms = start.elapsed().as_secs_f64() * 1e3;
    if !done.status.success() {
        return Err(super::child_failed(program, &done.stderr));
    }
    let stats = std::fs::read(&stats).ok().and_then(|bytes| serde_json::from_slice::<Value>(&bytes).ok());
    let stages = stats.and_then(|stats| Some(stats.get("milliseconds")?.as_array()?.clone()));
    Ok((wall_ms, stages.unwrap_or_default()))
}

/// Of every stage of the first start, over all.
fn medians(starts: &[Vec<Value>]) -> Vec<ColdStage> {
    let name = |stage: &Value| stage["stage"].as_str().unwrap_or_default().to_owned();
    let of = |wanted: &str, what: &str| {
        let all = starts.iter().flatten().filter(|stage| name(stage) == wanted);
        median(all.filter_map(|stage| stage[what].as_f64()))
    };
    let stage = |stage: &Value| {
        let name = name(stage);
        ColdStage { wall_ms: of(&name, "milliseconds"), cpu_ms: of(&name, "processor"), stage: name }
    };
    starts.first().map(|stages| stages.iter().map(stage).collect()).unwrap_or_default()
}

impl ColdStart {
    /// Rows of a table: stage, wall and processor time.
    pub(super) fn rows(&self) -> impl Iterator<Item = Vec<String>> {
        let time = time_text;
        let stages =
            self.stages.iter().map(move |stage| vec![stage.stage.clone(), time(stage.wall_ms), time(stage.cpu_ms)]);
        stages.chain(std::iter::once(vec!["the whole process".to_owned(), time(Some(self.wall_ms)), time(None)]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn stages_have_their_medians() {
        let start = |decode: f64| vec![json!({"stage": "decode", "milliseconds": decode, "processor": null})];
        let stages = medians(&[start(3.0), start(1.0), start(2.0)]);
        assert_eq!((stages.len(), stages[0].stage.as_str()), (1, "decode"));
        assert_eq!((stages[0].wall_ms, stages[0].cpu_ms), (Some(2.0), None));
        assert!(medians(&[]).is_empty());
    }
}
