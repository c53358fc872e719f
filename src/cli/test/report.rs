//! What a run of a suite leaves: `report.json`, and what it consists of.

use super::ingredients::{Finding, Ingredients};
use crate::cli::error::CliError;
use crate::cli::output::write_in_folders;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// Name and version of this layout.
pub(super) const SCHEMA: &str = "specula-test/1";

/// Name of the file in the folder of a run.
pub(super) const FILE_NAME: &str = "report.json";

/// A finished run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(in crate::cli) struct SuiteReport {
    /// [`SCHEMA`].
    pub(in crate::cli) schema: String,
    /// The suite's name.
    pub(in crate::cli) suite: String,
    /// Its file, as it was named on the command line.
    pub(in crate::cli) suite_file: PathBuf,
    /// BLAKE3 of that file: parts of one run have the same.
    pub(in crate::cli) suite_hash: String,
    /// Version of Specula.
    pub(in crate::cli) version: String,
    pub(in crate::cli) adapter: AdapterReport,
    /// Which part of a run this is; none where it is the whole.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(in crate::cli) part: Option<PartReport>,
    /// Cases of the whole suite, with those that were filtered out or belong to other parts.
    pub(in crate::cli) cases_in_suite: usize,
    /// Those of this run, in the order of the suite.
    pub(in crate::cli) cases: Vec<CaseReport>,
    /// Wall time of the whole run.
    pub(in crate::cli) milliseconds: f64,
}

/// A part of a run that several processes share.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(in crate::cli) struct PartReport {
    /// How the cases are shared: `slice`, `hash` or `weight`.
    pub(in crate::cli) scheme: String,
    /// From 1 to `of`.
    pub(in crate::cli) number: usize,
    pub(in crate::cli) of: usize,
    /// Cases of all parts together.
    pub(in crate::cli) cases: usize,
}

/// What drew.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(in crate::cli) struct AdapterReport {
    pub(in crate::cli) name: String,
    /// `vulkan`, `metal`, `dx12` or `gl`.
    pub(in crate::cli) backend: String,
    pub(in crate::cli) driver: String,
    /// Adapters whose pictures are expected to be alike: `llvmpipe-22.3`.
    pub(in crate::cli) class: String,
    /// Instruction set and widest vectors, which software drivers compile for: `x86_64-avx2`.
    pub(in crate::cli) cpu: String,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(in crate::cli) enum Status {
    Pass,
    /// A condition does not hold.
    Fail,
    Skipped,
    /// There is no picture, or nothing that it could be compared with: a model that cannot be read, a damaged golden.
    Error,
    /// There is no golden yet; counts as a failure.
    New,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(in crate::cli) enum Kind {
    /// Compared with a picture that was accepted before.
    Golden,
    /// A white furnace: all that is drawn has to have the radiance of the white surroundings.
    Furnace,
    /// Compared with the reference renderer.
    Reference,
}

/// What became of one case.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(in crate::cli) struct CaseReport {
    /// Unique in the suite: its name, and what a matrix has made of it. Also a relative path with `/`.
    pub(in crate::cli) id: String,
    /// Its place in the suite, from 0.
    pub(in crate::cli) index: usize,
    pub(in crate::cli) kind: Kind,
    pub(in crate::cli) status: Status,
    /// Why it was skipped, is in error, or failed without a metric; one line.
    pub(in crate::cli) reason: Option<String>,
    /// Line of the suite file where the case begins, from 1.
    pub(in crate::cli) line: usize,
    /// Model, and the flags of `specula render` that draw the picture.
    pub(in crate::cli) model: String,
    pub(in crate::cli) settings: Vec<String>,
    /// Empty where nothing was compared.
    pub(in crate::cli) metrics: Vec<MetricReport>,
    pub(in crate::cli) paths: Paths,
    /// Pictures that are kept beside the report, wherever it is taken.
    #[serde(default, skip_serializing_if = "Blobs::is_empty")]
    pub(in crate::cli) blobs: Blobs,
    /// Of the picture of this run.
    pub(in crate::cli) provenance: Option<Provenance>,
    /// Of the golden, as far as it says.
    pub(in crate::cli) golden_provenance: Option<Provenance>,
    /// What has moved since the golden was drawn, or is not as the truth or a furnace has it, where the case fails.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(in crate::cli) moved: Vec<Finding>,
    /// Of the picture of this run, where it could become the golden.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(in crate::cli) ingredients: Option<Ingredients>,
    /// The command that makes the picture of this run the golden, where that would help.
    pub(in crate::cli) accept: Option<String>,
    /// What happened to the golden in this run.
    pub(in crate::cli) golden_written: bool,
    pub(in crate::cli) times: Times,
}

