//! Cases that failed or have no golden yet are looked at again, once all pictures are judged: what they are made of is drawn,
//! compared with what the golden was made of, with the truth or with the law of a furnace, and kept for the golden that they
//! may become.

use super::comparison::read_golden;
use super::golden;
use super::ingredients::{Finding, Ingredients, findings, findings_in_furnace};
use super::judge::{Judge, REPETITIONS, Update};
use super::report::{CaseReport, Kind, Status};
use super::suite::Case;
use crate::cli::error::CliError;
use crate::cli::stage::Stage;
use std::path::Path;

impl Judge<'_> {
    /// Whether the case is worth it. One that passes is not.
    pub(super) fn wants_second_look(&self, report: &CaseReport) -> bool {
        let is_open = matches!(report.status, Status::Fail | Status::New) || report.accept.is_some();
        is_open && report.paths.actual.is_some()
    }

    /// Says what has moved, or is not as it should be, and makes the picture the golden where that was asked for.
    pub(super) fn look_again<'a>(&self, stage: &mut Stage<'a>, case: &'a Case, report: &mut CaseReport) {
        let within = case.within.as_ref().map_or(0.0, |(within, _)| *within);
        let found = match case.kind {
            Kind::Golden => return self.look_at_golden(case, report, stage.ingredients(case)),
            Kind::Furnace => stage.ingredients(case).map(|made_of| findings_in_furnace(&made_of, within)),
            Kind::Reference => stage.beside_truth(case),
        };
        report.moved = found.unwrap_or_else(|error| vec![cannot_be_drawn(&error)]);
    }

    fn look_at_golden(&self, case: &Case, report: &mut CaseReport, made_of: Result<Ingredients, CliError>) {
        let path = self.suite.golden(&case.id, &self.adapter.class);
        let ingredients = match made_of {
            Ok(ingredients) => Some(ingredients),
            Err(error) => {
                report.moved = vec![cannot_be_drawn(&error)];
                None
            }
        };
        if let (Status::Fail, Some(now)) = (report.status, &ingredients) {
            report.moved = moved(&path, now);
        }
        if report.accept.is_some() {
            report.ingredients = ingredients;
        }
        let is_wanted = match self.update {
            None => false,
            Some(Update::New) => report.status == Status::New,
            Some(Update::Changed) => report.status == Status::Fail,
            Some(Update::All) => true,
        };
        if is_wanted
            && report.accept.take().is_some()
            && let Err(error) = self.bless(&path, report)
        {
            (report.status, report.reason) = (Status::Error, Some(error.to_string()));
        }
    }

    fn bless(&self, path: &Path, report: &mut CaseReport) -> Result<(), CliError> {
        let (Some(actual), Some(provenance)) = (&report.paths.actual, &report.provenance) else { return Ok(()) };
        let png = golden::read_judged(actual, report.paths.actual_hash.as_deref()).map_err(CliError::Usage)?;
        golden::write(path, &png, (provenance, report.ingredients.as_ref()), self.suite.golden_bytes_max)?;
        // A golden that is not drawn again by the next call is one that fails.
        let repeats = report.metrics.iter().all(|metric| metric.holds || metric.name != REPETITIONS);
        report.status = if repeats { Status::Pass } else { Status::Fail };
        (report.golden_written, report.moved) = (true, Vec::new());
        report.reason = Some("the picture has become the golden".into());
        Ok(())
    }
}

fn cannot_be_drawn(error: &CliError) -> Finding {
    Finding::unknown(format!("what the picture is made of cannot be drawn: {error}"))
}

/// What has moved since the golden was drawn.
fn moved(golden: &Path, now: &Ingredients) -> Vec<Finding> {
    let then = read_golden(golden).ok().flatten().and_then(|(_, picture)| {
        golden::ingredients(golden, &golden::picture_hash(picture.width, picture.height, &picture.rgba))
    });
    match then {
        Some(then) => findings(&then, now),
        None => vec![Finding::unknown("nothing is kept of what the golden was made of; accept it again to have that")],
    }
}
