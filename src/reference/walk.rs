//! Light among the facets of a rough surface, reflection by reflection: the truth for multiple scattering.
//!
//! Heitz, Hanika, d'Eon and Dachsbacher 2016, "Multiple-Scattering Microfacet BSDFs with the Smith Model". The facets are
//! a volume of GGX flakes below a rough top: a ray at the height h, with the share C1(h) of the surface below it, meets the
//! next facet after a free path of known distribution, is mirrored at one of the normals that it sees, and goes on until
//! it leaves. Directions of the walk depend on C1(h) alone and so on no distribution of heights.

#![expect(non_snake_case, reason = "equations keep the symbols of their papers")]

use super::microfacet::distribution::Lambda_GGX_anisotropic;
use super::sampling::{PixelSampler, sample_visible_normal};
use glam::{DVec2, DVec3};

/// A surface to walk on: GGX facets that mirror.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Microsurface {
    /// Alphas along +X and +Y, in (0, 1].
    pub alpha: DVec2,
}

/// Where a walk has come to.
#[derive(Debug, Clone, Copy)]
struct State {
    /// Unit direction of travel.
    direction: DVec3,
    /// C1: the share of the surface below, in (0, 1]; 1 above everything.
    below: f64,
}

/// One facet on a walk.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reflection {
    /// Cosine between the ray and the facet's normal, in [0, 1]: what a Fresnel factor wants to know.
    pub cosine: f64,
}

impl Microsurface {
    /// Signed Lambda (Heitz et al. 2016, appendix A): that of Smith upward, and -1 minus it downward.
    fn Lambda(&self, w: DVec3) -> f64 {
        let Lambda = Lambda_GGX_anisotropic(self.alpha.x, self.alpha.y, w.x, w.y, w.z.abs());
        if w.z > 0.0 { Lambda } else { -1.0 - Lambda }
    }

    /// Goes on to the next facet (Heitz et al. 2016, section 4.2); `None` when the ray leaves the surface.
    ///
    /// The ray passes the heights up to h' with probability (C1(h) / C1(h'))^Lambda, for an upward ray at most to C1 = 1.
    fn advance(&self, state: State, u: f64) -> Option<State> {
        let Lambda = self.Lambda(state.direction);
        if Lambda == 0.0 {
            return None;
        }
        let below = state.below * (1.0 - u).powf(-1.0 / Lambda);
        (below < 1.0).then_some(State { below, ..state })
    }

    /// Sends a ray against `view`, a unit vector with z above 0, and calls `visit` at every facet it meets; `draw` gives
    /// numbers in (0, 1). Returns the direction in which it leaves, or `None` if `visit` ends the walk by `false`.
    pub fn walk(
        &self,
        view: DVec3,
        mut draw: impl FnMut() -> f64,
        mut visit: impl FnMut(Reflection) -> bool,
    ) -> Option<DVec3> {
        let mut state = State { direction: -view, below: 1.0 };
        while let Some(next) = self.advance(state, draw()) {
            let back = -next.direction;
            let facet = sample_visible_normal(self.alpha, back, DVec2::new(draw(), draw()));
            let cosine = back.dot(facet).clamp(0.0, 1.0);
            if !visit(Reflection { cosine }) {
                return None;
            }
            state = State { direction: (2.0 * cosine * facet - back).normalize(), ..next };
        }
        Some(state.direction)
    }
}

/// Albedo by number of reflections for several colours of conductor or coat.
#[derive(Debug, Clone, PartialEq)]
pub struct WalkAlbedo<const N: usize> {
    /// Share of light that leaves, for each F0.
    pub all: [f64; N],
    /// What of it has met one facet only.
    pub single: [f64; N],
    /// Standard error of `all` if the walks were independent; they are stratified, and their mean is better than that.
    pub standard_error: [f64; N],
}

/// Facets after which a walk is taken for lost. A share of the light leaves at each, so that none comes this far.
const LONGEST_WALK: u32 = 10_000;

/// Directional albedo of a surface with Schlick's Fresnel factor, F90 = 1, from `walks` random walks.
///
/// Light that is not reflected at a facet is gone: absorbed by a metal, sent below by a dielectric.
pub fn albedo<const N: usize>(
    surface: Microsurface,
    view: DVec3,
    f0: [f64; N],
    walks: u32,
    seed: u64,
) -> WalkAlbedo<N> {
    let (mut all, mut single, mut squares) = ([0.0; N], [0.0; N], [0.0; N]);
    for index in 0..walks {
        let mut numbers = Numbers::new(seed, index);
        let (mut weights, mut facets) = ([1.0; N], 0);
        let left = surface.walk(
            view,
            || numbers.next(),
            |Reflection { cosine }| {
                let tail = (1.0 - cosine).powi(5);
                weights.iter_mut().zip(f0).for_each(|(weight, f0)| *weight *= f0 + (1.0 - f0) * tail);
                facets += 1;
                facets < LONGEST_WALK
            },
        );
        if left.is_none() {
            continue;
        }
        for i in 0..N {
            all[i] += weights[i];
            squares[i] += weights[i] * weights[i];
            single[i] += if facets == 1 { weights[i] } else { 0.0 };
        }
    }
    let count = f64::from(walks);
    let standard_error =
        std::array::from_fn(|i| ((squares[i] / count - (all[i] / count).powi(2)).max(0.0) / count).sqrt());
    WalkAlbedo { all: all.map(|sum| sum / count), single: single.map(|sum| sum / count), standard_error }
}

/// Numbers of one walk. Pairs of each step are low-discrepancy over the walks.
#[derive(Debug)]
pub struct Numbers {
    sampler: PixelSampler,
    index: u32,
    dimension: u32,
    spare: Option<f64>,
}

