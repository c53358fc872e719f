//! Pictures with an estimate of their own error, which say when they are good enough.

use super::render::{Samples, Tracer};
use super::sampling::PixelSampler;
use crate::progress::{Progress, Silent};
use crate::scene::{RadianceImage, Scene, View};
use crate::threads::*;
use glam::{DVec2, DVec4, UVec2, Vec4};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// How a picture is estimated, and when it is done: at the first of the limits that are given.
#[derive(Clone, Copy)]
pub struct EstimateOptions<'a> {
    /// The most reflections between a source of light and the eye. 0 is the model of the real-time path: one reflection,
    /// and no shadows. From 1 up surfaces hide light from each other and, where they emit, light each other.
    pub bounces: u32,
    /// Samples a pixel, at most. Shared out over the [`REPLICATES`] where an error is estimated, and so a multiple of
    /// their number.
    pub samples: u32,
    /// Stop once [`Estimate::relative_error`] is at most this.
    pub relative_error: Option<f64>,
    /// Stop before this has passed, if it suffices for the first samples.
    pub time: Option<Duration>,
    /// Estimate the error even where no limit asks for it.
    pub standard_error: bool,
    /// Take every sample in the middle of its pixel, where a rasteriser takes its only one.
    pub centers: bool,
    /// The same seed gives the same picture, on any number of threads.
    pub seed: u64,
    pub progress: &'a dyn Progress,
}

impl Default for EstimateOptions<'_> {
    fn default() -> Self {
        Self {
            bounces: 0,
            samples: 64,
            relative_error: None,
            time: None,
            standard_error: false,
            centers: false,
            seed: 0,
            progress: &Silent,
        }
    }
}

impl std::fmt::Debug for EstimateOptions<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("EstimateOptions")
            .field("bounces", &self.bounces)
            .field("samples", &self.samples)
            .field("relative_error", &self.relative_error)
            .field("time", &self.time)
            .field("seed", &self.seed)
            .finish_non_exhaustive()
    }
}

/// A picture and how far it is likely to be from the truth.
#[derive(Debug, Clone)]
pub struct Estimate {
    pub radiance: RadianceImage,
    /// Standard error of each channel of each pixel, in its units. `None` when it was not asked for.
    pub standard_error: Option<RadianceImage>,
    /// Root mean square, over pixels that show surfaces, of the standard error relative to the radiance (the mean of the
    /// channels; pixels darker than a hundredth of the median count as that bright).
    pub relative_error: Option<f64>,
    /// Samples a pixel that were taken.
    pub samples: u32,
}

/// Independent pictures whose differences tell the error. Low-discrepancy samples of one sequence do not: their spread is
/// much larger than their mean's error.
pub const REPLICATES: u32 = 8;

/// Renders `scene` until a limit of `options` is reached.
pub fn estimate(scene: &Scene, view: &View, options: &EstimateOptions) -> Estimate {
    let asked = options.standard_error || options.relative_error.is_some() || options.time.is_some();
    let replicates = if asked { REPLICATES } else { 1 };
    let last = options.samples.max(1).div_ceil(replicates);
    let mut rendering = Rendering::new(Tracer::new(scene, view, options.bounces), view, replicates, options);
    let (mut done, start) = (0, Instant::now());
    rendering.announce(if asked && (options.relative_error.is_some() || options.time.is_some()) { 1 } else { last });
    loop {
        let next = if asked { after(done).min(last) } else { last };
        rendering.extend(done..next);
        done = next;
        let Some(wanted) = rendering.samples_wanted(done, start.elapsed()) else {
            if done >= last {
                break;
            }
            continue;
        };
        if done >= last || wanted <= f64::from(done) || !rendering.fits(after(done).min(last), done, start.elapsed()) {
            break;
        }
        rendering.expect(wanted.min(f64::from(last)));
    }
    rendering.result(done)
}

