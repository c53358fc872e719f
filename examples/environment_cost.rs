//! Prints what share of baking a panorama goes into looking for suns, and what a file of the cache costs instead.
//!
//! `cargo run --release --example environment_cost -- PANORAMA.hdr ...`

#![expect(clippy::print_stdout, reason = "the figures are the output")]

mod clock;

use clock::{cpu_seconds, median};
use specula::bake::environment::{BakeOptions, bake};
use specula::bake::sun;
use specula::cache::{DEFAULT_LIMIT_BYTES, EnvironmentCache};
use specula::import::environment_from_path;
use specula::progress::Silent;
use std::time::Instant;

/// Each is measured so often, in turn, and the median counts.
const ROUNDS: usize = 9;

/// Time of a piece of work, seconds.
#[derive(Clone, Copy)]
struct Cost {
    wall: f64,
    /// Of all threads. None where the system does not tell.
    cpu: Option<f64>,
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    println!("| panorama | suns, CPU time | suns | cold cache | warm cache |\n|---|---|---|---|---|");
    for path in std::env::args().skip(1) {
        let image = environment_from_path(path.as_ref())?;
        let options = BakeOptions::default();
        let folder = std::env::temp_dir().join(format!("specula-environment-cost-{}", std::process::id()));
        let cache = EnvironmentCache::in_folder(&folder, DEFAULT_LIMIT_BYTES);
        let [mut whole, mut suns, mut cold, mut warm] = [const { Vec::new() }; 4];
        for _ in 0..ROUNDS {
            whole.push(cost(|| drop(bake(&image, &options, &Silent))));
            suns.push(cost(|| drop(sun::extract(&image))));
            cold.push(cost(|| drop(cache.bake(&image, &options, &Silent))));
            warm.push(cost(|| drop(cache.bake(&image, &options, &Silent))));
            std::fs::remove_dir_all(&folder)?;
        }
        let wall =
            |costs: &[Cost]| 100.0 * middle(costs, |cost| Some(cost.wall)) / middle(&whole, |cost| Some(cost.wall));
        let cpu = 100.0 * middle(&suns, |cost| cost.cpu) / middle(&whole, |cost| cost.cpu);
        println!("| {path} | {cpu:.1} % | {:.1} % | {:.1} % | {:.1} % |", wall(&suns), wall(&cold), wall(&warm));
    }
    Ok(())
}

fn cost(work: impl FnOnce()) -> Cost {
    let (start, cpu) = (Instant::now(), cpu_seconds());
    work();
    let wall = start.elapsed().as_secs_f64();
    Cost { wall, cpu: cpu_seconds().zip(cpu).map(|(after, before)| after - before) }
}

fn middle(costs: &[Cost], value: impl Fn(&Cost) -> Option<f64>) -> f64 {
    median(costs.iter().map(value))
}
