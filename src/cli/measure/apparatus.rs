//! Runs probes on a device and tells what one takes more than another.

use super::kinds::{Fill, Tap};
use super::probes::TEXTURE_SIDE;
use crate::capture::CaptureError;
use crate::cli::clock::{Basis, median, time_frame, timestamps};
use crate::cli::error::CliError;
use crate::gpu::bindings::background_layout;
use crate::gpu::pipeline::{DepthTarget, FullscreenDepth, FullscreenTarget, fullscreen_pipeline};
use crate::gpu::{Gpu, Timestamps, formats};
use crate::gpu_scene::entry;
use crate::renderer::RenderError;
use crate::shader::{Backdrop, ShaderSources, Slots, compose, create_module};
use wgpu::util::DeviceExt;

/// Rounds of each measurement, of which the median counts.
const ROUNDS: usize = 7;
/// A probe is repeated until it takes so long, ms, but not more often than this.
const LEAST_MS: f64 = 4.0;
const MOST_PASSES: u32 = 256;

pub(super) struct Apparatus<'a> {
    gpu: &'a Gpu,
    basis: Basis,
    timestamps: Option<Timestamps>,
    layout: wgpu::BindGroupLayout,
    sampler: wgpu::Sampler,
}

/// A pass that is ready to be timed.
pub(super) struct Probe {
    pipeline: wgpu::RenderPipeline,
    group: wgpu::BindGroup,
    color: wgpu::TextureView,
    resolve: Option<wgpu::TextureView>,
    depth: Option<wgpu::TextureView>,
}

impl<'a> Apparatus<'a> {
    pub(super) fn new(gpu: &'a Gpu, basis: Basis) -> Self {
        let sampler = gpu.device.create_sampler(&wgpu::SamplerDescriptor {
            label: Some("probe"),
            address_mode_u: wgpu::AddressMode::Repeat,
            address_mode_v: wgpu::AddressMode::Repeat,
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            mipmap_filter: wgpu::MipmapFilterMode::Linear,
            ..Default::default()
        });
        // A uniform, a texture and a sampler are what a probe binds too.
        Self {
            gpu,
            basis,
            timestamps: timestamps(gpu),
            layout: background_layout(&gpu.device, Backdrop::Sharp),
            sampler,
        }
    }

