//! The CPU renderer: primary rays, one pixel at a time, the same picture on any number of threads.

use super::bsdf::ModelChoices;
use super::geometry::Ray;
use super::integrator::Lighting;
use super::sampling::PixelSampler;
use super::surface::World;
use crate::progress::Progress;
use crate::scene::{Background, Projection, RadianceImage, Scene, View};
use glam::{DVec2, DVec3, DVec4, Vec4};
use rayon::prelude::*;

/// How a reference picture is made.
#[derive(Clone, Copy)]
pub struct ReferenceOptions<'a> {
    /// Samples a pixel, at least 1; a single one lies in the middle. Powers of two are stratified best.
    pub samples: u32,
    /// The same seed gives the same picture.
    pub seed: u64,
    /// Told about every finished row.
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

/// Renders `scene` as docs/model.md defines it: box filter, no shadows, no interreflection.
pub fn render(scene: &Scene, view: &View, options: &ReferenceOptions) -> RadianceImage {
    let (width, height) = (view.size_px.x, view.size_px.y);
    let choices = ModelChoices { energy_compensation: view.energy_compensation, geometry: view.geometry };
    let tracer = Tracer { view, world: World::new(scene, view), lighting: Lighting::new(scene, choices) };
    options.progress.begin("reference", u64::from(height));
    let mut texels = vec![Vec4::ZERO; width as usize * height as usize];
    texels.par_chunks_mut((width as usize).max(1)).zip(0..height).for_each(|(row, y)| {
        for (texel, x) in row.iter_mut().zip(0..width) {
            *texel = tracer.pixel(x, y, options).as_vec4();
        }
        options.progress.advance(1);
    });
    RadianceImage { width, height, texels }
}

struct Tracer<'a> {
    view: &'a View,
    world: World<'a>,
    lighting: Lighting<'a>,
}

impl Tracer<'_> {
    /// Radiance averaged over the pixel, multiplied with the coverage in w.
    fn pixel(&self, x: u32, y: u32, options: &ReferenceOptions) -> DVec4 {
        let sampler = PixelSampler::new(options.seed, x, y);
        let corner = DVec2::new(f64::from(x), f64::from(y));
        let samples = options.samples.max(1);
        // A single sample is where a rasteriser takes it.
        let place = |index| if samples == 1 { DVec2::splat(0.5) } else { sampler.pair(index, PIXEL_DIMENSION) };
        let sum: DVec4 = (0..samples).map(|index| self.sample(corner + place(index), &sampler, index)).sum();
        sum / f64::from(samples)
    }

    fn sample(&self, pixel: DVec2, sampler: &PixelSampler, index: u32) -> DVec4 {
        let ray = self.ray(pixel);
        let mut radiance = DVec3::ZERO;
        let mut transmittance = 1.0;
        for (layer, depth) in self.world.layers(&ray).iter().zip(0..) {
            let first = PIXEL_DIMENSION + 1 + depth * DIMENSIONS_PER_LAYER;
            let draws = [0, 1, 2].map(|dimension| sampler.pair(index, first + dimension));
            let surface = self.world.surface(&layer.hit);
            radiance += self.lighting.radiance(&surface, -ray.direction, &draws) * (layer.alpha * transmittance);
            transmittance *= 1.0 - layer.alpha;
        }
        match self.view.background {
            Background::Environment => {
                (radiance + self.lighting.environment_radiance(ray.direction) * transmittance).extend(1.0)
            }
            Background::Transparent | Background::Color(_) => radiance.extend(1.0 - transmittance),
        }
    }

    /// The ray through a point of the picture, between the camera's near and far planes.
    fn ray(&self, pixel: DVec2) -> Ray {
        let camera = &self.view.camera;
        let (origin, direction) = camera.ray(pixel, self.view.size_px);
        let depth_per_t = direction.dot(camera.forward_in_world());
        let far_m = match camera.projection {
            Projection::Perspective { .. } => f64::INFINITY,
            Projection::Orthographic { .. } => camera.far_m,
        };
        Ray { origin, direction, t_min: camera.near_m / depth_per_t, t_max: far_m / depth_per_t }
    }
}
