//! Random numbers that cover space evenly, and directions made of them.

#![expect(non_snake_case, reason = "equations keep the symbols of their papers")]

use super::microfacet::distribution::{D_GGX_anisotropic, Lambda_GGX_anisotropic};
use glam::{DVec2, DVec3};
use std::f64::consts::{PI, TAU};

/// Low-discrepancy pairs of one pixel: the first two dimensions of Sobol's sequence, Owen-scrambled and shuffled by
/// hashing (Burley 2020, "Practical Hash-based Owen Scrambling"), so that pairs of different dimensions and pixels are
/// independent. The same seed gives the same numbers on any number of threads.
#[derive(Debug, Clone, Copy)]
pub struct PixelSampler {
    seed: u64,
}

impl PixelSampler {
    pub fn new(seed: u64, x: u32, y: u32) -> Self {
        Self { seed: mix(mix(seed) ^ (u64::from(x) << 32 | u64::from(y))) }
    }

    /// Point `index` of the sequence for the purpose `dimension`, in (0, 1)^2.
    pub fn pair(&self, index: u32, dimension: u32) -> DVec2 {
        let seed = mix(self.seed ^ (u64::from(dimension) + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15));
        let index = owen_scramble(index, seed as u32);
        let seeds = mix(seed);
        let x = owen_scramble(index.reverse_bits(), seeds as u32);
        let y = owen_scramble(sobol_second(index), (seeds >> 32) as u32);
        // The centre of the interval that the 32 bits stand for: never 0, never 1.
        DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5) / 4_294_967_296.0
    }
}

/// A bijective hash of 64 bits (Steele, Lea and Flood 2014, the finalizer of SplitMix64).
fn mix(mut x: u64) -> u64 {
    x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ (x >> 31)
}

/// Owen scrambling in base 2 by the hash of Laine and Karras (2011), with Vegdahl's constants (2021).
fn owen_scramble(x: u32, seed: u32) -> u32 {
    let mut x = x.reverse_bits();
    x ^= x.wrapping_mul(0x3d20_adea);
    x = x.wrapping_add(seed);
    x = x.wrapping_mul((seed >> 16) | 1);
    x ^= x.wrapping_mul(0x0552_6c56);
    x ^= x.wrapping_mul(0x53a2_2864);
    x.reverse_bits()
}

/// Second dimension of Sobol's sequence; its direction numbers are the rows of Pascal's triangle modulo 2.
fn sobol_second(index: u32) -> u32 {
    let mut direction = 1_u32 << 31;
    let mut point = 0;
    for bit in 0..32 {
        if index >> bit & 1 == 1 {
            point ^= direction;
        }
        direction ^= direction >> 1;
    }
    point
}

/// A direction about +Z with density cos(theta) / pi: a uniform disk, projected up.
pub fn sample_cosine_hemisphere(u: DVec2) -> DVec3 {
    let (sin, cos) = (TAU * u.y).sin_cos();
    let radius = u.x.sqrt();
    DVec3::new(radius * cos, radius * sin, (1.0 - u.x).sqrt())
}

/// Density of [`sample_cosine_hemisphere`], 1/sr.
pub fn pdf_cosine_hemisphere(NoL: f64) -> f64 {
    NoL.max(0.0) / PI
}

/// A microfacet normal among those that `v` sees (Heitz 2018, "Sampling the GGX Distribution of Visible Normals", in the
/// spherical-cap form of Dupuy and Benyoub 2023). Tangent frame: `alpha` along +X and +Y, surface normal +Z; `v` is a unit
/// vector. It may point below the horizon, as light does that was scattered upward among facets.
pub fn sample_visible_normal(alpha: DVec2, v: DVec3, u: DVec2) -> DVec3 {
    let stretch = alpha.extend(1.0);
    let v = (v * stretch).normalize();
    // Mirror images of v on a unit sphere of facets fill the cap z > -v.z evenly; the facet bisects.
    let z = (1.0 - u.x) * (1.0 + v.z) - v.z;
    let radius = (1.0 - z * z).max(0.0).sqrt();
    let (sin, cos) = (TAU * u.y).sin_cos();
    ((DVec3::new(radius * cos, radius * sin, z) + v) * stretch).normalize_or(DVec3::Z)
}

