//! Measured metals: complex index of refraction at three wavelengths, and the approximations fitted to it.

#![expect(non_snake_case, reason = "equations keep the symbols of their papers")]

use super::fresnel::{F_conductor, conductor, lazanyi_shape};
use crate::math::quadrature::GaussLegendre;
use crate::reference::brdf::F_Schlick;
use crate::scene::{Material, MetalFresnel};
use glam::DVec3;

/// A metal at 650, 550 and 450 nm, which stand for red, green and blue.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Metal {
    /// Chemical symbols, in lower case: the name on the command line.
    pub symbol: &'static str,
    pub name: &'static str,
    /// Index of refraction n + i k.
    pub n: DVec3,
    pub k: DVec3,
    /// Who measured it.
    pub source: &'static str,
    /// Factor of the term -a cos (1 - cos)^6 in [`super::fresnel::F_Lazanyi`], as [`fit_a`] finds it.
    pub a: DVec3,
}

const LYNCH_HUNTER: &str =
    "Lynch and Hunter 1985, in Palik (ed.), Handbook of Optical Constants of Solids; interpolated";
const JOHNSON_CHRISTY: &str = "Johnson and Christy 1974, Phys. Rev. B 9, 5056; interpolated";

/// The table. `n` and `k` are as published, interpolated to the three wavelengths; `a` is fitted.
pub const METALS: [Metal; 7] = [
    Metal {
        symbol: "ag",
        name: "silver",
        n: DVec3::new(0.1394, 0.1248, 0.1517),
        k: DVec3::new(4.1288, 3.3396, 2.4704),
        source: LYNCH_HUNTER,
        a: DVec3::new(0.302, 0.229, 0.061),
    },
    Metal {
        symbol: "al",
        name: "aluminium",
        n: DVec3::new(1.4748, 0.9586, 0.6180),
        k: DVec3::new(7.7941, 6.6870, 5.4694),
        source: "Smith, Shiles and Inokuti 1985, in Palik (ed.), Handbook of Optical Constants of Solids; interpolated",
        a: DVec3::new(2.015, 1.558, 1.168),
    },
    Metal {
        symbol: "au",
        name: "gold",
        n: DVec3::new(0.1678, 0.3504, 1.5085),
        k: DVec3::new(3.1378, 2.7141, 1.8788),
        source: LYNCH_HUNTER,
        a: DVec3::new(0.270, 0.317, 0.268),
    },
    Metal {
        symbol: "cu",
        name: "copper",
        n: DVec3::new(0.2166, 0.9582, 1.1658),
        k: DVec3::new(3.6377, 2.5771, 2.3939),
        source: LYNCH_HUNTER,
        a: DVec3::new(0.423, 0.662, 0.613),
    },
    Metal {
        symbol: "cuzn",
        name: "brass (70 % copper, 30 % zinc)",
        n: DVec3::new(0.444, 0.527, 1.094),
        k: DVec3::new(3.695, 2.765, 1.829),
        source: "Querry 1985, Contractor Report CRDC-CR-85034",
        a: DVec3::new(0.812, 0.499, -0.446),
    },
    Metal {
        symbol: "fe",
        name: "iron",
        n: DVec3::new(2.9114, 2.9497, 2.5845),
        k: DVec3::new(3.0893, 2.9318, 2.7670),
        source: JOHNSON_CHRISTY,
        a: DVec3::new(3.104, 3.060, 2.601),
    },
    Metal {
        symbol: "ti",
        name: "titanium",
        n: DVec3::new(2.7407, 2.5418, 2.2670),
        k: DVec3::new(3.8143, 3.4345, 3.0385),
        source: JOHNSON_CHRISTY,
        a: DVec3::new(3.263, 2.944, 2.460),
    },
];

impl Metal {
    /// The metal of a symbol, as "au".
    pub fn by_symbol(symbol: &str) -> Option<&'static Self> {
        METALS.iter().find(|metal| metal.symbol.eq_ignore_ascii_case(symbol))
    }

    /// Reflectance at normal incidence: ((n - 1)^2 + k^2) / ((n + 1)^2 + k^2).
    pub fn f0(&self) -> DVec3 {
        F_conductor(self.n, self.k, 1.0)
    }

    /// Reflectance at cos = 1/7, 82 degrees.
    pub fn f82(&self) -> DVec3 {
        F_conductor(self.n, self.k, 1.0 / 7.0)
    }

    /// The exact curve, as a material holds it.
    pub fn conductor(&self) -> MetalFresnel {
        MetalFresnel::Conductor { n: self.n.as_vec3(), k: self.k.as_vec3(), a: self.a.as_vec3() }
    }

    /// A material of this metal; `fresnel` is [`Self::conductor`] or an approximation of it.
    pub fn material(&self, perceptual_roughness: f32, metal_fresnel: MetalFresnel) -> Material {
        let base_color = self.f0().as_vec3().extend(1.0);
        Material { base_color, metallic: 1.0, perceptual_roughness, metal_fresnel, ..Default::default() }
    }

    /// [`fit_a`] of each channel.
    pub fn fit_a(&self) -> DVec3 {
        let channel = |i: usize| fit_a(self.n[i], self.k[i]);
        DVec3::new(channel(0), channel(1), channel(2))
    }
}

