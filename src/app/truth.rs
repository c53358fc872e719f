//! The reference renderer beside the picture: it refines what is seen, on threads of its own.

use super::loading::Wake;
use super::stage::{Stage, upload_picture};
use crate::capture::CaptureError;
use crate::metrics::heat::heat;
use crate::metrics::truth::{EstimatedTruth, RelativeError, median_nits};
use crate::reference::color::to_srgb8;
use crate::reference::{Estimate, EstimateOptions, REPLICATES, refine};
use crate::scene::{RadianceImage, Scene, ToneMap, View};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, channel};

/// Samples a pixel at which nobody sees noise any more.
const SAMPLES: u32 = 4096;
/// The relative error of a pixel that is white on the heat map.
const HOTTEST: f64 = 0.1;

/// A picture that becomes true.
pub(super) struct Truth {
    of: (View, u64),
    stop: Arc<AtomicBool>,
    estimates: Receiver<Estimate>,
    /// Of the rasteriser, for comparison.
    actual: RadianceImage,
    best: Option<Best>,
}

/// The best that is known.
struct Best {
    estimate: Estimate,
    figures: Figures,
    /// How it was displayed, and as what.
    texture: Option<(View, bool, wgpu::TextureView)>,
}

/// How far the picture is from the truth, and that from itself. Relative, root mean square over what is covered.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Figures {
    /// Samples a pixel of the truth.
    pub(super) samples: u32,
    /// Its noise.
    pub(super) noise: f64,
    /// Of the picture, the noise taken out; where it does not show, a bound from above.
    pub(super) error: f64,
    pub(super) is_bound: bool,
}

/// What the radiance of a view depends on: how it is displayed does not matter.
fn radiance_view(view: &View) -> View {
    View { exposure_ev: 0.0, tone_map: ToneMap::default(), channel: None, ..view.clone() }
}

impl Truth {
    /// Begins to refine what a view shows of the scene on the stage.
    pub(super) fn start(
        stage: &mut Stage,
        scene: &Scene,
        view: &View,
        wake: Wake,
    ) -> Result<Option<Self>, CaptureError> {
        let view = radiance_view(view);
        let Some(actual) = stage.radiance(&view)? else { return Ok(None) };
        let (send, estimates) = channel();
        let stop = Arc::new(AtomicBool::new(false));
        let (scene, of, stopped) = (scene.clone(), (view.clone(), stage.version), Arc::clone(&stop));
        std::thread::spawn(move || {
            let options = EstimateOptions { samples: SAMPLES, ..Default::default() };
            refine(&scene, &view, &options, &stopped, |estimate| {
                // Nobody is there any more when another view is looked at.
                if send.send(estimate).is_err() {
                    stopped.store(true, Ordering::Relaxed);
                }
                wake();
            });
        });
        Ok(Some(Self { of, stop, estimates, actual, best: None }))
    }

    /// Whether this is the truth of a view.
    pub(super) fn is_of(&self, stage: &Stage, view: &View) -> bool {
        self.of.1 == stage.version && self.of.0 == radiance_view(view)
    }

    /// Takes what has been found since.
    pub(super) fn turn(&mut self) {
        if let Some(estimate) = self.estimates.try_iter().last() {
            let figures = figures(&self.actual, &estimate);
            self.best = Some(Best { estimate, figures, texture: None });
        }
    }

    pub(super) fn figures(&self) -> Option<Figures> {
        self.best.as_ref().map(|best| best.figures)
    }

    /// The truth as `view` displays it, or the error as colours.
    pub(super) fn texture(&mut self, stage: &Stage, view: &View, errors: bool) -> Option<wgpu::TextureView> {
        let best = self.best.as_mut()?;
        if best.texture.as_ref().is_none_or(|(of, as_errors, _)| (of, *as_errors) != (view, errors)) {
            let Estimate { radiance, .. } = &best.estimate;
            let pixels = if errors { heat_map(&self.actual, radiance) } else { to_srgb8(radiance, view) };
            let texture = upload_picture(&stage.gpu, view.size_px.to_array(), &pixels);
            best.texture = Some((view.clone(), errors, texture));
        }
        best.texture.as_ref().map(|(_, _, texture)| texture.clone())
    }
}

impl Drop for Truth {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::Relaxed);
    }
}

fn figures(actual: &RadianceImage, estimate: &Estimate) -> Figures {
    let radiance = &estimate.radiance;
    let counts = |i: usize| radiance.texels[i].w > 0.0;
    let error = estimate.standard_error.as_ref().map_or(RelativeError::default(), |standard_error| {
        let truth = EstimatedTruth { radiance, standard_error, degrees_of_freedom: f64::from(REPLICATES - 1) };
        RelativeError::of(actual, &truth, (radiance, median_nits(radiance, counts)), counts)
    });
    let (noise, is_bound) = (error.noise_rms(), !error.is_visible());
    Figures { samples: estimate.samples, noise, error: error.upper(), is_bound }
}

/// The relative difference of each pixel.
fn heat_map(actual: &RadianceImage, truth: &RadianceImage) -> Vec<u8> {
    let floor = median_nits(truth, |i| truth.texels[i].w > 0.0);
    let gray = |texel: &glam::Vec4| f64::from(texel.truncate().element_sum()) / 3.0;
    let pixel = |(actual, truth): (&glam::Vec4, &glam::Vec4)| {
        let relative = (gray(actual) - gray(truth)).abs() / gray(truth).max(gray(actual)).max(floor);
        let [r, g, b] = heat(relative / HOTTEST);
        [r, g, b, 255]
    };
    actual.texels.iter().zip(&truth.texels).flat_map(pixel).collect()
}
