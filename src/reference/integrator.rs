//! Light that a surface sends to the eye: the sum over lights, and the environment by multiple importance sampling.

#![expect(non_snake_case, reason = "equations keep the symbols of their papers")]

mod backdrop;
mod parts;
mod path;

pub use parts::Estimated;
pub(super) use path::{PathDraws, Paths};

use super::albedo::DirectionalAlbedo;
use super::bsdf::{Bsdf, ModelChoices, PerComponent, lift_view};
use super::disney::bsdf::{DisneyBsdf, DisneyMaterial, TangentFrame};
use super::environment::EnvironmentSampler;
use super::lights;
use super::surface::Surface;
use super::techniques::{Draws, Facets, Techniques};
use crate::scene::{Component, Components, Environment, LightInWorld, LightKind, Scene, Term};
use glam::DVec3;

/// The BSDF of a surface, of whichever model its material is.
#[expect(clippy::large_enum_variant, reason = "one at a time, on the stack")]
enum Kind<'a> {
    Standard(Bsdf<'a>),
    Disney(DisneyBsdf),
}

/// The BSDF of a surface, or some of its components.
struct Model<'a> {
    kind: Kind<'a>,
    only: Option<Components>,
}

impl Model<'_> {
    /// f(l, v), 1/sr.
    fn evaluate(&self, light: DVec3) -> DVec3 {
        let Some(only) = self.only else { return self.components(light).into_iter().sum() };
        let parts = Component::ALL.into_iter().zip(self.components(light));
        parts.filter(|(component, _)| only.contains(*component)).map(|(_, part)| part).sum()
    }

    /// The components of f(l, v), 1/sr.
    fn components(&self, light: DVec3) -> PerComponent {
        match &self.kind {
            Kind::Standard(bsdf) => bsdf.components(light),
            Kind::Disney(bsdf) => bsdf.components(light),
        }
    }

    /// The facets that light is mirrored at.
    fn facets(&self) -> Facets {
        match &self.kind {
            Kind::Standard(bsdf) => bsdf.facets(),
            Kind::Disney(bsdf) => bsdf.facets(),
        }
    }
}

/// All that lights a scene.
#[derive(Debug)]
pub struct Lighting<'a> {
    lights: Vec<LightInWorld>,
    environment: Option<&'a Environment>,
    environment_sampler: Option<EnvironmentSampler>,
    albedo: DirectionalAlbedo,
    choices: ModelChoices,
}

impl<'a> Lighting<'a> {
    pub fn new(scene: &'a Scene, choices: ModelChoices) -> Self {
        let environment = scene.environment.as_ref();
        Self {
            lights: scene.lights_in_world(),
            environment,
            environment_sampler: environment.and_then(EnvironmentSampler::new),
            albedo: DirectionalAlbedo::default(),
            choices,
        }
    }

    /// Radiance that arrives from the environment, cd/m2; black without one.
    pub fn environment_radiance(&self, direction_in_world: DVec3) -> DVec3 {
        self.environment.map_or(DVec3::ZERO, |environment| environment.radiance(direction_in_world))
    }

    /// Radiance that leaves `surface` along the unit direction `view`, cd/m2: emission and punctual lights exactly, the
    /// environment estimated with one sample of each technique. No shadows and no interreflection (docs/model.md).
    pub fn radiance(&self, surface: &Surface, view: DVec3, draws: &Draws) -> DVec3 {
        let shows = |of: fn(Term) -> bool| self.choices.term.is_none_or(of);
        let (emits, mut radiance) = (shows(|term| term == Term::Emission), DVec3::ZERO);
        if surface.unlit {
            return if emits { surface.material.base_color } else { radiance };
        }
        let view = lift_view(surface.normal_in_world, view);
        let bsdf = self.model(surface, view);
        let everything_is_seen = |_, _| 1.0;
        if emits {
            radiance += surface.emissive_nits;
        }
        if shows(Term::is_direct) {
            radiance += self.radiance_from_lights(surface, &bsdf, everything_is_seen);
        }
        if shows(Term::is_of_environment) {
            let reflected = self.radiance_from_environment(surface, view, &bsdf, draws, everything_is_seen);
            radiance += reflected * surface.occlusion;
        }
        radiance
    }

