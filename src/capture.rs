//! Frames without a window: our own device and targets, and the picture back in memory.

use crate::frame::RenderPath;
use crate::gpu::formats::{self, Precision};
use crate::gpu::{Gpu, GpuError, Readback, read_texel, read_texture};
use crate::gpu_scene::GpuScene;
use crate::passes::ForwardTarget;
use crate::renderer::{FrameState, FrameStats, RadianceTarget, RenderError, Renderer, SurfaceTarget};
use crate::scene::{RadianceImage, View};
use glam::{UVec2, Vec4};
use std::sync::{Mutex, MutexGuard, OnceLock, PoisonError};

/// Why there is no picture.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum CaptureError {
    #[error(transparent)]
    Render(#[from] RenderError),
    #[error(transparent)]
    Gpu(#[from] GpuError),
    #[error("{adapter} cannot draw {format} with {samples} samples a pixel; it can with {possible:?}")]
    Target { adapter: String, format: String, samples: u32, possible: Vec<u32> },
}

/// How a frame is captured.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct CaptureOptions {
    /// Samples a pixel: 1 or 4.
    pub samples: u32,
    pub precision: Precision,
}

impl Default for CaptureOptions {
    fn default() -> Self {
        Self { samples: 4, precision: Precision::Half }
    }
}

/// The textures that frames of one size are drawn into.
#[derive(Debug)]
pub struct CaptureTarget {
    options: CaptureOptions,
    size: wgpu::Extent3d,
    /// Of the forward path with several samples.
    multisampled: OnceLock<wgpu::TextureView>,
    /// Of the deferred path.
    visibility: OnceLock<wgpu::TextureView>,
    covered: OnceLock<wgpu::TextureView>,
    over: OnceLock<wgpu::TextureView>,
    depth: wgpu::TextureView,
    radiance: wgpu::Texture,
    radiance_view: wgpu::TextureView,
    display: wgpu::Texture,
    display_view: wgpu::TextureView,
    /// What frames into these textures have in common.
    state: Mutex<FrameState>,
}

impl CaptureTarget {
    pub fn new(gpu: &Gpu, view: &View, options: CaptureOptions) -> Result<Self, CaptureError> {
        let CaptureOptions { samples, precision } = options;
        let format = precision.hdr_format();
        check_samples(gpu, format, samples)?;
        let size = wgpu::Extent3d { width: view.size_px.x, height: view.size_px.y, depth_or_array_layers: 1 };
        let attachment = wgpu::TextureUsages::RENDER_ATTACHMENT;
        let readable = attachment | wgpu::TextureUsages::COPY_SRC | wgpu::TextureUsages::TEXTURE_BINDING;
        let view = |texture: &wgpu::Texture| texture.create_view(&Default::default());
        let radiance = texture(gpu, size, ("radiance", format, 1), readable);
        let display = texture(gpu, size, ("display", formats::CAPTURED_DISPLAY, 1), readable);
        Ok(Self {
            options,
            size,
            multisampled: OnceLock::new(),
            visibility: OnceLock::new(),
            covered: OnceLock::new(),
            over: OnceLock::new(),
            depth: view(&texture(gpu, size, ("depth", formats::DEPTH, samples), attachment)),
            radiance_view: view(&radiance),
            radiance,
            display_view: view(&display),
            display,
            state: Mutex::default(),
        })
    }

    /// Display values of the frame that was drawn last, in [`formats::CAPTURED_DISPLAY`].
    pub fn display_view(&self) -> &wgpu::TextureView {
        &self.display_view
    }

