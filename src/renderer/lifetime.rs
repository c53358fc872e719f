//! What a renderer takes from one device to the next, and what the host lends it.

use super::Renderer;
use crate::passes::ForwardPipelines;

impl Renderer {
    /// With the host's memory of what its driver has compiled, for the pipelines of surfaces. The cache is of this
    /// renderer's device.
    pub fn with_pipeline_cache(self, cache: wgpu::PipelineCache) -> Self {
        Self { forward: ForwardPipelines::with_cache(Some(cache)), ..self }
    }

    /// A renderer like this one on another device, after its own was lost: with its shaders, paths and culling. Pipelines
    /// are made when they are needed; a pipeline cache belongs to the device that is gone.
    pub fn restore(&self, device: &wgpu::Device, queue: &wgpu::Queue) -> Self {
        let Self { sources, path, culling, .. } = self;
        Self { path: *path, culling: *culling, ..Self::with_shaders(device, queue, sources.clone()) }
    }
}
