//! Where functions are compared: argument lists that reach the ends of every domain.

use crate::math::spaces::orthonormal_basis;
use glam::{Vec3, vec3};
use std::f64::consts::TAU;

/// Every combination of one value from each axis.
pub(super) fn product(axes: &[&[f32]]) -> Vec<Vec<f32>> {
    axes.iter().fold(vec![Vec::new()], |points, axis| {
        let extended = |point: &Vec<f32>| axis.iter().map(|&x| [point.as_slice(), &[x]].concat()).collect::<Vec<_>>();
        points.iter().flat_map(extended).collect()
    })
}

/// The `index`th of a sequence in [0, 1) that covers six dimensions evenly: additive recurrence (Roberts 2018).
pub(super) fn spread(index: usize, dimension: u32) -> f32 {
    // The root of x^7 = x + 1.
    let step = 1.112_775_684_278_705_5_f64.powi(-(dimension as i32 + 1));
    (0.5 + step * (index + 1) as f64).fract() as f32
}

/// Alphas from the smallest that is shaded upwards.
pub(super) const ALPHAS: [f32; 11] = [1e-4, 2e-4, 5e-4, 1e-3, 3e-3, 0.01, 0.03, 0.1, 0.3, 0.6, 1.0];

/// Cosines, dense toward both ends, where equations cancel or divide by little.
pub(super) const COSINES: [f32; 17] =
    [1e-6, 1e-4, 1e-3, 0.01, 0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 0.9, 0.99, 0.999, 0.9999, 0.999_99, 0.999_999_9, 1.0];

/// Numbers from `first` to `last`, so many a decade, even in their logarithm.
pub(super) fn log_steps(first: f32, last: f32, a_decade: u32) -> Vec<f32> {
    let (start, end) = (f64::from(first).log10(), f64::from(last).log10());
    let steps = ((end - start) * f64::from(a_decade)).round() as i32;
    let at = |step: i32| 10f64.powf(start + (end - start) * f64::from(step) / f64::from(steps)) as f32;
    // The ends as they were given, whatever the logarithm rounded.
    (0..=steps).map(|step| at(step).clamp(first, last)).collect()
}

/// Numbers in [0, 1] for weights and reflectances.
pub(super) const UNIT: [f32; 9] = [0.0, 1e-3, 0.02, 0.04, 0.2, 0.5, 0.8, 0.96, 1.0];

/// Unit vectors: axes, diagonals of faces, and an even cover of the sphere.
pub(super) fn directions(count: usize) -> Vec<Vec3> {
    let steps = [-1.0, 0.0, 1.0];
    let corners = steps.iter().flat_map(|&x| steps.iter().flat_map(move |&y| steps.map(|z| vec3(x, y, z))));
    let mut directions: Vec<Vec3> = corners.filter_map(Vec3::try_normalize).collect();
    directions.extend((0..count).map(|i| {
        let y = 1.0 - 2.0 * spread(i, 0);
        let (sin, cos) = (std::f32::consts::TAU * spread(i, 1)).sin_cos();
        let radius = (1.0 - y * y).max(0.0).sqrt();
        vec3(radius * cos, y, radius * sin).normalize()
    }));
    directions
}

/// A normal and a half vector for every alpha: angles of many sizes in units of alpha, in random frames.
pub(super) fn microfacets(alphas: &[f32]) -> Vec<Vec<f32>> {
    let in_alphas = [0.0, 0.1, 0.3, 0.7, 1.0, 2.0, 5.0, 12.0, 40.0, 150.0];
    let in_rad = [0.02, 0.1, 0.4, 0.8, 1.2, 1.5, 1.57];
    let frames = directions(24);
    let mut points = Vec::new();
    for &alpha in alphas {
        let angles = in_alphas.iter().map(|x| x * alpha).chain(in_rad).filter(|angle| *angle < 1.571);
        for (i, angle) in angles.enumerate() {
            for (j, n) in frames.iter().enumerate() {
                let side = n.any_orthonormal_vector();
                let turn = std::f32::consts::TAU * spread(64 * i + j, 2);
                let tangent = side * turn.cos() + n.cross(side) * turn.sin();
                let h = (n.as_dvec3() * f64::from(angle).cos() + tangent.as_dvec3() * f64::from(angle).sin()).as_vec3();
                points.push([&[alpha], n.as_ref() as &[f32], h.as_ref()].concat());
            }
        }
    }
    points
}