/// Renders `scene` with ever more samples, up to those of `options`, whose limits on error and time do not count here.
/// `look` sees the picture with its errors at each stop on the way. It goes on until `stop` is set, which is heeded
/// between rows; a picture that is not complete is not shown.
pub fn refine(
    scene: &Scene,
    view: &View,
    options: &EstimateOptions,
    stop: &AtomicBool,
    mut look: impl FnMut(Estimate),
) {
    let last = options.samples.max(1).div_ceil(REPLICATES);
    let tracer = Tracer::new(scene, view, options.bounces);
    let mut rendering = Rendering { stop: Some(stop), ..Rendering::new(tracer, view, REPLICATES, options) };
    let mut done = 0;
    while done < last {
        let next = after(done).min(last);
        rendering.announce(next - done);
        rendering.extend(done..next);
        if stop.load(Ordering::Relaxed) {
            return;
        }
        done = next;
        look(rendering.result(done));
    }
}

/// Numbers of samples at which a sequence is looked at: powers of two, and halfway between. The former are stratified
/// best; the latter keep what is done too much below one half.
fn after(samples: u32) -> u32 {
    let power = (samples + 1).next_power_of_two();
    let halfway = power / 4 * 3;
    if halfway > samples { halfway } else { power }
}

/// What is known of a pixel.
#[derive(Debug, Clone, Copy, Default)]
struct Pixel {
    /// Sums over the samples of each replicate.
    radiance: [Vec4; REPLICATES as usize],
    surface: f32,
}

impl Pixel {
    /// The mean, and its standard error: that of independent means (Bessel's correction included).
    fn mean_and_error(&self, replicates: u32, samples: u32) -> (DVec4, DVec4) {
        let means = self.radiance[..replicates as usize].iter().map(|sum| sum.as_dvec4() / f64::from(samples));
        let mean = means.clone().sum::<DVec4>() / f64::from(replicates);
        let squares: DVec4 = means.map(|replicate| (replicate - mean) * (replicate - mean)).sum();
        let pairs = f64::from(replicates) * f64::from(replicates - 1).max(1.0);
        (mean, (squares / pairs).map(f64::sqrt))
    }
}

struct Rendering<'a> {
    tracer: Tracer<'a>,
    size: UVec2,
    replicates: u32,
    options: &'a EstimateOptions<'a>,
    pixels: Vec<Pixel>,
    /// Once it is set, nothing more is drawn.
    stop: Option<&'a AtomicBool>,
}

impl<'a> Rendering<'a> {
    fn new(tracer: Tracer<'a>, view: &View, replicates: u32, options: &'a EstimateOptions<'a>) -> Self {
        let count = view.size_px.x as usize * view.size_px.y as usize;
        Self { tracer, size: view.size_px, replicates, options, pixels: vec![Pixel::default(); count], stop: None }
    }

    /// A step of progress is one sample of a row in each replicate.
    fn announce(&self, samples: u32) {
        self.options.progress.begin("reference", u64::from(self.size.y) * u64::from(samples));
    }

    fn expect(&self, samples: f64) {
        self.options.progress.expect((f64::from(self.size.y) * samples) as u64);
    }

    /// Takes the samples `indices` of every replicate.
    fn extend(&mut self, indices: std::ops::Range<u32>) {
        let Self { tracer, size, replicates, options, pixels, stop } = self;
        let steps = u64::from(indices.end - indices.start);
        let alone = *replicates == 1 && options.samples <= 1;
        // A single sample is where a rasteriser takes it.
        let place = (alone || options.centers).then_some(DVec2::splat(0.5));
        pixels.par_chunks_mut((size.x as usize).max(1)).zip(0..size.y).for_each(|(row, y)| {
            if stop.is_some_and(|stop| stop.load(Ordering::Relaxed)) {
                return;
            }
            for (pixel, x) in row.iter_mut().zip(0..size.x) {
                for (sum, replicate) in pixel.radiance.iter_mut().zip(0..*replicates) {
                    let sampler = PixelSampler::new(seed_of(options.seed, replicate), x, y);
                    let Samples { radiance, surface } =
                        tracer.pixel(UVec2::new(x, y), &sampler, indices.clone(), place);
                    *sum += radiance.as_vec4();
                    pixel.surface += surface as f32;
                }
            }
            options.progress.advance(steps);
        });
    }