    /// A pass over `side` by `side` pixels with the shader `wgsl`.
    pub(super) fn probe(
        &self,
        wgsl: String,
        fill: Fill,
        side: u32,
        texture: &wgpu::TextureView,
    ) -> Result<Probe, CliError> {
        let device = &self.gpu.device;
        let mut sources = ShaderSources::default();
        sources.insert("probe.wgsl", wgsl);
        let module = compose(&sources, "probe.wgsl", &Slots::new());
        let module = module.and_then(|composed| create_module(device, "probe", &composed));
        let module = module.map_err(|error| CaptureError::from(RenderError::from(error)))?;
        let format = fill.target.format();
        let depth = if fill.depth { FullscreenDepth::Behind(DepthTarget::OWN) } else { FullscreenDepth::None };
        let into = FullscreenTarget { format: Some(format), samples: fill.samples, depth, blend: None };
        let seed = [1.0 / side as f32, 0.999, 0.001, 2.0];
        let uniform = device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some("probe"),
            contents: bytemuck::bytes_of(&seed),
            usage: wgpu::BufferUsages::UNIFORM,
        });
        Ok(Probe {
            pipeline: fullscreen_pipeline(device, "probe", &[Some(&self.layout)], &module, into),
            group: device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some("probe"),
                layout: &self.layout,
                entries: &[
                    entry(0, uniform.as_entire_binding()),
                    entry(1, wgpu::BindingResource::TextureView(texture)),
                    entry(2, wgpu::BindingResource::Sampler(&self.sampler)),
                ],
            }),
            color: self.target(format, fill.samples, side),
            resolve: (fill.samples > 1).then(|| self.target(format, 1, side)),
            depth: fill.depth.then(|| self.target(formats::DEPTH, fill.samples, side)),
        })
    }

    fn target(&self, format: wgpu::TextureFormat, sample_count: u32, side: u32) -> wgpu::TextureView {
        let texture = self.gpu.device.create_texture(&wgpu::TextureDescriptor {
            label: Some("probe"),
            size: square(side),
            mip_level_count: 1,
            sample_count,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT,
            view_formats: &[],
        });
        texture.create_view(&Default::default())
    }

    /// A texture with all its levels, full of numbers that differ and are finite in every format.
    pub(super) fn texture(&self, tap: Tap) -> wgpu::TextureView {
        let format = tap.format(self.gpu.device.features());
        let texel_bytes = format.block_copy_size(None).unwrap_or(4);
        let mip_level_count = TEXTURE_SIDE.ilog2() + 1;
        let texels: u32 = (0..mip_level_count).map(|level| (TEXTURE_SIDE >> level).pow(2)).sum();
        let word = |i: u32| 0x3800_u16 | (i.wrapping_mul(2_654_435_761) >> 22) as u16;
        let bytes: Vec<u8> = (0..texels * texel_bytes / 2).flat_map(|i| word(i).to_le_bytes()).collect();
        let descriptor = wgpu::TextureDescriptor {
            label: Some("probe"),
            size: square(TEXTURE_SIDE),
            mip_level_count,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage: wgpu::TextureUsages::TEXTURE_BINDING,
            view_formats: &[],
        };
        let order = wgpu::util::TextureDataOrder::LayerMajor;
        let texture = self.gpu.device.create_texture_with_data(&self.gpu.queue, &descriptor, order, &bytes);
        texture.create_view(&Default::default())
    }

    /// What `more` takes more than `less`, ms: the median over rounds in which both run in turn.
    pub(super) fn difference_ms(&self, less: &Probe, more: &Probe) -> Result<f64, CliError> {
        // The first run compiles.
        self.run_ms(less, 1)?;
        self.run_ms(more, 1)?;
        let once = self.run_ms(more, 1)?;
        let passes = ((LEAST_MS / once.max(1e-6)).ceil() as u32).clamp(1, MOST_PASSES);
        let mut differences = Vec::new();
        for round in 0..ROUNDS {
            // Both orders, so that what the first leaves to the second counts for neither.
            let (less_ms, more_ms) = if round % 2 == 0 {
                let less_ms = self.run_ms(less, passes)?;
                (less_ms, self.run_ms(more, passes)?)
            } else {
                let more_ms = self.run_ms(more, passes)?;
                (self.run_ms(less, passes)?, more_ms)
            };
            differences.push((more_ms - less_ms) / f64::from(passes));
        }
        Ok(median(differences.into_iter()).unwrap_or(0.0).max(0.0))
    }

    fn run_ms(&self, probe: &Probe, passes: u32) -> Result<f64, CliError> {
        let times = time_frame(self.gpu, self.timestamps.as_ref(), |encoder| {
            (0..passes).for_each(|_| probe.encode(encoder));
            Ok(())
        })?;
        self.basis.check([times].iter())?;
        Ok(self.basis.of(&times).unwrap_or(times.wall_ms))
    }
}

impl Probe {
    fn encode(&self, encoder: &mut wgpu::CommandEncoder) {
        let store = if self.resolve.is_some() { wgpu::StoreOp::Discard } else { wgpu::StoreOp::Store };
        let depth = self.depth.as_ref().map(|view| wgpu::RenderPassDepthStencilAttachment {
            view,
            depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store: wgpu::StoreOp::Discard }),
            stencil_ops: None,
        });
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("probe"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &self.color,
                depth_slice: None,
                resolve_target: self.resolve.as_ref(),
                ops: wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT), store },
            })],
            depth_stencil_attachment: depth,
            timestamp_writes: None,
            occlusion_query_set: None,
            multiview_mask: None,
        });
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &self.group, &[]);
        pass.draw(0..3, 0..1);
    }
}

fn square(side: u32) -> wgpu::Extent3d {
    wgpu::Extent3d { width: side, height: side, depth_or_array_layers: 1 }
}
