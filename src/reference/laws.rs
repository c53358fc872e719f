//! The laws that a BRDF must obey, checked by evaluating it: it is the same with light and view exchanged, nowhere
//! negative, and reflects no more light than arrives, from any direction.

mod albedo;
mod brdf;
mod facets;
mod hemisphere;
mod pairs;

pub use albedo::{AlbedoReport, AlbedoSample, check_albedo, directional_albedo};
pub use brdf::{Brdf, DisneyBrdf, Lobe, StandardBrdf};
pub use facets::{FacetReport, check_facets};
pub use pairs::{PairReport, check_pairs};

use super::microfacet::Distribution;
use crate::math::quadrature::adaptive::Accuracy;

/// How exactly the laws' integrals are evaluated when nothing else is asked for. The table of directional albedo that
/// the standard material reads is good to 3e-4, so that finer would measure its interpolation.
pub const ACCURACY: Accuracy = Accuracy { absolute: 2e-5, evaluations: 60_000 };

/// What the order of float64 operations may change of f, relative.
const ROUNDING: f64 = 1e-9;

/// What was found for one BRDF.
#[derive(Debug, Clone, PartialEq)]
pub struct LawReport {
    pub pairs: PairReport,
    pub albedo: AlbedoReport,
    /// `None` for a BRDF that is not made of facets.
    pub facets: Option<FacetReport>,
}

/// A law, and by how much it is broken.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Violation {
    /// Relative difference between f(v, l) and f(l, v).
    Reciprocity(f64),
    /// The smallest value of f found, 1/sr, or NaN.
    Positivity(f64),
    /// The largest directional albedo, less its error.
    Energy(f64),
    /// Difference of projected areas, relative to the macroscopic area.
    Facets(f64),
}

impl LawReport {
    /// Checks `brdf`, and the distribution it is made of, if any.
    pub fn new(brdf: &dyn Brdf, distribution: Option<&Distribution>, accuracy: Accuracy) -> Self {
        Self {
            pairs: check_pairs(brdf),
            albedo: check_albedo(brdf, accuracy),
            facets: distribution.map(|distribution| check_facets(distribution, accuracy)),
        }
    }

    /// The laws that are broken by more than `tolerance`: a relative difference of f for reciprocity, a share of the
    /// light that arrives for energy, of the macroscopic area for facets. No f below 0 is tolerated.
    pub fn violations(&self, tolerance: f64) -> Vec<Violation> {
        let mut violations = Vec::new();
        if exceeds(self.pairs.relative_difference, tolerance.max(ROUNDING)) {
            violations.push(Violation::Reciprocity(self.pairs.relative_difference));
        }
        if exceeds(-self.pairs.smallest, 0.0) {
            violations.push(Violation::Positivity(self.pairs.smallest));
        }
        // What the quadrature cannot tell apart from 1 breaks nothing.
        let largest = self.albedo.largest.albedo.value.max_element() - self.albedo.largest.albedo.error;
        if exceeds(largest, 1.0 + tolerance) {
            violations.push(Violation::Energy(largest));
        }
        if let Some(facets) = &self.facets
            && exceeds(facets.difference - facets.error, tolerance)
        {
            violations.push(Violation::Facets(facets.difference));
        }
        violations
    }
}

/// Whether `value` is above `limit`, or no number: of several, NaN is the worst.
fn exceeds(value: f64, limit: f64) -> bool {
    value > limit || value.is_nan()
}

#[cfg(test)]
mod tests;
