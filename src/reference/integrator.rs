//! Light that a surface sends to the eye: the sum over lights, and the environment by multiple importance sampling.

#![expect(non_snake_case, reason = "equations keep the symbols of their papers")]

use super::albedo::DirectionalAlbedo;
use super::bsdf::{Bsdf, SMALLEST_NOV};
use super::environment::EnvironmentSampler;
use super::lights;
use super::sampling::{
    pdf_cosine_hemisphere, pdf_visible_normal_reflection, sample_cosine_hemisphere, sample_visible_normal,
};
use super::surface::Surface;
use crate::math::spaces::orthonormal_basis;
use crate::scene::{Environment, LightInWorld, Scene};
use glam::{DMat3, DVec2, DVec3};

/// One random pair for each technique: visible normals, cosine, environment.
pub type Draws = [DVec2; 3];

/// All that lights a scene.
#[derive(Debug)]
pub struct Lighting<'a> {
    lights: Vec<LightInWorld>,
    environment: Option<&'a Environment>,
    environment_sampler: Option<EnvironmentSampler>,
    albedo: DirectionalAlbedo,
    energy_compensation: bool,
}

impl<'a> Lighting<'a> {
    pub fn new(scene: &'a Scene, energy_compensation: bool) -> Self {
        let environment = scene.environment.as_ref();
        Self {
            lights: scene.lights_in_world(),
            environment,
            environment_sampler: environment.and_then(EnvironmentSampler::new),
            albedo: DirectionalAlbedo::default(),
            energy_compensation,
        }
    }

    /// Radiance that arrives from the environment, cd/m2; black without one.
    pub fn environment_radiance(&self, direction_in_world: DVec3) -> DVec3 {
        self.environment.map_or(DVec3::ZERO, |environment| environment.radiance(direction_in_world))
    }

    /// Radiance that leaves `surface` along the unit direction `view`, cd/m2: emission and punctual lights exactly, the
    /// environment estimated with one sample of each technique. No shadows and no interreflection (docs/model.md).
    pub fn radiance(&self, surface: &Surface, view: DVec3, draws: &Draws) -> DVec3 {
        if surface.unlit {
            return surface.material.base_color;
        }
        let bsdf = Bsdf::new(&self.albedo, surface.material, surface.normal_in_world, view, self.energy_compensation);
        surface.emissive_nits
            + self.from_lights(surface, &bsdf)
            + self.from_environment(surface.normal_in_world, view, &bsdf, draws) * surface.occlusion
    }

    fn from_lights(&self, surface: &Surface, bsdf: &Bsdf) -> DVec3 {
        let from_light = |light| {
            let incidence = lights::incidence(light, surface.position_in_world)?;
            let NoL = surface.normal_in_world.dot(incidence.direction_in_world);
            Some(bsdf.evaluate(incidence.direction_in_world) * incidence.illuminance_lux * NoL.max(0.0))
        };
        self.lights.iter().filter_map(from_light).sum()
    }

    /// int f L cos by multiple importance sampling with the balance heuristic (Veach 1997, section 9.2).
    fn from_environment(&self, normal: DVec3, view: DVec3, bsdf: &Bsdf, draws: &Draws) -> DVec3 {
        let Some(environment) = self.environment else { return DVec3::ZERO };
        let techniques = Techniques::new(normal, view, bsdf.alpha(), self.environment_sampler.as_ref());
        let estimate = |light: DVec3| {
            let NoL = normal.dot(light);
            if NoL <= 0.0 {
                return DVec3::ZERO;
            }
            bsdf.evaluate(light) * environment.radiance(light) * (NoL / techniques.pdf_sum(light))
        };
        techniques.sample(draws).into_iter().flatten().map(estimate).sum()
    }
}

/// The ways in which a direction of light can be drawn for one surface and view.
struct Techniques<'a> {
    world_from_local: DMat3,
    local_from_world: DMat3,
    /// The view in the local frame, lifted above the horizon if need be: sampling may use any view that sees the surface.
    view: DVec3,
    alpha: f64,
    environment: Option<&'a EnvironmentSampler>,
}

impl<'a> Techniques<'a> {
    fn new(normal: DVec3, view: DVec3, alpha: f64, environment: Option<&'a EnvironmentSampler>) -> Self {
        let (b1, b2) = orthonormal_basis(normal);
        let world_from_local = DMat3::from_cols(b1, b2, normal);
        let local_from_world = world_from_local.transpose();
        let mut view = local_from_world * view;
        view.z = view.z.max(SMALLEST_NOV);
        Self { world_from_local, local_from_world, view: view.normalize(), alpha, environment }
    }

    /// One direction in world space of each technique.
    fn sample(&self, draws: &Draws) -> [Option<DVec3>; 3] {
        let h = sample_visible_normal(self.alpha, self.view, draws[0]);
        let mirrored = 2.0 * self.view.dot(h) * h - self.view;
        [
            Some(self.world_from_local * mirrored),
            Some(self.world_from_local * sample_cosine_hemisphere(draws[1])),
            self.environment.map(|environment| environment.sample(draws[2])),
        ]
    }

    /// Sum of the techniques' densities at a direction above the horizon, 1/sr.
    fn pdf_sum(&self, light_in_world: DVec3) -> f64 {
        let light = self.local_from_world * light_in_world;
        pdf_visible_normal_reflection(self.alpha, self.view, light)
            + pdf_cosine_hemisphere(light.z)
            + self.environment.map_or(0.0, |environment| environment.pdf(light_in_world))
    }
}