    /// The same in memory: RGBA8 from the top left, sRGB with straight alpha.
    pub fn read_display(&self, gpu: &Gpu) -> Result<Vec<u8>, CaptureError> {
        let mut encoder =
            gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("readback") });
        let readback = read_texture(&gpu.device, &mut encoder, &self.display);
        gpu.queue.submit([encoder.finish()]);
        Ok(readback.wait(gpu)?)
    }

    /// Of the frames drawn so far.
    pub fn state(&self) -> MutexGuard<'_, FrameState> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// What a frame is drawn into, or one pixel of it. Only the path that is taken has textures.
    fn attachments(
        &self,
        gpu: &Gpu,
        (renderer, scene, view): (&Renderer, &GpuScene, &View),
        pixel: Option<UVec2>,
    ) -> RadianceTarget<'_> {
        let forward_target = self.forward_target();
        // One pixel is not worth passes over all.
        let path = if pixel.is_some() { RenderPath::Forward } else { renderer.path(scene, view, forward_target) };
        let surfaces = self.surfaces(gpu, path);
        let ForwardTarget { format, samples, .. } = forward_target;
        RadianceTarget { format, samples, surfaces, depth: &self.depth, pixel }
    }

    fn surfaces(&self, gpu: &Gpu, path: RenderPath) -> SurfaceTarget<'_> {
        let CaptureOptions { samples, precision } = self.options;
        let attachment = wgpu::TextureUsages::RENDER_ATTACHMENT;
        let view = |what, usage| texture(gpu, self.size, what, usage).create_view(&Default::default());
        match path {
            RenderPath::Forward if samples == 1 => SurfaceTarget::Forward { color: &self.radiance_view, resolve: None },
            RenderPath::Forward => {
                let what = ("multisampled radiance", precision.hdr_format(), samples);
                let color = self.multisampled.get_or_init(|| view(what, attachment));
                SurfaceTarget::Forward { color, resolve: Some(&self.radiance_view) }
            }
            RenderPath::Deferred | RenderPath::Mixed => {
                let read = attachment | wgpu::TextureUsages::TEXTURE_BINDING;
                let visibility = || view(("visibility", formats::VISIBILITY, samples), read);
                let over = || view(("over", precision.hdr_format(), samples), read);
                SurfaceTarget::Deferred {
                    visibility: self.visibility.get_or_init(visibility),
                    covered: self.covered.get_or_init(|| view(("covered", formats::DEPTH, 1), attachment)),
                    over: (path == RenderPath::Mixed).then(|| self.over.get_or_init(over)),
                    color: &self.radiance_view,
                }
            }
        }
    }

    pub fn forward_target(&self) -> ForwardTarget {
        ForwardTarget::radiance(self.options.precision.hdr_format(), self.options.samples)
    }
}

/// A frame that was recorded and submitted.
#[derive(Debug)]
pub struct PendingFrame {
    pub stats: FrameStats,
    precision: Precision,
    width: u32,
    height: u32,
    radiance: Option<Readback>,
    display: Option<Readback>,
}

/// What is wanted of a frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Wanted {
    pub radiance: bool,
    pub display: bool,
}

/// What one pixel of a picture holds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CapturedPixel {
    /// Radiance, or what the view's channel is, multiplied with coverage; and coverage.
    pub radiance: Vec4,
    /// sRGB with straight alpha, in [0, 1] and in steps of 1/255.
    pub display: Vec4,
}

/// Draws one pixel of a picture, counted from the top left and inside of it, in the middle of which it looks, into a
/// target of [`PIXEL_OPTIONS`].
pub fn capture_pixel(
    gpu: &Gpu,
    renderer: &mut Renderer,
    scene: &mut GpuScene,
    view: &View,
    target: &CaptureTarget,
    pixel: UVec2,
) -> Result<CapturedPixel, CaptureError> {
    let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("pixel") });
    record_part(gpu, renderer, &mut encoder, scene, view, target, (true, Some(pixel)))?;
    let [radiance, display] =
        [&target.radiance, &target.display].map(|texture| read_texel(&gpu.device, &mut encoder, texture, pixel));
    gpu.queue.submit([encoder.finish()]);
    let (radiance, display) = (radiance.wait(gpu)?, display.wait(gpu)?);
    let mut texels = target.options.precision.texels(&radiance);
    let code = |i: usize| f32::from(display.get(i).copied().unwrap_or_default()) / 255.0;
    Ok(CapturedPixel {
        radiance: texels.pop().unwrap_or_default(),
        display: Vec4::new(code(0), code(1), code(2), code(3)),
    })
}

/// How a pixel is captured: as the reference renderer takes its one sample.
pub const PIXEL_OPTIONS: CaptureOptions = CaptureOptions { samples: 1, precision: Precision::Float };

/// A frame in memory.
#[derive(Debug, Clone, PartialEq)]
pub struct CapturedFrame {
    pub radiance: Option<RadianceImage>,
    /// RGBA8 from the top left: sRGB with straight alpha.
    pub display: Option<Vec<u8>>,
}

/// Records one frame into `encoder`: radiance and, where it is wanted, display light.
pub fn record(
    gpu: &Gpu,
    renderer: &mut Renderer,
    encoder: &mut wgpu::CommandEncoder,
    scene: &mut GpuScene,
    view: &View,
    target: &CaptureTarget,
    display: bool,
) -> Result<FrameStats, CaptureError> {
    record_part(gpu, renderer, encoder, scene, view, target, (display, None))
}

