//! Finished pictures to a window: display values are copied as they are.

use crate::gpu::bindings::present_layout;
use crate::gpu::pipeline::{FullscreenDepth, FullscreenTarget, fullscreen_pipeline};
use crate::gpu::{DeviceLost, KeptUniform};
use crate::gpu_scene::entry;
use crate::shader::types::PresentUniform;
use crate::shader::{ShaderError, ShaderSources, create_module, present_module};

/// Two pictures of the window's size, on both sides of a line.
#[derive(Debug, Clone, Copy)]
pub struct Presented<'a> {
    pub left: &'a wgpu::TextureView,
    pub right: &'a wgpu::TextureView,
    /// Where the right picture begins, pixels from the left; beyond the width there is the left one alone.
    pub split_px: f32,
    /// Behind pixels that are not covered: display values.
    pub behind: [f32; 3],
}

/// Half the width of the line between the pictures, pixels.
const LINE_PX: f32 = 1.0;

/// What windows of one format are drawn with.
#[derive(Debug)]
pub struct PresentPass {
    layout: wgpu::BindGroupLayout,
    pipeline: wgpu::RenderPipeline,
    kept: KeptUniform<[wgpu::TextureView; 2]>,
}

impl PresentPass {
    pub fn new(
        device: &wgpu::Device,
        sources: &ShaderSources,
        format: wgpu::TextureFormat,
    ) -> Result<Self, ShaderError> {
        let layout = present_layout(device);
        let module = create_module(device, "present", &present_module(sources)?)?;
        let into = FullscreenTarget { format: Some(format), samples: 1, depth: FullscreenDepth::None, blend: None };
        let pipeline = fullscreen_pipeline(device, "present", &[Some(&layout)], &module, into);
        Ok(Self { layout, pipeline, kept: KeptUniform::default() })
    }

    /// Writes what the pass reads. Once a submission.
    ///
    /// # Errors
    /// Where the device is lost.
    pub fn prepare(
        &mut self,
        (device, queue): (&wgpu::Device, &wgpu::Queue),
        shown: &Presented<'_>,
    ) -> Result<wgpu::BindGroup, DeviceLost> {
        let [r, g, b] = shown.behind;
        let uniform =
            PresentUniform { behind: [r, g, b, 1.0], split_px: shown.split_px, line_px: LINE_PX, ..Default::default() };
        let beside = [shown.left.clone(), shown.right.clone()];
        let bind = |uniform: &wgpu::Buffer, [left, right]: &[wgpu::TextureView; 2]| {
            device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some("present"),
                layout: &self.layout,
                entries: &[
                    entry(0, uniform.as_entire_binding()),
                    entry(1, wgpu::BindingResource::TextureView(left)),
                    entry(2, wgpu::BindingResource::TextureView(right)),
                ],
            })
        };
        self.kept.group((device, queue), "present", bytemuck::bytes_of(&uniform), beside, bind)
    }

    /// Covers the whole target of `pass`.
    pub fn draw(&self, pass: &mut wgpu::RenderPass<'_>, group: &wgpu::BindGroup) {
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, group, &[]);
        pass.draw(0..3, 0..1);
    }
}
