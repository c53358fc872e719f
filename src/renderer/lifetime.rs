//! What a renderer takes from one device to the next, and what the host lends it.

use super::{RenderError, Renderer};
use crate::gpu::{LostFlag, Staging, Uploads};
use crate::passes::ForwardPipelines;

impl Renderer {
    /// With the host's memory of what its driver has compiled, for the pipelines of surfaces. The cache is of this
    /// renderer's device, which has [`wgpu::Features::PIPELINE_CACHE`].
    ///
    /// ```
    /// use specula::embed::{LiveScene, Requirements};
    /// use specula::glam::UVec2;
    /// use specula::gpu::{GpuRequest, adapters, formats::Precision};
    /// use specula::renderer::{FrameState, PassFormat, Renderer};
    /// use specula::scene::{Background, Material, Mesh, Node, Scene, View, framing::default_view, shapes};
    /// use specula::wgpu;
    ///
    /// type Failure = Box<dyn std::error::Error>;
    ///
    /// fn open(adapter: &wgpu::Adapter) -> Result<(wgpu::Device, wgpu::Queue), Failure> {
    ///     let mut descriptor = Requirements::for_adapter(adapter, Precision::Half)?.device_descriptor();
    ///     descriptor.required_features |= wgpu::Features::PIPELINE_CACHE;
    ///     Ok(pollster::block_on(adapter.request_device(&descriptor))?)
    /// }
    ///
    /// fn cache(device: &wgpu::Device, data: Option<&[u8]>) -> wgpu::PipelineCache {
    ///     let descriptor = wgpu::PipelineCacheDescriptor { label: None, data, fallback: true };
    ///     // SAFETY: the data are what a cache of this adapter gave.
    ///     unsafe { device.create_pipeline_cache(&descriptor) }
    /// }
    ///
    /// /// Makes the pipelines of a ball.
    /// fn prepare(mut renderer: Renderer, device: &wgpu::Device, queue: &wgpu::Queue) -> Result<(), Failure> {
    ///     let ball = Scene {
    ///         nodes: vec![Node { mesh: Some(0), ..Default::default() }],
    ///         roots: vec![0],
    ///         meshes: vec![Mesh { name: None, primitives: vec![shapes::sphere(1.0, 8, 0)] }],
    ///         materials: vec![Material { unlit: true, ..Default::default() }],
    ///         ..Default::default()
    ///     };
    ///     let mut scene = LiveScene::new();
    ///     scene.insert(&ball)?;
    ///     let view = View { background: Background::Transparent, ..default_view(&ball, UVec2::splat(16)) };
    ///     let uploaded = scene.update(&renderer, (device, queue))?;
    ///     let (pass, mut state) = (PassFormat::own(1), FrameState::default());
    ///     renderer.prepare_frame((device, queue), uploaded, (&view, UVec2::ZERO), &pass, &mut state)?;
    ///     Ok(())
    /// }
    ///
    /// let adapter = adapters(&GpuRequest::default())?.remove(0);
    /// if adapter.features().contains(wgpu::Features::PIPELINE_CACHE) {
    ///     let (device, queue) = open(&adapter)?;
    ///     let first = cache(&device, None);
    ///     prepare(Renderer::new(&device, &queue).with_pipeline_cache(first.clone()), &device, &queue)?;
    ///     // What the host keeps in a file, and has the next time.
    ///     let kept = first.get_data();
    ///     let second = cache(&device, kept.as_deref());
    ///     prepare(Renderer::new(&device, &queue).with_pipeline_cache(second), &device, &queue)?;
    /// #   // Pipelines are made with it, or else nobody would mind one of another device.
    /// #   let foreign = cache(&open(&adapter)?.0, None);
    /// #   let scope = device.push_error_scope(wgpu::ErrorFilter::Validation);
    /// #   prepare(Renderer::new(&device, &queue).with_pipeline_cache(foreign), &device, &queue)?;
    /// #   assert!(pollster::block_on(scope.pop()).is_some());
    /// }
    /// # Ok::<(), Failure>(())
    /// ```
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
