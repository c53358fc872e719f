//! One pixel, and everything that made it.

use super::bsdf::{ModelChoices, PerComponent, lift_view};
use super::disney::specular_f0;
use super::geometry::{Hit, Ray};
use super::integrator::{Estimated, Lighting};
use super::render::{camera_ray, composite};
use super::sampling::PixelSampler;
use super::surface::{Details, Layer, Surface, World};
use crate::scene::{Scene, View};
use glam::{DVec2, DVec3, DVec4, UVec2};

/// Of a background that is blurred.
const BLUR_SAMPLES: u32 = 4096;

/// A scene and a view whose pixels can be looked into.
#[derive(Debug)]
pub struct Inspector<'a> {
    view: &'a View,
    world: World<'a>,
    lighting: Lighting<'a>,
}

/// What shading makes of a surface before any light falls on it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Inputs {
    /// Reflectance at normal incidence, dielectric and metal mixed, in [0, 1].
    pub f0: DVec3,
    /// Alphas of the microfacets along the tangent and across it.
    pub alphas: DVec2,
    /// Unit vector across the shading normal along which facets are spread; of facets that are spread evenly the tangent
    /// of the vertices, or zero.
    pub tangent_in_world: DVec3,
    /// Cosine between the normal and the viewer, once that is lifted above the horizon.
    pub n_dot_v: f64,
}

/// Light that leaves a surface toward the eye, cd/m2.
#[derive(Debug, Clone, PartialEq)]
pub struct Leaving {
    /// Of each punctual light, in the order of [`Scene::lights_in_world`].
    pub lights: Vec<PerComponent>,
    /// Occlusion included.
    pub environment: Estimated,
    /// Emission, or the base colour of an unlit surface.
    pub emitted: DVec3,
}

impl Leaving {
    /// All of it.
    pub fn sum(&self) -> DVec3 {
        self.lights.iter().chain([&self.environment.mean]).flatten().sum::<DVec3>() + self.emitted
    }
}

impl<'a> Inspector<'a> {
    pub fn new(scene: &'a Scene, view: &'a View) -> Self {
        let choices = ModelChoices { term: None, ..ModelChoices::of(view) };
        Self { view, world: World::new(scene, view), lighting: Lighting::new(scene, choices) }
    }

    /// The ray through the middle of a pixel, counted from the top left, and the surfaces along it, front to back.
    pub fn layers(&self, pixel: UVec2) -> (Ray, Vec<Layer>) {
        let ray = camera_ray(self.view, pixel.as_dvec2() + DVec2::splat(0.5));
        let layers = self.world.layers(&ray);
        (ray, layers)
    }

    /// What is known of a hit.
    pub fn details(&self, hit: &Hit, ray: &Ray) -> Details {
        self.world.details(hit, ray)
    }

    /// Index of the material of a hit, in [`Scene::materials`].
    pub fn material(&self, hit: &Hit) -> usize {
        self.world.material(hit)
    }

    /// Texture coordinates of a hit in one of the sets of its primitive, before any transform.
    pub fn uv(&self, hit: &Hit, set: usize) -> Option<DVec2> {
        self.world.uv(hit, set)
    }

    /// What shading makes of a surface that the ray meets.
    pub fn inputs(&self, surface: &Surface, ray: &Ray) -> Inputs {
        let material = &surface.material;
        let view = lift_view(surface.normal_in_world, -ray.direction);
        let facets = self.lighting.facets(surface, view);
        Inputs {
            f0: match surface.disney {
                Some(disney) => {
                    let (specular, tint) = (f64::from(disney.specular), f64::from(disney.specular_tint));
                    specular_f0(material.base_color, material.metallic, specular, tint)
                }
                None => material.dielectric_f0.lerp(material.base_color, material.metallic),
            },
            alphas: facets.alpha,
            tangent_in_world: match (material.anisotropy, surface.disney) {
                (None, None) => surface.tangent_in_world.normalize_or_zero(),
                _ => facets.world_from_tangent.x_axis,
            },
            n_dot_v: surface.normal_in_world.dot(view),
        }
    }

    /// Light that a surface sends back along the ray; the environment's is estimated with `samples` of each technique.
    pub fn leaving(&self, surface: &Surface, ray: &Ray, samples: u32) -> Leaving {
        let eye = -ray.direction;
        Leaving {
            lights: self.lighting.parts_from_lights(surface, eye),
            environment: self.lighting.parts_from_environment(surface, eye, samples),
            emitted: if surface.unlit { surface.material.base_color } else { surface.emissive_nits },
        }
    }

    /// Radiance of the background's environment along the ray, cd/m2; an estimate, where it is blurred.
    pub fn background(&self, ray: &Ray) -> DVec3 {
        let samples = if self.view.background_blur > 0.0 { BLUR_SAMPLES } else { 1 };
        let sampler = PixelSampler::new(0, 0, 0);
        let blur = f64::from(self.view.background_blur);
        let draws = |index| [0, 1].map(|dimension| sampler.pair(index, dimension));
        let sample = |index| self.lighting.blurred_radiance(ray.direction, blur, draws(index));
        (0..samples).map(sample).sum::<DVec3>() / f64::from(samples)
    }

    /// The pixel: what each layer sends to the eye, over one another and over the background, multiplied with the
    /// coverage in w.
    pub fn composite(&self, layers: &[(f64, DVec3)], ray: &Ray) -> DVec4 {
        let sent = layers.iter().copied();
        composite(self.view.background, sent, || self.background(ray)).radiance
    }
}
