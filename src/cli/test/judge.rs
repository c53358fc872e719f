//! What a picture is worth: the golden beside it, the limits, and what is left for people to look at.

use super::comparison::{Comparison, compare, read_golden};
use super::drawing::Drawn;
use super::golden;
use super::limits::Compared;
use super::report::{AdapterReport, Blobs, CaseReport, Kind, MetricReport, Paths, Provenance, Status, Times};
use super::suite::{Case, Suite, default_out};
use crate::cli::error::CliError;
use crate::cli::output;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Name of the condition that `--repeat` makes.
pub(super) const REPETITIONS: &str = "repeat.pixels";

/// Which goldens a run writes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub(super) enum Update {
    /// Those that are missing.
    New,
    /// Those that pictures fail against.
    Changed,
    /// Those that are missing, and all that differ at all.
    All,
}

/// All that judging the cases of a run has in common.
#[derive(Debug)]
pub(super) struct Judge<'a> {
    pub(super) suite: &'a Suite,
    pub(super) adapter: &'a AdapterReport,
    /// The folder of the run.
    pub(super) out: &'a Path,
    pub(super) update: Option<Update>,
    /// How often each case was drawn.
    pub(super) times: u32,
}

/// One case while it is judged.
struct Trial<'a> {
    judge: &'a Judge<'a>,
    case: &'a Case,
    drawn: &'a Drawn,
    provenance: Provenance,
    report: CaseReport,
    /// The file of the picture, once it is written.
    png: Option<Vec<u8>>,
}

/// The report of a case that has no picture.
pub(super) fn without_picture(case: &Case, status: Status, reason: Option<String>) -> CaseReport {
    CaseReport {
        id: case.id.clone(),
        index: case.index,
        kind: case.kind,
        status,
        reason,
        line: case.line,
        model: case.model.clone(),
        settings: case.settings.clone(),
        metrics: Vec::new(),
        paths: Paths::default(),
        blobs: Blobs::default(),
        provenance: None,
        golden_provenance: None,
        moved: Vec::new(),
        ingredients: None,
        accept: None,
        golden_written: false,
        times: Times::default(),
    }
}

impl Judge<'_> {
    /// The hash of the picture that a case is known by, if it is known by one.
    pub(super) fn known_picture(&self, case: &Case) -> Option<String> {
        (case.kind == Kind::Golden)
            .then(|| self.suite.golden(&case.id, &self.adapter.class))
            .and_then(|path| golden::recorded_hash(&path))
    }

    /// Judges the picture of a case, and writes what is to be seen of it.
    pub(super) fn judge(&self, case: &Case, drawn: &Drawn) -> CaseReport {
        let start = Instant::now();
        let provenance = Provenance {
            version: env!("CARGO_PKG_VERSION").into(),
            suite: self.suite.name.clone(),
            case: case.id.clone(),
            adapter: self.adapter.clone(),
            scene_hash: drawn.scene_hash.clone(),
            picture_hash: drawn.picture_hash.clone(),
            settings_hash: case.settings_hash(),
            settings: case.settings.clone(),
        };
        let report = CaseReport { provenance: Some(provenance.clone()), ..without_picture(case, Status::Pass, None) };
        let mut trial = Trial { judge: self, case, drawn, provenance, report, png: None };
        trial.forget_earlier_files();
        let judged = match case.kind {
            Kind::Golden => trial.against_golden(),
            Kind::Furnace => trial.in_furnace(),
            Kind::Reference => trial.against_truth(),
        };
        trial.check_repetitions();
        let mut report = trial.report;
        if let Err(error) = judged {
            (report.status, report.reason, report.accept) = (Status::Error, Some(error.to_string()), None);
        }
        let judge_ms = start.elapsed().as_secs_f64() * 1e3;
        report.times = Times { load_ms: drawn.load_ms, draw_ms: drawn.draw_ms, judge_ms };
        report
    }
}

