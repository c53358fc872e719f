//! Prints the tables of docs/multiscatter.md: models of multiple scattering against random walks on the microsurface.
//!
//! `cargo run --release --example multiscatter`

#![expect(non_snake_case, clippy::print_stdout, reason = "symbols of the papers; the tables are the output")]

use glam::{DVec2, DVec3};
use specula::reference::albedo::DfgIntegrator;
use specula::reference::brdf::{F_Schlick_average, later_escape};
use specula::reference::compensation::Compensation;
use specula::reference::quadrature::GaussLegendre;
use specula::reference::walk::{Microsurface, Numbers, albedo};
use std::f64::consts::{PI, TAU};

/// Reflectances at normal incidence: a white metal, two grey ones, gold's green and blue, a dielectric.
const F0: [f64; 6] = [1.0, 0.8, 0.5, 0.77, 0.34, 0.04];
const WALKS: u32 = 1 << 18;
const BINS: usize = 8;

/// Of the fit: all that `F0` has between a tenth and 1, and more.
const COLORS: [f64; 8] = [0.1, 0.2, 0.34, 0.5, 0.65, 0.77, 0.9, 0.97];
/// Facets of which the share that leaves is printed.
const FACETS: usize = 4;

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
    escapes(&integrator);
    fit(&integrator);
    println!("\n| r | NoV | Kulla-Conty | Turquin | Fdez-Aguera |\n|---|---|---|---|---|");
    for r in [0.4, 0.7, 1.0] {
        for NoV in [0.2, 0.6, 0.95] {
            let [kulla_conty, turquin, fdez_aguera] = shapes(&integrator, r, NoV).map(|share| 100.0 * share);
            println!("| {r} | {NoV} | {kulla_conty:.0} % | {turquin:.0} % | {fdez_aguera:.0} % |");
        }
    }
}

/// Prints the share of the light at the first, second and later facets that leaves from there.
fn escapes(integrator: &DfgIntegrator) {
    println!("| r | E_avg | 1 | 2 | 3 | 4 | later_escape |\n|---|---|---|---|---|---|---|");
    for r in [0.4, 0.6, 0.8, 1.0] {
        let surface = Microsurface { alpha: DVec2::splat(r * r) };
        // Light that leaves after so many facets, and light that meets as many.
        let (mut leaves, mut meets) = ([0.0; FACETS], [0.0; FACETS]);
        for (NoV, weight) in GaussLegendre::new(8).nodes_on(0.0, 1.0) {
            for index in 0..WALKS {
                let (mut numbers, mut facets) = (Numbers::new(7, index), 0);
                surface.walk(
                    view(NoV),
                    || numbers.next(),
                    |_| {
                        facets += 1;
                        true
                    },
                );
                meets.iter_mut().take(facets).for_each(|meets| *meets += weight * NoV);
                leaves.iter_mut().skip(facets - 1).take(1).for_each(|leaves| *leaves += weight * NoV);
            }
        }
        let E_avg = integrator.dfg_average(r).albedo();
        print!("| {r} | {E_avg:.3} |");
        leaves.iter().zip(meets).for_each(|(leaves, meets)| print!(" {:.3} |", leaves / meets));
        println!(" {:.3} |", later_escape(E_avg));
    }
}

/// A curve for the share that leaves at later facets, over `E_avg` and a parameter.
type Escape = fn(f64, f64) -> f64;

/// Prints the error of several curves over their parameter, and where it is least.
fn fit(integrator: &DfgIntegrator) {
    let curves: [(&str, Escape); 4] = [
        ("E_avg (1 + k (1 - E_avg))", |E, k| E * (1.0 + k * (1.0 - E))),
        ("1 - (1 - E_avg)^k", |E, k| 1.0 - (1.0 - E).powf(k)),
        ("E_avg / (E_avg + k (1 - E_avg))", |E, k| E / (E + k * (1.0 - E))),
        ("E_avg^k", |E, k| E.powf(k)),
    ];
    // The part of the albedo that stays, what is to be met, E_avg and F_avg.
    let points: Vec<[f64; 5]> = (4..=20).flat_map(|step| fit_points(integrator, f64::from(step) * 0.05)).collect();
    let rms = |escape: Escape, k: f64, lowest: f64| {
        let errors = points.iter().filter(|point| point[4] > lowest).map(|&[single, truth, E, F, _]| {
            let e = escape(E, k);
            ((single + F * F * e / (1.0 - F * (1.0 - e)) * (1.0 - E)) / truth - 1.0).powi(2)
        });
        let errors: Vec<f64> = errors.collect();
        100.0 * (errors.iter().sum::<f64>() / errors.len() as f64).sqrt()
    };
    println!("\n| share that leaves later | k | RMS, F0 > 0.3 | RMS, F0 >= 0.1 |\n|---|---|---|---|");
    for k in [0.0, 0.5, 0.6, 0.7, 0.8, 0.9] {
        println!("| {} | {k} | {:.2} % | {:.2} % |", curves[0].0, rms(curves[0].1, k, 0.3), rms(curves[0].1, k, 0.0));
    }
    for (name, escape) in curves {
        let best =
            (0..400).map(|i| f64::from(i) * 0.01).min_by(|a, b| rms(escape, *a, 0.3).total_cmp(&rms(escape, *b, 0.3)));
        let k = best.unwrap_or_default();
        println!("| {name} | best: {k:.2} | {:.2} % | {:.2} % |", rms(escape, k, 0.3), rms(escape, k, 0.0));
    }
}

/// Cosine averages at one perceptual roughness for each of `COLORS`: single albedo, albedo of walks, E_avg, F_avg, F0.
fn fit_points(integrator: &DfgIntegrator, r: f64) -> Vec<[f64; 5]> {
    let pair = integrator.dfg_average(r);
    let mut truths = [0.0; COLORS.len()];
    for (NoV, weight) in GaussLegendre::new(8).nodes_on(0.0, 1.0) {
        let walked = albedo(Microsurface { alpha: DVec2::splat(r * r) }, view(NoV), COLORS, WALKS, 7).all;
        truths.iter_mut().zip(walked).for_each(|(truth, walked)| *truth += 2.0 * weight * NoV * walked);
    }
    let point = |(truth, f0): (f64, f64)| {
        let F_avg = F_Schlick_average(DVec3::splat(f0), 1.0).x;
        [f0 * pair.scale + pair.bias, truth, pair.albedo(), F_avg, f0]
    };
    truths.into_iter().zip(COLORS).map(point).collect()
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
