//! What a renderer takes from one device to the next, and what the host lends it.

use super::{RenderError, Renderer};
use crate::gpu::{LostFlag, Staging, Uploads};
use crate::passes::ForwardPipelines;

impl Renderer {
    /// With the host's memory of what its driver has compiled, for the pipelines of surfaces. The cache is of this
    /// renderer's device.
    pub fn with_pipeline_cache(self, cache: wgpu::PipelineCache) -> Self {
        Self { forward: ForwardPipelines::with_cache(Some(cache)), ..self }
    }

    /// With another way for texels to the device, for uploads from now on.
    pub fn with_uploads(self, uploads: Uploads) -> Self {
        Self { uploads, ..self }
    }

    /// With what tells that this renderer's device is lost. Without one it is found out where a buffer is made or written,
    /// which a frame like the one before does not do.
    pub fn with_lost_flag(self, lost: LostFlag) -> Self {
        Self { lost, ..self }
    }

    /// Whether the flag of [`Self::with_lost_flag`] is raised: all that uploads or records is then
    /// [`RenderError::DeviceLost`], until [`Self::restore`] gives another renderer.
    pub fn is_lost(&self) -> bool {
        self.lost.is_raised()
    }

    /// # Errors
    /// [`RenderError::DeviceLost`] where [`Self::is_lost`].
    pub(crate) fn check_device(&self) -> Result<(), RenderError> {
        Ok(self.lost.check()?)
    }

    /// A renderer like this one on another device, after its own was lost: with its shaders, paths, culling and way of
    /// uploading. Pipelines are made when they are needed; a pipeline cache and a flag belong to the device that is gone.
    pub fn restore(&self, device: &wgpu::Device, queue: &wgpu::Queue) -> Self {
        let Self { sources, path, culling, uploads, .. } = self;
        let fresh = Self::with_shaders(device, queue, sources.clone());
        Self { path: *path, culling: *culling, uploads: *uploads, ..fresh }
    }

    /// What an upload goes through.
    pub(super) fn staging<'a>(
        &self,
        device: &'a wgpu::Device,
        queue: &'a wgpu::Queue,
    ) -> Result<Staging<'a>, RenderError> {
        self.check_device()?;
        Ok(Staging::new(device, queue, self.uploads))
    }
}