impl Trial<'_> {
    fn against_golden(&mut self) -> Result<(), CliError> {
        let class = &self.judge.adapter.class;
        let path = self.judge.suite.golden(&self.case.id, class);
        self.report.paths.golden = Some(path.clone());
        let flaw = || self.drawn.fault.clone().or_else(|| golden::blank(&self.drawn.rgba));
        let Some((bytes, golden)) = read_golden(&path)? else {
            self.report.status = Status::New;
            return self.propose(flaw());
        };
        if let Some(problem) = golden::blank(&golden.rgba) {
            return Err(CliError::Usage(format!("{}: is no golden: {problem}; remove it", path.display())));
        }
        let (size, [width, height]) = ((golden.width, golden.height), self.drawn.size_px.to_array());
        let is_equal = size == (width, height) && golden.rgba == self.drawn.rgba;
        let limits = self.judge.suite.limits(self.case, class);
        if is_equal {
            self.report.metrics = limits.iter().map(|limit| limit.check(Compared::Equal)).collect();
        } else if size == (width, height) {
            let actual = self.actual()?;
            let compared = compare(&actual, (&bytes, &path), limits, self.case.mask.as_deref())?;
            self.take_over(compared)?;
        } else {
            let (w, h) = size;
            self.fail(Some(format!("the golden is {w} x {h} pixels, the picture {width} x {height}")));
        }
        self.report.golden_provenance = golden.provenance;
        self.fail_by_metrics();
        // What is the golden was asked when it became that.
        let flaw = if is_equal { None } else { flaw() };
        if flaw.is_some() {
            self.fail(None);
        }
        let has_failed = self.report.status == Status::Fail;
        if has_failed || (self.judge.update == Some(Update::All) && !is_equal) { self.propose(flaw) } else { Ok(()) }
    }

    /// Says how to make the picture the golden, or why it cannot be one.
    fn propose(&mut self, flaw: Option<String>) -> Result<(), CliError> {
        self.actual()?;
        if let Some(flaw) = flaw {
            self.report.reason = Some(format!("{flaw}; such a picture cannot become a golden"));
            return Ok(());
        }
        let Judge { suite, out, .. } = *self.judge;
        self.report.accept = Some(accept_command(&suite.file, &self.case.id, out));
        Ok(())
    }

    /// Where surfaces are, a white furnace has the radiance of its surroundings, which is 1.
    fn in_furnace(&mut self) -> Result<(), CliError> {
        self.actual()?;
        if let Some(fault) = &self.drawn.fault {
            self.fail(Some(fault.clone()));
            return Ok(());
        }
        let texels: &[glam::Vec4] = self.drawn.radiance.as_ref().map_or(&[], |radiance| &radiance.texels);
        let covered = texels.iter().enumerate().filter(|(_, texel)| texel.w > 0.999);
        let error = |texel: &glam::Vec4| (texel.truncate() - 1.0).abs().max_element();
        let worst = covered.map(|(i, texel)| (i, error(texel))).max_by(|a, b| a.1.total_cmp(&b.1));
        let Some((index, worst)) = worst else {
            return Err(CliError::Usage("no pixel is covered by a surface".into()));
        };
        let (limit, limit_from) = self.case.within.clone().unwrap_or_default();
        let (x, y) = (index as u32 % self.drawn.size_px.x, index as u32 / self.drawn.size_px.x);
        let value = f64::from(worst);
        self.report.metrics.push(MetricReport {
            name: "furnace.max".into(),
            value: Some(value),
            comparison: "<=".into(),
            limit,
            limit_from,
            holds: value <= limit,
            remark: format!("pixel ({x}, {y}): {}", texels[index].truncate()),
        });
        self.fail_by_metrics();
        Ok(())
    }

    fn against_truth(&mut self) -> Result<(), CliError> {
        let actual = self.actual()?;
        if let Some(fault) = &self.drawn.fault {
            self.fail(Some(fault.clone()));
            return Ok(());
        }
        let path = self.file("truth.png");
        let truth = self.encode(self.drawn.truth.as_deref().unwrap_or_default(), &path)?;
        output::write_in_folders(&path, &truth)?;
        self.report.paths.golden = Some(path.clone());
        let limits = self.judge.suite.limits(self.case, &self.judge.adapter.class);
        let compared = compare(&actual, (&truth, &path), limits, self.case.mask.as_deref())?;
        self.take_over(compared)?;
        self.fail_by_metrics();
        Ok(())
    }

    fn take_over(&mut self, compared: Comparison) -> Result<(), CliError> {
        self.report.metrics = compared.metrics;
        let Some([difference, heat_map]) = compared.pictures else { return Ok(()) };
        let files = [self.file("difference.png"), self.file("flip.png")];
        output::write_in_folders(&files[0], &difference)?;
        output::write_in_folders(&files[1], &heat_map)?;
        let [difference, heat_map] = files;
        (self.report.paths.difference, self.report.paths.heat_map) = (Some(difference), Some(heat_map));
        Ok(())
    }

    fn check_repetitions(&mut self) {
        let Some(differing) = self.drawn.differing_when_repeated else { return };
        self.report.metrics.push(MetricReport {
            name: REPETITIONS.into(),
            value: Some(differing as f64),
            comparison: "<=".into(),
            limit: 0.0,
            limit_from: format!("--repeat {}", self.judge.times),
            holds: differing == 0,
            remark: "pixels that were not the same every time".into(),
        });
        if self.report.status == Status::Pass {
            self.fail_by_metrics();
        }
    }

    fn fail_by_metrics(&mut self) {
        if self.report.metrics.iter().any(|metric| !metric.holds) {
            self.fail(None);
        }
    }

    fn fail(&mut self, reason: Option<String>) {
        self.report.status = Status::Fail;
        if reason.is_some() {
            self.report.reason = reason;
        }
    }

    /// The file of the picture of this run, which is written the first time that it is asked for.
    fn actual(&mut self) -> Result<Vec<u8>, CliError> {
        if let Some(png) = &self.png {
            return Ok(png.clone());
        }
        let path = self.file("actual.png");
        let png = self.encode(&self.drawn.rgba, &path)?;
        output::write_in_folders(&path, &png)?;
        self.report.paths.actual_hash = Some(blake3::hash(&png).to_hex().to_string());
        self.report.paths.actual = Some(path);
        self.png = Some(png.clone());
        Ok(png)
    }

    fn encode(&self, rgba: &[u8], path: &Path) -> Result<Vec<u8>, CliError> {
        let png = golden::encode(self.drawn.size_px.x, self.drawn.size_px.y, rgba, &self.provenance);
        png.map_err(|reason| CliError::Write { path: path.to_owned(), reason })
    }

    fn file(&self, ending: &str) -> PathBuf {
        self.judge.out.join(format!("{}.{ending}", self.case.id))
    }

    /// What a run before has left of the case would be taken for this one's. That there is nothing is no error.
    fn forget_earlier_files(&self) {
        for ending in ["actual.png", "truth.png", "difference.png", "flip.png"] {
            let _ = std::fs::remove_file(self.file(ending));
        }
    }
}

/// What a user types to make the picture of the last run the golden.
pub(super) fn accept_command(suite: &Path, id: &str, out: &Path) -> String {
    let quoted = |path: &Path| {
        let text = path.display().to_string();
        let is_plain = |c: char| c.is_ascii_alphanumeric() || "/._-+=,:@%".contains(c);
        if text.chars().all(is_plain) && !text.is_empty() { text } else { format!("'{}'", text.replace('\'', r"'\''")) }
    };
    let place = if out == default_out(suite) { String::new() } else { format!(" --out {}", quoted(out)) };
    format!("specula accept {} {id}{place}", quoted(suite))
}
