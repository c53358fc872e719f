//! Minima of smooth functions of many variables, by their gradients.

use std::collections::VecDeque;

/// Pairs of steps and changes of the gradient that stand for the second derivatives.
const MEMORY: usize = 12;
/// What of the expected decrease a step has to bring (Armijo 1966).
const SUFFICIENT: f64 = 1e-4;
/// Halvings of a step before the search gives up.
const HALVINGS: usize = 30;

/// The search L-BFGS of Liu and Nocedal 1989 with halved steps, from `start`.
///
/// `function` returns its value and gradient; the first step is `first_step` long. Ends after `steps` of them, or when none
/// goes further down. Deterministic.
pub fn descend(
    function: impl Fn(&[f64]) -> (f64, Vec<f64>),
    start: Vec<f64>,
    first_step: f64,
    steps: usize,
) -> Vec<f64> {
    let mut at = start;
    let (mut value, mut gradient) = function(&at);
    let mut memory: VecDeque<Pair> = VecDeque::new();
    for _ in 0..steps {
        let mut direction = newton_step(&memory, &gradient, first_step);
        let mut slope = dot(&direction, &gradient);
        if slope >= 0.0 {
            memory.clear();
            direction = newton_step(&memory, &gradient, first_step);
            slope = dot(&direction, &gradient);
        }
        let reached = |halvings: usize| {
            let length = 0.5_f64.powi(halvings as i32);
            let to: Vec<f64> = at.iter().zip(&direction).map(|(x, step)| x + length * step).collect();
            let (to_value, to_gradient) = function(&to);
            (to_value <= value + SUFFICIENT * length * slope).then_some((to, to_value, to_gradient))
        };
        let Some((to, to_value, to_gradient)) = (0..HALVINGS).find_map(reached) else { break };
        memory.extend(Pair::new(difference(&to, &at), difference(&to_gradient, &gradient)));
        if memory.len() > MEMORY {
            memory.pop_front();
        }
        (at, value, gradient) = (to, to_value, to_gradient);
    }
    at
}

/// A step and how the gradient changed by it.
struct Pair {
    step: Vec<f64>,
    change: Vec<f64>,
    curvature: f64,
}

impl Pair {
    /// `None` where the function curves down, which no minimum does.
    fn new(step: Vec<f64>, change: Vec<f64>) -> Option<Self> {
        let curvature = dot(&step, &change);
        (curvature > 1e-14 * dot(&change, &change)).then_some(Self { step, change, curvature })
    }
}

/// The recursion of two loops: minus the inverse of the second derivatives times the gradient.
fn newton_step(memory: &VecDeque<Pair>, gradient: &[f64], first_step: f64) -> Vec<f64> {
    let mut direction: Vec<f64> = gradient.iter().map(|x| -x).collect();
    let mut shares = Vec::with_capacity(memory.len());
    for pair in memory.iter().rev() {
        let share = dot(&pair.step, &direction) / pair.curvature;
        add(&mut direction, -share, &pair.change);
        shares.push(share);
    }
    let scale = memory.back().map_or_else(
        || first_step / dot(gradient, gradient).sqrt().max(f64::MIN_POSITIVE),
        |pair| pair.curvature / dot(&pair.change, &pair.change),
    );
    direction.iter_mut().for_each(|x| *x *= scale);
    for (pair, share) in memory.iter().zip(shares.into_iter().rev()) {
        let share = share - dot(&pair.change, &direction) / pair.curvature;
        add(&mut direction, share, &pair.step);
    }
    direction
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn difference(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a - b).collect()
}

fn add(to: &mut [f64], factor: f64, what: &[f64]) {
    to.iter_mut().zip(what).for_each(|(to, what)| *to += factor * what);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_valley_of_rosenbrock_is_followed_to_its_end() {
        // Fifty valleys beside one another.
        let valley = |p: &[f64]| {
            let mut gradient = vec![0.0; p.len()];
            let mut value = 0.0;
            for i in (0..p.len()).step_by(2) {
                let (a, b) = (1.0 - p[i], p[i + 1] - p[i] * p[i]);
                value += a * a + 100.0 * b * b;
                gradient[i] = -2.0 * a - 400.0 * p[i] * b;
                gradient[i + 1] = 200.0 * b;
            }
            (value, gradient)
        };
        let found = descend(valley, [-1.2, 1.0].repeat(50), 0.1, 200);
        assert!(found.iter().all(|x| (x - 1.0).abs() < 1e-6), "{found:?}");
    }

    #[test]
    fn a_bowl_of_unlike_axes_ends_at_its_middle() {
        let scales: Vec<f64> = (0..20).map(|i| 1.5_f64.powi(i)).collect();
        let bowl = |p: &[f64]| {
            let value = p.iter().zip(&scales).map(|(x, s)| 0.5 * s * x * x).sum();
            (value, p.iter().zip(&scales).map(|(x, s)| s * x).collect())
        };
        let found = descend(bowl, vec![1.0; 20], 0.1, 300);
        assert!(found.iter().all(|x| x.abs() < 1e-6), "{found:?}");
    }
}
