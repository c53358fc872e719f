//! The Disney BRDF at one point, seen from one direction.

#![expect(non_snake_case, reason = "equations keep the symbols of their papers")]

use super::{
    CLEARCOAT_F0, CLEARCOAT_MASKING, CLEARCOAT_WEIGHT, D_GTR1, D_GTR2_anisotropic, Fd_Burley, Fd_Subsurface,
    G1_SmithGGX, Schlick_weight, alpha_of_clearcoat, alpha_of_masking, alphas, specular_f0, tint,
};
use crate::reference::bsdf::{BLACK, PerComponent, SMALLEST_NOV};
use crate::reference::techniques::Facets;
use crate::scene::{Component, Disney};
use glam::{DMat3, DVec2, DVec3};
use std::f64::consts::PI;

/// A material with all of its parameters, textures and vertex colours multiplied in.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DisneyMaterial {
    /// Linear Rec.709 in [0, 1].
    pub base_color: DVec3,
    /// In [0, 1].
    pub metallic: f64,
    /// In [0, 1].
    pub perceptual_roughness: f64,
    pub parameters: Disney,
}

/// Orthonormal vectors at a point: the surface is roughest along the tangent. The sign of either does not matter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TangentFrame {
    pub tangent: DVec3,
    pub bitangent: DVec3,
    pub normal: DVec3,
}

impl TangentFrame {
    /// `normal` is a unit vector; of `tangent` only the part across it counts, and any direction if there is none.
    pub fn new(normal: DVec3, tangent: DVec3) -> Self {
        let (any, _) = crate::math::spaces::orthonormal_basis(normal);
        let tangent = (tangent - normal * normal.dot(tangent)).normalize_or(any);
        Self { tangent, bitangent: normal.cross(tangent), normal }
    }

    /// The frame whose normal is +Z and whose tangent is +X.
    pub const LOCAL: Self = Self { tangent: DVec3::X, bitangent: DVec3::Y, normal: DVec3::Z };
}

/// The BRDF of a point for one direction of view.
#[derive(Debug, Clone, Copy)]
pub struct DisneyBsdf {
    frame: TangentFrame,
    view: DVec3,
    NoV: f64,
    perceptual_roughness: f64,
    alphas: (f64, f64),
    /// Base colour without its metallic part.
    diffuse: DVec3,
    subsurface: f64,
    f0: DVec3,
    sheen: DVec3,
    clearcoat: f64,
    clearcoat_alpha: f64,
}

impl DisneyBsdf {
    /// `view` points away from the surface and is above its horizon, a unit vector as those of the frame.
    pub fn new(material: &DisneyMaterial, frame: TangentFrame, view: DVec3) -> Self {
        let DisneyMaterial { base_color, metallic, perceptual_roughness, parameters } = *material;
        let number = f64::from;
        let sheen_color = DVec3::ONE.lerp(tint(base_color), number(parameters.sheen_tint));
        let (specular, specular_tint) = (number(parameters.specular), number(parameters.specular_tint));
        Self {
            frame,
            view,
            NoV: frame.normal.dot(view).clamp(SMALLEST_NOV, 1.0),
            perceptual_roughness,
            alphas: alphas(perceptual_roughness, number(parameters.anisotropic)),
            diffuse: base_color * (1.0 - metallic),
            subsurface: number(parameters.subsurface),
            f0: specular_f0(base_color, metallic, specular, specular_tint),
            sheen: sheen_color * (number(parameters.sheen) * (1.0 - metallic)),
            clearcoat: CLEARCOAT_WEIGHT * number(parameters.clearcoat),
            clearcoat_alpha: alpha_of_clearcoat(number(parameters.clearcoat_gloss)),
        }
    }

    /// The facets of the specular lobe and of the clearcoat, if there is one.
    pub fn facets(&self) -> Facets {
        let TangentFrame { tangent, bitangent, normal } = self.frame;
        Facets {
            world_from_tangent: DMat3::from_cols(tangent, bitangent, normal),
            alpha: DVec2::new(self.alphas.0, self.alphas.1),
            clearcoat_alpha: (self.clearcoat > 0.0).then_some(self.clearcoat_alpha),
        }
    }

    /// f(l, v), 1/sr, for the unit direction `light`; black below the horizon of the shading normal.
    pub fn evaluate(&self, light: DVec3) -> DVec3 {
        self.components(light).into_iter().sum()
    }