/// A number and what it has to be.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(in crate::cli) struct MetricReport {
    /// `flip.mean`; `max-abs > 24` for the share of the pixels that differ by more than 24 steps of 255.
    pub(in crate::cli) name: String,
    /// None where it is infinite (PSNR of equal pictures) or cannot be measured.
    pub(in crate::cli) value: Option<f64>,
    /// `<=`, `<`, `>=` or `>`.
    pub(in crate::cli) comparison: String,
    pub(in crate::cli) limit: f64,
    /// `suite.toml:12`, or a flag of the run.
    pub(in crate::cli) limit_from: String,
    pub(in crate::cli) holds: bool,
    /// The place of the worst pixel, a unit, and the like.
    pub(in crate::cli) remark: String,
}

/// Files, as this process could open them: relative to its working folder or absolute.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(in crate::cli) struct Paths {
    /// The picture of this run; none where it is bit for bit the golden.
    pub(in crate::cli) actual: Option<PathBuf>,
    /// What it was compared with: the golden, or the truth of a reference case. For a new case, where the golden will be.
    pub(in crate::cli) golden: Option<PathBuf>,
    /// Absolute difference, scaled so that the largest is white; none where the pictures are equal.
    pub(in crate::cli) difference: Option<PathBuf>,
    /// FLIP error of each pixel; none where the pictures are equal.
    pub(in crate::cli) heat_map: Option<PathBuf>,
    /// BLAKE3 of the file of `actual`.
    pub(in crate::cli) actual_hash: Option<String>,
}

/// BLAKE3 of pictures; each is the file `blobs/HASH.png` in the folder of the report.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(in crate::cli) struct Blobs {
    pub(in crate::cli) actual: Option<String>,
    pub(in crate::cli) golden: Option<String>,
    pub(in crate::cli) difference: Option<String>,
    pub(in crate::cli) heat_map: Option<String>,
}

impl Blobs {
    pub(in crate::cli) fn is_empty(&self) -> bool {
        *self == Self::default()
    }
}

/// What a picture was made by and of.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(in crate::cli) struct Provenance {
    /// Version of Specula.
    pub(in crate::cli) version: String,
    pub(in crate::cli) suite: String,
    pub(in crate::cli) case: String,
    #[serde(flatten)]
    pub(in crate::cli) adapter: AdapterReport,
    /// BLAKE3 of the bytes of the model, of the files that it refers to, and of the environment.
    pub(in crate::cli) scene_hash: String,
    /// BLAKE3 of width, height and RGBA values of the picture.
    pub(in crate::cli) picture_hash: String,
    /// BLAKE3 of the flags.
    pub(in crate::cli) settings_hash: String,
    /// The flags themselves.
    pub(in crate::cli) settings: Vec<String>,
}

/// Wall time of the parts of a case; some run beside the drawing of other cases.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub(in crate::cli) struct Times {
    /// Model, environment and upload; 0 for cases that share those of the case before.
    pub(in crate::cli) load_ms: f64,
    /// From the recording of the frame until it is in memory.
    pub(in crate::cli) draw_ms: f64,
    /// Encoding, comparison and files.
    pub(in crate::cli) judge_ms: f64,
}

impl SuiteReport {
    /// Cases with one of the states.
    pub(in crate::cli) fn count(&self, states: &[Status]) -> usize {
        self.cases.iter().filter(|case| states.contains(&case.status)).count()
    }

    /// Writes `report.json` into the folder.
    ///
    /// # Errors
    /// When it cannot be written; then none is there, or the one of before.
    pub(in crate::cli) fn write(&self, folder: &Path) -> Result<(), CliError> {
        write_in_folders(&folder.join(FILE_NAME), self.json()?.as_bytes())
    }

