//! The files of a finished run: the page for people, JUnit XML for CI systems, JSON for all else.

use super::report::{self, SuiteReport};
use super::{annotations, junit, page};
use crate::cli::error::CliError;
use crate::cli::output;
use std::path::Path;

/// Names of the files in the folder of a run.
pub(super) const PAGE: &str = "report.html";
pub(super) const JUNIT: &str = "junit.xml";

#[derive(Debug, Clone, clap::Args)]
pub(super) struct PublishArgs {
    /// Most that the pictures in report.html may take together; those of the worst cases go first.
    #[arg(long, value_name = "MIB", default_value_t = 32)]
    page_limit: u32,
    /// Print failures as workflow commands of GitHub Actions, which shows them beside the lines of the suite.
    #[arg(long)]
    github: bool,
}

/// Writes all files of the report into `folder`, where its blobs are too; `report.json` comes last, when all is there.
///
/// # Errors
/// When a file cannot be written.
pub(super) fn publish(report: &SuiteReport, folder: &Path, args: &PublishArgs) -> Result<(), CliError> {
    let limit = u64::from(args.page_limit) << 20;
    output::write_in_folders(&folder.join(PAGE), page::html(report, folder, limit)?.as_bytes())?;
    output::write_in_folders(&folder.join(JUNIT), junit::xml(report)?.as_bytes())?;
    report.write(folder)?;
    if args.github {
        output::write(Path::new("-"), annotations::github(report).as_bytes())?;
    }
    Ok(())
}

/// Takes away what an earlier run has reported: if this one is interrupted, nobody shall take that for its report. What
/// killed runs have left half written goes too.
///
/// # Errors
/// When it is there and stays.
pub(super) fn forget(folder: &Path) -> Result<(), CliError> {
    output::clear_stale_below(folder);
    for name in [report::FILE_NAME, PAGE, JUNIT] {
        let path = folder.join(name);
        match std::fs::remove_file(&path) {
            Err(error) if error.kind() != std::io::ErrorKind::NotFound => {
                return Err(CliError::Write { path, reason: error.to_string() });
            }
            _ => {}
        }
    }
    Ok(())
}
