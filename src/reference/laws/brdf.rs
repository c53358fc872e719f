//! What the laws are checked on.

use crate::reference::albedo::DirectionalAlbedo;
use crate::reference::brdf::alpha_from_perceptual_roughness;
use crate::reference::bsdf::{Bsdf, SurfaceMaterial};
use crate::reference::microfacet::{Distribution, Microfacet};
use glam::DVec3;

/// Where half vectors crowd: what quadrature and sample pairs need to know beforehand.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lobe {
    /// Unit vector around which f is highest as a function of the half vector.
    pub axis: DVec3,
    /// Width of the narrowest feature around it: tan of an angle, above 0.
    pub alpha: f64,
    /// How many times wider the lobe is across, from 1 up.
    pub aspect: f64,
}

impl Lobe {
    /// A round lobe around the normal.
    pub fn round(alpha: f64) -> Self {
        Self { axis: DVec3::Z, alpha, aspect: 1.0 }
    }

    /// The lobe of half vectors that a distribution of facets makes.
    pub fn of(distribution: &Distribution) -> Self {
        let (alpha_x, alpha_y) = distribution.alphas();
        let alpha = alpha_x.min(alpha_y);
        Self { axis: distribution.predominant_normal(), alpha, aspect: alpha_x.max(alpha_y) / alpha }
    }
}

/// A reflecting surface. Directions are unit vectors in the tangent frame, +Z along the normal, and point away from the
/// surface.
pub trait Brdf: Sync {
    /// f(v, l), 1/sr; black where a direction is below the horizon.
    fn evaluate(&self, v: DVec3, l: DVec3) -> DVec3;

    /// `evaluate` for many directions of light and one of view; to override where what depends on the view is worth
    /// working out once.
    fn seen_from(&self, v: DVec3) -> Box<dyn Fn(DVec3) -> DVec3 + '_> {
        Box::new(move |l| self.evaluate(v, l))
    }

    /// The narrowest specular lobe; round, with alpha 1, for a surface without any.
    fn lobe(&self) -> Lobe;

    /// Whether turning light and view together about the normal changes nothing.
    fn is_isotropic(&self) -> bool;
}

/// The material of docs/model.md.
#[derive(Debug)]
pub struct StandardBrdf<'a> {
    pub table: &'a DirectionalAlbedo,
    pub material: SurfaceMaterial,
    pub energy_compensation: bool,
}

impl Brdf for StandardBrdf<'_> {
    fn evaluate(&self, v: DVec3, l: DVec3) -> DVec3 {
        if v.z <= 0.0 {
            return DVec3::ZERO;
        }
        Bsdf::new(self.table, self.material, DVec3::Z, v, self.energy_compensation).evaluate(l)
    }

    fn seen_from(&self, v: DVec3) -> Box<dyn Fn(DVec3) -> DVec3 + '_> {
        if v.z <= 0.0 {
            return Box::new(|_| DVec3::ZERO);
        }
        let bsdf = Bsdf::new(self.table, self.material, DVec3::Z, v, self.energy_compensation);
        Box::new(move |l| bsdf.evaluate(l))
    }

    fn lobe(&self) -> Lobe {
        Lobe::round(alpha_from_perceptual_roughness(self.material.perceptual_roughness))
    }

    fn is_isotropic(&self) -> bool {
        true
    }
}

impl Brdf for Microfacet {
    fn evaluate(&self, v: DVec3, l: DVec3) -> DVec3 {
        Microfacet::evaluate(self, v, l)
    }

    fn lobe(&self) -> Lobe {
        Lobe::of(&self.distribution)
    }

    fn is_isotropic(&self) -> bool {
        self.distribution.is_isotropic()
    }
}
