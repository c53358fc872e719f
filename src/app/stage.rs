//! The GPU's side of the viewer: the scene on the device, and pictures of it.

use super::channel_picture::{in_units, picture};
use super::edit::MaterialEdit;
use super::shown::Shown;
use super::state::ViewerState;
use super::timing::{FrameTiming, Timer};
use crate::capture::{CaptureError, CaptureOptions, CaptureTarget, Wanted, capture_pixel, redraw, submit};
use crate::gpu::{Gpu, Uploads, formats};
use crate::gpu_scene::{GpuScene, TextureLevels};
use crate::renderer::{FrameStats, PathChoice, Renderer};
use crate::scene::{EnvironmentMaps, RadianceImage, View};
use crate::shader::ShaderSources;
use glam::{UVec2, Vec4};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// What of a state is part of the uploaded scene.
#[derive(Debug, Clone, PartialEq)]
struct Applied {
    materials: BTreeMap<usize, MaterialEdit>,
    hidden_nodes: BTreeSet<usize>,
    light_factors: BTreeMap<usize, f64>,
    rotation_deg: f64,
    intensity: f64,
}

impl Applied {
    fn of(state: &ViewerState) -> Self {
        Self {
            materials: state.materials.clone(),
            hidden_nodes: state.hidden_nodes.clone(),
            light_factors: state.light_factors.clone(),
            rotation_deg: state.environment.rotation_deg,
            intensity: state.environment.intensity,
        }
    }
}

/// A device with a scene on it.
pub(super) struct Stage {
    pub(super) gpu: Gpu,
    pub(super) renderer: Renderer,
    pub(super) uploaded: Option<GpuScene>,
    /// Of the frame that was drawn last.
    pub(super) stats: Option<FrameStats>,
    maps: Option<Arc<EnvironmentMaps>>,
    applied: Option<Applied>,
    target: Option<CaptureTarget>,
    size_px: [u32; 2],
    painted: Option<Painted>,
    /// Frames drawn so far.
    pub(super) frames: u64,
    /// Of the last frame, where that was timed.
    pub(super) timing: Option<FrameTiming>,
    /// Counts what was put on the device: another number, another scene.
    pub(super) version: u64,
}

/// A picture that was made in memory.
struct Painted {
    of: View,
    pixels: Vec<u8>,
    texture: wgpu::TextureView,
}

impl Stage {
    pub(super) fn new(gpu: Gpu, shaders: ShaderSources) -> Self {
        Self {
            renderer: renderer(&gpu, shaders),
            gpu,
            uploaded: None,
            stats: None,
            maps: None,
            applied: None,
            target: None,
            size_px: [0; 2],
            painted: None,
            frames: 0,
            timing: None,
            version: 0,
        }
    }

    /// Whether the device is the processors.
    pub(super) fn is_software(&self) -> bool {
        self.gpu.info.device_type == wgpu::DeviceType::Cpu
    }

    /// Puts a scene on the device, as `state` shows it. `levels` are of its textures, and made where there are none.
    pub(super) fn open(
        &mut self,
        shown: &mut Shown,
        state: &ViewerState,
        levels: Option<TextureLevels>,
        maps: Option<Arc<EnvironmentMaps>>,
    ) -> Result<(), CaptureError> {
        self.close();
        let Gpu { device, queue, .. } = &self.gpu;
        shown.apply(state);
        let max_side = device.limits().max_texture_dimension_2d;
        let levels = levels.unwrap_or_else(|| TextureLevels::of(&shown.scene, max_side));
        self.maps = maps;
        let uploaded = self.renderer.upload_with(device, queue, &shown.scene, levels, self.maps.as_deref())?;
        (self.uploaded, self.applied) = (Some(uploaded), Some(Applied::of(state)));
        Ok(())
    }

    /// Draws with other shaders from now on, if they can draw this view.
    pub(super) fn try_shaders(&mut self, shaders: ShaderSources, view: &View) -> Result<(), CaptureError> {
        let before = std::mem::replace(&mut self.renderer, renderer(&self.gpu, shaders));
        (self.target, self.painted) = (None, None);
        // Errors of the driver come with the wait.
        let tried = self.draw(view, false).and_then(|()| Ok(self.gpu.wait()?));
        if tried.is_err() {
            self.renderer = before;
            (self.target, self.painted) = (None, None);
        }
        self.version += 1;
        tried
    }

    /// Draws with other shaders from now on.
    pub(super) fn use_shaders(&mut self, shaders: ShaderSources) {
        self.renderer = renderer(&self.gpu, shaders);
        (self.target, self.painted) = (None, None);
        self.version += 1;
    }

    /// Takes the scene off the device.
    pub(super) fn close(&mut self) {
        (self.uploaded, self.applied, self.painted) = (None, None, None);
        self.version += 1;
    }

    /// Brings the scene on the device up to what `state` says.
    pub(super) fn follow(&mut self, shown: &mut Shown, state: &ViewerState) -> Result<(), CaptureError> {
        let wanted = Applied::of(state);
        if self.applied.as_ref() == Some(&wanted) {
            return Ok(());
        }
        self.upload_again(shown, state, true)
    }

    /// Lights the scene with the maps of another panorama, which already is around it.
    pub(super) fn relight(
        &mut self,
        shown: &mut Shown,
        state: &ViewerState,
        maps: Option<Arc<EnvironmentMaps>>,
    ) -> Result<(), CaptureError> {
        self.maps = maps;
        self.upload_again(shown, state, false)
    }