    fn model(&self, surface: &Surface, view: DVec3) -> Model<'_> {
        let (n, material) = (surface.normal_in_world, surface.material);
        let only = self.choices.term.and_then(Term::components);
        let Some(parameters) = surface.disney else {
            return Model { kind: Kind::Standard(Bsdf::new(&self.albedo, material, n, view, self.choices)), only };
        };
        let material = DisneyMaterial {
            base_color: material.base_color,
            metallic: material.metallic,
            perceptual_roughness: material.perceptual_roughness,
            parameters,
        };
        let frame = TangentFrame::new(n, surface.tangent_in_world);
        Model { kind: Kind::Disney(DisneyBsdf::new(&material, frame, view)), only }
    }

    /// `seen` is the share of light, in [0, 1], that passes along a direction up to a distance in metres.
    fn radiance_from_lights(&self, surface: &Surface, bsdf: &Model<'_>, seen: impl Fn(DVec3, f64) -> f64) -> DVec3 {
        let from_light = |light: &LightInWorld| {
            let (direction, irradiance) = arriving(light, surface)?;
            let radiance = bsdf.evaluate(direction) * irradiance;
            let distance_m = match light.kind {
                LightKind::Directional => f64::INFINITY,
                LightKind::Point { .. } | LightKind::Spot { .. } => {
                    light.position_in_world.distance(surface.position_in_world)
                }
            };
            (radiance != DVec3::ZERO).then(|| radiance * seen(direction, distance_m))
        };
        self.lights.iter().filter_map(from_light).sum()
    }

    /// int f L cos by multiple importance sampling with the balance heuristic (Veach 1997, section 9.2).
    fn radiance_from_environment(
        &self,
        surface: &Surface,
        view: DVec3,
        bsdf: &Model<'_>,
        draws: &Draws,
        seen: impl Fn(DVec3, f64) -> f64,
    ) -> DVec3 {
        let arriving = self.arriving_from_environment(surface, view, bsdf, draws, seen);
        arriving.into_iter().flatten().map(|(light, irradiance)| bsdf.evaluate(light) * irradiance).sum()
    }

    /// Directions of light, one of each technique, and the irradiance that each stands for.
    fn arriving_from_environment(
        &self,
        surface: &Surface,
        view: DVec3,
        bsdf: &Model<'_>,
        draws: &Draws,
        seen: impl Fn(DVec3, f64) -> f64,
    ) -> [Option<(DVec3, DVec3)>; 3] {
        let Some(environment) = self.environment else { return [None; 3] };
        let techniques = Techniques::new(bsdf.facets(), view, self.environment_sampler.as_ref());
        techniques.sample(draws).map(|light| {
            let light = light?;
            let NoL = surface.normal_in_world.dot(light);
            if NoL <= 0.0 {
                return None;
            }
            let radiance = environment.radiance(light);
            let seen = if radiance == DVec3::ZERO { 0.0 } else { seen(light, f64::INFINITY) };
            Some((light, radiance * (seen * NoL / techniques.pdf_sum(light))))
        })
    }
}

/// The direction toward a light and the irradiance that it brings, unshadowed. `None` where it has no direction.
fn arriving(light: &LightInWorld, surface: &Surface) -> Option<(DVec3, DVec3)> {
    let incidence = lights::incidence(light, surface.position_in_world)?;
    let NoL = surface.normal_in_world.dot(incidence.direction_in_world);
    Some((incidence.direction_in_world, incidence.illuminance_lux * NoL.max(0.0)))
}

#[cfg(test)]
mod tests {
    use super::super::bsdf::{Anisotropy, SurfaceMaterial};
    use super::super::sampling::PixelSampler;
    use super::*;
    use crate::math::spaces::direction_from_equirect;
    use crate::scene::{Disney, EnvironmentImage};
    use glam::{DVec2, Vec3};
    use std::f64::consts::PI;

    /// A gradient with a sun of one texel.
    fn scene() -> Scene {
        let mut texels: Vec<Vec3> = (0..32 * 16).map(|i| Vec3::new(0.2, 0.3, (i % 32) as f32 / 32.0)).collect();
        texels[4 * 32 + 20] = Vec3::new(90.0, 80.0, 50.0);
        let environment = Environment::new(EnvironmentImage { width: 32, height: 16, texels });
        Scene {
            environment: Some(Environment { rotation_rad: 0.4, intensity: 1.5, ..environment }),
            ..Scene::default()
        }
    }

    fn surface(metallic: f64, perceptual_roughness: f64) -> Surface {
        Surface {
            position_in_world: DVec3::ZERO,
            normal_in_world: DVec3::new(0.3, 0.8, 0.1).normalize(),
            tangent_in_world: DVec3::X,
            disney: None,
            material: SurfaceMaterial {
                base_color: DVec3::new(0.9, 0.6, 0.3),
                metallic,
                perceptual_roughness,
                dielectric_f0: DVec3::splat(0.04),
                dielectric_f90: 1.0,
                metal_fresnel: Default::default(),
                anisotropy: None,
            },
            emissive_nits: DVec3::ZERO,
            occlusion: 0.5,
            unlit: false,
        }
    }

    /// The same integral by brute force: midpoints of a fine grid over the sphere.
    fn by_midpoints(lighting: &Lighting, surface: &Surface, view: DVec3) -> DVec3 {
        const ROWS: u32 = 512;
        let n = surface.normal_in_world;
        let bsdf = lighting.model(surface, view);
        let mut sum = DVec3::ZERO;
        for row in 0..ROWS {
            let v = (f64::from(row) + 0.5) / f64::from(ROWS);
            for column in 0..2 * ROWS {
                let light = direction_from_equirect(DVec2::new((f64::from(column) + 0.5) / f64::from(2 * ROWS), v));
                let cell = (PI / f64::from(ROWS)).powi(2) * (v * PI).sin();
                sum += bsdf.evaluate(light) * lighting.environment_radiance(light) * (cell * n.dot(light).max(0.0));
            }
        }
        sum * surface.occlusion
    }