    /// The components whose sum is [`Self::evaluate`].
    pub fn components(&self, light: DVec3) -> PerComponent {
        let NoL = self.frame.normal.dot(light).min(1.0);
        if NoL <= 0.0 {
            return BLACK;
        }
        let h = (light + self.view).normalize_or(self.frame.normal);
        let [ToH, BoH, NoH] = [self.frame.tangent, self.frame.bitangent, self.frame.normal].map(|axis| axis.dot(h));
        let LoH = light.dot(h).clamp(0.0, 1.0);
        let fresnel = Schlick_weight(LoH);

        let D = D_GTR2_anisotropic(self.alphas.0, self.alphas.1, ToH, BoH, NoH);
        let masking = alpha_of_masking(self.perceptual_roughness);
        let mut components = BLACK;
        components[Component::Specular as usize] = self.f0.lerp(DVec3::ONE, fresnel) * (D * self.masked(masking, NoL));

        let clearcoat = CLEARCOAT_F0 + (1.0 - CLEARCOAT_F0) * fresnel;
        let clearcoat = clearcoat * D_GTR1(self.clearcoat_alpha, NoH) * self.masked(CLEARCOAT_MASKING, NoL);
        components[Component::Clearcoat as usize] = DVec3::splat(self.clearcoat * clearcoat);

        let Fd = Fd_Burley(self.perceptual_roughness, self.NoV, NoL, LoH);
        let Fss = Fd_Subsurface(self.perceptual_roughness, self.NoV, NoL, LoH);
        components[Component::Diffuse as usize] = self.diffuse * (Fd + (Fss - Fd) * self.subsurface);
        components[Component::Sheen as usize] = self.sheen * fresnel;
        components
    }

    /// Separable masking and shadowing over 4 NoV NoL.
    fn masked(&self, alpha: f64, NoL: f64) -> f64 {
        G1_SmithGGX(alpha, self.NoV) * G1_SmithGGX(alpha, NoL) / (4.0 * self.NoV * NoL)
    }
}

/// Density of the facets that [`sample_clearcoat_normal`] draws, by mirrored direction, 1/sr. Local frame, both unit.
pub fn pdf_clearcoat_reflection(alpha: f64, v: DVec3, l: DVec3) -> f64 {
    let h = (l + v).normalize_or(DVec3::Z);
    let VoH = v.dot(h);
    if VoH <= 0.0 || h.z <= 0.0 { 0.0 } else { D_GTR1(alpha, h.z) * h.z / (4.0 * VoH) }
}

/// A facet of the GTR1 distribution with density D NoH (Burley 2012, appendix B), for `u` in (0, 1)^2.
pub fn sample_clearcoat_normal(alpha: f64, u: glam::DVec2) -> DVec3 {
    let a2 = alpha * alpha;
    let cos2 = ((1.0 - a2.powf(1.0 - u.x)) / (1.0 - a2)).clamp(0.0, 1.0);
    let (sin_phi, cos_phi) = (2.0 * PI * u.y).sin_cos();
    let sin = (1.0 - cos2).sqrt();
    DVec3::new(sin * cos_phi, sin * sin_phi, cos2.sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reference::tests::chi_square_of_directions;

    #[test]
    fn light_and_view_can_be_exchanged() {
        let parameters = Disney {
            subsurface: 0.4,
            anisotropic: 0.7,
            sheen: 0.9,
            sheen_tint: 0.5,
            clearcoat: 1.0,
            clearcoat_gloss: 0.3,
            ..Disney::default()
        };
        let base_color = DVec3::new(0.8, 0.3, 0.1);
        let material = DisneyMaterial { base_color, metallic: 0.3, perceptual_roughness: 0.6, parameters };
        let at = |view| DisneyBsdf::new(&material, TangentFrame::LOCAL, view);
        for i in 0..200 {
            let direction = |a: f64, b: f64| {
                let z = 0.001 + 0.999 * (a * f64::from(i)).fract();
                let (sin, phi) = ((1.0 - z * z).sqrt(), 2.0 * PI * (b * f64::from(i)).fract());
                DVec3::new(sin * phi.cos(), sin * phi.sin(), z)
            };
            let (a, b) = (direction(0.754_877, 0.569_840), direction(0.618_034, 0.414_213));
            let (forth, back) = (at(a).evaluate(b), at(b).evaluate(a));
            assert!((forth - back).length() <= 1e-12 * forth.length(), "{a} {b}: {forth} and {back}");
        }
    }

    #[test]
    fn clearcoat_facets_follow_their_density() {
        for alpha in [0.3, 0.5, 0.9] {
            let pdf = |h: DVec3| if h.z > 0.0 { D_GTR1(alpha, h.z) * h.z } else { 0.0 };
            let chi = chi_square_of_directions(|u| sample_clearcoat_normal(alpha, u), pdf);
            assert!(chi.is_plausible(), "alpha {alpha}: {chi:?}");
        }
    }
}
