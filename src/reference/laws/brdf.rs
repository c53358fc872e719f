//! What the laws are checked on.

use crate::reference::albedo::DirectionalAlbedo;
use crate::reference::bsdf::{Bsdf, ModelChoices, SurfaceMaterial};
use crate::reference::disney::bsdf::{DisneyBsdf, DisneyMaterial, TangentFrame};
use crate::reference::disney::{alpha_of_clearcoat, alphas};
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

impl StandardBrdf<'_> {
    fn choices(&self) -> ModelChoices {
        ModelChoices { energy_compensation: self.energy_compensation, ..Default::default() }
    }
}

impl Brdf for StandardBrdf<'_> {
    fn evaluate(&self, v: DVec3, l: DVec3) -> DVec3 {
        if v.z <= 0.0 {
            return DVec3::ZERO;
        }
        Bsdf::new(self.table, self.material, DVec3::Z, v, self.choices()).evaluate(l)
    }

    fn seen_from(&self, v: DVec3) -> Box<dyn Fn(DVec3) -> DVec3 + '_> {
        if v.z <= 0.0 {
            return Box::new(|_| DVec3::ZERO);
        }
        let bsdf = Bsdf::new(self.table, self.material, DVec3::Z, v, self.choices());
        Box::new(move |l| bsdf.evaluate(l))
    }

    fn lobe(&self) -> Lobe {
        Lobe::of(&self.material.distribution())
    }

    fn is_isotropic(&self) -> bool {
        self.material.anisotropy.is_none()
    }
}

/// The Disney BRDF.
#[derive(Debug)]
pub struct DisneyBrdf {
    pub material: DisneyMaterial,
}

impl Brdf for DisneyBrdf {
    fn evaluate(&self, v: DVec3, l: DVec3) -> DVec3 {
        if v.z <= 0.0 || l.z <= 0.0 {
            return DVec3::ZERO;
        }
        DisneyBsdf::new(&self.material, TangentFrame::LOCAL, v).evaluate(l)
    }

    /// The clearcoat, where there is one, is mostly narrower than the base.
    fn lobe(&self) -> Lobe {
        let parameters = &self.material.parameters;
        let (alpha_x, alpha_y) = alphas(self.material.perceptual_roughness, parameters.anisotropic.into());
        let coat = alpha_of_clearcoat(parameters.clearcoat_gloss.into());
        if parameters.clearcoat > 0.0 && coat < alpha_y {
            return Lobe::round(coat);
        }
        Lobe::of(&Distribution::GgxAnisotropic { alpha_x, alpha_y, rotation_rad: 0.0 })
    }

    fn is_isotropic(&self) -> bool {
        self.material.parameters.anisotropic == 0.0
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
