//! The table: every WGSL function of `shaders/{brdf,lobe,light,color,math}` with its grid, its twin and its bound.
//!
//! Twins are in the algebra of the papers; arguments that a shader clamps are clamped here to the stated domain.
//! Limits of closed forms are a few roundings, eps each. Limits of the curves of a display are measured on llvmpipe
//! (Mesa 22.3.6), times a margin for the slack that WGSL leaves other drivers in pow and log2.

use super::grid::{ALPHAS, COSINES, UNIT, colors, directions, display_light, microfacets, product, spread};
use super::truth::{self, vec3};
use super::twin::{Scale, Twin};
use crate::math::color::srgb_from_linear;
use crate::math::spaces::{octahedral_from_direction, orthonormal_basis};
use crate::reference::albedo::Dfg;
use crate::reference::microfacet::Distribution;
use crate::reference::microfacet::distribution::D_GGX_anisotropic;
use crate::reference::microfacet::fresnel::{F_Lazanyi, F_conductor};
use crate::reference::microfacet::masking::{V_Schlick, V_SmithGGX_separable, V_SmithGGXCorrelated_anisotropic};
use crate::reference::{brdf, color, disney, lights};
use crate::scene::{Geometry, ToneMap};
use glam::{DMat4, DVec3, DVec4};

const EPS: f64 = f32::EPSILON as f64;

