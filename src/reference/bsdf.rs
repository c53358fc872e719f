//! The material of docs/model.md at one point, seen from one direction.

#![expect(non_snake_case, reason = "equations keep the symbols of their papers")]

use super::albedo::{Dfg, DirectionalAlbedo};
use super::brdf::{
    F_Schlick, F_Schlick_average, F_multiscatter, Fd_Coupled, alpha_from_perceptual_roughness, f_KullaConty,
};
use super::microfacet::Distribution;
use super::microfacet::fresnel::{F_Lazanyi, F_conductor};
use super::techniques::Facets;
use crate::math::spaces::orthonormal_basis;
use crate::scene::{Component, Geometry, MetalFresnel, Term, View};
use glam::{DMat3, DVec2, DVec3};

/// A number for each component, in the order of [`Component::ALL`].
pub type PerComponent = [DVec3; Component::ALL.len()];

/// Nothing from any component.
pub const BLACK: PerComponent = [DVec3::ZERO; Component::ALL.len()];

/// What a material comes to at a point, textures and vertex colours multiplied in.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfaceMaterial {
    /// Linear Rec.709 in [0, 1].
    pub base_color: DVec3,
    /// In [0, 1].
    pub metallic: f64,
    /// In [0, 1].
    pub perceptual_roughness: f64,
    /// F0 of the dielectric interface, tint and weight included, in [0, 1].
    pub dielectric_f0: DVec3,
    /// F90 of the dielectric interface: its weight, in [0, 1].
    pub dielectric_f90: f64,
    /// The base colour is its F0.
    pub metal_fresnel: MetalFresnel,
    /// How the microfacets are spread along the surface; `None` is the same in all directions.
    pub anisotropy: Option<Anisotropy>,
}

impl SurfaceMaterial {
    /// How the microfacets are spread; of anisotropic ones, alpha_x is along [`Anisotropy::tangent`].
    pub fn distribution(&self) -> Distribution {
        let alpha = alpha_from_perceptual_roughness(self.perceptual_roughness);
        let Some(Anisotropy { strength, .. }) = self.anisotropy else { return Distribution::Ggx { alpha } };
        let alpha_x = alpha + (1.0 - alpha) * strength * strength;
        Distribution::GgxAnisotropic { alpha_x, alpha_y: alpha, rotation_rad: 0.0 }
    }
}

/// The wide direction of anisotropic microfacets.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Anisotropy {
    /// Unit vector at right angles to the normal.
    pub tangent: DVec3,
    /// Completes the frame; its sign does not matter to the lobe.
    pub bitangent: DVec3,
    /// In [0, 1]: alpha along the tangent grows to 1 with its square (KHR_materials_anisotropy).
    pub strength: f64,
}

/// What of the shading model is a choice of the view.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ModelChoices {
    pub energy_compensation: bool,
    /// The tables of directional albedo are of the default; another geometry only changes the lobe itself.
    pub geometry: Geometry,
    /// The only part of the radiance that is evaluated.
    pub term: Option<Term>,
}

impl ModelChoices {
    pub fn of(view: &View) -> Self {
        Self { energy_compensation: view.energy_compensation, geometry: view.geometry, term: view.term }
    }
}

impl Default for ModelChoices {
    fn default() -> Self {
        Self { energy_compensation: true, geometry: Geometry::default(), term: None }
    }
}

/// F0 and F90 of a dielectric interface to air (docs/model.md, "Material"): `ior` is 0 or from 1 up, `specular` in [0, 1].
pub fn dielectric_reflectance(ior: f64, specular: f64, specular_color: DVec3) -> (DVec3, f64) {
    let f0 = (specular_color * ((ior - 1.0) / (ior + 1.0)).powi(2)).clamp(DVec3::ZERO, DVec3::ONE);
    (f0 * specular, specular)
}

/// A specular lobe's Fresnel factor and its multiple scattering.
#[derive(Debug, Clone, Copy)]
struct Interface {
    f0: DVec3,
    f90: f64,
    F_ms: DVec3,
}

/// The BRDF of a point for one direction of view: what does not depend on the light is worked out once.
#[derive(Debug)]
pub struct Bsdf<'a> {
    table: &'a DirectionalAlbedo,
    material: SurfaceMaterial,
    /// Takes world directions into the frame of tangent, bitangent and normal.
    local_from_world: DMat3,
    normal: DVec3,
    /// In that frame.
    view: DVec3,
    distribution: Distribution,
    geometry: Geometry,
    /// E(NoV) and its average.
    E_v: f64,
    E_avg: f64,
    dielectric: Interface,
    metal: Interface,
    /// Albedo of the dielectric's specular lobe by its strongest channel: strength of its multiple scattering, E_s(NoV)
    /// and the average of E_s.
    coupling: Coupling,
}

