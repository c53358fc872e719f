//! Directional albedos of the Disney lobes by quadrature: what each returns of light that is the same everywhere.

#![expect(non_snake_case, reason = "equations keep the symbols of their papers")]

use super::{
    CLEARCOAT_F0, CLEARCOAT_MASKING, Fd_Burley, Fd_Subsurface, G1_SmithGGX, Schlick_weight, alpha_of_clearcoat,
    alpha_of_masking, alphas,
};
use crate::reference::albedo::Dfg;
use crate::reference::quadrature::GaussLegendre;
use glam::{DVec2, DVec3};
use std::f64::consts::PI;

/// Albedos of the lobes whose light spreads over the whole hemisphere, for base colour and weight 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DiffuseAlbedo {
    pub burley: f64,
    pub subsurface: f64,
    pub sheen: f64,
}

/// Integrates the lobes; holds the quadrature's nodes so that many calls share them.
#[derive(Debug)]
pub struct DisneyAlbedo {
    polar: GaussLegendre,
    /// Cosines and sines of evenly spaced azimuths.
    azimuths: Vec<DVec2>,
}

impl Default for DisneyAlbedo {
    fn default() -> Self {
        Self::with_nodes(64, 96)
    }
}

impl DisneyAlbedo {
    fn with_nodes(polar: usize, azimuth: usize) -> Self {
        let angle = |i: usize| DVec2::from_angle((i as f64 + 0.5) * 2.0 * PI / azimuth as f64);
        Self { polar: GaussLegendre::new(polar), azimuths: (0..azimuth).map(angle).collect() }
    }

    /// The specular lobe's split-sum pair: its albedo is `scale F0 + bias`. `azimuth_rad` is the view's, from the
    /// tangent.
    pub fn specular(&self, perceptual_roughness: f64, anisotropic: f64, NoV: f64, azimuth_rad: f64) -> Dfg {
        let (x, y) = alphas(perceptual_roughness, anisotropic);
        let masking = alpha_of_masking(perceptual_roughness);
        // The facets of GGX with slope tan psi make up the share sin^2 psi = u of the surface.
        self.over_facets(masking, NoV, azimuth_rad, DVec2::new(x, y), |u| (u / (1.0 - u)).sqrt())
    }

    /// The clearcoat's albedo for weight 1, Fresnel factor included.
    pub fn clearcoat(&self, clearcoat_gloss: f64, NoV: f64) -> f64 {
        let a2 = alpha_of_clearcoat(clearcoat_gloss).powi(2);
        // cos^2 = (1 - a2^(1-u)) / (1 - a2) inverts the share of GTR1's facets below an angle (Burley 2012, appendix
        // B.2).
        let slope = |u: f64| {
            let a2_power = a2.powf(1.0 - u);
            ((a2_power - a2) / (1.0 - a2_power)).max(0.0).sqrt()
        };
        let Dfg { scale, bias } = self.over_facets(CLEARCOAT_MASKING, NoV, 0.0, DVec2::ONE, slope);
        CLEARCOAT_F0 * scale + bias
    }

    /// int F G1 G1 LoH / (NoV NoH) over facets whose slopes are `slope(u)`, stretched; u is even in [0, 1].
    fn over_facets(&self, masking: f64, NoV: f64, azimuth_rad: f64, stretch: DVec2, slope: impl Fn(f64) -> f64) -> Dfg {
        let v = (DVec2::from_angle(azimuth_rad) * (1.0 - NoV * NoV).max(0.0).sqrt()).extend(NoV);
        let from_view = G1_SmithGGX(masking, NoV) / NoV;
        let mut sum = Dfg { scale: 0.0, bias: 0.0 };
        for (u, weight) in self.polar.nodes_with_flat_ends(0.0, 1.0) {
            let radius = slope(u);
            for azimuth in &self.azimuths {
                let h = (radius * stretch * *azimuth).extend(1.0).normalize();
                let LoH = v.dot(h);
                let NoL = 2.0 * LoH * h.z - NoV;
                if LoH <= 0.0 || NoL <= 0.0 {
                    continue;
                }
                let f = weight * from_view * G1_SmithGGX(masking, NoL.min(1.0)) * LoH / h.z;
                let fresnel = Schlick_weight(LoH.min(1.0));
                sum.scale += f * (1.0 - fresnel);
                sum.bias += f * fresnel;
            }
        }
        let count = self.azimuths.len() as f64;
        Dfg { scale: sum.scale / count, bias: sum.bias / count }
    }