pub const TWINS: &[Twin] = &[
    Twin {
        file: "math/vectors.wgsl",
        function: "normalize_or",
        grid: vectors,
        truth: truth::normalize_or,
        // Components of a unit vector: a small one carries the error of none but itself, yet the fallback is exact.
        scale: Scale::One,
        limit: 8.0 * EPS,
    },
    Twin {
        file: "math/half_range.wgsl",
        function: "clamp_to_half",
        grid: || product(&[&[0.0, 1e-40, 1.0, 65503.0, 65504.0, 65520.0, 1e30, f32::INFINITY], &[0.5], &[7e4]]),
        truth: |x| x.iter().map(|x| x.min(65504.0)).collect(),
        scale: Scale::One,
        limit: 0.0,
    },
    Twin {
        file: "math/octahedral.wgsl",
        function: "octahedral_from_direction",
        grid: || directions(4000).iter().map(|d| d.to_array().to_vec()).collect(),
        truth: |x| octahedral_from_direction(vec3(x, 0)).to_array().into(),
        // Texture coordinates.
        scale: Scale::One,
        limit: 4.0 * EPS,
    },
    Twin {
        file: "brdf/d_ggx.wgsl",
        function: "D_GGX",
        grid: || microfacets(&ALPHAS),
        // The truth for vectors that are of unit length only to f32: their directions.
        truth: |x| vec![brdf::D_GGX(x[0], vec3(x, 1).normalize().dot(vec3(x, 4).normalize()))],
        scale: Scale::Result,
        // The chord of vectors that are a rounding too long: (1e-7 / alpha)^2 at alpha = 1e-4, and ten roundings.
        limit: 2e-6,
    },
    Twin {
        file: "brdf/v_smith_ggx_correlated.wgsl",
        function: "V_SmithGGXCorrelated",
        grid: || product(&[&ALPHAS, &COSINES, &[&[0.0], COSINES.as_slice()].concat()]),
        // The paper's form is 0/0 at NoL = 0; 1e-15 gives its limit to 1e-9.
        truth: |x| vec![brdf::V_SmithGGXCorrelated(x[0], x[1], x[2].max(1e-15))],
        scale: Scale::Result,
        limit: 8.0 * EPS,
    },
    Twin {
        file: "brdf/f_schlick.wgsl",
        function: "F_Schlick_weight",
        grid: || product(&[&[&[-1e-3, -1e-7, 0.0, 1.0 + 1e-7, 1.01], COSINES.as_slice()].concat()]),
        truth: |x| vec![brdf::F_Schlick(DVec3::ZERO, 1.0, x[0].clamp(0.0, 1.0)).x],
        scale: Scale::Result,
        limit: 8.0 * EPS,
    },
    Twin {
        file: "brdf/f_schlick.wgsl",
        function: "F_Schlick",
        grid: || product(&[&UNIT, &[0.04], &[1.0], &UNIT, &COSINES]),
        truth: |x| brdf::F_Schlick(vec3(x, 0), x[3], x[4].clamp(0.0, 1.0)).to_array().into(),
        // F90 below F0 makes a difference of two reflectances.
        scale: Scale::Terms(|x| x[0].max(x[1]).max(x[2]).max(x[3])),
        limit: 4.0 * EPS,
    },
    Twin {
        file: "brdf/f_schlick.wgsl",
        function: "F_Schlick_average",
        grid: || product(&[&UNIT, &[0.04], &[1.0], &UNIT]),
        truth: |x| brdf::F_Schlick_average(vec3(x, 0), x[3]).to_array().into(),
        scale: Scale::Terms(|x| x[0].max(x[1]).max(x[2]).max(x[3])),
        limit: 4.0 * EPS,
    },
    Twin {
        file: "brdf/f_lazanyi.wgsl",
        function: "F_Lazanyi_weight",
        grid: || product(&[&COSINES]),
        truth: |x| vec![x[0] * (1.0 - x[0]).powi(6)],
        scale: Scale::Result,
        limit: 8.0 * EPS,
    },
    Twin {
        file: "brdf/f_lazanyi.wgsl",
        function: "F_Lazanyi",
        grid: || product(&[&UNIT, &[0.5], &[0.9], &[-0.5, 0.0, 3.3], &[0.7], &[2.0], &COSINES]),
        truth: |x| F_Lazanyi(vec3(x, 0), vec3(x, 3), x[6]).to_array().into(),
        // A difference: a cos (1 - cos)^6 is up to 0.06 a.
        scale: Scale::One,
        limit: 4.0 * EPS,
    },
    Twin {
        file: "brdf/f_conductor.wgsl",
        function: "F_conductor",
        grid: || product(&[&[0.05, 0.2, 1.0, 3.0], &[0.3], &[2.9], &[0.0, 1.5, 4.0, 8.0], &[3.0], &[3.3], &COSINES]),
        truth: |x| F_conductor(vec3(x, 0), vec3(x, 3), x[6]).to_array().into(),
        // Reflectances of a transparent medium near 0 are squares of a difference.
        scale: Scale::One,
        limit: 16.0 * EPS,
    },
    Twin {
        file: "brdf/d_ggx_anisotropic.wgsl",
        function: "D_GGX_anisotropic",
        grid: || [anisotropic_frames(), anisotropic_microfacets()].concat(),
        truth: |x| {
            let (t, b, n, h) = (vec3(x, 2), vec3(x, 5), vec3(x, 8).normalize(), vec3(x, 11).normalize());
            // What is left of t and b along n in f32 is no property of the surface.
            let [t, b] = [t, b].map(|axis| axis - n * n.dot(axis));
            vec![D_GGX_anisotropic(x[0], x[1], t.dot(h), b.dot(h), n.dot(h))]
        },
        scale: Scale::Result,
        // A frame of f32 vectors is askew by a rounding, 6e-8, which the smallest alpha here, 1e-3, magnifies where h is
        // far from n along the wide direction. Measured 7.6e-5.
        limit: 1.5e-4,
    },
    Twin {
        file: "brdf/v_smith_ggx_correlated_anisotropic.wgsl",
        function: "V_SmithGGXCorrelated_anisotropic",
        grid: anisotropic_directions,
        truth: |x| vec![V_SmithGGXCorrelated_anisotropic(x[0], x[1], x[2], x[3], x[4], x[5], x[6], x[7].max(1e-15))],
        scale: Scale::Result,
        limit: 8.0 * EPS,
    },
    Twin {
        file: "math/orthonormal.wgsl",
        function: "any_orthonormal",
        grid: || directions(4000).iter().map(|d| d.to_array().to_vec()).collect(),
        truth: |x| orthonormal_basis(vec3(x, 0)).0.to_array().into(),
        // Components of a unit vector.
        scale: Scale::One,
        limit: 4.0 * EPS,
    },
    Twin {
        file: "brdf/d_gtr1.wgsl",
        function: "D_GTR1",
        grid: || microfacets(&ALPHAS).into_iter().filter(|x| x[0] < 1.0).collect(),
        truth: |x| vec![disney::D_GTR1(x[0], vec3(x, 1).normalize().dot(vec3(x, 4).normalize()))],
        scale: Scale::Result,
        // Measured 4.9e-7, margin 3: as D_GGX, with the square of the denominator left out.
        limit: 1.5e-6,
    },
    Twin {
        file: "brdf/g1_smith_ggx.wgsl",
        function: "G1_SmithGGX",
        grid: || product(&[&ALPHAS, &[&[0.0], COSINES.as_slice()].concat()]),
        truth: |x| vec![if x[1] > 0.0 { disney::G1_SmithGGX(x[0], x[1]) } else { 0.0 }],
        scale: Scale::Result,
        limit: 8.0 * EPS,
    },
    Twin {
        file: "brdf/v_smith_ggx_separable.wgsl",
        function: "V_SmithGGX_separable",
        grid: || product(&[&ALPHAS, &COSINES, &[&[0.0], COSINES.as_slice()].concat()]),
        truth: |x| vec![V_SmithGGX_separable(x[0], x[1], x[2].max(1e-15))],
        scale: Scale::Result,
        limit: 8.0 * EPS,
    },
    Twin {
        file: "brdf/fd_burley.wgsl",
        function: "Fd_Burley",
        grid: || product(&[&UNIT, &COSINES, &[&[0.0], COSINES.as_slice()].concat(), &COSINES]),
        truth: |x| vec![disney::Fd_Burley(x[0], x[1], x[2], x[3])],
        // No factor is below 1/2.
        scale: Scale::Result,
        limit: 8.0 * EPS,
    },
    Twin {
        file: "brdf/v_schlick.wgsl",
        function: "V_Schlick",
        grid: || product(&[&ALPHAS, &COSINES, &[&[0.0], COSINES.as_slice()].concat()]),
        truth: |x| vec![V_Schlick(x[0], x[1], x[2].max(1e-15))],
        scale: Scale::Result,
        limit: 8.0 * EPS,
    },
    visibility("lobe/visibility_smith_correlated.wgsl", |x| geometry(Geometry::SmithCorrelated, x)),
    visibility("lobe/visibility_smith_separable.wgsl", |x| geometry(Geometry::SmithSeparable, x)),
    visibility("lobe/visibility_schlick_half_alpha.wgsl", |x| geometry(Geometry::SchlickHalfAlpha, x)),
    visibility("lobe/visibility_schlick_karis.wgsl", |x| geometry(Geometry::SchlickKaris, x)),
    visibility("lobe/visibility_schlick_lecture.wgsl", |x| geometry(Geometry::SchlickLecture, x)),
    visibility_anisotropic("lobe/visibility_anisotropic_smith_correlated.wgsl", |x| {
        geometry_anisotropic(Geometry::SmithCorrelated, x)
    }),
    visibility_anisotropic("lobe/visibility_anisotropic_smith_separable.wgsl", |x| {
        geometry_anisotropic(Geometry::SmithSeparable, x)
    }),
    Twin {
        file: "brdf/fd_subsurface.wgsl",
        function: "Fd_Subsurface",
        grid: || product(&[&UNIT, &COSINES, &[&[0.0], COSINES.as_slice()].concat(), &COSINES]),
        truth: |x| vec![disney::Fd_Subsurface(x[0], x[1], x[2], x[3])],
        // F_ss vanishes where both cosines and alpha do; its terms are of the size of 1 / (NoV + NoL).
        scale: Scale::Terms(|x| 1.0 + 1.0 / (x[1] + x[2])),
        limit: 8.0 * EPS,
    },
    Twin {
        file: "brdf/fd_lambert.wgsl",
        function: "Fd_Lambert",
        grid: || vec![vec![]],
        truth: |_| vec![brdf::Fd_Lambert()],
        scale: Scale::Result,
        limit: EPS,
    },
    Twin {
        file: "lobe/albedo.wgsl",
        function: "E_specular",
        grid: albedos,
        truth: |x| {
            let dfg = Dfg { scale: x[3], bias: x[4] };
            let single = dfg.with_fresnel(DVec3::splat(x[0]), x[1]).x;
            vec![(single + x[2] * (1.0 - dfg.albedo())).clamp(0.0, 1.0)]
        },
        // Shares of energy; it is the complement of the result that is used.
        scale: Scale::One,
        limit: 4.0 * EPS,
    },
    Twin {
        file: "lobe/multiscatter_kulla_conty.wgsl",
        function: "F_multiscatter",
        // GGX has E_avg from 0.409 on.
        grid: || product(&[&UNIT, &[0.04], &[1.0], &[0.4, 0.5, 0.7, 0.9, 0.99, 0.9999, 1.0]]),
        truth: |x| brdf::F_multiscatter(vec3(x, 0), x[3]).to_array().into(),
        // Sums and products of what is not negative.
        scale: Scale::Result,
        limit: 16.0 * EPS,
    },
    Twin {
        file: "lobe/multiscatter_none.wgsl",
        function: "F_multiscatter",
        grid: || product(&[&UNIT, &[0.04], &[1.0], &[0.4, 1.0]]),
        truth: |_| vec![0.0; 3],
        scale: Scale::One,
        limit: 0.0,
    },
    Twin {
        file: "light/attenuation.wgsl",
        function: "distance_attenuation",
        grid: distances,
        truth: |x| {
            let range_m = (x[0] > 0.0).then(|| x[0].sqrt().recip());
            let distance_m = x[1].sqrt();
            vec![lights::distance_falloff(distance_m) * lights::range_window(range_m, distance_m)]
        },
        // The window is a difference that vanishes at the range; the inverse square is what it is taken from.
        scale: Scale::Terms(|x| lights::distance_falloff(x[1].sqrt())),
        limit: 8.0 * EPS,
    },
    Twin {
        file: "light/attenuation.wgsl",
        function: "spot_attenuation",
        grid: cones,
        truth: |x| {
            let (scale, cos_outer) = (x[0], -x[1] / x[0]);
            let cos_inner = (cos_outer + 1.0 / scale).min(1.0);
            vec![lights::spot_cone(cos_inner.acos(), cos_outer.acos(), x[2])]
        },
        // Scale and offset are as large as the cone is narrow, and their sum is in [0, 1].
        scale: Scale::Terms(|x| x[0].max(1.0)),
        limit: 8.0 * EPS,
    },
    Twin {
        file: "light/irradiance_sh.wgsl",
        function: "irradiance_linear_sh",
        grid: irradiances,
        truth: |x| half_sum(&irradiance_form(x, 1.0), &irradiance_form(x, -1.0), -1.0),
        scale: Scale::Terms(|x| x[..36].iter().map(|c| c.abs()).sum()),
        limit: 8.0 * EPS,
    },
    Twin {
        file: "light/irradiance_sh.wgsl",
        function: "irradiance_quadratic_sh",
        grid: irradiances,
        truth: |x| {
            let even = half_sum(&irradiance_form(x, 1.0), &irradiance_form(x, -1.0), 1.0);
            even.iter().zip(x).map(|(even, mean)| even - mean).collect()
        },
        scale: Scale::Terms(|x| x[..36].iter().map(|c| c.abs()).sum()),
        limit: 8.0 * EPS,
    },
    Twin {
        file: "light/irradiance_sh.wgsl",
        function: "irradiance_over_pi_sh",
        grid: irradiances,
        truth: |x| irradiance_form(x, 1.0).into_iter().map(|sum| sum.max(0.0)).collect(),
        // A sum of nine that may cancel.
        scale: Scale::Terms(|x| x[..36].iter().map(|c| c.abs()).sum()),
        limit: 8.0 * EPS,
    },
    Twin {
        file: "color/srgb.wgsl",
        function: "srgb_from_linear",
        grid: display_light,
        truth: |x| x.iter().map(|&x| srgb_from_linear(x)).collect(),
        scale: Scale::One,
        // Measured 2.1e-7, margin 5. Half a step of 16 bits is 7.6e-6.
        limit: 1e-6,
    },
    Twin {
        file: "color/encode_srgb.wgsl",
        function: "encode",
        grid: display_light,
        truth: |x| x.iter().map(|&x| srgb_from_linear(x)).collect(),
        scale: Scale::One,
        limit: 1e-6,
    },
    Twin {
        file: "color/encode_linear.wgsl",
        function: "encode",
        grid: display_light,
        truth: |x| x.iter().map(|x| x.clamp(0.0, 1.0)).collect(),
        scale: Scale::One,
        limit: 0.0,
    },
    // Measured 1.2e-7, margin 4.
    Twin { limit: 5e-7, ..tone_map("color/tone_map_neutral.wgsl", |x| display(ToneMap::Neutral, x)) },
    // Measured 3.2e-7, margin 3.
    Twin { limit: 1e-6, ..tone_map("color/tone_map_aces.wgsl", |x| display(ToneMap::Aces, x)) },
    // Measured 5.7e-6, margin 2: terms of up to 40 cancel in the fit of the contrast curve.
    Twin { limit: 1.2e-5, ..tone_map("color/tone_map_agx.wgsl", |x| display(ToneMap::AgX, x)) },
    Twin { limit: 4.0 * EPS, ..tone_map("color/tone_map_reinhard.wgsl", |x| display(ToneMap::Reinhard, x)) },
    Twin { limit: 0.0, ..tone_map("color/tone_map_linear.wgsl", |x| display(ToneMap::Linear, x)) },
];

