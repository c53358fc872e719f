//! Adaptive quadrature over rectangles with an error estimate: where an integrand has peaks and bends, more nodes go.

use glam::DVec3;
use std::cmp::Ordering;
use std::collections::BinaryHeap;
use std::ops::{Add, Mul, Sub};

/// What can be integrated.
pub trait Integrable: Copy + Add<Output = Self> + Sub<Output = Self> + Mul<f64, Output = Self> {
    const ZERO: Self;
    /// A norm, for errors.
    fn size(self) -> f64;
}

impl Integrable for f64 {
    const ZERO: Self = 0.0;
    fn size(self) -> f64 {
        self.abs()
    }
}

impl Integrable for DVec3 {
    const ZERO: Self = Self::ZERO;
    fn size(self) -> f64 {
        self.abs().max_element()
    }
}

/// An integral and how far off it may be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate<T> {
    pub value: T,
    /// Absolute, of the largest component: the difference between the rule and the one of half the nodes. Far too high
    /// for what is smooth; too low where a feature falls between all nodes, which no quadrature can tell.
    pub error: f64,
    pub evaluations: u64,
}

/// When an integral is good enough.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Accuracy {
    /// Absolute error to stop at.
    pub absolute: f64,
    /// Evaluations of the integrand to stop at, whatever the error.
    pub evaluations: u64,
}

/// Nodes of the 15-point Kronrod rule on [-1, 1] that are not negative, with its weights and those of the 7-point Gauss
/// rule, which has every other node (Piessens et al. 1983, QUADPACK, qk15).
const KRONROD: [(f64, f64, f64); 8] = [
    (0.991_455_371_120_812_6, 0.022_935_322_010_529_224, 0.0),
    (0.949_107_912_342_758_5, 0.063_092_092_629_978_55, 0.129_484_966_168_869_7),
    (0.864_864_423_359_769_1, 0.104_790_010_322_250_19, 0.0),
    (0.741_531_185_599_394_4, 0.140_653_259_715_525_92, 0.279_705_391_489_276_64),
    (0.586_087_235_467_691_1, 0.169_004_726_639_267_9, 0.0),
    (0.405_845_151_377_397_2, 0.190_350_578_064_785_4, 0.381_830_050_505_118_9),
    (0.207_784_955_007_898_47, 0.204_432_940_075_298_9, 0.0),
    (0.0, 0.209_482_141_084_727_82, 0.417_959_183_673_469_4),
];

/// Node, Kronrod weight and Gauss weight of the 15 points, mapped to [a, b].
pub fn kronrod_nodes(a: f64, b: f64) -> impl Iterator<Item = (f64, f64, f64)> + Clone {
    let (center, half) = (0.5 * (a + b), 0.5 * (b - a));
    let mirrored = KRONROD[..7].iter().map(|&(x, k, g)| (-x, k, g));
    mirrored.chain(KRONROD.iter().rev().copied()).map(move |(x, k, g)| (center + half * x, half * k, half * g))
}

/// Integral of `f` over [a, b] by one 15-point rule.
pub fn integrate_once<T: Integrable>(a: f64, b: f64, mut f: impl FnMut(f64) -> T) -> Estimate<T> {
    let (mut kronrod, mut gauss) = (T::ZERO, T::ZERO);
    for (x, k, g) in kronrod_nodes(a, b) {
        let value = f(x);
        kronrod = kronrod + value * k;
        gauss = gauss + value * g;
    }
    Estimate { value: kronrod, error: (kronrod - gauss).size(), evaluations: 15 }
}

/// A rectangle of the plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rectangle {
    pub x: [f64; 2],
    pub y: [f64; 2],
}

/// Integral of `f` over disjoint rectangles: the one with the largest error is halved, across the direction that has
/// more of it, until all errors together are below `accuracy` (the global strategy of QUADPACK's qag in two dimensions).
pub fn integrate_rectangles<T: Integrable>(
    rectangles: &[Rectangle],
    accuracy: Accuracy,
    mut f: impl FnMut(f64, f64) -> T,
) -> Estimate<T> {
    let mut cells: BinaryHeap<Cell<T>> = rectangles.iter().map(|&rectangle| Cell::new(rectangle, &mut f)).collect();
    let mut evaluations = Cell::<T>::EVALUATIONS * cells.len() as u64;
    let mut error: f64 = cells.iter().map(Cell::error).sum();
    while error > accuracy.absolute && evaluations + 2 * Cell::<T>::EVALUATIONS <= accuracy.evaluations {
        let Some(worst) = cells.pop() else { break };
        for half in worst.halves() {
            cells.push(Cell::new(half, &mut f));
            evaluations += Cell::<T>::EVALUATIONS;
        }
        // Summed anew: differences of errors would leave the rounding of the first, large ones.
        error = cells.iter().map(Cell::error).sum();
    }
    let value = cells.iter().fold(T::ZERO, |sum, cell| sum + cell.value);
    Estimate { value, error, evaluations }
}

