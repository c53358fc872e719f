//! The part of a run that this process draws.

use super::partition::{PartitionRequest, Share};
use super::report::{PartReport, SuiteReport};
use super::suite::Case;
use crate::cli::error::CliError;
use std::collections::HashMap;
use std::path::PathBuf;

#[derive(Debug, clap::Args)]
pub(super) struct PartArgs {
    /// Draw one part of the cases, such as hash:2/4: slice takes neighbours, hash goes by names, weight by the times of an
    /// earlier run. A scheduler's variables stand in for auto, and for both numbers (docs/sharding.md).
    #[arg(long, value_name = "slice|hash|weight[:K/N]")]
    partition: Option<PartitionRequest>,
    /// Folder of an earlier run of the suite, whose times --partition weight shares by; the same for all parts.
    #[arg(long, value_name = "DIR", requires = "partition")]
    times: Option<PathBuf>,
}

impl PartArgs {
    /// Those of the cases that are in this part, and what the part is; all of them where no part was asked for.
    ///
    /// # Errors
    /// When it cannot be told which part this is, or by which times.
    pub(super) fn take<'a>(&self, cases: &[&'a Case]) -> Result<(Vec<&'a Case>, Option<PartReport>), CliError> {
        let Some(request) = self.partition else { return Ok((cases.to_vec(), None)) };
        if request.is_by_weight() != self.times.is_some() {
            return Err(CliError::Usage(
                "--partition weight and --times, the folder of an earlier run, go together".into(),
            ));
        }
        let partition = request.resolve_here()?;
        let earlier = self.times.as_deref().map(SuiteReport::read).transpose()?;
        let known = earlier.iter().flat_map(|report| &report.cases);
        let times: HashMap<&str, f64> = known.map(|case| (case.id.as_str(), case.milliseconds())).collect();
        let share = |case: &&'a Case| Share { id: &case.id, milliseconds: times.get(case.id.as_str()).copied() };
        let shares: Vec<Share<'_>> = cases.iter().map(share).collect();
        let chosen = partition.select(&shares).into_iter().map(|index| cases[index]).collect();
        Ok((chosen, Some(partition.report(cases.len()))))
    }
}