/// A tone map: what matters of its error is what reaches the display.
const fn tone_map(file: &'static str, truth: fn(&[f64]) -> Vec<f64>) -> Twin {
    Twin { file, function: "tone_map", grid: colors, truth, scale: Scale::One, limit: 0.0 }
}

fn display(curve: ToneMap, exposed: &[f64]) -> Vec<f64> {
    color::tone_map(curve, vec3(exposed, 0)).to_array().into()
}

/// Two alphas, an orthonormal frame and a half vector: angles of many sizes in units of the alphas.
fn anisotropic_microfacets() -> Vec<Vec<f32>> {
    let with_frame = |(i, point): (usize, Vec<f32>)| {
        let n = glam::Vec3::from_slice(&point[1..]).as_dvec3().normalize();
        let side = n.any_orthonormal_vector();
        let turn = std::f64::consts::TAU * f64::from(spread(i, 3));
        let t = side * turn.cos() + n.cross(side) * turn.sin();
        let b = n.cross(t);
        // From ten times as rough along the tangent to ten times as rough across it.
        let ratio = 10.0_f32.powf(2.0 * spread(i, 4) - 1.0);
        let alphas = [point[0] * ratio.sqrt(), point[0] / ratio.sqrt()].map(|alpha| alpha.max(1e-4));
        [&alphas, t.as_vec3().as_ref() as &[f32], b.as_vec3().as_ref(), &point[1..]].concat()
    };
    microfacets(&ALPHAS).into_iter().enumerate().map(with_frame).collect()
}