    /// The lobes without a peak.
    pub fn diffuse(&self, perceptual_roughness: f64, NoV: f64) -> DiffuseAlbedo {
        let v = DVec3::new((1.0 - NoV * NoV).max(0.0).sqrt(), 0.0, NoV);
        let mut sum = DiffuseAlbedo { burley: 0.0, subsurface: 0.0, sheen: 0.0 };
        for (x, weight) in self.polar.nodes_on(0.0, 1.0) {
            // NoL = x^2 crowds the nodes at the horizon.
            let (NoL, sin) = (x * x, (1.0 - x.powi(4)).sqrt());
            let weight = weight * 2.0 * x * NoL * 2.0 * PI / self.azimuths.len() as f64;
            for azimuth in &self.azimuths {
                let l = (*azimuth * sin).extend(NoL);
                let LoH = (0.5 + 0.5 * l.dot(v)).max(0.0).sqrt();
                sum.burley += weight * Fd_Burley(perceptual_roughness, NoV, NoL, LoH);
                sum.subsurface += weight * Fd_Subsurface(perceptual_roughness, NoV, NoL, LoH);
                sum.sheen += weight * Schlick_weight(LoH.min(1.0));
            }
        }
        sum
    }
}

#[cfg(test)]
mod tests {
    use super::super::bsdf::{DisneyBsdf, DisneyMaterial, TangentFrame};
    use super::*;
    use crate::scene::Disney;

    #[test]
    fn the_quadrature_has_converged() {
        let (fine, coarse) = (DisneyAlbedo::with_nodes(200, 192), DisneyAlbedo::default());
        let mut worst: f64 = 0.0;
        for r in [0.0, 0.1, 0.4, 1.0] {
            for NoV in [0.01, 0.1, 0.5, 1.0] {
                for (anisotropic, azimuth) in [(0.0, 0.0), (1.0, 0.2), (1.0, 1.4)] {
                    let (a, b) =
                        (coarse.specular(r, anisotropic, NoV, azimuth), fine.specular(r, anisotropic, NoV, azimuth));
                    worst = worst.max((a.scale - b.scale).abs()).max((a.bias - b.bias).abs());
                }
                worst = worst.max((coarse.clearcoat(r, NoV) - fine.clearcoat(r, NoV)).abs());
                let (a, b) = (coarse.diffuse(r, NoV), fine.diffuse(r, NoV));
                worst = worst.max((a.burley - b.burley).abs()).max((a.subsurface - b.subsurface).abs());
                worst = worst.max((a.sheen - b.sheen).abs());
            }
        }
        // Measured 3.1e-4, where the horizon cuts through the lobe of a rough, stretched surface. Margin 1.6.
        assert!(worst < 5e-4, "{worst:e}");
    }

    /// The albedo of the whole BSDF by brute force over light directions.
    fn by_light(material: &DisneyMaterial, view: DVec3) -> f64 {
        let bsdf = DisneyBsdf::new(material, TangentFrame::LOCAL, view);
        let rule = GaussLegendre::new(192);
        let ring = |NoL: f64, phi: f64| {
            let sin = (1.0 - NoL * NoL).sqrt();
            bsdf.evaluate(DVec3::new(sin * phi.cos(), sin * phi.sin(), NoL)).x * NoL
        };
        rule.nodes_on(0.0, 1.0)
            .map(|(x, weight)| weight * 2.0 * x * rule.integrate(0.0, 2.0 * PI, |phi| ring(x * x, phi)))
            .sum()
    }