#[derive(Debug, Clone, Copy)]
struct Coupling {
    f0: f64,
    F_ms: f64,
    E_s_v: f64,
    E_s_avg: f64,
}

/// Directions of view below this cosine are lifted to it (docs/model.md).
pub const SMALLEST_NOV: f64 = 1e-4;

/// `view`, or the nearest direction that is not behind the shading normal.
pub fn lift_view(normal: DVec3, view: DVec3) -> DVec3 {
    let missing = SMALLEST_NOV - normal.dot(view);
    if missing > 0.0 { (view + missing * normal).normalize() } else { view }
}

impl<'a> Bsdf<'a> {
    /// `normal` is the shading normal and `view` points away from the surface; both are unit vectors in one frame.
    pub fn new(
        table: &'a DirectionalAlbedo,
        material: SurfaceMaterial,
        normal: DVec3,
        view: DVec3,
        choices: ModelChoices,
    ) -> Self {
        let distribution = material.distribution();
        let (tangent, bitangent) =
            material.anisotropy.map_or_else(|| orthonormal_basis(normal), |facets| (facets.tangent, facets.bitangent));
        let local_from_world = DMat3::from_cols(tangent, bitangent, normal).transpose();
        let view = lift_view(normal, view);
        let NoV = normal.dot(view).clamp(SMALLEST_NOV, 1.0);
        let view = (local_from_world * view).with_z(NoV);
        let dfg_v = table.dfg(perceptual_roughness_toward(&distribution, view), NoV);
        let dfg_avg = average(table, &distribution);
        let (E_v, E_avg) = (dfg_v.albedo(), dfg_avg.albedo());
        let share = if choices.energy_compensation { compensated_share(&distribution) } else { 0.0 };
        let F_ms = |F_avg| F_multiscatter(F_avg, E_avg) * share;
        let interface = |f0, f90| Interface { f0, f90, F_ms: F_ms(F_Schlick_average(f0, f90)) };
        let dielectric = interface(material.dielectric_f0, material.dielectric_f90);
        let metal = Interface { f0: material.base_color, f90: 1.0, F_ms: F_ms(metal_average(&material)) };

        let strongest = interface(DVec3::splat(material.dielectric_f0.max_element()), material.dielectric_f90);
        let (f0, f90, F_ms) = (strongest.f0.x, strongest.f90, strongest.F_ms.x);
        let E_s = |scale: f64, bias: f64| f0 * scale + f90 * bias + F_ms * (1.0 - scale - bias);
        let coupling =
            Coupling { f0, F_ms, E_s_v: E_s(dfg_v.scale, dfg_v.bias), E_s_avg: E_s(dfg_avg.scale, dfg_avg.bias) };
        let geometry = choices.geometry;
        Self {
            table,
            material,
            local_from_world,
            normal,
            view,
            distribution,
            geometry,
            E_v,
            E_avg,
            dielectric,
            metal,
            coupling,
        }
    }

    /// The facets of the specular lobe.
    pub fn facets(&self) -> Facets {
        let (alpha_x, alpha_y) = self.distribution.alphas();
        Facets {
            world_from_tangent: self.local_from_world.transpose(),
            alpha: DVec2::new(alpha_x, alpha_y),
            clearcoat_alpha: None,
        }
    }

    /// f(l, v), 1/sr, for the unit direction `light`; black below the horizon of the shading normal.
    pub fn evaluate(&self, light: DVec3) -> DVec3 {
        self.components(light).into_iter().sum()
    }

    /// The components whose sum is [`Self::evaluate`].
    pub fn components(&self, light: DVec3) -> PerComponent {
        let NoL = self.normal.dot(light).min(1.0);
        if NoL <= 0.0 {
            return BLACK;
        }
        let light = self.local_from_world * light;
        let h = (light + self.view).normalize_or(DVec3::Z);
        let VoH = self.view.dot(h).clamp(0.0, 1.0);
        let single =
            self.distribution.D(h) * self.geometry.visibility(&self.distribution, self.view, light.with_z(NoL));
        let dfg_l = self.table.dfg(perceptual_roughness_toward(&self.distribution, light), NoL);
        let multiple = f_KullaConty(self.E_v, dfg_l.albedo(), self.E_avg);
        let mixed = |dielectric: DVec3, metal: DVec3| dielectric.lerp(metal, self.material.metallic);
        let fresnel = F_Schlick(self.dielectric.f0, self.dielectric.f90, VoH);

        let c = &self.coupling;
        let E_s_l = c.f0 * dfg_l.scale + self.dielectric.f90 * dfg_l.bias + c.F_ms * (1.0 - dfg_l.albedo());
        let diffuse = self.material.base_color * Fd_Coupled(c.E_s_v, E_s_l, c.E_s_avg);

        let mut components = BLACK;
        components[Component::Diffuse as usize] = mixed(diffuse, DVec3::ZERO);
        components[Component::Specular as usize] = mixed(fresnel, metal_reflectance(&self.material, VoH)) * single;
        components[Component::MultipleScattering as usize] = mixed(self.dielectric.F_ms, self.metal.F_ms) * multiple;
        components
    }
}