/// Directions of many lengths, those included whose square underflows, and a fallback.
fn vectors() -> Vec<Vec<f32>> {
    let lengths =
        [0.0, 1e-40, 1e-32, 1e-28, 1e-20, 1e-16, 3e-15, 1e-6, 0.3, 1.0, 1.0 + 1e-6, 1e5, 1e18, 1e20, 1e36, 3e38];
    let all = directions(100).into_iter().flat_map(|d| lengths.map(|length| d * length));
    all.map(|v| [v.to_array(), [0.6, -0.48, 0.64]].concat()).collect()
}

/// Fresnel values and split-sum pairs. The 16-bit table's pairs can add up to a little more than 1.
fn albedos() -> Vec<Vec<f32>> {
    let pairs = [[1.0, 0.0], [0.0, 1.0], [0.97, 0.03], [0.5, 0.1], [0.3, 0.2], [0.05, 0.4], [0.999_98, 4e-5]];
    let fresnel = product(&[&UNIT, &UNIT, &UNIT]);
    fresnel.iter().flat_map(|f| pairs.map(|pair| [f.as_slice(), &pair].concat())).collect()
}

/// Distances from nothing to beyond the ranges, in metres, squared as the shader has them.
fn distances() -> Vec<Vec<f32>> {
    let ranges = [0.0, 0.02, 0.5, 1.0, 3.0, 10.0, 1000.0_f32];
    let inverse = ranges.map(|range| if range > 0.0 { (range * range).recip() } else { 0.0 });
    let relative = [0.0, 1e-3, 0.01, 0.1, 0.3, 0.5, 0.7, 0.9, 0.99, 0.999, 1.0, 1.001, 1.5, 30.0];
    let absolute = [1e-20, 1e-6, 5e-3, 0.01, 0.02, 0.7, 20.0, 1e4, 1e10, 1e18, 1e20_f32];
    let of_range = ranges.iter().flat_map(|range| relative.iter().map(move |x| x * range));
    let squares: Vec<f32> = of_range.chain(absolute).map(|distance| distance * distance).collect();
    product(&[&inverse, &squares])
}