    fn upload_again(&mut self, shown: &mut Shown, state: &ViewerState, same_light: bool) -> Result<(), CaptureError> {
        let Gpu { device, queue, .. } = &self.gpu;
        let Some(previous) = self.uploaded.take() else { return self.open(shown, state, None, self.maps.clone()) };
        self.painted = None;
        self.version += 1;
        shown.apply(state);
        let light = (self.maps.as_deref(), same_light);
        self.uploaded = Some(self.renderer.upload_again(device, queue, &shown.scene, light, previous)?);
        self.applied = Some(Applied::of(state));
        Ok(())
    }

    /// Draws the view, if it is not what was drawn last. `timed` waits until that is done.
    pub(super) fn draw(&mut self, view: &View, timed: bool) -> Result<(), CaptureError> {
        if self.size_px != view.size_px.to_array() {
            (self.target, self.painted) = (None, None);
            self.size_px = view.size_px.to_array();
        }
        let target = match self.target.take() {
            Some(target) => target,
            None => CaptureTarget::new(&self.gpu, view, CaptureOptions::default())?,
        };
        if timed && self.timing.is_none() {
            // What is shown already is drawn once more, to be timed.
            target.state().forget();
            self.painted = None;
        }
        let mut timer = timed.then(|| Timer::start(&self.gpu, &target));
        let before = self.frames;
        let mut drawn = self.draw_into(view, &target, &mut timer);
        match timer {
            Some(timer) if self.frames > before => {
                drawn = drawn.and_then(|()| {
                    self.timing = Some(timer.stop(&self.gpu, &target)?);
                    Ok(())
                });
            }
            Some(_) => {}
            None => {
                self.timing = None;
                target.state().clock = None;
            }
        }
        self.target = Some(target);
        drawn
    }

    fn draw_into(
        &mut self,
        view: &View,
        target: &CaptureTarget,
        timer: &mut Option<Timer>,
    ) -> Result<(), CaptureError> {
        let Some(uploaded) = &mut self.uploaded else { return Ok(()) };
        let (gpu, renderer) = (&self.gpu, &mut self.renderer);
        let mut submitted = || timer.iter_mut().for_each(Timer::submitted);
        let Some(channel) = view.channel else {
            self.painted = None;
            if let Some(stats) = redraw(gpu, renderer, uploaded, view, target)? {
                submitted();
                self.stats = Some(stats);
                self.frames += 1;
            }
            return Ok(());
        };
        if self.painted.as_ref().is_some_and(|painted| painted.of == *view) {
            return Ok(());
        }
        let wanted = Wanted { radiance: true, display: false };
        let pending = submit(gpu, renderer, uploaded, view, target, wanted)?;
        submitted();
        self.stats = Some(pending.stats.clone());
        self.frames += 1;
        if let Some(image) = pending.wait(gpu)?.radiance {
            let pixels = picture(channel, &in_units(channel, image, view), view);
            let texture = upload_picture(gpu, view.size_px.to_array(), &pixels);
            self.painted = Some(Painted { of: view.clone(), pixels, texture });
        }
        Ok(())
    }

    /// What the shaders make of the middle of one pixel: radiance, cd/m2, multiplied with coverage, and that.
    pub(super) fn pixel(&mut self, view: &View, pixel: UVec2) -> Result<Option<Vec4>, CaptureError> {
        let Some(uploaded) = &mut self.uploaded else { return Ok(None) };
        let view = View { channel: None, ..view.clone() };
        let target = CaptureTarget::new(&self.gpu, &view, CaptureOptions { samples: 1, ..Default::default() })?;
        let captured = capture_pixel(&self.gpu, &mut self.renderer, uploaded, &view, &target, pixel)?;
        Ok(Some(captured.radiance))
    }

    /// Radiance of the view, whatever of it is shown.
    pub(super) fn radiance(&mut self, view: &View) -> Result<Option<RadianceImage>, CaptureError> {
        let (Some(uploaded), Some(target)) = (&mut self.uploaded, &self.target) else { return Ok(None) };
        let wanted = Wanted { radiance: true, display: false };
        let pending = submit(&self.gpu, &mut self.renderer, uploaded, view, target, wanted)?;
        Ok(pending.wait(&self.gpu)?.radiance)
    }

    /// Display values of the picture that was drawn last, if there is one.
    pub(super) fn shown(&self) -> Option<&wgpu::TextureView> {
        self.uploaded.as_ref()?;
        let painted = self.painted.as_ref().map(|painted| &painted.texture);
        painted.or_else(|| self.target.as_ref().map(CaptureTarget::display_view))
    }

    /// The same in memory: RGBA8 from the top left, sRGB with straight alpha.
    pub(super) fn pixels(&self) -> Result<Option<Vec<u8>>, CaptureError> {
        if let Some(painted) = &self.painted {
            return Ok(Some(painted.pixels.clone()));
        }
        let target = self.target.as_ref().filter(|_| self.uploaded.is_some());
        target.map(|target| target.read_display(&self.gpu)).transpose()
    }
}

fn renderer(gpu: &Gpu, shaders: ShaderSources) -> Renderer {
    let paths = PathChoice::for_device(gpu.info.device_type);
    Renderer::with_shaders(&gpu.device, &gpu.queue, shaders).with_uploads(Uploads::Bounded).with_paths(paths)
}

/// A picture in memory, RGBA8 from the top left, as a texture that can be presented.
pub(super) fn upload_picture(gpu: &Gpu, [width, height]: [u32; 2], pixels: &[u8]) -> wgpu::TextureView {
    let size = wgpu::Extent3d { width, height, depth_or_array_layers: 1 };
    let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some("picture"),
        size,
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: formats::CAPTURED_DISPLAY,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    });
    let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(4 * width), rows_per_image: None };
    gpu.queue.write_texture(texture.as_image_copy(), pixels, layout, size);
    texture.create_view(&Default::default())
}
