//! Light that comes over several surfaces: shadows and path tracing.

#![expect(non_snake_case, reason = "equations keep the symbols of their papers")]

use super::super::bsdf::lift_view;
use super::super::geometry::{Hit, Ray};
use super::super::sampling::PixelSampler;
use super::super::surface::{Surface, World};
use super::super::techniques::Techniques;
use super::{Lighting, Model};
use glam::{DVec2, DVec3};

/// Paths from a visible surface to sources of light.
pub(in crate::reference) struct Paths<'a> {
    pub(in crate::reference) world: &'a World<'a>,
    pub(in crate::reference) lighting: &'a Lighting<'a>,
    /// The most reflections between a source and the eye.
    pub(in crate::reference) bounces: u32,
}

/// The random pairs of one path.
#[derive(Debug, Clone, Copy)]
pub(in crate::reference) struct PathDraws<'a> {
    pub(in crate::reference) sampler: &'a PixelSampler,
    pub(in crate::reference) index: u32,
    /// Which of the surfaces along the ray from the eye this is.
    pub(in crate::reference) layer: u32,
}

/// Pairs at each surface of a path: three techniques for the environment, a direction, and chances.
const DIMENSIONS_PER_SURFACE: u32 = 5;
/// Paths of another layer begin this many dimensions on, and all of them after those of unshadowed light.
const DIMENSIONS_PER_LAYER: u32 = 1 << 20;

impl PathDraws<'_> {
    fn pair(&self, reflection: u32, purpose: u32) -> DVec2 {
        let dimension =
            (self.layer + 1).wrapping_mul(DIMENSIONS_PER_LAYER).wrapping_add(reflection * DIMENSIONS_PER_SURFACE);
        self.sampler.pair(self.index, dimension + purpose)
    }
}

/// From this reflection on, paths end by chance (Russian roulette).
const ROULETTE_FROM: u32 = 3;
/// Rays start this far away, relative to their coordinates: a hundred million times the rounding of float64.
const RAY_START: f64 = 1e-8;

/// A surface on a path.
struct Vertex {
    surface: Surface,
    /// Toward the side that the path comes from.
    facet_normal: Option<DVec3>,
    /// Unit vector back along the path.
    view: DVec3,
}

impl Vertex {
    /// The ray that leaves toward `direction`; `None` where it would run into the body that the surface bounds.
    fn ray(&self, direction: DVec3, distance_m: f64) -> Option<Ray> {
        if self.facet_normal.is_some_and(|normal| normal.dot(direction) <= 0.0) {
            return None;
        }
        let origin = self.surface.position_in_world;
        let t_min = RAY_START * origin.abs().max_element().max(f64::MIN_POSITIVE);
        Some(Ray { origin, direction, t_min, t_max: distance_m - t_min })
    }
}

impl Paths<'_> {
    /// Radiance, cd/m2, that the surface at `hit` sends back along `ray`: what it and others emit, punctual lights and
    /// the environment, after at most [`Self::bounces`] reflections, of which the one at `hit` is the first.
    ///
    /// Direct light is estimated at each surface, the environment with three techniques; what other surfaces send comes
    /// along one direction of the mirrored and cosine techniques. Occlusion textures stand for shadows, and are not used.
    pub(in crate::reference) fn radiance(&self, hit: &Hit, ray: &Ray, draws: &PathDraws<'_>) -> DVec3 {
        let (mut radiance, mut throughput) = (DVec3::ZERO, DVec3::ONE);
        let mut vertex = self.vertex(hit, ray);
        for reflection in 0.. {
            let surface = &vertex.surface;
            if surface.unlit {
                return radiance + throughput * surface.material.base_color;
            }
            radiance += throughput * surface.emissive_nits;
            if reflection == self.bounces {
                break;
            }
            let view = lift_view(surface.normal_in_world, vertex.view);
            let bsdf = self.lighting.model(surface, view);
            radiance += throughput * self.direct(&vertex, view, &bsdf, draws, reflection);

            let chances = draws.pair(reflection, 4);
            let (light, weight) = scatter(surface, view, &bsdf, draws.pair(reflection, 3));
            throughput *= weight;
            let survival = if reflection < ROULETTE_FROM { 1.0 } else { throughput.max_element().min(1.0) };
            if chances.x >= survival || throughput == DVec3::ZERO {
                break;
            }
            throughput /= survival;
            let Some(ray) = vertex.ray(light, f64::INFINITY) else { break };
            let Some(hit) = self.world.meets(&ray, chances.y) else { break };
            vertex = self.vertex(&hit, &ray);
        }
        radiance
    }

    /// Light from the sources themselves, without surfaces that emit.
    fn direct(&self, vertex: &Vertex, view: DVec3, bsdf: &Model<'_>, draws: &PathDraws<'_>, reflection: u32) -> DVec3 {
        let seen =
            |direction, distance_m| vertex.ray(direction, distance_m).map_or(0.0, |ray| self.world.transmittance(&ray));
        let pairs = [0, 1, 2].map(|technique| draws.pair(reflection, technique));
        self.lighting.radiance_from_lights(&vertex.surface, bsdf, seen)
            + self.lighting.radiance_from_environment(&vertex.surface, view, bsdf, &pairs, seen)
    }

    fn vertex(&self, hit: &Hit, ray: &Ray) -> Vertex {
        Vertex {
            surface: self.world.surface(hit),
            facet_normal: self.world.facet_normal(hit, ray),
            view: -ray.direction,
        }
    }
}

/// A direction that light may come from, and f cos / pdf.
fn scatter(surface: &Surface, view: DVec3, bsdf: &Model<'_>, u: DVec2) -> (DVec3, DVec3) {
    let (light, pdf) = Techniques::new(bsdf.facets(), view, None).sample_surface(u);
    let NoL = surface.normal_in_world.dot(light);
    if NoL <= 0.0 {
        return (light, DVec3::ZERO);
    }
    (light, bsdf.evaluate(light) * (NoL / pdf))
}