/// Cones from needles to half spaces, as scale and offset, and cosines across them.
fn cones() -> Vec<Vec<f32>> {
    let cones: [(f64, f64); 7] =
        [(0.0, 0.01), (0.0, 0.1), (0.1, 0.1), (0.2, 0.6), (0.5, 0.501), (0.3, 1.2), (0.0, 1.57)];
    let mut points = Vec::new();
    for (inner, outer) in cones {
        let scale = 1.0 / (inner.cos() - outer.cos()).max(1e-3);
        let across = (-8..=24).map(|i| outer.cos() + f64::from(i) / 16.0 / scale);
        let cosines = across.chain([-1.0, 0.0, 1.0]).map(|x| x.clamp(-1.0, 1.0));
        points.extend(cosines.map(|x| vec![scale as f32, (-outer.cos() * scale) as f32, x as f32]));
    }
    points
}

/// Each coefficient alone, then mixtures: a strong sun that rings below zero among them.
fn irradiances() -> Vec<Vec<f32>> {
    let mut sets: Vec<Vec<f32>> = (0..9).map(unit_coefficient).collect();
    let random = |i: usize| (0..36).map(|c| 4.0 * spread(i * 36 + c, c as u32 % 6) - 2.0).collect();
    sets.extend((0..20).map(random));
    let normals = directions(40);
    let with_normals =
        |set: &Vec<f32>| normals.iter().map(|n| [set, n.as_ref() as &[f32]].concat()).collect::<Vec<_>>();
    sets.iter().flat_map(with_normals).collect()
}