    /// Samples a replicate after which the limits on error and time are likely to be reached; `None` without such limits.
    fn samples_wanted(&self, done: u32, elapsed: Duration) -> Option<f64> {
        let samples = f64::from(done);
        let for_error = self.options.relative_error.map(|limit| {
            // The error falls with the square root of the samples, or faster.
            samples * (self.relative_error(done) / limit).powi(2)
        });
        let in_time = self.options.time.map(|time| samples * (time.as_secs_f64() / elapsed.as_secs_f64().max(1e-9)));
        [for_error, in_time].into_iter().flatten().reduce(f64::min)
    }

    /// Whether a picture of `next` samples would be done in time.
    fn fits(&self, next: u32, done: u32, elapsed: Duration) -> bool {
        let needed = elapsed.as_secs_f64() * f64::from(next) / f64::from(done);
        self.options.time.is_none_or(|time| needed <= time.as_secs_f64())
    }

    fn relative_error(&self, samples: u32) -> f64 {
        let shown = self.pixels.iter().filter(|pixel| pixel.surface > 0.0);
        let gray = |color: DVec4| color.truncate().element_sum() / 3.0;
        let mut values: Vec<(f64, f64)> = shown
            .map(|pixel| {
                let (mean, error) = pixel.mean_and_error(self.replicates, samples);
                (gray(mean), gray(error))
            })
            .collect();
        if values.is_empty() {
            return 0.0;
        }
        let middle = values.len() / 2;
        let (_, &mut (median, _), _) = values.select_nth_unstable_by(middle, |a, b| a.0.total_cmp(&b.0));
        // In black pictures every error is absolute.
        let darkest = if median > 0.0 { 0.01 * median } else { 1.0 };
        let sum: f64 = values.iter().map(|(mean, error)| (error / mean.max(darkest)).powi(2)).sum();
        (sum / values.len() as f64).sqrt()
    }

    fn result(&self, samples: u32) -> Estimate {
        let UVec2 { x: width, y: height } = self.size;
        let results: Vec<_> = self.pixels.iter().map(|pixel| pixel.mean_and_error(self.replicates, samples)).collect();
        let image = |texels: Vec<Vec4>| RadianceImage { width, height, texels };
        let estimated = self.replicates > 1;
        Estimate {
            radiance: image(results.iter().map(|(mean, _)| mean.as_vec4()).collect()),
            standard_error: estimated.then(|| image(results.iter().map(|(_, error)| error.as_vec4()).collect())),
            relative_error: estimated.then(|| self.relative_error(samples)),
            samples: samples * self.replicates,
        }
    }
}

/// Seeds of different replicates are independent; that of the first is the picture's own.
fn seed_of(seed: u64, replicate: u32) -> u64 {
    seed.wrapping_add(u64::from(replicate).wrapping_mul(0xd1b5_4a32_d192_ed03))
}

#[cfg(test)]
mod tests {
    use super::super::tests::{add_light, options, scene_of, sphere, view};
    use super::*;
    use crate::reference::render;
    use crate::scene::*;
    use glam::{DVec3, Vec3};

    /// A sphere of plastic under a small bright light and a dim sky.
    fn scene() -> Scene {
        let mut scene =
            scene_of(sphere(32), Material { metallic: 0.0, perceptual_roughness: 0.3, ..Material::default() });
        let mut texels = vec![Vec3::splat(0.3); 32 * 16];
        texels[4 * 32 + 20] = Vec3::splat(200.0);
        scene.environment = Some(Environment::new(EnvironmentImage { width: 32, height: 16, texels }));
        add_light(&mut scene, LightKind::Point { range_m: None }, 20.0, DVec3::new(3.0, 2.0, 4.0));
        scene
    }

    fn small_view() -> View {
        View { size_px: UVec2::splat(24), ..view() }
    }

