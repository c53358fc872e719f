//! What pictures are held against: the reference renderer's, term by term, with its own error.

use super::steady::steady_pixels;
use crate::metrics::flip::flip;
use crate::metrics::truth::{EstimatedTruth, RelativeError, median_nits};
use crate::metrics::{Pair, PairError};
use crate::progress::Progress;
use crate::reference::color::to_srgb8;
use crate::reference::{Estimate, EstimateOptions, REPLICATES, estimate};
use crate::scene::{Background, Encoding, Picture, RadianceImage, Scene, Term, View};
use glam::{Vec3, Vec4};

/// How much the truth is sampled.
#[derive(Clone, Copy)]
pub(in crate::cli) struct TruthOptions<'a> {
    /// Samples a pixel and term, at most.
    pub(in crate::cli) samples: u32,
    /// Stop a term at this standard error, relative to its radiance.
    pub(in crate::cli) relative_error: Option<f64>,
    pub(in crate::cli) progress: &'a dyn Progress,
}

impl<'a> TruthOptions<'a> {
    fn estimate(&self, seed: u64) -> EstimateOptions<'a> {
        let Self { samples, relative_error, progress } = *self;
        EstimateOptions { samples, relative_error, seed, progress, ..Default::default() }
    }
}

/// The scene whose textures are read at their finest level alone, by either renderer.
pub(in crate::cli) fn with_bare_textures(scene: &Scene) -> Scene {
    let mut bare = scene.clone();
    for texture in &mut bare.textures {
        texture.sampler.mip_linear = None;
        texture.sampler.min_linear = texture.sampler.mag_linear;
    }
    bare
}

fn without_background(view: &View) -> View {
    View { background: Background::Transparent, ..view.clone() }
}

/// A truth and its standard error, cd/m2.
pub(in crate::cli) struct Sampled {
    radiance: RadianceImage,
    standard_error: RadianceImage,
}

impl Sampled {
    fn of(estimate: Estimate) -> Self {
        let Estimate { radiance, standard_error, .. } = estimate;
        // It was asked for; without it every difference is an error.
        let none = || RadianceImage { texels: vec![Vec4::ZERO; radiance.texels.len()], ..radiance };
        Self { standard_error: standard_error.unwrap_or_else(none), radiance }
    }
}

/// The unshadowed radiance of a view without its background.
pub(in crate::cli) struct Truth {
    view: View,
    /// Those that the scene has, where they are asked for.
    terms: Vec<(Term, Sampled)>,
    whole: Sampled,
    /// Pixels that are compared.
    counted: Vec<bool>,
    /// Errors of darker pixels are relative to this: the median.
    floor_nits: f64,
    /// Samples a pixel, of all terms together.
    pub(in crate::cli) samples: u32,
}

/// The terms that may not be black in a scene.
fn terms_of(scene: &Scene) -> Vec<Term> {
    let is_unlit = scene.materials.iter().any(|material| material.unlit)
        || scene.meshes.iter().flat_map(|mesh| &mesh.primitives).any(|primitive| primitive.normals.is_none());
    let emits = scene.materials.iter().any(|material| material.emissive_nits != Vec3::ZERO) || is_unlit;
    let lights = scene.lights_in_world().iter().any(|light| light.intensity != glam::DVec3::ZERO);
    let environment = scene.lit_environment().is_some();
    let is_there = |term: &Term| match term {
        Term::Emission => emits || !(lights || environment),
        term if term.is_direct() => lights,
        _ => environment,
    };
    Term::ALL.into_iter().filter(is_there).collect()
}

impl Truth {
    /// The picture as it should be: the mean over each pixel.
    pub(super) fn of_picture(scene: &Scene, view: &View, options: &TruthOptions<'_>) -> Self {
        let view = without_background(view);
        let estimate_options = EstimateOptions { standard_error: true, ..options.estimate(0) };
        let estimated = estimate(scene, &view, &estimate_options);
        let (samples, whole) = (estimated.samples, Sampled::of(estimated));
        let counted = whole.radiance.texels.iter().map(|texel| texel.w > 0.0).collect();
        Self::new(view, (Vec::new(), whole), counted, samples)
    }

