//! The panorama, drawn where no surface is.

use crate::gpu::KeptUniform;
use crate::gpu::bindings::{FRAME_ATLAS, FRAME_ENVIRONMENT, FRAME_SAMPLER, background_layout};
use crate::gpu::pipeline::{DepthTarget, FullscreenDepth, FullscreenTarget, PassError, fullscreen_pipeline};
use crate::gpu_scene::entry;
use crate::shader::types::BackgroundUniform;
use crate::shader::{
    Backdrop, Composed, ShaderError, ShaderSources, TargetLight, background_module_into, create_module,
};
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
    pub backdrop: Backdrop,
}

/// What is seen.
#[derive(Debug, Clone, PartialEq)]
pub enum BackgroundSource {
    Panorama(wgpu::TextureView),
    /// Uniform, prefiltered maps, and the sampler that shading has.
    Environment(wgpu::Buffer, wgpu::TextureView, wgpu::Sampler),
}

/// The pipeline of the panorama, for each target.
#[derive(Debug)]
pub struct BackgroundPipeline {
    sharp: wgpu::BindGroupLayout,
    blurred: wgpu::BindGroupLayout,
    sampler: wgpu::Sampler,
    modules: HashMap<(Backdrop, TargetLight), (Composed, wgpu::ShaderModule)>,
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
        let [sharp, blurred] = [Backdrop::Sharp, Backdrop::Blurred].map(|backdrop| background_layout(device, backdrop));
        Self { sharp, blurred, sampler, modules: HashMap::new(), pipelines: HashMap::new() }
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
        source: BackgroundSource,
        (uniform, kept): (&BackgroundUniform, &mut KeptUniform<BackgroundSource>),
    ) -> Result<BackgroundPass, PassError> {
        let pipeline = self.pipeline(device, sources, target)?;
        let bind = |uniform: &wgpu::Buffer, source: &BackgroundSource| {
            use wgpu::BindingResource::{Sampler, TextureView};
            let view = entry(0, uniform.as_entire_binding());
            let (layout, entries) = match source {
                BackgroundSource::Panorama(panorama) => {
                    (&self.sharp, vec![view, entry(1, TextureView(panorama)), entry(2, Sampler(&self.sampler))])
                }
                BackgroundSource::Environment(environment, atlas, sampler) => {
                    let environment = entry(FRAME_ENVIRONMENT, environment.as_entire_binding());
                    let maps = [entry(FRAME_ATLAS, TextureView(atlas)), entry(FRAME_SAMPLER, Sampler(sampler))];
                    (&self.blurred, [vec![view, environment], maps.into()].concat())
                }
            };
            let label = Some("background");
            device.create_bind_group(&wgpu::BindGroupDescriptor { label, layout, entries: &entries })
        };
        let contents = bytemuck::bytes_of(uniform);
        let group = kept.group((device, queue), "background", contents, source, bind)?;
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
        let key = (target.backdrop, target.light);
        let module = match self.modules.get(&key) {
            Some((_, module)) => module.clone(),
            None => {
                let composed = background_module_into(sources, target.backdrop, target.light)?;
                let module = create_module(device, "background", &composed)?;
                self.modules.insert(key, (composed, module.clone()));
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
        let layout = match target.backdrop {
            Backdrop::Sharp => &self.sharp,
            Backdrop::Blurred => &self.blurred,
        };
        let pipeline = fullscreen_pipeline(device, "background", &[Some(layout)], &module, into);
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