    #[test]
    fn the_lobes_add_up_to_the_bsdf() {
        let albedo = DisneyAlbedo::default();
        let parameters = Disney {
            subsurface: 0.3,
            anisotropic: 0.8,
            sheen: 0.7,
            clearcoat: 1.0,
            clearcoat_gloss: 0.0,
            ..Disney::default()
        };
        for (r, azimuth, NoV) in [(0.5, 0.3, 0.8_f64), (0.8, 1.2, 0.4), (1.0, 0.7, 0.15)] {
            let material =
                DisneyMaterial { base_color: DVec3::splat(0.6), metallic: 0.25, perceptual_roughness: r, parameters };
            let view = (DVec2::from_angle(azimuth) * (1.0 - NoV * NoV).sqrt()).extend(NoV);
            let specular = albedo.specular(r, f64::from(parameters.anisotropic), NoV, azimuth);
            let diffuse = albedo.diffuse(r, NoV);
            let f0 = super::super::specular_f0(material.base_color, 0.25, 0.5, 0.0).x;
            let below = diffuse.burley + (diffuse.subsurface - diffuse.burley) * f64::from(parameters.subsurface);
            let sum = f0 * specular.scale
                + specular.bias
                + 0.75 * (0.6 * below + f64::from(parameters.sheen) * diffuse.sheen)
                + 0.25 * albedo.clearcoat(0.0, NoV);
            let expected = by_light(&material, view);
            // Measured 1.1e-4, margin 3.
            assert!((sum / expected - 1.0).abs() < 3e-4, "{r} {azimuth} {NoV}: {sum} instead of {expected}");
        }
    }

    /// Smallest and largest albedo of a white material over perceptual roughness and view.
    fn range(albedo: &DisneyAlbedo, metallic: f64, disney: Disney) -> [f64; 2] {
        let [subsurface, sheen, clearcoat, gloss] =
            [disney.subsurface, disney.sheen, disney.clearcoat, disney.clearcoat_gloss].map(f64::from);
        let at = |r: f64, NoV: f64| {
            let f0 = super::super::specular_f0(DVec3::ONE, metallic, f64::from(disney.specular), 0.0).x;
            let (specular, smooth) = (albedo.specular(r, 0.0, NoV, 0.0), albedo.diffuse(r, NoV));
            let below = smooth.burley + (smooth.subsurface - smooth.burley) * subsurface + sheen * smooth.sheen;
            f0 * specular.scale
                + specular.bias
                + below * (1.0 - metallic)
                + 0.25 * clearcoat * albedo.clearcoat(gloss, NoV)
        };
        let steps = || (0..=20).map(|i| f64::from(i) / 20.0);
        let all = steps().flat_map(|r| steps().map(move |x| (r, (x * x).max(1e-3)))).map(|(r, NoV)| at(r, NoV));
        all.fold([f64::INFINITY, 0.0], |[least, most], E| [least.min(E), most.max(E)])
    }

    #[test]
    fn white_materials_return_what_the_document_says() {
        let albedo = DisneyAlbedo::default();
        let neutral = Disney::default();
        let cases = [
            ("dielectric, specular 0", 0.0, Disney { specular: 0.0, ..neutral }, [0.491, 1.575]),
            ("neutral dielectric", 0.0, neutral, [0.491, 1.599]),
            ("specular 1", 0.0, Disney { specular: 1.0, ..neutral }, [0.491, 1.623]),
            ("subsurface 1", 0.0, Disney { subsurface: 1.0, ..neutral }, [0.633, 1.553]),
            ("sheen 1", 0.0, Disney { sheen: 1.0, ..neutral }, [0.579, 1.687]),
            ("clearcoat 1, gloss 0", 0.0, Disney { clearcoat: 1.0, clearcoat_gloss: 0.0, ..neutral }, [0.539, 1.648]),
            ("metal", 1.0, neutral, [0.000, 1.000]),
        ];
        for (name, metallic, disney, expected) in cases {
            let [least, most] = range(&albedo, metallic, disney);
            let off = (least - expected[0]).abs().max((most - expected[1]).abs());
            assert!(off < 2e-3, "{name}: {least} to {most} instead of {expected:?}");
        }
    }
}