/// The a for which Schlick's curve minus a cos (1 - cos)^6 is nearest, in least squares over cos in [0, 1], to the exact
/// reflectance of a metal of index n + i k.
pub fn fit_a(n: f64, k: f64) -> f64 {
    let f0 = DVec3::splat(conductor(n, k, 1.0));
    let excess = |VoH: f64| F_Schlick(f0, 1.0, VoH).x - conductor(n, k, VoH);
    let projection = GaussLegendre::new(64).integrate(0.0, 1.0, |VoH| excess(VoH) * lazanyi_shape(VoH));
    // int c^2 (1 - c)^12 dc = 2! 12! / 15!.
    projection * 1365.0
}

#[cfg(test)]
mod tests {
    use super::super::Fresnel;
    use super::*;

    #[test]
    fn the_table_holds_what_the_fit_finds() {
        for metal in METALS {
            // The table has three decimals.
            let difference = (metal.a - metal.fit_a()).abs().max_element();
            assert!(difference <= 5.1e-4, "{}: {} instead of {}", metal.symbol, metal.a, metal.fit_a());
            assert_eq!(Metal::by_symbol(&metal.symbol.to_uppercase()), Some(Metal::by_symbol(metal.symbol).unwrap()));
        }
    }

    #[test]
    fn metals_have_their_known_colours() {
        // F0 to three decimals, of an independent prototype.
        let expected = [
            ("ag", [0.970, 0.960, 0.918]),
            ("al", [0.912, 0.921, 0.924]),
            ("au", [0.940, 0.847, 0.386]),
            ("cu", [0.941, 0.634, 0.553]),
            ("cuzn", [0.887, 0.789, 0.434]),
            ("fe", [0.531, 0.512, 0.496]),
            ("ti", [0.616, 0.582, 0.546]),
        ];
        for (symbol, f0) in expected {
            let difference = (Metal::by_symbol(symbol).unwrap().f0() - DVec3::from(f0)).abs().max_element();
            // 1.6e-3 for the blue of titanium, which lies between two published wavelengths; else rounding.
            assert!(difference < if symbol == "ti" { 2e-3 } else { 6e-4 }, "{symbol}: {difference}");
        }
    }

    #[test]
    fn the_documentation_lists_the_table() {
        let document = include_str!("../../../docs/microfacets.md");
        for metal in METALS {
            let three = |color: DVec3| color.to_array().map(|channel| format!("{channel:.3}")).join(" ");
            let name = metal.name.split(' ').next().unwrap();
            let row = format!("| {name} | {} | {} |\n", three(metal.f0()), three(metal.a));
            assert!(document.contains(&row), "docs/microfacets.md has another row than\n{row}");
        }
    }

    /// Largest difference from the exact curve, of each metal and channel.
    fn largest_errors(approximate: impl Fn(&Metal) -> Fresnel) -> Vec<f64> {
        let of_metal = |metal: &Metal| {
            let (exact, approximate) = (Fresnel::of_metal(metal), approximate(metal));
            let error = |i: i32| {
                let VoH = f64::from(i) / 1000.0;
                (exact.reflectance(VoH) - approximate.reflectance(VoH)).abs()
            };
            (0..=1000).map(error).fold(DVec3::ZERO, DVec3::max).to_array()
        };
        METALS.iter().flat_map(of_metal).collect()
    }

    fn mean_and_worst(errors: &[f64]) -> (f64, f64) {
        (errors.iter().sum::<f64>() / errors.len() as f64, errors.iter().copied().fold(0.0, f64::max))
    }

    #[test]
    fn approximations_are_as_far_off_as_documented() {
        let schlick = largest_errors(|metal| Fresnel::schlick(metal.f0(), 1.0).unwrap());
        let lazanyi = largest_errors(|metal| Fresnel::lazanyi(metal.f0(), metal.a).unwrap());
        let f82 = largest_errors(|metal| Fresnel::f82(metal.f0(), metal.f82()).unwrap());
        // Mean of the largest errors and the worst of them, as in docs/microfacets.md.
        for (errors, mean, worst) in [(schlick, 0.0740, 0.1850), (lazanyi, 0.0101, 0.0231), (f82, 0.0105, 0.0224)] {
            let found = mean_and_worst(&errors);
            assert!((found.0 - mean).abs() < 1e-4 && (found.1 - worst).abs() < 1e-4, "{found:?}, not {mean}, {worst}");
        }
    }
}
