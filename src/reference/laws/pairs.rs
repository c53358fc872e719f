//! Reciprocity and positivity, over a fixed set of pairs of directions.

use super::brdf::Brdf;
use super::exceeds;
use glam::DVec3;
use std::f64::consts::TAU;

/// Pairs tried: half of them spread over both hemispheres, half with the half vector in the lobe.
const PAIRS: u32 = 4096;

/// The worst of all pairs tried.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PairReport {
    /// Largest |f(v, l) - f(l, v)| / max(f(v, l), f(l, v)), of any channel; NaN when an f is no number.
    pub relative_difference: f64,
    /// Where it is.
    pub pair: [DVec3; 2],
    /// Smallest value of any channel, 1/sr; NaN or minus infinity when an f is not finite.
    pub smallest: f64,
    pub pairs: u32,
}

/// Evaluates f both ways for every pair. Cosines go down to 1e-3.
pub fn check_pairs(brdf: &dyn Brdf) -> PairReport {
    let mut report = PairReport { relative_difference: 0.0, pair: [DVec3::Z; 2], smallest: f64::INFINITY, pairs: 0 };
    for [v, l] in (0..PAIRS).filter_map(|i| pair(brdf, i)) {
        let (forth, back) = (brdf.evaluate(v, l), brdf.evaluate(l, v));
        report.pairs += 1;
        let difference = relative_difference(forth, back);
        if exceeds(difference, report.relative_difference) {
            (report.relative_difference, report.pair) = (difference, [v, l]);
        }
        for f in [forth, back] {
            report.smallest = if f.is_finite() { report.smallest.min(f.min_element()) } else { f64::NEG_INFINITY };
        }
    }
    report
}

fn relative_difference(a: DVec3, b: DVec3) -> f64 {
    let channel = |i: usize| {
        let largest = a[i].abs().max(b[i].abs());
        if largest == 0.0 { 0.0 } else { (a[i] - b[i]).abs() / largest }
    };
    // Unlike f64::max, this keeps NaN.
    (0..3).map(channel).fold(0.0, |worst, difference| if difference <= worst { worst } else { difference })
}

/// The i-th pair; `None` where the mirror image of the view about the half vector is below the horizon.
fn pair(brdf: &dyn Brdf, i: u32) -> Option<[DVec3; 2]> {
    // Additive recurrence in four dimensions (Roberts 2018): powers of the root of x^5 = x + 1.
    const ROOT: f64 = 1.167_303_978_261_418_7;
    let u = |dimension: i32| (0.5 + f64::from(i) / ROOT.powi(dimension)).fract();
    // Every third view is grazing.
    let v = direction(if i.is_multiple_of(3) { u(1).powi(4) } else { u(1) }, u(2));
    let l = if i.is_multiple_of(2) {
        direction(if i.is_multiple_of(4) { u(3).powi(4) } else { u(3) }, u(4))
    } else {
        let lobe = brdf.lobe();
        // GGX's own density of half vectors: tan = alpha sqrt(u / (1 - u)).
        let tan = lobe.alpha * (u(3) / (1.0 - u(3))).sqrt();
        let (x, y) = crate::math::spaces::orthonormal_basis(lobe.axis);
        let (sin, cos) = (TAU * u(4)).sin_cos();
        let h = (lobe.axis + tan * (cos * x + sin * y)).normalize();
        2.0 * v.dot(h) * h - v
    };
    (l.z >= 1e-3).then_some([v, l])
}

/// The direction of a cosine, kept off the horizon, and of a share of the full turn.
fn direction(u: f64, turn: f64) -> DVec3 {
    let cos = 1e-3 + (1.0 - 1e-3) * u;
    let (sin_phi, cos_phi) = (TAU * turn).sin_cos();
    let sin = (1.0 - cos * cos).sqrt();
    DVec3::new(sin * cos_phi, sin * sin_phi, cos)
}
