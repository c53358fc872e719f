//! `specula bake`: the tables that are part of the program.

use super::error::CliError;
use crate::bake::dfg;
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
    if args.check {
        let steps = dfg::bake().iter().zip(dfg::embedded()).map(|(a, b)| a.abs_diff(b)).max().unwrap_or(u16::MAX);
        return match steps {
            0 | 1 => Ok(()),
            _ => Err(CliError::CheckFailed(format!("dfg.bin differs by {steps} steps; run `specula bake`"))),
        };
    }
    let path = args.out.join("dfg.bin");
    dfg::write(&path).map_err(|error| CliError::Write { path: path.clone(), reason: error.to_string() })?;
    eprintln!("specula: wrote {}", path.display());
    Ok(())
}