/// The perceptual roughness whose isotropic facets have about the albedo that these have along a direction of the
/// tangent frame. Each direction is read by itself, so that light and view can still be exchanged.
///
/// alpha^2 = m (1 - 0.2 d^2 - 0.4 d (x^2 - y^2)), with m the mean of both alpha^2 and d their contrast, was fitted to
/// albedos by quadrature. It stays on the side of less energy where it cannot follow.
fn perceptual_roughness_toward(distribution: &Distribution, direction: DVec3) -> f64 {
    let (mean, contrast) = mean_and_contrast(distribution);
    let lean = direction.x.powi(2) - direction.y.powi(2);
    (mean * (1.0 - 0.2 * contrast * contrast - 0.4 * contrast * lean)).powf(0.25)
}

/// The average of the albedo over directions.
fn average(table: &DirectionalAlbedo, distribution: &Distribution) -> Dfg {
    let (mean, contrast) = mean_and_contrast(distribution);
    table.average((mean * (1.0 - 0.2 * contrast * contrast)).powf(0.25))
}

/// How much of the lost energy is given back. The albedo of anisotropic facets is known within a few hundredths only, so
/// what is given back fades with their contrast: no body may be brighter than the light that falls on it.
fn compensated_share(distribution: &Distribution) -> f64 {
    let (_, contrast) = mean_and_contrast(distribution);
    1.0 - contrast * contrast
}

fn mean_and_contrast(distribution: &Distribution) -> (f64, f64) {
    let (x2, y2) = (distribution.alphas().0.powi(2), distribution.alphas().1.powi(2));
    (0.5 * (x2 + y2), (x2 - y2) / (x2 + y2))
}

fn metal_reflectance(material: &SurfaceMaterial, VoH: f64) -> DVec3 {
    match material.metal_fresnel {
        MetalFresnel::Schlick => F_Schlick(material.base_color, 1.0, VoH),
        MetalFresnel::Lazanyi { a } => F_Lazanyi(material.base_color, a.as_dvec3(), VoH),
        MetalFresnel::Conductor { n, k, .. } => F_conductor(n.as_dvec3(), k.as_dvec3(), VoH),
    }
}

