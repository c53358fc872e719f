//! The ways in which a direction of light can be drawn for one surface and view.

use super::disney::bsdf::{pdf_clearcoat_reflection, sample_clearcoat_normal};
use super::environment::EnvironmentSampler;
use super::sampling::{
    pdf_cosine_hemisphere, pdf_visible_normal_reflection, sample_cosine_hemisphere, sample_visible_normal,
};
use glam::{DMat3, DVec2, DVec3};

/// Share of the draws for visible normals that goes to a clearcoat, if there is one.
const CLEARCOAT_SHARE: f64 = 0.3;

/// One random pair for each technique: visible normals, cosine, environment.
pub type Draws = [DVec2; 3];

/// The facets of a BSDF that light is mirrored at.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Facets {
    /// Columns: tangent, bitangent, normal. Which hand they make does not matter.
    pub world_from_tangent: DMat3,
    /// GGX alphas along tangent and bitangent.
    pub alpha: DVec2,
    /// Alpha of a clearcoat's GTR1 facets, where there is one.
    pub clearcoat_alpha: Option<f64>,
}

/// Mirrored visible normals, a cosine lobe, and the environment's own density.
pub(super) struct Techniques<'a> {
    facets: Facets,
    /// In the tangent frame, above the horizon.
    view: DVec3,
    environment: Option<&'a EnvironmentSampler>,
}

impl<'a> Techniques<'a> {
    /// `view` is above the horizon of the facets' normal.
    pub(super) fn new(facets: Facets, view: DVec3, environment: Option<&'a EnvironmentSampler>) -> Self {
        Self { facets, view: facets.world_from_tangent.transpose() * view, environment }
    }

    /// One direction in world space of each technique.
    pub(super) fn sample(&self, draws: &Draws) -> [Option<DVec3>; 3] {
        [
            Some(self.sample_mirrored(draws[0])),
            Some(self.sample_cosine(draws[1])),
            self.environment.map(|environment| environment.sample(draws[2])),
        ]
    }

    fn sample_mirrored(&self, u: DVec2) -> DVec3 {
        let h = self.sample_facet(u);
        self.facets.world_from_tangent * (2.0 * self.view.dot(h) * h - self.view)
    }

    fn sample_cosine(&self, u: DVec2) -> DVec3 {
        self.facets.world_from_tangent * sample_cosine_hemisphere(u)
    }

    /// A facet of the specular lobe, or of the clearcoat.
    fn sample_facet(&self, u: DVec2) -> DVec3 {
        let visible = |u| sample_visible_normal(self.facets.alpha, self.view, u);
        match self.facets.clearcoat_alpha {
            None => visible(u),
            Some(alpha) if u.x < CLEARCOAT_SHARE => {
                sample_clearcoat_normal(alpha, DVec2::new(u.x / CLEARCOAT_SHARE, u.y))
            }
            Some(_) => visible(DVec2::new((u.x - CLEARCOAT_SHARE) / (1.0 - CLEARCOAT_SHARE), u.y)),
        }
    }

    /// Density of directions mirrored at [`Self::sample_facet`], 1/sr.
    fn pdf_mirrored(&self, light: DVec3) -> f64 {
        let visible = pdf_visible_normal_reflection(self.facets.alpha, self.view, light);
        let Some(alpha) = self.facets.clearcoat_alpha else { return visible };
        let clearcoat = pdf_clearcoat_reflection(alpha, self.view, light);
        visible + (clearcoat - visible) * CLEARCOAT_SHARE
    }

    /// Sum of the densities of the two techniques that know the surface, at a direction above the horizon, 1/sr.
    fn pdf_surface(&self, light_in_world: DVec3) -> f64 {
        let light = self.facets.world_from_tangent.transpose() * light_in_world;
        self.pdf_mirrored(light) + pdf_cosine_hemisphere(light.z)
    }

    /// One direction in world space by either of the techniques that know the surface, and its density, 1/sr.
    pub(super) fn sample_surface(&self, u: DVec2) -> (DVec3, f64) {
        let halves = DVec2::new((2.0 * u.x).fract(), u.y);
        let light = if u.x < 0.5 { self.sample_mirrored(halves) } else { self.sample_cosine(halves) };
        (light, 0.5 * self.pdf_surface(light))
    }

    /// Sum of the techniques' densities at a direction above the horizon, 1/sr.
    pub(super) fn pdf_sum(&self, light_in_world: DVec3) -> f64 {
        self.pdf_surface(light_in_world) + self.environment.map_or(0.0, |environment| environment.pdf(light_in_world))
    }
}
