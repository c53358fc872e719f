//! Radiance taken apart: by light, and by component of the BRDF.

use super::super::bsdf::{BLACK, PerComponent, lift_view};
use super::super::sampling::PixelSampler;
use super::super::surface::Surface;
use super::super::techniques::Facets;
use super::{Lighting, arriving};
use crate::scene::Component;
use glam::DVec3;

/// Independent estimates whose differences tell the error.
const REPLICATES: u32 = 8;

/// A mean of samples for each component, and the standard error of each channel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimated {
    pub mean: PerComponent,
    pub standard_error: PerComponent,
}

impl Lighting<'_> {
    /// The microfacets of a surface's specular lobe; `view` is above its horizon.
    pub fn facets(&self, surface: &Surface, view: DVec3) -> Facets {
        self.model(surface, view).facets()
    }

    /// Radiance that leaves `surface` along the unit direction `view`, cd/m2, from each punctual light in the order of
    /// [`crate::scene::Scene::lights_in_world`], by each component. Black where the surface is unlit.
    pub fn parts_from_lights(&self, surface: &Surface, view: DVec3) -> Vec<PerComponent> {
        let bsdf = self.model(surface, lift_view(surface.normal_in_world, view));
        let from_light = |light| match arriving(light, surface) {
            Some((direction, irradiance)) if !surface.unlit => bsdf.components(direction).map(|part| part * irradiance),
            _ => BLACK,
        };
        self.lights.iter().map(from_light).collect()
    }

    /// The same from the environment, occlusion included, estimated with at least `samples` of each technique.
    pub fn parts_from_environment(&self, surface: &Surface, view: DVec3, samples: u32) -> Estimated {
        if surface.unlit || self.environment.is_none() {
            return Estimated { mean: BLACK, standard_error: BLACK };
        }
        let view = lift_view(surface.normal_in_world, view);
        let bsdf = self.model(surface, view);
        let count = samples.div_ceil(REPLICATES).max(1);
        let replicate = |seed: u32| {
            let sampler = PixelSampler::new(u64::from(seed), 0, 0);
            let mut sum = BLACK;
            for index in 0..count {
                let draws = [0, 1, 2].map(|dimension| sampler.pair(index, dimension));
                let arriving = self.arriving_from_environment(surface, view, &bsdf, &draws, |_, _| 1.0);
                for (light, irradiance) in arriving.into_iter().flatten() {
                    let components = bsdf.components(light);
                    sum.iter_mut().zip(components).for_each(|(sum, part)| *sum += part * irradiance);
                }
            }
            sum.map(|sum| sum * (surface.occlusion / f64::from(count)))
        };
        mean_and_error(&(0..REPLICATES).map(replicate).collect::<Vec<_>>())
    }
}

/// The mean, and the standard error that independent means have.
fn mean_and_error(replicates: &[PerComponent]) -> Estimated {
    let count = replicates.len() as f64;
    let (mut mean, mut standard_error) = (BLACK, BLACK);
    for i in 0..Component::ALL.len() {
        let values = replicates.iter().map(|replicate| replicate[i]);
        mean[i] = values.clone().sum::<DVec3>() / count;
        let squares: DVec3 = values.map(|value| (value - mean[i]) * (value - mean[i])).sum();
        standard_error[i] = (squares / (count * (count - 1.0))).map(f64::sqrt);
    }
    Estimated { mean, standard_error }
}

#[cfg(test)]
mod tests {
    use super::super::super::bsdf::ModelChoices;
    use super::super::super::surface::World;
    use super::super::super::tests::{add_light, scene_of, sphere, view};
    use super::*;
    use crate::reference::inspect::Inspector;
    use crate::scene::{Disney, Environment, EnvironmentImage, LightKind, Material};
    use glam::{UVec2, Vec3};

    #[test]
    fn the_parts_are_the_whole() {
        let plain = Material { metallic: 0.4, perceptual_roughness: 0.5, ..Material::default() };
        let disney = Disney { sheen: 1.0, clearcoat: 0.7, subsurface: 0.5, ..Disney::default() };
        for material in [plain.clone(), Material { disney: Some(disney), ..plain }] {
            let mut scene = scene_of(sphere(24), material);
            let mut texels = vec![Vec3::splat(0.3); 32 * 16];
            texels[4 * 32 + 20] = Vec3::splat(200.0);
            scene.environment = Some(Environment::new(EnvironmentImage { width: 32, height: 16, texels }));
            add_light(&mut scene, LightKind::Point { range_m: None }, 20.0, DVec3::new(3.0, 2.0, 4.0));
            add_light(&mut scene, LightKind::Directional, 2.0, DVec3::ZERO);
            let view = view();
            let (ray, layers) = Inspector::new(&scene, &view).layers(view.size_px / 2 + UVec2::ONE);
            let surface = World::new(&scene, &view).surface(&layers[0].hit);
            let lighting = Lighting::new(&scene, ModelChoices::default());
            let eye = -ray.direction;
            let environment = lighting.parts_from_environment(&surface, eye, 8);
            let lights = lighting.parts_from_lights(&surface, eye);
            assert_eq!(lights.len(), 2);
            let sum: DVec3 = lights.into_iter().chain([environment.mean]).flatten().sum();
            // One sample of each replicate, as `parts_from_environment` draws them.
            let whole = (0..REPLICATES).map(|seed| {
                let sampler = PixelSampler::new(u64::from(seed), 0, 0);
                lighting.radiance(&surface, eye, &[0, 1, 2].map(|dimension| sampler.pair(0, dimension)))
            });
            let whole = whole.sum::<DVec3>() / f64::from(REPLICATES);
            assert!((sum / whole - 1.0).abs().max_element() < 1e-12, "{sum} instead of {whole}");
        }
    }

    #[test]
    fn the_error_stated_is_the_error_made() {
        let mut scene = scene_of(sphere(24), Material { perceptual_roughness: 0.4, ..Material::default() });
        let mut texels = vec![Vec3::splat(0.3); 32 * 16];
        texels[3 * 32 + 9] = Vec3::splat(60.0);
        scene.environment = Some(Environment::new(EnvironmentImage { width: 32, height: 16, texels }));
        let view = view();
        let inspector = Inspector::new(&scene, &view);
        let (ray, layers) = inspector.layers(view.size_px / 2);
        let surface = World::new(&scene, &view).surface(&layers[0].hit);
        let lighting = Lighting::new(&scene, ModelChoices::default());
        let specular = Component::Specular as usize;
        let at = |samples| lighting.parts_from_environment(&surface, -ray.direction, samples);
        let (few, many) = (at(64), at(1 << 16));
        let (made, stated) = ((few.mean[specular] - many.mean[specular]).abs(), few.standard_error[specular]);
        assert!(stated.min_element() > 0.0 && many.standard_error[specular].max_element() < stated.min_element());
        assert!(made.cmple(4.0 * stated).all(), "{made} against {stated}");
    }
}
