//! Scene radiance to display values: exposure, tone map, background colour, sRGB.

use crate::gpu::bindings::display_layout;
use crate::gpu::pipeline::{FullscreenDepth, FullscreenTarget, PassError, fullscreen_pipeline};
use crate::gpu::{KeptUniform, PassClock, timed};
use crate::gpu_scene::entry;
use crate::shader::types::DisplayUniform;
use crate::shader::{Composed, DisplayFeatures, ShaderSources, create_module, display_module};
use std::collections::HashMap;

/// Display pipelines by features and target format.
#[derive(Debug)]
pub struct DisplayPipelines {
    layout: wgpu::BindGroupLayout,
    pipelines: HashMap<(DisplayFeatures, wgpu::TextureFormat), (Composed, wgpu::RenderPipeline)>,
}

/// What one view binds to be displayed.
#[derive(Debug)]
pub struct DisplayPass {
    group: wgpu::BindGroup,
    pipeline: wgpu::RenderPipeline,
}

impl DisplayPipelines {
    pub fn new(device: &wgpu::Device) -> Self {
        Self { layout: display_layout(device), pipelines: HashMap::new() }
    }

    /// Name and text of every module made so far.
    pub fn sources(&self) -> impl Iterator<Item = (String, &str)> {
        let name = |features: &DisplayFeatures| format!("display+{:?}", features.tone_map).to_lowercase();
        self.pipelines.iter().map(move |((features, _), (composed, _))| (name(features), composed.text.as_str()))
    }

    pub fn prepare(
        &mut self,
        (device, queue): (&wgpu::Device, &wgpu::Queue),
        sources: &ShaderSources,
        features: DisplayFeatures,
        format: wgpu::TextureFormat,
        radiance: &wgpu::TextureView,
        (uniform, kept): (&DisplayUniform, &mut KeptUniform<wgpu::TextureView>),
    ) -> Result<DisplayPass, PassError> {
        let pipeline = match self.pipelines.get(&(features, format)) {
            Some((_, pipeline)) => pipeline.clone(),
            None => {
                let composed = display_module(sources, features)?;
                let module = create_module(device, "display", &composed)?;
                let into =
                    FullscreenTarget { format: Some(format), samples: 1, depth: FullscreenDepth::None, blend: None };
                let pipeline = fullscreen_pipeline(device, "display", &[Some(&self.layout)], &module, into);
                self.pipelines.insert((features, format), (composed, pipeline.clone()));
                pipeline
            }
        };
        let bind = |uniform: &wgpu::Buffer, radiance: &wgpu::TextureView| {
            device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some("display"),
                layout: &self.layout,
                entries: &[
                    entry(0, uniform.as_entire_binding()),
                    entry(1, wgpu::BindingResource::TextureView(radiance)),
                ],
            })
        };
        let contents = bytemuck::bytes_of(uniform);
        let group = kept.group((device, queue), "display", contents, radiance.clone(), bind)?;
        Ok(DisplayPass { group, pipeline })
    }
}

impl DisplayPass {
    /// Overwrites all of `target`.
    pub fn encode(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        target: &wgpu::TextureView,
        clock: &mut Option<PassClock>,
    ) {
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("display"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: target,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::BLACK), store: wgpu::StoreOp::Store },
            })],
            depth_stencil_attachment: None,
            timestamp_writes: timed(clock, "display"),
            occlusion_query_set: None,
            multiview_mask: None,
        });
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &self.group, &[]);
        pass.draw(0..3, 0..1);
    }
}
