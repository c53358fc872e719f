//! A run: one thread draws, others judge.

use super::date::today;
use super::drawing::Drawn;
use super::judge::{Judge, without_picture};
use super::report::{CaseReport, Status};
use super::suite::Case;
use crate::cli::environment::CacheArgs;
use crate::cli::error::CliError;
use crate::cli::stage::Stage;
use crate::gpu::Gpu;
use crate::progress::{Progress, Silent};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

/// What is drawn and how it is judged.
pub(super) struct Plan<'a> {
    pub(super) cases: &'a [&'a Case],
    pub(super) judge: &'a Judge<'a>,
    /// Threads that judge.
    pub(super) jobs: usize,
    pub(super) cache: &'a CacheArgs,
}

/// A picture and the case that it is of, by its number.
type Job = (usize, Drawn);

impl Plan<'_> {
    /// The reports of all cases, in their order.
    pub(super) fn run(&self, gpu: &Gpu, progress: &dyn Progress) -> Vec<CaseReport> {
        progress.begin("Drawing cases", self.cases.len() as u64);
        let reports: Vec<Mutex<Option<CaseReport>>> = self.cases.iter().map(|_| Mutex::new(None)).collect();
        // Pictures that wait to be judged are in memory.
        let (sender, receiver) = sync_channel(self.jobs);
        let receiver = Mutex::new(receiver);
        let mut stage = Stage::new(gpu, self.cache, &Silent);
        std::thread::scope(|scope| {
            for _ in 0..self.jobs {
                scope.spawn(|| self.judge_all(&receiver, &reports));
            }
            self.draw_all(&mut stage, &sender, &reports, progress);
            // No more are to come.
            drop(sender);
        });
        let report = |(case, report): (&&Case, Mutex<Option<CaseReport>>)| {
            let report = report.into_inner().unwrap_or_else(PoisonError::into_inner);
            let lost = || without_picture(case, Status::Error, Some("was not judged; please report this".into()));
            report.unwrap_or_else(lost)
        };
        let mut reports: Vec<CaseReport> = self.cases.iter().zip(reports).map(report).collect();
        self.look_again(&mut stage, &mut reports, progress);
        reports
    }

    /// Draws what failing and new pictures are made of.
    fn look_again<'a>(&'a self, stage: &mut Stage<'a>, reports: &mut [CaseReport], progress: &dyn Progress) {
        let wanted = |index: &usize| self.judge.wants_second_look(&reports[*index]);
        // Backwards: what was loaded last is still there.
        let again: Vec<usize> = self.order().into_iter().rev().filter(wanted).collect();
        if again.is_empty() {
            return;
        }
        progress.begin("Finding out what has moved", again.len() as u64);
        for index in again {
            let start = Instant::now();
            let (case, report) = (self.cases[index], &mut reports[index]);
            self.judge.look_again(stage, case, report);
            report.times.judge_ms += start.elapsed().as_secs_f64() * 1e3;
            progress.advance(1);
        }
    }

    fn draw_all<'a>(
        &'a self,
        stage: &mut Stage<'a>,
        sender: &SyncSender<Job>,
        reports: &[Mutex<Option<CaseReport>>],
        progress: &dyn Progress,
    ) {
        for index in self.order() {
            let case = self.cases[index];
            let drawn = match skip_reason(case) {
                Some(reason) => Err((Status::Skipped, reason)),
                None => self.draw(stage, case).map_err(|error| (Status::Error, error.to_string())),
            };
            match drawn {
                // Nobody receives when all judges have panicked; that is told when they are joined.
                Ok(drawn) => drop(sender.send((index, drawn))),
                Err((status, reason)) => store(&reports[index], without_picture(case, status, Some(reason))),
            }
            progress.advance(1);
        }
    }

    fn draw<'a>(&self, stage: &mut Stage<'a>, case: &'a Case) -> Result<Drawn, CliError> {
        stage.draw(case, self.judge.times, self.judge.known_picture(case).as_deref())
    }

    /// Cases of one model and light follow each other, otherwise in the order of the suite.
    fn order(&self) -> Vec<usize> {
        let mut subjects: Vec<&Case> = Vec::new();
        let mut groups: Vec<Vec<usize>> = Vec::new();
        for (index, case) in self.cases.iter().enumerate() {
            match subjects.iter().position(|other| other.args.subject == case.args.subject) {
                Some(group) => groups[group].push(index),
                None => {
                    subjects.push(case);
                    groups.push(vec![index]);
                }
            }
        }
        groups.concat()
    }

    fn judge_all(&self, jobs: &Mutex<Receiver<Job>>, reports: &[Mutex<Option<CaseReport>>]) {
        loop {
            // The lock is let go before the picture is judged.
            let job = jobs.lock().unwrap_or_else(PoisonError::into_inner).recv();
            let Ok((index, drawn)) = job else { return };
            store(&reports[index], self.judge.judge(self.cases[index], &drawn));
        }
    }
}

fn store(place: &Mutex<Option<CaseReport>>, report: CaseReport) {
    *place.lock().unwrap_or_else(PoisonError::into_inner) = Some(report);
}

/// Why a case is left out today, if it is.
fn skip_reason(case: &Case) -> Option<String> {
    let skip = case.skip.as_ref()?;
    let (year, month, day) = skip.until;
    (today() <= skip.until).then(|| format!("{} (until {year:04}-{month:02}-{day:02})", skip.reason))
}