/// A rectangle with its integral by the product of two 15-point rules.
#[derive(Debug)]
struct Cell<T> {
    rectangle: Rectangle,
    value: T,
    /// Difference to the product with the 7-point rule along x, and along y.
    error_x: f64,
    error_y: f64,
}

impl<T: Integrable> Cell<T> {
    const EVALUATIONS: u64 = 15 * 15;

    fn new(rectangle: Rectangle, f: &mut impl FnMut(f64, f64) -> T) -> Self {
        let ([x0, x1], [y0, y1]) = (rectangle.x, rectangle.y);
        let (mut value, mut coarse_x, mut coarse_y) = (T::ZERO, T::ZERO, T::ZERO);
        for (x, kronrod_x, gauss_x) in kronrod_nodes(x0, x1) {
            let (mut column, mut coarse_column) = (T::ZERO, T::ZERO);
            for (y, kronrod_y, gauss_y) in kronrod_nodes(y0, y1) {
                let value = f(x, y);
                column = column + value * kronrod_y;
                coarse_column = coarse_column + value * gauss_y;
            }
            value = value + column * kronrod_x;
            coarse_x = coarse_x + column * gauss_x;
            coarse_y = coarse_y + coarse_column * kronrod_x;
        }
        Self { rectangle, value, error_x: (value - coarse_x).size(), error_y: (value - coarse_y).size() }
    }

    fn error(&self) -> f64 {
        self.error_x + self.error_y
    }

    fn halves(&self) -> [Rectangle; 2] {
        let Rectangle { x, y } = self.rectangle;
        if self.error_x > self.error_y {
            let middle = 0.5 * (x[0] + x[1]);
            [Rectangle { x: [x[0], middle], y }, Rectangle { x: [middle, x[1]], y }]
        } else {
            let middle = 0.5 * (y[0] + y[1]);
            [Rectangle { x, y: [y[0], middle] }, Rectangle { x, y: [middle, y[1]] }]
        }
    }
}

impl<T: Integrable> PartialEq for Cell<T> {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl<T: Integrable> Eq for Cell<T> {}

impl<T: Integrable> PartialOrd for Cell<T> {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl<T: Integrable> Ord for Cell<T> {
    fn cmp(&self, other: &Self) -> Ordering {
        self.error().total_cmp(&other.error())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    const UNIT: Rectangle = Rectangle { x: [0.0, 1.0], y: [0.0, 1.0] };

    #[test]
    fn the_rules_are_exact_for_polynomials_of_their_degree() {
        for degree in 0..=22 {
            let (mut kronrod, mut gauss) = (0.0, 0.0);
            for (x, k, g) in kronrod_nodes(-0.5, 2.0) {
                kronrod += k * x.powi(degree);
                gauss += g * x.powi(degree);
            }
            let n = degree + 1;
            let exact = (2.0_f64.powi(n) - (-0.5_f64).powi(n)) / f64::from(n);
            assert!((kronrod / exact - 1.0).abs() < 1e-13, "degree {degree}: {kronrod}");
            assert!(degree > 13 || (gauss / exact - 1.0).abs() < 1e-13, "degree {degree}: {gauss}");
        }
    }

    #[test]
    fn errors_stay_below_their_estimate_for_peaks_and_bends() {
        let accuracy = Accuracy { absolute: 1e-8, evaluations: 1_000_000 };
        let narrow = 1e-3_f64;
        let peak = |x: f64, y: f64| narrow / ((x - 0.3).powi(2) + narrow * narrow) * (1.0 + y);
        let exact_peak = 1.5 * ((0.7 / narrow).atan() + (0.3 / narrow).atan());
        let bend = |x: f64, y: f64| (x + 0.5 * y - 0.7).max(0.0);
        // int over y of (0.3 + y/2)^2 / 2, all of which lies inside.
        let exact_bend = (0.8_f64.powi(3) - 0.3_f64.powi(3)) / 3.0;
        let found = integrate_rectangles(&[UNIT], accuracy, peak);
        assert!((found.value - exact_peak).abs() <= found.error && found.error <= 1e-8, "{found:?}, not {exact_peak}");
        let found = integrate_rectangles(&[UNIT], Accuracy { absolute: 1e-6, ..accuracy }, bend);
        assert!((found.value - exact_bend).abs() <= found.error && found.error <= 1e-6, "{found:?}, not {exact_bend}");
    }

    #[test]
    fn an_integral_that_is_too_hard_ends_and_says_how_far_off_it_may_be() {
        let accuracy = Accuracy { absolute: 1e-12, evaluations: 5000 };
        let step =
            |x: f64, y: f64| if (x - 0.5).hypot(y - 0.5) < 0.4 { DVec3::new(1.0, 2.0, 0.0) } else { DVec3::ZERO };
        let found = integrate_rectangles(&[UNIT], accuracy, step);
        assert!(found.evaluations <= 5000 && found.error > 1e-12);
        assert!((found.value - DVec3::new(1.0, 2.0, 0.0) * (PI * 0.16)).size() < found.error, "{found:?}");
    }
}