    #[test]
    fn looks_come_at_powers_of_two_and_halfway() {
        let looks: Vec<u32> = std::iter::successors(Some(after(0)), |&samples| Some(after(samples))).take(9).collect();
        assert_eq!(looks, [1, 2, 3, 4, 6, 8, 12, 16, 24]);
    }

    #[test]
    fn the_error_estimated_is_the_error_made() {
        let (scene, view) = (scene(), small_view());
        let truth = render(&scene, &view, &options(8192));
        let (mut made, mut estimated) = (0.0, 0.0);
        let few = EstimateOptions { samples: 32, standard_error: true, ..Default::default() };
        let picture = estimate(&scene, &view, &few);
        let error = picture.standard_error.unwrap();
        for ((a, b), error) in picture.radiance.texels.iter().zip(&truth.texels).zip(&error.texels) {
            made += f64::from((*a - *b).truncate().length_squared());
            estimated += f64::from(error.truncate().length_squared());
        }
        let ratio = (estimated / made).sqrt();
        // Measured 0.958: 24 x 24 pixels and 8 replicates estimate it within a few hundredths.
        assert!((0.85..1.15).contains(&ratio), "{ratio}");
    }

    #[test]
    fn sampling_goes_on_until_the_error_is_small_enough() {
        let (scene, view) = (scene(), small_view());
        let to = |relative_error| {
            let options = EstimateOptions { samples: 4096, relative_error, ..Default::default() };
            estimate(&scene, &view, &options)
        };
        let (coarse, fine) = (to(Some(0.08)), to(Some(0.02)));
        assert!(coarse.relative_error.unwrap() <= 0.08 && fine.relative_error.unwrap() <= 0.02);
        assert!(coarse.samples < fine.samples && fine.samples < 4096, "{} {}", coarse.samples, fine.samples);
        let unreachable =
            estimate(&scene, &view, &EstimateOptions { samples: 24, relative_error: Some(1e-9), ..Default::default() });
        assert_eq!(unreachable.samples, 24);
    }

    #[test]
    fn pictures_are_refined_to_the_estimate_and_can_be_stopped() {
        let (scene, view) = (scene(), small_view());
        let options = EstimateOptions { samples: 32, standard_error: true, ..Default::default() };
        let mut seen = Vec::new();
        let stop = AtomicBool::new(false);
        refine(&scene, &view, &options, &stop, |picture| seen.push(picture));
        assert_eq!(seen.iter().map(|picture| picture.samples).collect::<Vec<_>>(), [8, 16, 24, 32]);
        let whole = estimate(&scene, &view, &options);
        // Sums of the same samples, in another order.
        let last = seen.last().unwrap();
        for (a, b) in last.radiance.texels.iter().zip(&whole.radiance.texels) {
            assert!((*a - *b).abs().max_element() <= 1e-5 * b.abs().max_element(), "{a} {b}");
        }
        let mut looks = 0;
        refine(&scene, &view, &options, &stop, |_| {
            looks += 1;
            stop.store(true, Ordering::Relaxed);
        });
        assert_eq!(looks, 1);
    }

    #[test]
    fn no_time_is_enough_for_the_first_samples() {
        let options = EstimateOptions { samples: 4096, time: Some(Duration::ZERO), ..Default::default() };
        assert_eq!(estimate(&scene(), &small_view(), &options).samples, REPLICATES);
    }

    #[test]
    fn estimates_do_not_depend_on_the_number_of_threads() {
        let (scene, view) = (scene(), small_view());
        let options = EstimateOptions { bounces: 3, samples: 4096, relative_error: Some(0.1), ..Default::default() };
        let with_threads = |count: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(count).build().unwrap();
            pool.install(|| estimate(&scene, &view, &options))
        };
        let (one, three) = (with_threads(1), with_threads(3));
        assert_eq!(one.radiance, three.radiance);
        assert_eq!(one.standard_error, three.standard_error);
        assert_eq!(one.relative_error, three.relative_error);
    }
}
