//! Weights by least squares, some of them bounded.

/// Minimises w.S w - 2 w.p. The first `shares` weights are not negative, nor is what they leave of 1; the others are free.
/// Whichever bound is broken most is met exactly, until none is broken.
pub(super) fn best(squares: &[Vec<f64>], products: &[f64], shares: usize) -> Vec<f64> {
    let mut used: Vec<usize> = (0..products.len()).collect();
    let mut full = false;
    loop {
        let mut weights = vec![0.0; products.len()];
        let solution = solve(squares, products, &used, full.then_some(shares));
        used.iter().zip(solution).for_each(|(&i, weight)| weights[i] = weight);
        let rest = 1.0 - weights[..shares].iter().sum::<f64>();
        let least = (0..shares).min_by(|&a, &b| weights[a].total_cmp(&weights[b]));
        match least {
            Some(i) if weights[i] < 0.0 && (full || weights[i] < rest) => used.retain(|&j| j != i),
            _ if rest < 0.0 && !full => full = true,
            _ => return weights,
        }
    }
}

/// The minimum over the weights in `used`; where `full` says so, its first weights sum to 1, by Lagrange's multiplier.
fn solve(squares: &[Vec<f64>], products: &[f64], used: &[usize], full: Option<usize>) -> Vec<f64> {
    let size = used.len() + usize::from(full.is_some());
    let mut rows = vec![vec![0.0; size + 1]; size];
    for (row, &i) in rows.iter_mut().zip(used) {
        for (cell, &j) in row.iter_mut().zip(used) {
            // Two taps at one place share their weight evenly.
            *cell = squares[i][j] + if i == j { 1e-9 * squares[i][i] } else { 0.0 };
        }
        row[size] = products[i];
    }
    if let Some(shares) = full {
        for (k, _) in used.iter().enumerate().filter(|(_, i)| **i < shares) {
            rows[k][size - 1] = 1.0;
            rows[size - 1][k] = 1.0;
        }
        rows[size - 1][size] = 1.0;
    }
    eliminate(&mut rows);
    rows.iter().take(used.len()).map(|row| row[size]).collect()
}

/// Gauss and Jordan with the largest pivot of each column; the solutions stand in the last one.
fn eliminate(rows: &mut [Vec<f64>]) {
    for column in 0..rows.len() {
        let largest = (column..rows.len()).max_by(|&a, &b| rows[a][column].abs().total_cmp(&rows[b][column].abs()));
        rows.swap(column, largest.unwrap_or(column));
        let pivot = rows[column].clone();
        for (i, row) in rows.iter_mut().enumerate() {
            let factor = row[column] / pivot[column];
            for (cell, above) in row.iter_mut().zip(&pivot).skip(column) {
                *cell = if i == column { *above / pivot[column] } else { *cell - factor * above };
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn products(squares: &[Vec<f64>], mixture: [f64; 3]) -> Vec<f64> {
        squares.iter().map(|row| row.iter().zip(mixture).map(|(square, weight)| square * weight).sum()).collect()
    }

    #[test]
    fn a_target_that_is_a_mixture_is_found() {
        let squares = vec![vec![2.0, 0.5, 0.1], vec![0.5, 1.0, 0.3], vec![0.1, 0.3, 1.5]];
        let mixture = [0.2, 0.5, -0.3];
        for (got, expected) in best(&squares, &products(&squares, mixture), 2).iter().zip(mixture) {
            assert!((got - expected).abs() < 1e-8, "{got} {expected}");
        }
    }

    #[test]
    fn bounds_are_met_exactly() {
        let squares = vec![vec![1.0, 0.9], vec![0.9, 1.0]];
        let near = |got: Vec<f64>, expected: [f64; 2]| {
            assert!(got.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-8), "{got:?}");
        };
        near(best(&squares, &[0.5, 0.1], 2), [0.5, 0.0]);
        near(best(&squares, &[2.0, 2.0], 2), [0.5, 0.5]);
        near(best(&squares, &[2.0, 0.5], 2), [1.0, 0.0]);
    }
}
