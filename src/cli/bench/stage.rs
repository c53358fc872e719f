//! A scene on the device, once for every prefiltered environment that some setting wants.

use super::settings::Setting;
use crate::bake::environment::BakeOptions;
use crate::capture::{CaptureError, CaptureOptions, CaptureTarget, CapturedFrame, Wanted, record, submit};
use crate::cli::clock::{FrameTimes, time_frame, timestamps};
use crate::cli::environment::{CacheArgs, bake_with};
use crate::cli::error::CliError;
use crate::cli::measure::FloorOf;
use crate::gpu::{Gpu, Timestamps, Uploads};
use crate::gpu_scene::GpuScene;
use crate::progress::Progress;
use crate::renderer::{FrameStats, PathChoice, Renderer};
use crate::scene::{Background, RadianceImage, Scene, Term, View};
use glam::Vec4;

/// Frames of each setting that are drawn and forgotten: the first compiles shaders.
pub(super) const WARM_UP_FRAMES: u32 = 3;

/// Whether suns are parted from the environment, the side of its prefiltered maps, and whether only the forward path is
/// wanted.
type MapsKey = (bool, u32, bool);

pub(in crate::cli) struct Stage<'a> {
    gpu: &'a Gpu,
    scene: &'a Scene,
    cache: &'a CacheArgs,
    renderer: Renderer,
    timestamps: Option<Timestamps>,
    uploaded: Vec<(MapsKey, GpuScene)>,
    /// Between frames that are timed.
    pub(super) motion: CameraMotion,
    frames_drawn: u32,
}

/// What the camera does between frames.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::cli) enum CameraMotion {
    Still,
    /// Forth and back by a ten-thousandth of its distance to the origin, so that every frame is planned anew and shows the
    /// same.
    Sideways,
}

/// A view that is ready to be drawn with a setting.
pub(in crate::cli) struct Shot {
    pub(in crate::cli) setting: Setting,
    view: View,
    target: CaptureTarget,
    /// Index into what its stage has uploaded.
    scene: usize,
}

impl<'a> Stage<'a> {
    pub(in crate::cli) fn new(gpu: &'a Gpu, scene: &'a Scene, cache: &'a CacheArgs) -> Self {
        let renderer = Renderer::new(&gpu.device, &gpu.queue).with_uploads(Uploads::Bounded);
        Self {
            gpu,
            scene,
            cache,
            renderer,
            timestamps: timestamps(gpu),
            uploaded: Vec::new(),
            motion: CameraMotion::Still,
            frames_drawn: 0,
        }
    }

    /// Makes ready to draw `view` with `setting`, whose tier and samples replace the view's.
    pub(in crate::cli) fn shot(
        &mut self,
        setting: Setting,
        view: &View,
        progress: &dyn Progress,
    ) -> Result<Shot, CliError> {
        let view = View { size_px: view.size_px * setting.supersampling, quality: setting.quality, ..view.clone() };
        let options = CaptureOptions { samples: setting.msaa, precision: setting.precision };
        let target = CaptureTarget::new(self.gpu, &view, options)?;
        let is_forward = setting.path == PathChoice::Forward;
        let key = (setting.quality.parts_suns(), setting.prefilter_side, is_forward);
        self.renderer.set_paths(setting.path);
        let known = self.uploaded.iter().position(|(other, _)| *other == key);
        let scene = known.unwrap_or(self.uploaded.len());
        if known.is_none() {
            self.uploaded.push((key, self.upload(key, progress)?));
        }
        Ok(Shot { setting, view, target, scene })
    }

    fn upload(&self, (suns, max_side, _): MapsKey, progress: &dyn Progress) -> Result<GpuScene, CaptureError> {
        let maps = self
            .scene
            .lit_environment()
            .map(|e| bake_with(&e.image, &BakeOptions { suns, max_side }, self.cache, progress).maps);
        Ok(self.renderer.upload(&self.gpu.device, &self.gpu.queue, self.scene, maps.as_ref())?)
    }

    /// What the floor of a shot is made of.
    pub(in crate::cli) fn floor_of<'s>(&'s self, shot: &'s Shot) -> FloorOf<'s> {
        FloorOf {
            scene: self.scene,
            view: &shot.view,
            features: self.uploaded[shot.scene].1.features,
            precision: shot.setting.precision,
            samples: shot.setting.msaa,
        }
    }

