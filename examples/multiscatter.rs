//! Prints the tables of docs/multiscatter.md: models of multiple scattering against random walks on the microsurface.
//!
//! `cargo run --release --example multiscatter`

#![expect(non_snake_case, clippy::print_stdout, reason = "symbols of the papers; the tables are the output")]

use glam::{DVec2, DVec3};
use specula::reference::albedo::DfgIntegrator;
use specula::reference::compensation::Compensation;
use specula::reference::quadrature::GaussLegendre;
use specula::reference::walk::{Microsurface, Numbers, albedo};
use std::f64::consts::{PI, TAU};

/// Reflectances at normal incidence: a white metal, two grey ones, gold's green and blue, a dielectric.
const F0: [f64; 6] = [1.0, 0.8, 0.5, 0.77, 0.34, 0.04];
const WALKS: u32 = 1 << 18;
const BINS: usize = 8;

fn main() {
    let integrator = DfgIntegrator::default();
    println!(
        "| r | F0 | walk | error of none | Kulla-Conty | with escape by walks | Turquin | Fdez-Aguera |\n|---|---|---|---|---|---|---|---|"
    );
    let mut squares = [0.0; 5];
    for r in [0.2, 0.4, 0.6, 0.8, 1.0] {
        for (index, (truth, models)) in averages(&integrator, r).into_iter().enumerate() {
            let errors = models.map(|model| 100.0 * (model / truth - 1.0));
            let [none, kulla_conty, by_walks, turquin, fdez_aguera] = errors;
            let f0 = F0[index];
            println!(
                "| {r} | {f0} | {truth:.4} | {none:.2} % | {kulla_conty:.2} % | {by_walks:.2} % | {turquin:.2} % | {fdez_aguera:.2} % |"
            );
            if (0.3..1.0).contains(&f0) {
                squares.iter_mut().zip(errors).for_each(|(square, error)| *square += error * error / 20.0);
            }
        }
    }
    println!(
        "\nRMS over metals below 1 (none, Kulla-Conty, with escape by walks, Turquin, Fdez-Aguera): {:.2?} %\n",
        squares.map(f64::sqrt)
    );
    println!("| r | NoV | Kulla-Conty | Turquin | Fdez-Aguera |\n|---|---|---|---|---|");
    for r in [0.4, 0.7, 1.0] {
        for NoV in [0.2, 0.6, 0.95] {
            let [kulla_conty, turquin, fdez_aguera] = shapes(&integrator, r, NoV).map(|share| 100.0 * share);
            println!("| {r} | {NoV} | {kulla_conty:.0} % | {turquin:.0} % | {fdez_aguera:.0} % |");
        }
    }
}

/// For each F0 the cosine-weighted albedo of walks and of every model.
fn averages(integrator: &DfgIntegrator, r: f64) -> Vec<(f64, [f64; 5])> {
    let average = integrator.dfg_average(r);
    let mut sums = vec![(0.0, [0.0; 5]); F0.len()];
    for (NoV, weight) in GaussLegendre::new(8).nodes_on(0.0, 1.0) {
        let truth = albedo(Microsurface { alpha: DVec2::splat(r * r) }, view(NoV), F0, WALKS, 7).all;
        let pair = integrator.dfg(r, NoV);
        let weight = 2.0 * weight * NoV;
        for ((sum, truth), f0) in sums.iter_mut().zip(truth).zip(F0) {
            sum.0 += weight * truth;
            for (sum, model) in sum.1.iter_mut().zip(Compensation::ALL) {
                *sum += weight * (f0 * pair.scale + pair.bias + model.multiple_albedo(pair, average, f0));
            }
        }
    }
    sums
}

/// Where the multiply scattered light of F0 = 0.8 goes: share of it that a model sends elsewhere, over 8 x 8 cells.
fn shapes(integrator: &DfgIntegrator, r: f64, NoV: f64) -> [f64; 3] {
    let (f0, alpha) = (0.8, r * r);
    let surface = Microsurface { alpha: DVec2::splat(alpha) };
    let mut walked = [[0.0; BINS]; BINS];
    for index in 0..WALKS {
        let mut numbers = Numbers::new(11, index);
        let (mut weight, mut facets) = (1.0, 0);
        let left = surface.walk(
            view(NoV),
            || numbers.next(),
            |reflection| {
                weight *= f0 + (1.0 - f0) * (1.0 - reflection.cosine).powi(5);
                facets += 1;
                true
            },
        );
        let Some(l) = left.filter(|_| facets > 1) else { continue };
        let row = (l.z * l.z * BINS as f64) as usize;
        let column = (l.y.atan2(l.x).rem_euclid(TAU) / TAU * BINS as f64) as usize;
        walked[row.min(BINS - 1)][column.min(BINS - 1)] += weight / f64::from(WALKS);
    }
    [Compensation::KullaConty, Compensation::Turquin, Compensation::FdezAguera].map(|model| {
        let modelled = modelled(integrator, model, (r, alpha, f0), NoV);
        let total = |cells: &[[f64; BINS]; BINS]| cells.iter().flatten().sum::<f64>();
        let scale = total(&walked) / total(&modelled);
        let cells = walked.iter().flatten().zip(modelled.iter().flatten());
        0.5 * cells.map(|(a, b)| (a - b * scale).abs()).sum::<f64>() / total(&walked)
    })
}

/// Light of a model in each cell, by midpoints.
fn modelled(
    integrator: &DfgIntegrator,
    model: Compensation,
    (r, alpha, f0): (f64, f64, f64),
    NoV: f64,
) -> [[f64; BINS]; BINS] {
    const FINE: usize = 64;
    let (pair, average, v) = (integrator.dfg(r, NoV), integrator.dfg_average(r), view(NoV));
    let mut cells = [[0.0; BINS]; BINS];
    for i in 0..FINE {
        let NoL = ((i as f64 + 0.5) / FINE as f64).sqrt();
        let pair_l = integrator.dfg(r, NoL);
        for j in 0..FINE {
            let phi = TAU * (j as f64 + 0.5) / FINE as f64;
            let l = (DVec2::from_angle(phi) * (1.0 - NoL * NoL).sqrt()).extend(NoL);
            // NoL dl = d(NoL^2) / 2 dphi.
            let cell = PI / (FINE * FINE) as f64;
            cells[i * BINS / FINE][j * BINS / FINE] +=
                model.multiple(alpha, f0, (v, l), (pair, pair_l, average)) * cell;
        }
    }
    cells
}

fn view(NoV: f64) -> DVec3 {
    DVec3::new((1.0 - NoV * NoV).sqrt(), 0.0, NoV)
}