fn unit_coefficient(k: usize) -> Vec<f32> {
    (0..36).map(|i| if i / 4 == k { 1.0 + (i % 4) as f32 } else { 0.0 }).collect()
}

/// Half of a + `sign` b.
fn half_sum(a: &[f64], b: &[f64], sign: f64) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| 0.5 * (a + sign * b)).collect()
}

/// Ramamoorthi and Hanrahan 2001, equation 12: the quadratic form of (n, 1) with a symmetric matrix for each channel, at
/// `side` times n.
fn irradiance_form(x: &[f64], side: f64) -> Vec<f64> {
    let n = (vec3(x, 36) * side).extend(1.0);
    let channel = |channel: usize| {
        let c = |k: usize| x[4 * k + channel];
        let matrix = DMat4::from_cols(
            DVec4::new(c(8), 0.5 * c(4), 0.5 * c(7), 0.5 * c(3)),
            DVec4::new(0.5 * c(4), -c(8), 0.5 * c(5), 0.5 * c(1)),
            DVec4::new(0.5 * c(7), 0.5 * c(5), 3.0 * c(6), 0.5 * c(2)),
            DVec4::new(0.5 * c(3), 0.5 * c(1), 0.5 * c(2), c(0) - c(6)),
        );
        n.dot(matrix * n)
    };
    (0..3).map(channel).collect()
}