    /// Draws one frame and says what it consists of.
    pub(super) fn draw(&mut self, shot: &Shot) -> Result<FrameStats, CaptureError> {
        let mut drawn = FrameStats::default();
        self.frame(shot, &mut drawn)?;
        Ok(drawn)
    }

    /// Draws every shot `frames` times, all in turn, forth and back, so that whatever disturbs the machine falls on all
    /// alike. Returns the times by shot.
    pub(in crate::cli) fn measure(
        &mut self,
        shots: &[Shot],
        frames: u32,
        progress: &dyn Progress,
    ) -> Result<Vec<Vec<FrameTimes>>, CaptureError> {
        progress.begin("Drawing frames", u64::from(frames + WARM_UP_FRAMES) * shots.len() as u64);
        let mut times = vec![Vec::new(); shots.len()];
        for round in 0..frames + WARM_UP_FRAMES {
            let mut order: Vec<usize> = (0..shots.len()).collect();
            if round % 2 == 1 {
                order.reverse();
            }
            for index in order {
                let frame = self.frame(&shots[index], &mut FrameStats::default())?;
                if round >= WARM_UP_FRAMES {
                    times[index].push(frame);
                }
                progress.advance(1);
            }
        }
        Ok(times)
    }

    fn frame(&mut self, shot: &Shot, drawn: &mut FrameStats) -> Result<FrameTimes, CaptureError> {
        let view = self.next_view(&shot.view);
        let Self { gpu, renderer, timestamps, uploaded, .. } = self;
        let (_, scene) = &mut uploaded[shot.scene];
        renderer.set_paths(shot.setting.path);
        time_frame(gpu, timestamps.as_ref(), |encoder| {
            *drawn = record(gpu, renderer, encoder, scene, &view, &shot.target, true)?;
            Ok(())
        })
    }

    fn next_view(&mut self, view: &View) -> View {
        let mut view = view.clone();
        if self.motion == CameraMotion::Sideways {
            let step_m = 1e-4 * view.camera.position_in_world().length();
            let right = view.camera.world_from_view.x_axis;
            view.camera.world_from_view.w_axis += right * (step_m * f64::from(self.frames_drawn % 7));
            self.frames_drawn += 1;
        }
        view
    }

    /// The radiance of surfaces without background, or of one term of it, at the size of the picture, cd/m2.
    pub(in crate::cli) fn radiance(&mut self, shot: &Shot, term: Option<Term>) -> Result<RadianceImage, CaptureError> {
        let view = View { background: Background::Transparent, term, ..shot.view.clone() };
        let radiance = self.capture(shot, &view)?.radiance;
        let nothing = RadianceImage { width: 0, height: 0, texels: Vec::new() };
        Ok(box_filtered(&radiance.unwrap_or(nothing), shot.setting.supersampling))
    }

    /// The radiance in a view like the shot's, and what the display pass made of it.
    pub(super) fn display(&mut self, shot: &Shot, view: &View) -> Result<CapturedFrame, CaptureError> {
        self.capture(shot, &View { size_px: shot.view.size_px, quality: shot.setting.quality, ..view.clone() })
    }

    fn capture(&mut self, shot: &Shot, view: &View) -> Result<CapturedFrame, CaptureError> {
        let (_, scene) = &mut self.uploaded[shot.scene];
        self.renderer.set_paths(shot.setting.path);
        let wanted = Wanted { radiance: true, display: true };
        submit(self.gpu, &mut self.renderer, scene, view, &shot.target, wanted)?.wait(self.gpu)
    }
}

/// The mean of every `side` by `side` texels.
fn box_filtered(image: &RadianceImage, side: u32) -> RadianceImage {
    let (width, height) = (image.width / side, image.height / side);
    let texel = |i: u32| {
        let (x, y) = (i % width * side, i / width * side);
        let cells = (y..y + side).flat_map(|y| (x..x + side).map(move |x| (x, y)));
        cells.map(|(x, y)| image.texels[(y * image.width + x) as usize]).sum::<Vec4>() / (side * side) as f32
    };
    RadianceImage { width, height, texels: (0..width * height).map(texel).collect() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn boxes_are_means() {
        let texels = (0..16).map(|i| Vec4::splat(i as f32)).collect();
        let half = box_filtered(&RadianceImage { width: 4, height: 4, texels }, 2);
        assert_eq!((half.width, half.height), (2, 2));
        assert_eq!(half.texels.iter().map(|texel| texel.x).collect::<Vec<f32>>(), [2.5, 4.5, 10.5, 12.5]);
    }
}
