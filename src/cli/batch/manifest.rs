//! Jobs in a file, one a line: `{"model": "a.glb", "output": "a.png", "size": "512x512", "orbit": [30, 75]}`.

use crate::cli::error::CliError;
use crate::cli::shot::{self, ShotArgs};
use serde_json::{Map, Value};
use std::collections::HashSet;
use std::io::Read;
use std::path::{Component, Path, PathBuf};

/// More jobs than this are a slip of the pen.
const MOST: usize = 1_000_000;

/// One picture.
#[derive(Debug)]
pub(super) struct ManifestJob {
    pub(super) args: ShotArgs,
    /// Below the folder of the run; also the name of the job.
    pub(super) output: String,
}

/// All jobs of a manifest. Files are looked for from its folder; - is stdin, and there from the working folder.
///
/// # Errors
/// With the line of what is wrong.
pub(super) fn read(path: &Path) -> Result<Vec<ManifestJob>, CliError> {
    let failed = |error: std::io::Error| CliError::Usage(format!("{}: cannot be read: {error}", path.display()));
    let text = if path == Path::new("-") {
        let mut text = String::new();
        std::io::stdin().lock().read_to_string(&mut text).map(|_| text)
    } else {
        std::fs::read_to_string(path)
    };
    let folder = path.parent().unwrap_or(Path::new(""));
    parse(&text.map_err(failed)?, folder)
        .map_err(|(line, problem)| CliError::Usage(format!("{}:{line}: {problem}", path.display())))
}

/// The jobs, or the line from 1 that is wrong and why.
fn parse(text: &str, folder: &Path) -> Result<Vec<ManifestJob>, (usize, String)> {
    let known = shot::names();
    let (mut jobs, mut outputs) = (Vec::new(), HashSet::new());
    for (line, text) in text.lines().enumerate().filter(|(_, text)| !text.trim().is_empty()) {
        let at = |problem: String| (line + 1, problem);
        let job = job(text, folder, &known).map_err(at)?;
        // Where case does not tell names apart.
        if !outputs.insert(job.output.to_lowercase()) {
            return Err(at(format!("another job has the output {:?} too", job.output)));
        }
        jobs.push(job);
        if jobs.len() > MOST {
            return Err(at(format!("there are more than {MOST} jobs")));
        }
    }
    // Nothing to do is a mistake and not success.
    if jobs.is_empty() { Err((1, "there is no job".into())) } else { Ok(jobs) }
}

fn job(text: &str, folder: &Path, known: &[String]) -> Result<ManifestJob, String> {
    let job: Map<String, Value> = serde_json::from_str(text).map_err(|error| format!("is no JSON object: {error}"))?;
    let text = |key: &str| match job.get(key) {
        Some(Value::String(text)) => Ok(text.as_str()),
        Some(other) => Err(format!("`{key}` is {other}, no string")),
        None => Err(format!("there is no `{key}`")),
    };
    let (model, output) = (text("model")?, text("output")?);
    check_output(output)?;
    if model == "-" {
        return Err("a model of a manifest is a file, not stdin".into());
    }
    let mut arguments = Vec::new();
    for (key, value) in job.iter().filter(|(key, _)| *key != "model" && *key != "output") {
        if !known.contains(key) {
            return Err(format!("`{key}` is neither model, output nor a flag of render: {}", known.join(", ")));
        }
        if shot::is_of_reference(key) {
            return Err(format!("`{key}` is of the reference renderer, which draws no manifests"));
        }
        arguments.extend(values(key, value)?.iter().map(|value| shot::argument(key, value.as_deref(), Some(folder))));
    }
    let args = shot::parse(&folder.join(model), &arguments).map_err(|(_, problem)| problem)?;
    Ok(ManifestJob { args, output: output.to_owned() })
}