/// Perceptual roughness, n, v and l where a picture has them: the view even in projected area, three lights in four
/// where GGX reflects the view, the fourth even in projected area as well. `a_decade` alphas from 1e-4 to 1, `samples` for
/// each, in random frames.
pub(super) fn sampled_lobe(a_decade: u32, samples: usize) -> Vec<Vec<f32>> {
    let frames = directions(64);
    let mut points = Vec::new();
    for (step, alpha) in log_steps(1e-4, 1.0, a_decade).into_iter().enumerate() {
        for i in 0..samples {
            let index = step * samples + i;
            let n = frames[index % frames.len()].as_dvec3().normalize();
            let (tangent, bitangent) = orthonormal_basis(n);
            let around = |cosine: f64, dimension: u32| {
                let phi = TAU * f64::from(spread(index, dimension));
                let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
                tangent * (sine * phi.cos()) + bitangent * (sine * phi.sin()) + n * cosine
            };
            let even = |dimension: u32| f64::from(spread(index, dimension));
            let v = around((1.0 - even(0)).sqrt(), 1);
            let l = if i % 4 == 3 {
                around((1.0 - even(2)).sqrt(), 3)
            } else {
                // Walter et al. 2007, equation 35: tan^2 = alpha^2 u / (1 - u).
                let tan2 = f64::from(alpha).powi(2) * even(2) / (1.0 - even(2));
                let h = around((1.0 + tan2).sqrt().recip(), 3);
                h * (2.0 * v.dot(h)) - v
            };
            if n.dot(l) > 0.0 {
                let [n, v, l] = [n, v, l].map(|x| x.as_vec3().to_array());
                points.push([&[alpha.sqrt()], n.as_slice(), &v, &l].concat());
            }
        }
    }
    points
}

/// Exposed radiance: greys and colours from black to the brightest half float, and around the bends of the curves.
pub(super) fn colors() -> Vec<Vec<f32>> {
    let channels: &[f32] = &[0.0, 0.02, 0.079, 0.081, 0.5, 4.0];
    let mut colors = product(&[channels; 3]);
    let greys = (-120..=128).map(|i| vec![(i as f32 * 0.125).exp2(); 3]);
    colors.extend(greys);
    let random = |i: usize, channel: u32| (20.0 * spread(i, channel) - 4.0 * spread(i, 3) - 8.0).exp2().min(65504.0);
    colors.extend((0..2000).map(|i| (0..3).map(|channel| random(i, channel)).collect()));
    colors.extend([65504.0, 1e6, 1e9].iter().flat_map(|&x| [vec![x; 3], vec![x, 0.0, 1.0], vec![0.5, x, x]]));
    colors
}

/// Display light, with what lies outside of [0, 1] and the bend of the sRGB curve.
pub(super) fn display_light() -> Vec<Vec<f32>> {
    let bend = 0.003_130_8_f32;
    let special = [-1.0, -1e-6, 0.0, 1e-30, 1e-6, bend.next_down(), bend, bend.next_up(), 1.0, 1.0 + 1e-6, 7.0];
    let ramp: Vec<f32> = special.into_iter().chain((0..=4096).map(|i| i as f32 / 4096.0)).collect();
    ramp.iter().zip(ramp.iter().rev()).map(|(&x, &y)| vec![x, y, (x * y).sqrt().max(0.0)]).collect()
}
