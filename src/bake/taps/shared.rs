//! What both lobes, of F0 = 1 and 0.04, share of a texel, and what each has for itself.

use super::lobe::{PLACE_MAX, Tap};
use crate::scene::EnvironmentMaps;

/// Place, level and spread.
pub(super) const TAP_VARIABLES: usize = 3;
/// The widest level of the specular maps.
const LAST_LEVEL: f64 = (EnvironmentMaps::LEVELS - 1) as f64;

/// Taps with their shares of the lobes for F0 = 1 and 0.04. Irradiance has the rest, and of its parts of degree 1 and 2
/// as much more as `parts` says.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Shared {
    pub(super) taps: Vec<Tap>,
    pub(super) shares: [Vec<f64>; 2],
    pub(super) parts: [f64; 2],
}

impl Shared {
    /// Variables of `count` taps: their own, shares for both lobes, and parts.
    pub(super) fn from_variables(variables: &[f64]) -> Self {
        let count = (variables.len() - 2) / (TAP_VARIABLES + 2);
        let (taps, weights) = variables.split_at(TAP_VARIABLES * count);
        Self {
            taps: taps
                .chunks_exact(TAP_VARIABLES)
                .map(|tap| Tap { place: tap[0], level: tap[1], spread: tap[2] })
                .collect(),
            shares: [weights[..count].to_vec(), weights[count..2 * count].to_vec()],
            parts: [weights[2 * count], weights[2 * count + 1]],
        }
    }

    /// For both lobes, weights of the taps and of the two parts.
    pub(super) fn weights(&self) -> [Vec<f64>; 2] {
        self.shares.each_ref().map(|shares| shares.iter().chain(&self.parts).copied().collect())
    }

    /// Shares that are not negative, nor is what they leave.
    pub(super) fn with_bounded_shares(mut self) -> Self {
        for shares in &mut self.shares {
            shares.iter_mut().for_each(|share| *share = share.max(0.0));
            let sum = shares.iter().sum::<f64>().max(1.0);
            shares.iter_mut().for_each(|share| *share /= sum);
        }
        self
    }
}

/// As [`Shared::from_variables`] takes them.
pub(super) fn variables_of(shared: &Shared) -> Vec<f64> {
    let taps = shared.taps.iter().flat_map(|tap| [tap.place, tap.level, tap.spread]);
    taps.chain(shared.shares.iter().flatten().copied()).chain(shared.parts).collect()
}

impl Tap {
    /// The nearest tap that the table can hold, no wider than `widest`.
    pub(super) fn bounded(self, widest: f64) -> Self {
        Self {
            place: self.place.clamp(-PLACE_MAX, PLACE_MAX),
            level: self.level.clamp(1.0, widest.min(LAST_LEVEL)),
            spread: self.spread.clamp(-PLACE_MAX, PLACE_MAX),
        }
    }

    pub(super) fn distance2(self, other: Self) -> f64 {
        (self.place - other.place).powi(2) + (self.level - other.level).powi(2) + (self.spread - other.spread).powi(2)
    }
}