/// Density, 1/sr, of the directions `l` in which `v` is mirrored by [`sample_visible_normal`]: G1 D / (4 NoV)
/// (Heitz 2018, equations 3 and 17). Tangent frame, both unit, v.z > 0.
pub fn pdf_visible_normal_reflection(alpha: DVec2, v: DVec3, l: DVec3) -> f64 {
    let h = (l + v).normalize_or_zero();
    if h.z <= 0.0 {
        return 0.0;
    }
    let D = D_GGX_anisotropic(alpha.x, alpha.y, h.x, h.y, h.z);
    D / (4.0 * v.z * (1.0 + Lambda_GGX_anisotropic(alpha.x, alpha.y, v.x, v.y, v.z)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reference::tests::{ChiSquare, chi_square_of_directions};
    use glam::Vec2Swizzles;

    #[test]
    fn pairs_are_stratified_in_every_elementary_interval() {
        let sampler = PixelSampler::new(7, 3, 5);
        for dimension in 0..4 {
            for (columns, rows) in [(64, 1), (16, 4), (8, 8), (2, 32), (1, 64)] {
                let mut seen = vec![0; 64];
                for index in 0..64 {
                    let p = sampler.pair(index, dimension);
                    seen[(p.x * columns as f64) as usize * rows + (p.y * rows as f64) as usize] += 1;
                }
                assert!(seen.iter().all(|&count| count == 1), "dimension {dimension}, {columns} x {rows}: {seen:?}");
            }
        }
    }

    #[test]
    fn pixels_and_dimensions_do_not_repeat_each_other() {
        let first = |seed, x, y, dimension| PixelSampler::new(seed, x, y).pair(0, dimension).to_array();
        let points = [first(1, 0, 0, 0), first(1, 1, 0, 0), first(1, 0, 1, 0), first(2, 0, 0, 0), first(1, 0, 0, 1)];
        for (i, a) in points.iter().enumerate() {
            assert!(points[..i].iter().all(|b| a != b), "{points:?}");
        }
    }

    #[test]
    fn cosine_samples_follow_their_density() {
        let chi = chi_square_of_directions(sample_cosine_hemisphere, |l| pdf_cosine_hemisphere(l.z));
        assert!(chi.is_plausible(), "{chi:?}");
    }

    /// Chi-square of the directions in which mirrored light leaves.
    fn chi_square_of_mirrored(alpha: DVec2, v: DVec3, pdf_alpha: DVec2) -> ChiSquare {
        let sample = |u| {
            let h = sample_visible_normal(alpha, v, u);
            2.0 * v.dot(h) * h - v
        };
        chi_square_of_directions(sample, |l| pdf_visible_normal_reflection(pdf_alpha, v, l))
    }

    fn direction(cos: f64, azimuth_rad: f64) -> DVec3 {
        (DVec2::from_angle(azimuth_rad) * (1.0 - cos * cos).sqrt()).extend(cos)
    }

    #[test]
    fn mirrored_visible_normals_follow_their_density() {
        for (alpha, cos_v) in [(0.15, 0.9), (0.15, 0.2), (0.5, 0.6), (1.0, 0.05)] {
            let alpha = DVec2::splat(alpha);
            let chi = chi_square_of_mirrored(alpha, direction(cos_v, PI), alpha);
            assert!(chi.is_plausible(), "alpha {alpha}, NoV {cos_v}: {chi:?}");
        }
    }

    #[test]
    fn mirrored_visible_normals_of_anisotropic_facets_follow_their_density() {
        for (x, y, cos_v, azimuth) in [(0.8, 0.15, 0.7, 0.3), (0.2, 1.0, 0.3, 2.0), (0.4, 0.2, 0.1, -1.1)] {
            let (alpha, v) = (DVec2::new(x, y), direction(cos_v, azimuth));
            let chi = chi_square_of_mirrored(alpha, v, alpha);
            assert!(chi.is_plausible(), "{alpha}, NoV {cos_v}: {chi:?}");
            let exchanged = chi_square_of_mirrored(alpha, v, alpha.yx());
            assert!(!exchanged.is_plausible(), "{alpha} exchanged, NoV {cos_v}: {exchanged:?}");
        }
    }

    #[test]
    fn a_wrong_density_is_found_out() {
        let chi = chi_square_of_directions(sample_cosine_hemisphere, |l| 0.97 * pdf_cosine_hemisphere(l.z) + 0.0024);
        assert!(!chi.is_plausible(), "{chi:?}");
    }
}
