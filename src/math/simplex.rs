//! Minima of functions of a few variables, without derivatives.

/// Where the search ended, and the value there.
#[derive(Debug, Clone, PartialEq)]
pub struct Minimum {
    pub at: Vec<f64>,
    pub value: f64,
}

/// The simplex search of Nelder and Mead 1965, with their coefficients.
///
/// The first simplex is `start` and, for each variable, `start` moved by `step`. Ends after `evaluations` of `function`,
/// or when the values at the corners are within `tolerance` of each other. Deterministic.
pub fn minimize(
    function: impl Fn(&[f64]) -> f64,
    start: &[f64],
    step: f64,
    evaluations: usize,
    tolerance: f64,
) -> Minimum {
    let corner = |at: Vec<f64>| {
        let value = function(&at);
        Minimum { at, value }
    };
    let moved = |axis: usize| {
        let mut at = start.to_vec();
        at[axis] += step;
        corner(at)
    };
    let mut simplex: Vec<Minimum> =
        std::iter::once(corner(start.to_vec())).chain((0..start.len()).map(moved)).collect();
    let mut spent = simplex.len();
    loop {
        simplex.sort_by(|a, b| a.value.total_cmp(&b.value));
        let last = simplex.len() - 1;
        if spent >= evaluations || simplex[last].value - simplex[0].value <= tolerance {
            return simplex.swap_remove(0);
        }
        let center = mean(&simplex[..last]);
        // The worst corner, through the centre of the others to `reach` times its distance beyond.
        let thrown = |reach: f64| {
            let worst = &simplex[last].at;
            corner(center.iter().zip(worst).map(|(center, worst)| center + reach * (center - worst)).collect())
        };
        let reflected = thrown(1.0);
        spent += 1;
        let better = if reflected.value < simplex[0].value {
            let expanded = thrown(2.0);
            spent += 1;
            Some(if expanded.value < reflected.value { expanded } else { reflected })
        } else if reflected.value < simplex[last - 1].value {
            Some(reflected)
        } else {
            let contracted = thrown(if reflected.value < simplex[last].value { 0.5 } else { -0.5 });
            spent += 1;
            (contracted.value < reflected.value.min(simplex[last].value)).then_some(contracted)
        };
        match better {
            Some(better) => simplex[last] = better,
            None => {
                let best = simplex[0].at.clone();
                for shrunk in &mut simplex[1..] {
                    *shrunk = corner(best.iter().zip(&shrunk.at).map(|(best, at)| 0.5 * (best + at)).collect());
                }
                spent += last;
            }
        }
    }
}

fn mean(corners: &[Minimum]) -> Vec<f64> {
    let variables = corners[0].at.len();
    let sum = |axis: usize| corners.iter().map(|corner| corner.at[axis]).sum::<f64>();
    (0..variables).map(|axis| sum(axis) / corners.len() as f64).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_valley_of_rosenbrock_is_followed_to_its_end() {
        let valley = |p: &[f64]| (1.0 - p[0]).powi(2) + 100.0 * (p[1] - p[0] * p[0]).powi(2);
        let found = minimize(valley, &[-1.2, 1.0], 0.5, 500, 1e-16);
        assert!((found.at[0] - 1.0).abs() < 1e-6 && (found.at[1] - 1.0).abs() < 1e-6, "{found:?}");
    }

    #[test]
    fn it_ends_where_it_is_told_to() {
        let count = std::cell::Cell::new(0);
        let counted = |p: &[f64]| {
            count.set(count.get() + 1);
            p.iter().map(|x| x * x).sum()
        };
        minimize(counted, &[3.0, 2.0, 1.0], 0.5, 40, 0.0);
        assert!((40..50).contains(&count.get()), "{count:?}");
    }
}
