//! A table of taps while it is sought, of any number of rows and columns.

use super::lobe::PLACE_MAX;
use super::shared::{Shared, TAP_VARIABLES, variables_of};
use super::{FITTED_ROWS, LAST_LEVEL, level_of_row};

/// Variables of all nodes, row by row; levels of taps are relative to those of the rows.
pub(super) struct Grid {
    rows: usize,
    columns: usize,
    size: usize,
    variables: Vec<f64>,
}

impl Grid {
    /// The same everywhere.
    pub(super) fn uniform(node: &[f64]) -> Self {
        Self { rows: 2, columns: 2, size: node.len(), variables: node.repeat(4) }
    }

    pub(super) fn with(&self, variables: &[f64]) -> Self {
        Self { variables: variables.to_vec(), ..*self }
    }

    /// The same, linear between its nodes, by others.
    pub(super) fn resampled(&self, rows: usize, columns: usize) -> Self {
        let node = |i: usize| {
            let place = [(i / columns) as f64 / (rows - 1) as f64, (i % columns) as f64 / (columns - 1) as f64];
            let corners = self.corners(place);
            (0..self.size)
                .map(move |k| corners.iter().map(|(node, share)| share * self.variables[node * self.size + k]).sum())
        };
        Self { rows, columns, size: self.size, variables: (0..rows * columns).flat_map(node).collect() }
    }

    /// The same with one tap as two, half a unit of place apart, that share what it had.
    pub(super) fn split(&self, tap: usize) -> Self {
        let node = |node: &[f64]| {
            let mut shared = Shared::from_variables(node);
            let mut other = shared.taps[tap];
            shared.taps[tap].place -= 0.25;
            other.place += 0.25;
            shared.taps.push(other);
            for shares in &mut shared.shares {
                shares[tap] *= 0.5;
                shares.push(shares[tap]);
            }
            variables_of(&shared)
        };
        let variables: Vec<f64> = self.variables.chunks_exact(self.size).flat_map(node).collect();
        Self { size: variables.len() / self.len(), variables, ..*self }
    }

    /// The variables of a node.
    pub(super) fn at(&self, node: usize) -> &[f64] {
        &self.variables[node * self.size..][..self.size]
    }

    /// What the table holds between four nodes.
    pub(super) fn mean(&self, corners: [(usize, f64); 4]) -> Shared {
        let mut values = vec![0.0; self.size];
        for (node, share) in corners.into_iter().filter(|(_, share)| *share > 0.0) {
            values.iter_mut().zip(self.held(node)).for_each(|(value, held)| *value += share * held);
        }
        Shared::from_variables(&values)
    }

    pub(super) fn variables(&self) -> &[f64] {
        &self.variables
    }

    /// Nodes.
    pub(super) fn len(&self) -> usize {
        self.rows * self.columns
    }

    /// Variables of a node.
    pub(super) fn size(&self) -> usize {
        self.size
    }

    /// The four nodes around a place in [0, 1]^2, down and to the right, with their shares of it.
    pub(super) fn corners(&self, place: [f64; 2]) -> [(usize, f64); 4] {
        let split = |place: f64, nodes: usize| {
            let at = place * (nodes - 1) as f64;
            let first = (at as usize).min(nodes - 2);
            (first, at - first as f64)
        };
        let ((row, down), (column, right)) = (split(place[0], self.rows), split(place[1], self.columns));
        let first = row * self.columns + column;
        [
            (first, (1.0 - down) * (1.0 - right)),
            (first + 1, (1.0 - down) * right),
            (first + self.columns, down * (1.0 - right)),
            (first + self.columns + 1, down * right),
        ]
    }

    fn level(&self, node: usize) -> f64 {
        let (first, last) = (level_of_row(FITTED_ROWS.start as f64), level_of_row((FITTED_ROWS.end - 1) as f64));
        first + (last - first) * (node / self.columns) as f64 / (self.rows - 1) as f64
    }

    pub(super) fn taps(&self) -> usize {
        (self.size - 2) / (TAP_VARIABLES + 2)
    }

    /// Variables of a node within what the table can hold. Taps of level 1 are next to the mirror image and keep off it.
    pub(super) fn bounded(&self, node: usize, variables: &[f64]) -> Vec<f64> {
        let level = self.level(node);
        let widest = if level > 1.0 { LAST_LEVEL } else { 1.0 };
        let mut bounded = variables.to_vec();
        for tap in bounded.chunks_exact_mut(TAP_VARIABLES).take(self.taps()) {
            tap[0] = tap[0].clamp(-PLACE_MAX, PLACE_MAX);
            tap[1] = tap[1].clamp(1.0 - level, widest - level);
            tap[2] = tap[2].clamp(-PLACE_MAX, PLACE_MAX);
        }
        bounded
    }

    fn absolute(&self, node: usize, mut variables: Vec<f64>) -> Vec<f64> {
        let level = self.level(node);
        variables.chunks_exact_mut(TAP_VARIABLES).take(self.taps()).for_each(|tap| tap[1] += level);
        variables
    }

    /// What the table holds at a node.
    pub(super) fn held(&self, node: usize) -> Vec<f64> {
        self.absolute(node, self.bounded(node, self.at(node)))
    }

    /// What broken bounds of a node cost, and how that grows with each of its variables.
    fn beyond_cost(&self, node: usize, variables: &[f64], outside: f64) -> (f64, Vec<f64>) {
        let beyond = self.beyond(node, variables);
        let value = outside * beyond.iter().map(|x| x * x).sum::<f64>();
        (value, beyond.iter().map(|beyond| 2.0 * outside * beyond).collect())
    }

    /// What differences of neighbours and broken bounds cost, and how that grows with each variable.
    pub(super) fn penalties(&self, smoothness: f64, outside: f64) -> (f64, Vec<f64>) {
        let (mut value, mut gradient) = (0.0, vec![0.0; self.variables.len()]);
        let mut pull = |a: usize, b: usize| {
            for k in 0..self.size {
                let (a, b) = (a * self.size + k, b * self.size + k);
                let difference = self.variables[a] - self.variables[b];
                value += smoothness * difference * difference;
                gradient[a] += 2.0 * smoothness * difference;
                gradient[b] -= 2.0 * smoothness * difference;
            }
        };
        for node in 0..self.len() {
            if (node + 1) % self.columns > 0 {
                pull(node, node + 1);
            }
            if node + self.columns < self.len() {
                pull(node, node + self.columns);
            }
        }
        for node in 0..self.len() {
            let (cost, by) = self.beyond_cost(node, self.at(node), outside);
            value += cost;
            gradient[node * self.size..][..self.size].iter_mut().zip(by).for_each(|(into, by)| *into += by);
        }
        (value, gradient)
    }

    /// By how much each variable of a node breaks its bound; each share of a lobe by as much as all are above 1.
    fn beyond(&self, node: usize, variables: &[f64]) -> Vec<f64> {
        let mut beyond: Vec<f64> =
            variables.iter().zip(self.bounded(node, variables)).map(|(free, bounded)| free - bounded).collect();
        let count = self.taps();
        for lobe in 0..2 {
            let shares = (TAP_VARIABLES + lobe) * count..(TAP_VARIABLES + lobe + 1) * count;
            let above = (variables[shares.clone()].iter().sum::<f64>() - 1.0).max(0.0);
            for k in shares {
                beyond[k] = variables[k].min(0.0) + above;
            }
        }
        beyond
    }
}