    pub(in crate::cli) fn json(&self) -> Result<String, CliError> {
        let text = serde_json::to_string_pretty(self).map_err(|error| CliError::Usage(error.to_string()))?;
        Ok(format!("{text}\n"))
    }

    /// The report of an earlier run from its folder.
    ///
    /// # Errors
    /// When there is none, or it is of another layout.
    pub(in crate::cli) fn read(folder: &Path) -> Result<Self, CliError> {
        let path = folder.join(FILE_NAME);
        let problem = |reason: String| CliError::Usage(format!("{}: {reason}; run `specula test`", path.display()));
        let text = std::fs::read_to_string(&path).map_err(|error| problem(format!("cannot read it: {error}")))?;
        let report: Self = serde_json::from_str(&text).map_err(|error| problem(format!("is no report: {error}")))?;
        if report.schema == SCHEMA {
            Ok(report)
        } else {
            Err(problem(format!("is of the layout {}, not {SCHEMA}", report.schema)))
        }
    }
}

#[cfg(test)]
pub(in crate::cli) mod tests {
    use super::*;

    /// A report with one case of every state.
    pub(in crate::cli) fn example() -> SuiteReport {
        let adapter = AdapterReport {
            name: "llvmpipe (LLVM 15.0.6, 256 bits)".into(),
            backend: "vulkan".into(),
            driver: "llvmpipe Mesa 22.3.6 (LLVM 15.0.6)".into(),
            class: "llvmpipe-22.3".into(),
            cpu: "x86_64-avx2".into(),
        };
        let provenance = Provenance {
            version: "0.1.0".into(),
            suite: "example".into(),
            case: "helmet".into(),
            adapter: adapter.clone(),
            scene_hash: "5c".repeat(32),
            picture_hash: "77".repeat(32),
            settings_hash: "1f".repeat(32),
            settings: vec!["--size=64x64".into()],
        };
        let metric = |name: &str, value, holds| MetricReport {
            name: name.into(),
            value: Some(value),
            comparison: "<=".into(),
            limit: 0.004,
            limit_from: "suite.toml:3".into(),
            holds,
            remark: String::new(),
        };
        let states = [Status::Pass, Status::Fail, Status::Skipped, Status::Error, Status::New];
        let case = |(index, status): (usize, Status)| {
            let is_failure = status == Status::Fail;
            CaseReport {
                id: format!("helmet/quality={status:?}"),
                index,
                kind: Kind::Golden,
                status,
                reason: matches!(status, Status::Skipped | Status::Error).then(|| "a reason".into()),
                line: 7,
                model: "helmet.glb".into(),
                settings: provenance.settings.clone(),
                metrics: vec![metric("flip.mean", if is_failure { 0.02 } else { 0.001 }, !is_failure)],
                paths: Paths::default(),
                blobs: Blobs::default(),
                provenance: Some(provenance.clone()),
                golden_provenance: None,
                moved: Vec::new(),
                ingredients: None,
                accept: is_failure.then(|| "specula accept suite.toml helmet".into()),
                golden_written: false,
                times: Times::default(),
            }
        };
        SuiteReport {
            schema: SCHEMA.into(),
            suite: "example".into(),
            suite_file: "suite.toml".into(),
            suite_hash: "a0".repeat(32),
            version: "0.1.0".into(),
            adapter,
            part: None,
            cases_in_suite: states.len(),
            cases: states.into_iter().enumerate().map(case).collect(),
            milliseconds: 12.5,
        }
    }

    #[test]
    fn reports_are_read_as_they_were_written() {
        let folder = tempfile::tempdir().unwrap();
        let report = example();
        report.write(folder.path()).unwrap();
        assert_eq!(SuiteReport::read(folder.path()).unwrap(), report);
        assert_eq!(report.count(&[Status::Fail, Status::New]), 2);
        let other = SuiteReport { schema: "specula-test/0".into(), ..report };
        other.write(folder.path()).unwrap();
        let error = SuiteReport::read(folder.path()).unwrap_err().to_string();
        assert!(error.contains("specula-test/0") && !error.contains('\n'), "{error}");
        assert!(SuiteReport::read(&folder.path().join("none")).is_err());
    }
}