const fn visibility(file: &'static str, truth: fn(&[f64]) -> Vec<f64>) -> Twin {
    let grid = || product(&[&ALPHAS, &COSINES, &[&[0.0], COSINES.as_slice()].concat()]);
    Twin { file, function: "visibility", grid, truth, scale: Scale::Result, limit: 8.0 * EPS }
}

const fn visibility_anisotropic(file: &'static str, truth: fn(&[f64]) -> Vec<f64>) -> Twin {
    let grid = anisotropic_directions;
    Twin { file, function: "visibility_anisotropic", grid, truth, scale: Scale::Result, limit: 8.0 * EPS }
}

/// A direction with a cosine; where along the surface it leans is of no account to isotropic facets.
fn leaning(cos: f64) -> DVec3 {
    DVec3::new((1.0 - cos * cos).sqrt(), 0.0, cos.max(1e-15))
}

fn geometry(geometry: Geometry, x: &[f64]) -> Vec<f64> {
    let distribution = Distribution::Ggx { alpha: x[0] };
    vec![geometry.visibility(&distribution, leaning(x[1]), leaning(x[2]))]
}

fn geometry_anisotropic(geometry: Geometry, x: &[f64]) -> Vec<f64> {
    let distribution = Distribution::GgxAnisotropic { alpha_x: x[0], alpha_y: x[1], rotation_rad: 0.0 };
    let (v, l) = (DVec3::new(x[2], x[3], x[6]), DVec3::new(x[4], x[5], x[7].max(1e-15)));
    vec![geometry.visibility(&distribution, v, l)]
}

/// (alpha_t, alpha_b, ToV, BoV, ToL, BoL, NoV, NoL) of pairs of directions.
fn anisotropic_directions() -> Vec<Vec<f32>> {
    let up: Vec<[f32; 3]> = directions(60).iter().map(|d| [d.x, d.y, d.z.abs().max(1e-4)]).collect();
    let alphas = [[1e-4, 1e-4], [1.0, 1e-3], [0.3, 0.02], [0.05, 0.9], [1.0, 1.0]];
    let of_alphas = |[alpha_t, alpha_b]: [f32; 2]| {
        let pairs = up.iter().zip(up.iter().rev());
        pairs.map(|(v, l)| vec![alpha_t, alpha_b, v[0], v[1], l[0], l[1], v[2], l[2]]).collect::<Vec<_>>()
    };
    alphas.into_iter().flat_map(of_alphas).collect()
}

/// (alpha_t, alpha_b, t, b, n, h) around the peak of the narrow direction.
fn anisotropic_frames() -> Vec<Vec<f32>> {
    let mut points = Vec::new();
    for (index, n) in directions(40).into_iter().enumerate() {
        let n = n.as_dvec3().normalize();
        let (t, b) = crate::math::spaces::orthonormal_basis(n);
        for (alpha_t, alpha_b) in [(1e-3, 1e-3), (1.0, 1e-3), (0.4, 0.01), (0.02, 0.5), (1.0, 1.0)] {
            for step in [0.0, 0.1, 1.0, 3.0, 10.0] {
                let angle = index as f64;
                let lean = step * (t * alpha_t * angle.cos() + b * alpha_b * angle.sin());
                let axes = [t, b, n, (n + lean).normalize()].map(|axis| axis.as_vec3().to_array()).concat();
                points.push([vec![alpha_t as f32, alpha_b as f32], axes].concat());
            }
        }
    }
    points
}