/// The values of a flag: a number or a string is one, an array of numbers is one with commas, an array of strings gives the
/// flag several times, true gives it without a value.
fn values(key: &str, value: &Value) -> Result<Vec<Option<String>>, String> {
    let scalar = |value: &Value| match value {
        Value::String(text) => Some(text.clone()),
        Value::Number(number) => Some(number.to_string()),
        _ => None,
    };
    let wrong = || format!("`{key}` has to be a string, a number or an array of them");
    match value {
        Value::Bool(true) => Ok(vec![None]),
        Value::Bool(false) => Ok(Vec::new()),
        Value::Array(entries) => {
            let texts = entries.iter().map(|entry| scalar(entry).ok_or_else(wrong)).collect::<Result<Vec<_>, _>>()?;
            let is_vector = entries.iter().all(Value::is_number) && !entries.is_empty();
            Ok(if is_vector { vec![Some(texts.join(","))] } else { texts.into_iter().map(Some).collect() })
        }
        other => Ok(vec![Some(scalar(other).ok_or_else(wrong)?)]),
    }
}

/// A file below the folder of the run, and nowhere else.
fn check_output(output: &str) -> Result<(), String> {
    let is_below = Path::new(output).components().all(|part| matches!(part, Component::Normal(_)));
    let is_png = Path::new(output).extension().is_some_and(|ending| ending.eq_ignore_ascii_case("png"));
    match (is_below && !output.contains(['\\', ':', '\0']), is_png) {
        (true, true) => Ok(()),
        (true, false) => Err(format!("the output {output:?} does not end in .png")),
        (false, _) => Err(format!("the output {output:?} is no path below the folder of the run")),
    }
}

/// Where the picture of a job goes.
pub(super) fn place(out: &Path, job: &ManifestJob) -> PathBuf {
    out.join(&job.output)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_jobs() {
        let text = "{\"model\": \"a.glb\", \"output\": \"a/1.png\", \"orbit\": [30, 75], \"size\": \"64x32\", \
                    \"light\": [\"point:intensity=1cd\", \"directional:illuminance=1lux\"]}\n\n\
                    {\"model\": \"-odd.glb\", \"output\": \"b.png\", \"env\": \"sky.hdr\", \"msaa\": 1, \"ortho\": true}\n";
        let jobs = parse(text, Path::new("jobs")).unwrap();
        assert_eq!(jobs.len(), 2);
        assert_eq!(jobs[0].args.subject.model(), Path::new("jobs/a.glb"));
        assert_eq!(place(Path::new("out"), &jobs[0]), Path::new("out/a/1.png"));
        assert_eq!(jobs[1].args.subject.model(), Path::new("jobs/-odd.glb"));
        assert_eq!(jobs[1].args.subject.environment_source(), "jobs/sky.hdr");
    }

    #[test]
    fn mistakes_have_their_line() {
        let good = "{\"model\": \"a.glb\", \"output\": \"a.png\"}\n";
        let cases = [
            ("", 1, "no job"),
            ("[]", 1, "no JSON object"),
            ("{\"model\": \"a.glb\"}", 1, "no `output`"),
            ("{\"output\": \"b.png\"}", 1, "no `model`"),
            ("{\"model\": \"a.glb\", \"output\": \"A.png\"}", 2, "another job"),
            ("{\"model\": \"a.glb\", \"output\": \"../b.png\"}", 2, "no path below"),
            ("{\"model\": \"a.glb\", \"output\": \"/b.png\"}", 2, "no path below"),
            ("{\"model\": \"a.glb\", \"output\": \"b.exr\"}", 2, "does not end in .png"),
            ("{\"model\": \"a.glb\", \"output\": \"b.png\", \"speed\": 1}", 2, "`speed` is neither"),
            ("{\"model\": \"a.glb\", \"output\": \"b.png\", \"samples\": 1}", 2, "reference renderer"),
            ("{\"model\": \"a.glb\", \"output\": \"b.png\", \"size\": \"x\"}", 2, "'x'"),
            ("{\"model\": \"a.glb\", \"output\": \"b.png\", \"size\": {}}", 2, "`size` has to be"),
            ("{\"model\": \"-\", \"output\": \"b.png\"}", 2, "not stdin"),
        ];
        for (text, line, problem) in cases {
            let text = if line == 2 { format!("{good}{text}") } else { text.to_owned() };
            let (at, found) = parse(&text, Path::new("")).unwrap_err();
            assert!(at == line && found.contains(problem), "{text}: {at}: {found}");
        }
    }
}
