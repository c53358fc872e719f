//! The command line. Results go to stdout, everything else to stderr.

mod bake;
mod batch;
mod bench;
mod camera;
mod clock;
mod color;
mod compare;
mod debug_view;
mod doctor;
mod driver;
mod environment;
mod error;
mod furnace;
mod glob;
mod inspect;
mod light;
mod measure;
mod output;
mod overrides;
mod progress;
mod render;
mod shot;
mod stability;
mod stage;
mod stats;
mod subject;
mod svg;
mod test;
mod tier;
mod truth;
mod view;
#[cfg(feature = "view")]
mod window;

use crate::parallel;
use clap::{Parser, Subcommand};
use std::process::ExitCode;

/// Real-time, physically based glTF renderer: measurably accurate, and a scene pays only for what it uses.
#[derive(Debug, Parser)]
#[command(name = "specula", version, arg_required_else_help = true)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Render a model to a picture.
    Render(Box<render::RenderArgs>),
    #[cfg(feature = "view")]
    View(window::WindowArgs),
    /// Say what a model holds, or what made one pixel of its picture.
    Inspect(Box<inspect::InspectArgs>),
    /// Check that materials obey the laws of reflection: reciprocity, positivity, energy, facets.
    Furnace(Box<furnace::FurnaceArgs>),
    /// Measure what settings cost in time and gain in error against the reference renderer.
    Bench(Box<bench::BenchArgs>),
    /// Say which adapters there are, and what works less well on the one that is taken.
    Doctor(doctor::DoctorArgs),
    /// Compare two pictures, PNG with PNG or EXR with EXR: pixels, PSNR, SSIM, FLIP.
    Compare(Box<compare::CompareArgs>),
    /// Draw the cases of a suite and compare them with their goldens.
    Test(Box<test::TestArgs>),
    /// Make pictures of the last `specula test` goldens.
    Accept(test::AcceptArgs),
    /// Join the reports of a suite whose cases several processes have shared.
    MergeReports(test::MergeArgs),
    /// Regenerate the tables that are part of the program.
    Bake(bake::BakeArgs),
    /// Measure what f32 on this device makes of the shading model, and search it for faults.
    Stability(stability::StabilityArgs),
}

/// Runs the program with the arguments of the process.
///
/// Exit codes: 0 done; 1 a check failed or pictures differ; 2 bad usage, unreadable input or a GPU error; 3 no usable adapter.
pub fn main() -> ExitCode {
    let result = match Cli::parse().command {
        Command::Render(args) => render::run(&args),
        #[cfg(feature = "view")]
        Command::View(args) => window::run(&args),
        Command::Inspect(args) => inspect::run(&args),
        Command::Furnace(args) => furnace::run(&args),
        Command::Bench(args) => bench::run(&args),
        Command::Doctor(args) => doctor::run(&args),
        Command::Compare(args) => compare::run(&args),
        Command::Test(args) => test::run(&args),
        Command::Accept(args) => test::accept(&args),
        Command::MergeReports(args) => test::merge(&args),
        Command::Bake(args) => bake::run(&args),
        Command::Stability(args) => stability::run(&args),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("specula: {error}");
            error.exit_code()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn flags_that_are_named_by_others_exist() {
        Cli::command().debug_assert();
    }
}