    /// The worst relative difference between 8192 samples and brute force over several materials.
    fn worst_error(view: DVec3) -> f64 {
        let standard = [(0.0, 1.0), (0.0, 0.4), (1.0, 0.4), (0.6, 0.7)];
        worst_error_of(&standard.map(|(metallic, r)| surface(metallic, r)), view)
    }

    fn worst_error_of(surfaces: &[Surface], view: DVec3) -> f64 {
        let (scene, view) = (scene(), view.normalize());
        let lighting = Lighting::new(&scene, ModelChoices::default());
        let mut worst: f64 = 0.0;
        for surface in surfaces {
            let view = lift_view(surface.normal_in_world, view);
            let (sampler, count) = (PixelSampler::new(5, 0, 0), 8192);
            let estimate = |i| lighting.radiance(surface, view, &[0, 1, 2].map(|d| sampler.pair(i, d)));
            let mean = (0..count).map(estimate).sum::<DVec3>() / f64::from(count);
            let expected = by_midpoints(&lighting, surface, view);
            worst = worst.max(((mean - expected) / expected).abs().max_element());
        }
        worst
    }

    #[test]
    fn the_estimate_is_the_integral() {
        let views = [DVec3::new(0.2, 1.0, 0.3), DVec3::new(-1.0, 0.5, 0.2)];
        let worst = views.map(worst_error).into_iter().fold(0.0, f64::max);
        // Measured 1.3e-4; margin 2.
        assert!(worst < 3e-4, "{worst:e}");
    }

    #[test]
    fn the_estimate_is_the_integral_for_disney_materials_too() {
        let disney = Disney { anisotropic: 0.6, sheen: 0.5, subsurface: 0.5, ..Disney::default() };
        let coated = Disney { clearcoat: 1.0, clearcoat_gloss: 0.2, ..disney };
        let surfaces = [disney, coated].map(|disney| Surface { disney: Some(disney), ..surface(0.4, 0.5) });
        let worst = worst_error_of(&surfaces, DVec3::new(0.2, 1.0, 0.3));
        // Measured 1.9e-4, margin 2.
        assert!(worst < 4e-4, "{worst:e}");
    }

    #[test]
    fn the_estimate_is_the_integral_for_anisotropic_metals_too() {
        let mut brushed = surface(1.0, 0.4);
        let tangent = brushed.normal_in_world.any_orthonormal_vector();
        let bitangent = brushed.normal_in_world.cross(tangent);
        brushed.material.anisotropy = Some(Anisotropy { tangent, bitangent, strength: 0.9 });
        let worst = worst_error_of(&[brushed], DVec3::new(0.2, 1.0, 0.3));
        // Measured 7.4e-5; margin 2.
        assert!(worst < 1.5e-4, "{worst:e}");
    }

    #[test]
    fn views_below_the_horizon_of_the_shading_normal_converge_too() {
        // n.v = -0.1, as on silhouettes of coarse meshes: the view is lifted to the horizon.
        let worst = worst_error(DVec3::new(-0.5, 0.1, 0.2));
        // Measured 3.9e-4; margin 2.
        assert!(worst < 8e-4, "{worst:e}");
    }

    #[test]
    fn white_bodies_vanish_where_the_shading_normal_faces_away_too() {
        let constant = Environment::new(EnvironmentImage::constant(Vec3::ONE));
        let scene = Scene { environment: Some(constant), ..Scene::default() };
        let lighting = Lighting::new(&scene, ModelChoices::default());
        let mut surface = Surface { normal_in_world: DVec3::Z, occlusion: 1.0, ..surface(1.0, 0.1) };
        surface.material.base_color = DVec3::ONE;
        let (sampler, count) = (PixelSampler::new(5, 0, 0), 4096);
        let view = DVec3::new(1.0, 0.0, -0.1).normalize();
        let estimate = |i| lighting.radiance(&surface, view, &[0, 1, 2].map(|d| sampler.pair(i, d)));
        let mean = (0..count).map(estimate).sum::<DVec3>() / f64::from(count);
        // 0.09 if h were formed with the view that is not lifted.
        assert!((mean - 1.0).abs().max_element() < 1e-2, "{mean}");
    }

    #[test]
    fn unlit_surfaces_show_their_base_colour() {
        let scene = scene();
        let surface = Surface { unlit: true, ..surface(0.0, 0.5) };
        let radiance =
            Lighting::new(&scene, ModelChoices::default()).radiance(&surface, DVec3::Y, &[DVec2::splat(0.5); 3]);
        assert_eq!(radiance, surface.material.base_color);
    }
}
