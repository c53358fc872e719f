//! Models of what light does after its first facet, side by side, to be measured against random walks.

#![expect(non_snake_case, reason = "equations keep the symbols of their papers")]

use super::albedo::Dfg;
use super::brdf::{
    D_GGX, F_KullaConty, F_Schlick, F_Schlick_average, F_multiscatter, V_SmithGGXCorrelated, f_KullaConty,
};
use glam::DVec3;
use std::f64::consts::PI;

/// How a lobe of single reflections is given back its energy.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Compensation {
    /// Not at all.
    None,
    /// Kulla and Conty 2017: a reciprocal lobe of its own.
    KullaConty,
    /// The same lobe with the share of light that leaves at the second and later facets as random walks have it, in place
    /// of [`E_avg`](Dfg), which is that of the first: see [`super::brdf::later_escape`]. What the renderer has.
    KullaContyWalk,
    /// Turquin 2019, "Practical multiple scattering compensation for microfacet models", as Filament has it: the single
    /// lobe times 1 + F0 (1 - E) / E.
    Turquin,
    /// Fdez-Aguera 2019, "A Multiple-Scattering Microfacet Model for Real-Time Image-based Lighting": diffuse light.
    FdezAguera,
}

impl Compensation {
    pub const ALL: [Self; 5] = [Self::None, Self::KullaConty, Self::KullaContyWalk, Self::Turquin, Self::FdezAguera];

    /// The name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::KullaConty => "Kulla-Conty",
            Self::KullaContyWalk => "Kulla-Conty, escape by walks",
            Self::Turquin => "Turquin",
            Self::FdezAguera => "Fdez-Aguera",
        }
    }

    /// Albedo of the light that has met more than one facet, with Schlick's factor and F90 = 1. `pair` is of the view,
    /// `average` its cosine average.
    pub fn multiple_albedo(self, pair: Dfg, average: Dfg, f0: f64) -> f64 {
        let (E, missing) = (pair.albedo(), 1.0 - pair.albedo());
        let single = f0 * pair.scale + pair.bias;
        let F_avg = F_Schlick_average(DVec3::splat(f0), 1.0);
        match self {
            Self::None => 0.0,
            Self::KullaConty => F_KullaConty(F_avg, average.albedo()).x * missing,
            Self::KullaContyWalk => F_multiscatter(F_avg, average.albedo()).x * missing,
            Self::Turquin => single * f0 * missing / E,
            Self::FdezAguera => missing * single * F_avg.x / (1.0 - F_avg.x * missing),
        }
    }

    /// BRDF of the same light, 1/sr, for unit vectors above +Z; `pair_l` is of the light.
    pub fn multiple(
        self,
        alpha: f64,
        f0: f64,
        (v, l): (DVec3, DVec3),
        (pair_v, pair_l, average): (Dfg, Dfg, Dfg),
    ) -> f64 {
        let albedo = self.multiple_albedo(pair_v, average, f0);
        match self {
            Self::None => 0.0,
            Self::KullaConty | Self::KullaContyWalk => {
                // The albedo is F_ms (1 - E(v)).
                let F_ms = albedo / (1.0 - pair_v.albedo());
                F_ms * f_KullaConty(pair_v.albedo(), pair_l.albedo(), average.albedo())
            }
            Self::Turquin => {
                let h = (v + l).normalize();
                let single = F_Schlick(DVec3::splat(f0), 1.0, v.dot(h)).x
                    * D_GGX(alpha, h.z)
                    * V_SmithGGXCorrelated(alpha, v.z, l.z);
                single * f0 * (1.0 - pair_v.albedo()) / pair_v.albedo()
            }
            Self::FdezAguera => albedo / PI,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::albedo::DfgIntegrator;
    use super::super::walk::{self, Microsurface};
    use super::*;
    use glam::DVec2;

    #[test]
    fn all_but_none_return_all_light_to_white_facets() {
        let integrator = DfgIntegrator::default();
        for r in [0.3, 1.0] {
            let (pair, average) = (integrator.dfg(r, 0.6), integrator.dfg_average(r));
            for model in Compensation::ALL {
                let all = pair.albedo() + model.multiple_albedo(pair, average, 1.0);
                let expected = if model == Compensation::None { pair.albedo() } else { 1.0 };
                assert!((all - expected).abs() < 1e-9, "{model:?}: {all}");
            }
        }
    }

    #[test]
    fn kulla_conty_is_the_nearest_to_random_walks_of_rough_metals_and_nearer_with_their_escape() {
        let integrator = DfgIntegrator::default();
        let f0 = [0.8, 0.5];
        let mut squares = [0.0; 5];
        for r in [0.6_f64, 0.8, 1.0] {
            let average = integrator.dfg_average(r);
            for NoV in [0.2_f64, 0.5, 0.9] {
                let view = DVec3::new((1.0 - NoV * NoV).sqrt(), 0.0, NoV);
                let truth = walk::albedo(Microsurface { alpha: DVec2::splat(r * r) }, view, f0, 65_536, 1).all;
                let pair = integrator.dfg(r, NoV);
                for (square, model) in squares.iter_mut().zip(Compensation::ALL) {
                    for (truth, f0) in truth.iter().zip(f0) {
                        let all = f0 * pair.scale + pair.bias + model.multiple_albedo(pair, average, f0);
                        *square += (all / truth - 1.0).powi(2) / 18.0;
                    }
                }
            }
        }
        let [none, kulla_conty, by_walks, turquin, fdez_aguera] = squares.map(f64::sqrt);
        let errors = format!("{none:.4}, {kulla_conty:.4}, {by_walks:.4}, {turquin:.4}, {fdez_aguera:.4}");
        // Measured 0.2963, 0.0422, 0.0176, 0.0431, 0.0501.
        assert!(kulla_conty < turquin && turquin < fdez_aguera && fdez_aguera < 0.25 * none, "{errors}");
        assert!(by_walks < 0.5 * kulla_conty, "{errors}");
    }
}
