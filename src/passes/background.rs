//! The panorama, drawn where no surface is.

use crate::gpu::KeptUniform;
use crate::gpu::bindings::background_layout;
use crate::gpu::pipeline::{DepthTarget, FullscreenDepth, FullscreenTarget, PassError, fullscreen_pipeline};
use crate::gpu_scene::{Panorama, entry};
use crate::shader::types::BackgroundUniform;
use crate::shader::{Composed, ShaderError, ShaderSources, TargetLight, background_module_into, create_module};
use std::collections::HashMap;
use std::ops::Range;

/// What the panorama is drawn into.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct BackgroundTarget {
    pub format: wgpu::TextureFormat,
    pub samples: u32,
    pub depth: DepthTarget,
    pub light: TargetLight,
    /// Under what is there, by its coverage, and where the depth is the triangle's own; else behind what is nearer.
    pub under: bool,
}

/// The pipeline of the panorama, for each target.
#[derive(Debug)]
pub struct BackgroundPipeline {
    layout: wgpu::BindGroupLayout,
    sampler: wgpu::Sampler,
    modules: HashMap<TargetLight, (Composed, wgpu::ShaderModule)>,
    pipelines: HashMap<BackgroundTarget, wgpu::RenderPipeline>,
}

/// What one view binds to see the panorama.
#[derive(Debug)]
pub struct BackgroundPass {
    group: wgpu::BindGroup,
    pipeline: wgpu::RenderPipeline,
    instances: Range<u32>,
}

impl BackgroundPipeline {
    pub fn new(device: &wgpu::Device) -> Self {
        let sampler = device.create_sampler(&wgpu::SamplerDescriptor {
            label: Some("panorama"),
            address_mode_u: wgpu::AddressMode::Repeat,
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            ..Default::default()
        });
        Self { layout: background_layout(device), sampler, modules: HashMap::new(), pipelines: HashMap::new() }
    }

    /// Texts of the modules that were used.
    pub fn sources(&self) -> impl Iterator<Item = &str> {
        self.modules.values().map(|(composed, _)| composed.text.as_str())
    }

    pub fn prepare(
        &mut self,
        (device, queue): (&wgpu::Device, &wgpu::Queue),
        sources: &ShaderSources,
        target: BackgroundTarget,
        panorama: &Panorama,
        (uniform, kept): (&BackgroundUniform, &mut KeptUniform<wgpu::TextureView>),
    ) -> Result<BackgroundPass, PassError> {
        let pipeline = self.pipeline(device, sources, target)?;
        let bind = |uniform: &wgpu::Buffer, view: &wgpu::TextureView| {
            device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some("background"),
                layout: &self.layout,
                entries: &[
                    entry(0, uniform.as_entire_binding()),
                    entry(1, wgpu::BindingResource::TextureView(view)),
                    entry(2, wgpu::BindingResource::Sampler(&self.sampler)),
                ],
            })
        };
        let contents = bytemuck::bytes_of(uniform);
        let group = kept.group((device, queue), "background", contents, panorama.view.clone(), bind)?;
        let instances = match (target.under, target.depth.reversed) {
            (true, _) => 0..2,
            (false, true) => 0..1,
            // At depth 1.
            (false, false) => 1..2,
        };
        Ok(BackgroundPass { group, pipeline, instances })
    }

    fn pipeline(
        &mut self,
        device: &wgpu::Device,
        sources: &ShaderSources,
        target: BackgroundTarget,
    ) -> Result<wgpu::RenderPipeline, ShaderError> {
        if let Some(pipeline) = self.pipelines.get(&target) {
            return Ok(pipeline.clone());
        }
        let module = match self.modules.get(&target.light) {
            Some((_, module)) => module.clone(),
            None => {
                let composed = background_module_into(sources, target.light)?;
                let module = create_module(device, "background", &composed)?;
                self.modules.insert(target.light, (composed, module.clone()));
                module
            }
        };
        let component = wgpu::BlendComponent {
            src_factor: wgpu::BlendFactor::OneMinusDstAlpha,
            dst_factor: wgpu::BlendFactor::One,
            operation: wgpu::BlendOperation::Add,
        };
        let into = FullscreenTarget {
            format: Some(target.format),
            samples: target.samples,
            depth: if target.under { FullscreenDepth::Equal } else { FullscreenDepth::Behind(target.depth) },
            blend: target.under.then_some(wgpu::BlendState { color: component, alpha: component }),
        };
        let pipeline = fullscreen_pipeline(device, "background", &[Some(&self.layout)], &module, into);
        self.pipelines.insert(target, pipeline.clone());
        Ok(pipeline)
    }
}

impl BackgroundPass {
    /// Where nothing is; with `under`, also where something covers a part of the pixel.
    pub fn draw(&self, pass: &mut wgpu::RenderPass<'_>) {
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &self.group, &[]);
        pass.draw(0..3, self.instances.clone());
    }
}
