//! `specula bake`: the tables that are part of the program.

use super::error::CliError;
use crate::bake::{dfg, disney};
use std::io;
use std::path::{Path, PathBuf};

#[derive(Debug, clap::Args)]
pub(super) struct BakeArgs {
    /// Folder that receives the tables.
    #[arg(long, default_value = "assets")]
    out: PathBuf,
    /// Write nothing: exit with 1 when a table differs from the one in the program by more than one step.
    #[arg(long)]
    check: bool,
}

/// A table: its file, how it is made, what the program has, and how it is written.
struct Table {
    name: &'static str,
    bake: fn() -> Vec<u16>,
    embedded: fn() -> Vec<u16>,
    write: fn(&Path) -> io::Result<()>,
}

const TABLES: [Table; 2] = [
    Table { name: "dfg.bin", bake: dfg::bake, embedded: dfg::embedded, write: dfg::write },
    Table { name: "disney.bin", bake: disney::bake, embedded: disney::embedded, write: disney::write },
];

pub(super) fn run(args: &BakeArgs) -> Result<(), CliError> {
    TABLES.iter().try_for_each(|table| if args.check { check(table) } else { write(table, &args.out) })
}

fn check(table: &Table) -> Result<(), CliError> {
    let baked = (table.bake)();
    let steps = baked.iter().zip((table.embedded)()).map(|(a, b)| a.abs_diff(b)).max().unwrap_or(u16::MAX);
    match steps {
        0 | 1 => Ok(()),
        _ => Err(CliError::CheckFailed(format!("{} differs by {steps} steps; run `specula bake`", table.name))),
    }
}

fn write(table: &Table, folder: &Path) -> Result<(), CliError> {
    let path = folder.join(table.name);
    (table.write)(&path).map_err(|error| CliError::Write { path: path.clone(), reason: error.to_string() })?;
    eprintln!("specula: wrote {}", path.display());
    Ok(())
}
