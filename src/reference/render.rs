//! The CPU renderer: rays through a pixel, and what they see.

use super::bsdf::ModelChoices;
use super::estimate::{EstimateOptions, estimate};
use super::geometry::{Hit, Ray};
use super::integrator::{Lighting, PathDraws, Paths};
use super::sampling::PixelSampler;
use super::surface::World;
use crate::progress::Progress;
use crate::scene::{Background, Projection, RadianceImage, Scene, View};
use glam::{DVec2, DVec3, DVec4, UVec2};
use std::ops::Range;

/// How a reference picture is made.
#[derive(Clone, Copy)]
pub struct ReferenceOptions<'a> {
    /// Samples a pixel, at least 1; a single one lies in the middle. Powers of two are stratified best.
    pub samples: u32,
    /// The same seed gives the same picture.
    pub seed: u64,
    /// Told about what is done.
    pub progress: &'a dyn Progress,
}

impl std::fmt::Debug for ReferenceOptions<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("ReferenceOptions")
            .field("samples", &self.samples)
            .field("seed", &self.seed)
            .finish_non_exhaustive()
    }
}

/// Dimensions of the sampler: the place in the pixel, then three for each layer of surfaces.
const PIXEL_DIMENSION: u32 = 0;
const DIMENSIONS_PER_LAYER: u32 = 3;
/// Of a blurred background: no layer is so deep.
const BACKGROUND_DIMENSIONS: [u32; 2] = [u32::MAX - 2, u32::MAX - 1];

/// Renders `scene` as docs/model.md defines it: box filter, no shadows, no interreflection.
pub fn render(scene: &Scene, view: &View, options: &ReferenceOptions) -> RadianceImage {
    let ReferenceOptions { samples, seed, progress } = *options;
    estimate(scene, view, &EstimateOptions { samples, seed, progress, ..Default::default() }).radiance
}

/// A scene and a view, ready to be looked at.
pub(super) struct Tracer<'a> {
    view: &'a View,
    world: World<'a>,
    lighting: Lighting<'a>,
    bounces: u32,
}

/// A sum of samples.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Samples {
    /// Radiance, multiplied with the coverage in w.
    pub(super) radiance: DVec4,
    /// Coverage by surfaces, without the background.
    pub(super) surface: f64,
}

impl<'a> Tracer<'a> {
    pub(super) fn new(scene: &'a Scene, view: &'a View, bounces: u32) -> Self {
        let term = view.term.filter(|_| bounces == 0);
        let choices = ModelChoices { term, ..ModelChoices::of(view) };
        Self { view, world: World::new(scene, view), lighting: Lighting::new(scene, choices), bounces }
    }

    /// The samples `indices` of a pixel, at `place` in it or spread over it.
    pub(super) fn pixel(
        &self,
        pixel: UVec2,
        sampler: &PixelSampler,
        indices: Range<u32>,
        place: Option<DVec2>,
    ) -> Samples {
        let mut sum = Samples::default();
        for index in indices {
            let place = place.unwrap_or_else(|| sampler.pair(index, PIXEL_DIMENSION));
            let sample = self.sample(pixel.as_dvec2() + place, sampler, index);
            sum.radiance += sample.radiance;
            sum.surface += sample.surface;
        }
        sum
    }

    fn sample(&self, pixel: DVec2, sampler: &PixelSampler, index: u32) -> Samples {
        let ray = camera_ray(self.view, pixel);
        let layers = self.world.layers(&ray);
        let sent = layers
            .iter()
            .zip(0..)
            .map(|(layer, depth)| (layer.alpha, self.layer(&layer.hit, &ray, (sampler, index, depth))));
        composite(self.view.background, sent, || {
            let draws = BACKGROUND_DIMENSIONS.map(|dimension| sampler.pair(index, dimension));
            self.lighting.blurred_radiance(ray.direction, f64::from(self.view.background_blur), draws)
        })
    }

    /// Radiance that one of the surfaces along the ray sends back.
    fn layer(&self, hit: &Hit, ray: &Ray, (sampler, index, depth): (&PixelSampler, u32, u32)) -> DVec3 {
        if self.bounces > 0 {
            let paths = Paths { world: &self.world, lighting: &self.lighting, bounces: self.bounces };
            return paths.radiance(hit, ray, &PathDraws { sampler, index, layer: depth });
        }
        let first = PIXEL_DIMENSION + 1 + depth * DIMENSIONS_PER_LAYER;
        let draws = [0, 1, 2].map(|dimension| sampler.pair(index, first + dimension));
        self.lighting.radiance(&self.world.surface(hit), -ray.direction, &draws)
    }
}

/// The ray through a point of the picture, between the camera's near and far planes.
pub(super) fn camera_ray(view: &View, pixel: DVec2) -> Ray {
    let camera = &view.camera;
    let (origin, direction) = camera.ray(pixel, view.size_px);
    let depth_per_t = direction.dot(camera.forward_in_world());
    let far_m = match camera.projection {
        Projection::Perspective { .. } => f64::INFINITY,
        Projection::Orthographic { .. } => camera.far_m,
    };
    Ray { origin, direction, t_min: camera.near_m / depth_per_t, t_max: far_m / depth_per_t }
}

/// Layers over one another and over the background: alpha and radiance, front to back.
pub(super) fn composite(
    background: Background,
    layers: impl Iterator<Item = (f64, DVec3)>,
    environment: impl FnOnce() -> DVec3,
) -> Samples {
    let (mut radiance, mut transmittance) = (DVec3::ZERO, 1.0);
    for (alpha, sent) in layers {
        radiance += sent * (alpha * transmittance);
        transmittance *= 1.0 - alpha;
    }
    let surface = 1.0 - transmittance;
    let radiance = match background {
        Background::Environment => (radiance + environment() * transmittance).extend(1.0),
        Background::Transparent | Background::Color(_) => radiance.extend(surface),
    };
    Samples { radiance, surface }
}
