//! `specula bake`: the tables that are part of the program.

use super::error::CliError;
use crate::bake::TABLES;
use std::path::PathBuf;

#[derive(Debug, clap::Args)]
pub(super) struct BakeArgs {
    /// Folder that receives the tables.
    #[arg(long, default_value = "assets")]
    out: PathBuf,
    /// Write nothing: exit with 1 when a table differs from the one in the program by more than one step.
    #[arg(long)]
    check: bool,
}

pub(super) fn run(args: &BakeArgs) -> Result<(), CliError> {
    for table in TABLES {
        let path = args.out.join(table.file);
        if args.check {
            let steps = table.worst_difference();
            if steps > 1 {
                let message = format!("{} differs by {steps} steps; run `specula bake`", table.file);
                return Err(CliError::CheckFailed(message));
            }
            continue;
        }
        table.write(&args.out).map_err(|error| CliError::Write { path: path.clone(), reason: error.to_string() })?;
        eprintln!("specula: wrote {}", path.display());
    }
    Ok(())
}