    /// The light alone: what is seen through the middle of each pixel, term by term. Every term has samples of its own, so
    /// that their errors are independent and add up. `scene` is one [`with_bare_textures`].
    pub(in crate::cli) fn of_shading(scene: &Scene, view: &View, options: &TruthOptions<'_>) -> Self {
        let view = without_background(view);
        let (mut terms, mut samples) = (Vec::new(), 0);
        for (term, seed) in terms_of(scene).into_iter().zip(1..) {
            let of_term = View { term: Some(term), ..view.clone() };
            let estimate_options = EstimateOptions { centers: true, standard_error: true, ..options.estimate(seed) };
            let estimated = estimate(scene, &of_term, &estimate_options);
            samples += estimated.samples;
            terms.push((term, Sampled::of(estimated)));
        }
        let whole = sum(&terms, &view);
        let steady = steady_pixels(scene, &view);
        Self::new(view, (terms, whole), steady, samples)
    }

    fn new(view: View, (terms, whole): (Vec<(Term, Sampled)>, Sampled), counted: Vec<bool>, samples: u32) -> Self {
        let floor_nits = median_nits(&whole.radiance, |i| counted[i]);
        Self { view, terms, whole, counted, floor_nits, samples }
    }

    pub(super) fn terms(&self) -> Vec<Term> {
        self.terms.iter().map(|(term, _)| *term).collect()
    }

    /// Of a picture: over all pixels that show surfaces. Of the light alone: over those that show the same all around
    /// their middle.
    pub(in crate::cli) fn error(&self, actual: &RadianceImage) -> RelativeError {
        self.compare(actual, &self.whole)
    }

    /// Of a picture of one term, relative to the radiance of all; `None` for a term that the scene has not.
    pub(super) fn error_of_term(&self, term: Term, actual: &RadianceImage) -> Option<RelativeError> {
        let (_, truth) = self.terms.iter().find(|(other, _)| *other == term)?;
        Some(self.compare(actual, truth))
    }

    fn compare(&self, actual: &RadianceImage, truth: &Sampled) -> RelativeError {
        let estimated = EstimatedTruth {
            radiance: &truth.radiance,
            standard_error: &truth.standard_error,
            degrees_of_freedom: f64::from(REPLICATES - 1),
        };
        RelativeError::of(actual, &estimated, (&self.whole.radiance, self.floor_nits), |i| self.counted[i])
    }

    /// The view as a person would see it: over grey.
    pub(super) fn display_view(&self) -> View {
        View { background: Background::Color(Vec3::splat(0.16)), ..self.view.clone() }
    }

    /// Mean FLIP error of the picture that a person sees.
    pub(super) fn flip_mean(&self, actual: &RadianceImage) -> Result<f64, PairError> {
        let [actual, expected] = [actual, &self.whole.radiance].map(|image| {
            let codes = to_srgb8(image, &self.display_view());
            Picture {
                width: image.width,
                height: image.height,
                encoding: Encoding::Srgb,
                texels: codes
                    .chunks_exact(4)
                    .map(|code| Vec4::from_slice(&[0, 1, 2, 3].map(|c| f32::from(code[c]) / 255.0)))
                    .collect(),
            }
        });
        let pair = Pair::new(&actual, &expected, None)?;
        Ok(flip(&pair).pool(&pair).mean)
    }
}

/// The terms together: radiance adds up, and so do the squares of independent errors. Coverage is the mean.
fn sum(terms: &[(Term, Sampled)], view: &View) -> Sampled {
    let (width, height) = (view.size_px.x, view.size_px.y);
    let zero = || RadianceImage { width, height, texels: vec![Vec4::ZERO; (width * height) as usize] };
    let (mut radiance, mut standard_error) = (zero(), zero());
    let share = 1.0 / terms.len().max(1) as f32;
    for (_, term) in terms {
        for (sum, texel) in radiance.texels.iter_mut().zip(&term.radiance.texels) {
            *sum += texel.truncate().extend(texel.w * share);
        }
        for (sum, error) in standard_error.texels.iter_mut().zip(&term.standard_error.texels) {
            *sum += error * error;
        }
    }
    standard_error.texels.iter_mut().for_each(|error| *error = error.map(f32::sqrt));
    Sampled { radiance, standard_error }
}
