//! The environment as a blurred background.
#![expect(non_snake_case, reason = "equations keep the symbols of their papers")]

use super::Lighting;
use crate::math::blur;
use crate::math::spaces::orthonormal_basis;
use glam::{DVec2, DVec3};

impl Lighting<'_> {
    /// Radiance from about a unit direction, cd/m2, through the lobe that maps of this perceptual roughness are prefiltered
    /// with: an estimate from one direction by the lobe and one by the environment, weighted by the balance heuristic
    /// (Veach 1997). Exact for 0.
    pub fn blurred_radiance(&self, direction: DVec3, perceptual_roughness: f64, draws: [DVec2; 2]) -> DVec3 {
        if perceptual_roughness <= 0.0 {
            return self.environment_radiance(direction);
        }
        let alpha = perceptual_roughness.powi(2);
        let (tangent, bitangent) = orthonormal_basis(direction);
        let about_z = blur::sample(alpha, draws[0]);
        let by_lobe = tangent * about_z.x + bitangent * about_z.y + direction * about_z.z;
        let by_environment = self.environment_sampler.as_ref().map(|sampler| sampler.sample(draws[1]));
        let mean_cosine = blur::mean_cosine(alpha);
        let weighted = |l: DVec3| {
            let NoL = l.dot(direction);
            if NoL <= 0.0 {
                return DVec3::ZERO;
            }
            let density = blur::density(alpha, NoL);
            let other = self.environment_sampler.as_ref().map_or(0.0, |sampler| sampler.pdf(l));
            self.environment_radiance(l) * (density * NoL / mean_cosine / (density + other))
        };
        weighted(by_lobe) + by_environment.map_or(DVec3::ZERO, weighted)
    }
}
