//! `specula bake`: the tables that are part of the program.

use super::error::CliError;
use crate::bake::TABLES;
use std::path::PathBuf;

#[derive(Debug, clap::Args)]
pub(super) struct BakeArgs {
    /// Only these, such as dfg.bin; all by default.
    tables: Vec<String>,
    /// Folder that receives the tables.
    #[arg(long, default_value = "assets")]
    out: PathBuf,
    /// Write nothing: exit with 1 when a table in the program is not what a bake makes.
    #[arg(long)]
    check: bool,
}

pub(super) fn run(args: &BakeArgs) -> Result<(), CliError> {
    if let Some(unknown) = args.tables.iter().find(|name| TABLES.iter().all(|table| table.file != name.as_str())) {
        let names = TABLES.map(|table| table.file).join(", ");
        return Err(CliError::Usage(format!("there is no table `{unknown}`; there are {names}")));
    }
    for table in
        TABLES.iter().filter(|table| args.tables.is_empty() || args.tables.iter().any(|name| name == table.file))
    {
        let path = args.out.join(table.file);
        if args.check {
            let wrong = |problem| CliError::CheckFailed(format!("{problem}; run `specula bake {}`", table.file));
            (table.check)(table).map_err(wrong)?;
            continue;
        }
        table.write(&args.out).map_err(|error| CliError::Write { path: path.clone(), reason: error.to_string() })?;
        eprintln!("specula: wrote {}", path.display());
    }
    Ok(())
}