impl Numbers {
    pub fn new(seed: u64, index: u32) -> Self {
        Self { sampler: PixelSampler::new(seed, 0, 0), index, dimension: 0, spare: None }
    }

    /// The next number in (0, 1).
    #[expect(clippy::should_implement_trait, reason = "numbers do not end")]
    pub fn next(&mut self) -> f64 {
        if let Some(spare) = self.spare.take() {
            return spare;
        }
        let pair = self.sampler.pair(self.index, self.dimension);
        self.dimension += 1;
        self.spare = Some(pair.y);
        pair.x
    }
}

#[cfg(test)]
mod tests {
    use super::super::albedo::dfg;
    use super::super::brdf::{D_GGX, V_SmithGGXCorrelated};
    use super::super::tests::chi_square_of_directions;
    use super::*;

    fn view(NoV: f64) -> DVec3 {
        DVec3::new((1.0 - NoV * NoV).sqrt(), 0.0, NoV)
    }

    fn isotropic(alpha: f64) -> Microsurface {
        Microsurface { alpha: DVec2::splat(alpha) }
    }

    /// Where a walk leaves after how many facets, or `None` if it would meet more than `most`.
    fn leave(surface: Microsurface, NoV: f64, numbers: &mut Numbers, most: u32) -> Option<(DVec3, u32)> {
        let mut facets = 0;
        let left = surface.walk(
            view(NoV),
            || numbers.next(),
            |_| {
                facets += 1;
                facets <= most
            },
        );
        left.map(|left| (left, facets))
    }

    #[test]
    fn all_light_leaves_white_facets_and_none_of_it_downward() {
        for alpha in [DVec2::splat(0.01), DVec2::splat(1.0), DVec2::new(1.0, 0.1)] {
            for NoV in [0.05, 0.9] {
                let albedo = albedo(Microsurface { alpha }, view(NoV), [1.0], 20_000, 1);
                assert_eq!(albedo.all, [1.0], "{alpha} {NoV}");
                for index in 0..2000 {
                    let mut numbers = Numbers::new(2, index);
                    let (left, _) = leave(Microsurface { alpha }, NoV, &mut numbers, LONGEST_WALK).unwrap();
                    assert!(left.z > 0.0 && left.is_normalized(), "{left}");
                }
            }
        }
    }

    #[test]
    fn single_reflections_have_the_albedo_of_the_lobe() {
        let mut worst: f64 = 0.0;
        for r in [0.2_f64, 0.5, 0.8, 1.0] {
            for NoV in [0.1, 0.5, 0.95] {
                let walked = albedo(isotropic(r * r), view(NoV), [1.0, 0.5, 0.0], 65_536, 3).single;
                let pair = dfg(r, NoV);
                for (walked, f0) in walked.into_iter().zip([1.0, 0.5, 0.0]) {
                    worst = worst.max((walked - (f0 * pair.scale + pair.bias)).abs());
                }
            }
        }
        // Measured 9.8e-4 with 65 536 walks; margin 2.
        assert!(worst < 2e-3, "{worst:e}");
    }

    #[test]
    fn single_reflections_leave_as_the_lobe_sends_them() {
        // Chi-square of the walk against D V NoL, which share neither each other's code nor their derivation. Walks that
        // take another number of reflections are put at the nadir, where the density has what is missing to 1.
        for (alpha, NoV) in [(0.4_f64, 0.4), (1.0, 0.8)] {
            let surface = isotropic(alpha);
            let E = dfg(alpha.sqrt(), NoV).albedo();
            let sample = |u: DVec2| {
                let mut numbers = Numbers::new(u.x.to_bits() ^ u.y.to_bits().rotate_left(32), 0);
                let left = leave(surface, NoV, &mut numbers, 1);
                left.map_or(DVec3::new(1e-3, 1e-4, -1.0).normalize(), |(left, _)| left)
            };
            let nadir = |l: DVec3| {
                let in_cell =
                    l.z < -0.875 && l.x > 0.0 && (0.0..l.x * (std::f64::consts::PI / 16.0).tan()).contains(&l.y);
                if in_cell { (1.0 - E) / (4.0 * std::f64::consts::PI / 512.0) } else { 0.0 }
            };
            let pdf = |l: DVec3| {
                if l.z <= 0.0 {
                    return nadir(l);
                }
                let h = (view(NoV) + l).normalize();
                D_GGX(alpha, h.z) * V_SmithGGXCorrelated(alpha, NoV, l.z) * l.z
            };
            let chi = chi_square_of_directions(sample, pdf);
            assert!(chi.is_plausible(), "alpha {alpha}, NoV {NoV}: {chi:?}");
        }
    }

    #[test]
    fn light_and_view_can_be_exchanged_after_several_reflections() {
        // Share of light from a ring of directions that leaves into another after 2 or more facets, both ways.
        let surface = isotropic(0.8);
        let flow = |from: f64, to: f64, seed: u64| {
            const WALKS: u32 = 200_000;
            let mut count = 0.0;
            for index in 0..WALKS {
                let mut numbers = Numbers::new(seed, index);
                // Even in NoV^2 is as the cosine has it.
                let NoV = (from * from + numbers.next() * 0.2).sqrt();
                let Some((left, facets)) = leave(surface, NoV, &mut numbers, LONGEST_WALK) else { continue };
                let ring = left.z * left.z - to * to;
                count += f64::from(u8::from(facets > 1 && (0.0..0.2).contains(&ring)));
            }
            count / f64::from(WALKS)
        };
        let (forth, back) = (flow(0.2, 0.8, 5), flow(0.8, 0.2, 6));
        // Measured 0.4 %, the noise of 17 000 walks each; margin 5.
        assert!((forth / back - 1.0).abs() < 0.02, "{forth} and {back}");
    }
}