/// Cosine average of the metal's curve; that of Lazanyi's term is 2 int x^2 (1 - x)^6 dx = 1/126.
fn metal_average(material: &SurfaceMaterial) -> DVec3 {
    let schlick = F_Schlick_average(material.base_color, 1.0);
    match material.metal_fresnel {
        MetalFresnel::Schlick => schlick,
        MetalFresnel::Lazanyi { a } | MetalFresnel::Conductor { a, .. } => schlick - a.as_dvec3() / 126.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::quadrature::GaussLegendre;
    use std::f64::consts::{PI, TAU};

    fn white() -> SurfaceMaterial {
        SurfaceMaterial {
            base_color: DVec3::ONE,
            metallic: 0.0,
            perceptual_roughness: 0.5,
            dielectric_f0: DVec3::splat(0.04),
            dielectric_f90: 1.0,
            metal_fresnel: Default::default(),
            anisotropy: None,
        }
    }

    fn view(NoV: f64) -> DVec3 {
        DVec3::new((1.0 - NoV * NoV).sqrt(), 0.0, NoV)
    }

    /// Albedo by product quadrature over the light; good to 1e-5 for perceptual roughness of 0.4 and above.
    fn albedo(material: SurfaceMaterial, NoV: f64, energy_compensation: bool) -> DVec3 {
        let table = DirectionalAlbedo::default();
        let bsdf = Bsdf::new(
            &table,
            material,
            DVec3::Z,
            view(NoV),
            ModelChoices { energy_compensation, ..Default::default() },
        );
        let (polar, azimuth) = (GaussLegendre::new(96), GaussLegendre::new(96));
        let mut sum = DVec3::ZERO;
        // NoL = x^2 spreads the nodes toward the horizon.
        for (x, weight_x) in polar.nodes_on(0.0, 1.0) {
            let (NoL, sin) = (x * x, (1.0 - x.powi(4)).sqrt());
            for (phi, weight_phi) in azimuth.nodes_on(0.0, PI) {
                // Mirror directions lie at phi = pi; light and view are symmetric about the plane of incidence.
                let light = DVec3::new(sin * phi.cos(), sin * phi.sin(), NoL);
                sum += bsdf.evaluate(light) * (2.0 * weight_phi * weight_x * 2.0 * x * NoL);
            }
        }
        sum
    }

    #[test]
    fn a_white_dielectric_reflects_all_light() {
        let mut worst: f64 = 0.0;
        for r in [0.4, 0.6, 0.8, 1.0] {
            for NoV in [0.1, 0.3, 0.6, 0.95] {
                for compensation in [true, false] {
                    let all = albedo(SurfaceMaterial { perceptual_roughness: r, ..white() }, NoV, compensation);
                    worst = worst.max((all - DVec3::ONE).abs().max_element());
                }
            }
        }
        // Measured 4.3e-6, from the interpolation of the directional albedo. Margin 2.
        assert!(worst < 9e-6, "{worst:e}");
    }

    #[test]
    fn a_white_metal_reflects_all_light_with_compensation_and_loses_it_without() {
        for r in [0.5, 1.0] {
            let material = SurfaceMaterial { metallic: 1.0, perceptual_roughness: r, ..white() };
            let (with, without) = (albedo(material, 0.7, true).x, albedo(material, 0.7, false).x);
            assert!((with - 1.0).abs() < 1e-4, "r {r}: {with}");
            let E = super::super::albedo::dfg(r, 0.7).albedo();
            assert!((without - E).abs() < 1e-4, "r {r}: {without} instead of {E}");
        }
    }

    #[test]
    fn coloured_rough_metals_lose_at_every_bounce() {
        let material = SurfaceMaterial {
            metallic: 1.0,
            perceptual_roughness: 1.0,
            base_color: DVec3::new(0.8, 0.5, 1.0),
            ..white()
        };
        let albedo = albedo(material, 0.7, true);
        // The same model by an independent integrator, to the digits printed.
        assert!((albedo.x - 0.6607).abs() < 1e-4 && (albedo.y - 0.3164).abs() < 1e-4, "{albedo}");
    }

    #[test]
    fn light_and_view_can_be_exchanged() {
        let table = DirectionalAlbedo::default();
        let material = SurfaceMaterial {
            base_color: DVec3::new(0.9, 0.4, 0.1),
            metallic: 0.3,
            dielectric_f0: DVec3::new(0.08, 0.02, 0.05),
            dielectric_f90: 0.8,
            perceptual_roughness: 0.37,
            metal_fresnel: MetalFresnel::Lazanyi { a: glam::Vec3::new(1.0, 2.0, 0.5) },
            anisotropy: Some(Anisotropy { tangent: DVec3::X, bitangent: DVec3::Y, strength: 0.7 }),
        };
        for i in 0..200 {
            let direction = |a: f64, b: f64| {
                let z = 0.001 + 0.999 * (a * f64::from(i)).fract();
                let phi = TAU * (b * f64::from(i)).fract();
                let sin = (1.0 - z * z).sqrt();
                DVec3::new(sin * phi.cos(), sin * phi.sin(), z)
            };
            let (a, b) = (direction(0.754_877, 0.569_840), direction(0.618_034, 0.414_213));
            let forth = Bsdf::new(&table, material, DVec3::Z, a, ModelChoices::default()).evaluate(b);
            let back = Bsdf::new(&table, material, DVec3::Z, b, ModelChoices::default()).evaluate(a);
            assert!((forth - back).length() <= 1e-12 * forth.length(), "{a} {b}: {forth} and {back}");
        }
    }

    #[test]
    fn a_perfect_mirror_interface_leaves_no_diffuse_light_and_no_nan() {
        let table = DirectionalAlbedo::default();
        let material = SurfaceMaterial { dielectric_f0: DVec3::ONE, perceptual_roughness: 0.0, ..white() };
        let f = Bsdf::new(&table, material, DVec3::Z, view(0.5), ModelChoices::default()).evaluate(view(0.9));
        // Away from the mirror direction only the tail of D is left: about alpha^2.
        assert!(f.is_finite() && f.max_element() < 1e-4, "{f}");
    }
}