/// [`record`] of all pixels or of one.
fn record_part(
    gpu: &Gpu,
    renderer: &mut Renderer,
    encoder: &mut wgpu::CommandEncoder,
    scene: &mut GpuScene,
    view: &View,
    target: &CaptureTarget,
    (display, pixel): (bool, Option<UVec2>),
) -> Result<FrameStats, CaptureError> {
    let attachments = target.attachments(gpu, (renderer, scene, view), pixel);
    let (gpu, mut state) = ((&gpu.device, &gpu.queue), target.state());
    let stats = renderer.encode_radiance(gpu, encoder, scene, view, &attachments, &mut state)?;
    if display {
        let display = (&target.display_view, formats::CAPTURED_DISPLAY);
        renderer.encode_display(gpu, encoder, view, &target.radiance_view, display, &mut state)?;
    }
    Ok(stats)
}

/// One turn of a render loop: draws the view into the target and displays it there, unless that is what the target shows
/// already. Then nothing is recorded, submitted or allocated, and the answer is `None`.
pub fn redraw(
    gpu: &Gpu,
    renderer: &mut Renderer,
    scene: &mut GpuScene,
    view: &View,
    target: &CaptureTarget,
) -> Result<Option<FrameStats>, CaptureError> {
    let attachments = target.attachments(gpu, (renderer, scene, view), None);
    if renderer.is_current(&target.state(), scene, view, &attachments, Some(&target.display_view)) {
        return Ok(None);
    }
    let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("frame") });
    let stats = record(gpu, renderer, &mut encoder, scene, view, target, true)?;
    gpu.queue.submit([encoder.finish()]);
    Ok(Some(stats))
}

/// Draws one frame and starts its way back.
pub fn submit(
    gpu: &Gpu,
    renderer: &mut Renderer,
    scene: &mut GpuScene,
    view: &View,
    target: &CaptureTarget,
    wanted: Wanted,
) -> Result<PendingFrame, CaptureError> {
    let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("capture") });
    let stats = record(gpu, renderer, &mut encoder, scene, view, target, wanted.display)?;
    let mut read = |on: bool, texture| on.then(|| read_texture(&gpu.device, &mut encoder, texture));
    let radiance = read(wanted.radiance, &target.radiance);
    let display = read(wanted.display, &target.display);
    gpu.queue.submit([encoder.finish()]);
    let (width, height) = (view.size_px.x, view.size_px.y);
    Ok(PendingFrame { stats, precision: target.options.precision, width, height, radiance, display })
}

impl PendingFrame {
    /// Waits until the frame is drawn, but not for its way back.
    pub fn wait_drawn(&self, gpu: &Gpu) -> Result<(), CaptureError> {
        Ok(gpu.wait()?)
    }

    /// Waits for the frame.
    pub fn wait(self, gpu: &Gpu) -> Result<CapturedFrame, CaptureError> {
        let display = self.display.map(|readback| readback.wait(gpu)).transpose()?;
        let radiance = self.radiance.map(|readback| readback.wait(gpu)).transpose()?;
        gpu.check()?;
        let (width, height) = (self.width, self.height);
        Ok(CapturedFrame {
            radiance: radiance.map(|bytes| RadianceImage { width, height, texels: self.precision.texels(&bytes) }),
            display,
        })
    }
}

fn texture(
    gpu: &Gpu,
    size: wgpu::Extent3d,
    (label, format, sample_count): (&str, wgpu::TextureFormat, u32),
    usage: wgpu::TextureUsages,
) -> wgpu::Texture {
    gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some(label),
        size,
        mip_level_count: 1,
        sample_count,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage,
        view_formats: &[],
    })
}

fn check_samples(gpu: &Gpu, format: wgpu::TextureFormat, samples: u32) -> Result<(), CaptureError> {
    let adapter_specific = wgpu::Features::TEXTURE_ADAPTER_SPECIFIC_FORMAT_FEATURES;
    let features = if gpu.device.features().contains(adapter_specific) {
        gpu.adapter.get_texture_format_features(format)
    } else {
        format.guaranteed_format_features(gpu.device.features())
    };
    let renderable = features.allowed_usages.contains(wgpu::TextureUsages::RENDER_ATTACHMENT);
    let resolvable = features.flags.contains(wgpu::TextureFormatFeatureFlags::MULTISAMPLE_RESOLVE);
    let possible: Vec<u32> = [1, 2, 4, 8, 16]
        .into_iter()
        .filter(|&count| renderable && features.flags.sample_count_supported(count) && (count == 1 || resolvable))
        .collect();
    if possible.contains(&samples) {
        return Ok(());
    }
    let format = format!("{format:?}");
    Err(CaptureError::Target { adapter: gpu.info.name.clone(), format, samples, possible })
}
