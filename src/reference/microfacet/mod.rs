//! Named, interchangeable models of the parts of a microfacet lobe: how the facets are distributed, how they hide each
//! other, and how much each reflects. The renderer's own lobe, GGX with height-correlated Smith and Schlick, is one of
//! the combinations; docs/microfacets.md compares them.
//!
//! Directions are unit vectors in the tangent frame: +X along the tangent, +Y along the bitangent, +Z along the normal.

#![expect(non_snake_case, reason = "equations keep the symbols of their papers")]

pub mod distribution;
pub mod ellipsoid;
pub mod fresnel;
pub mod masking;
pub mod metals;
pub mod transfer;

pub use distribution::Distribution;
pub use ellipsoid::Ellipsoid;
pub use fresnel::Fresnel;
pub use masking::Geometry;
pub use metals::Metal;
pub use transfer::Transfer;

use glam::DVec3;

/// A lobe of facets that light leaves after a single reflection (Cook and Torrance 1982).
#[derive(Debug, Clone, PartialEq)]
pub struct Microfacet {
    pub distribution: Distribution,
    pub geometry: Geometry,
    pub fresnel: Fresnel,
}

impl Microfacet {
    /// f(v, l) = D V F, 1/sr; black where either direction is below the horizon.
    pub fn evaluate(&self, v: DVec3, l: DVec3) -> DVec3 {
        if v.z <= 0.0 || l.z <= 0.0 {
            return DVec3::ZERO;
        }
        let h = (v + l).normalize_or(DVec3::Z);
        let VoH = v.dot(h).clamp(0.0, 1.0);
        self.fresnel.reflectance(VoH) * (self.distribution.D(h) * self.geometry.visibility(&self.distribution, v, l))
    }
}

#[cfg(test)]
mod tests {
    use super::super::brdf::{D_GGX, F_Schlick, V_SmithGGXCorrelated};
    use super::*;

    #[test]
    fn the_default_combination_is_the_lobe_of_the_renderer() {
        let f0 = DVec3::new(0.9, 0.5, 0.04);
        let lobe = Microfacet {
            distribution: Distribution::ggx(0.3).unwrap(),
            geometry: Geometry::SmithCorrelated,
            fresnel: Fresnel::schlick(f0, 1.0).unwrap(),
        };
        let (v, l) = (DVec3::new(0.6, 0.0, 0.8), DVec3::new(-0.48, 0.64, 0.6));
        let h = (v + l).normalize();
        let expected = F_Schlick(f0, 1.0, v.dot(h)) * (D_GGX(0.3, h.z) * V_SmithGGXCorrelated(0.3, v.z, l.z));
        assert!((lobe.evaluate(v, l) - expected).length() < 1e-15);
        assert_eq!(lobe.evaluate(v, -l), DVec3::ZERO);
    }
}
