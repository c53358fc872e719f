//! What the real shaders make of a pixel, one channel at a time.

use crate::capture::{CaptureError, CaptureTarget, CapturedPixel, PIXEL_OPTIONS, capture_pixel};
use crate::cli::error::CliError;
use crate::frame::PrimitivePlace;
use crate::gpu::{Gpu, Uploads};
use crate::gpu_scene::GpuScene;
use crate::renderer::Renderer;
use crate::scene::{Channel, EnvironmentMaps, Input, Scene, Sun, View};
use crate::shader::channel_is_read;
use glam::{DVec3, UVec2};

/// A scene on the device, and the pixel that is looked at.
pub(super) struct Shaders<'a> {
    gpu: &'a Gpu,
    renderer: Renderer,
    scene: GpuScene,
    target: CaptureTarget,
    view: View,
    pixel: UVec2,
    /// The suns that the environment's maps were parted from.
    pub(super) suns: Vec<Sun>,
}

impl<'a> Shaders<'a> {
    pub(super) fn new(
        gpu: &'a Gpu,
        scene: &Scene,
        view: &View,
        pixel: UVec2,
        maps: Option<EnvironmentMaps>,
    ) -> Result<Self, CliError> {
        let renderer = Renderer::new(&gpu.device, &gpu.queue).with_uploads(Uploads::Bounded);
        let uploaded = renderer.upload(&gpu.device, &gpu.queue, scene, maps.as_ref()).map_err(CaptureError::from)?;
        let target = CaptureTarget::new(gpu, view, PIXEL_OPTIONS)?;
        let suns = maps.map_or_else(Vec::new, |maps| maps.suns);
        Ok(Self { gpu, renderer, scene: uploaded, target, view: view.clone(), pixel, suns })
    }

    /// Name of the adapter and its driver.
    pub(super) fn description(&self) -> String {
        self.gpu.description()
    }

    /// What the pixel of a frame holds.
    pub(super) fn picture(&mut self) -> Result<CapturedPixel, CliError> {
        self.capture(None)
    }

    /// What the nearest surface has in a channel. Black where there is none.
    pub(super) fn channel(&mut self, channel: Channel) -> Result<DVec3, CliError> {
        Ok(self.capture(Some(channel))?.radiance.truncate().as_dvec3())
    }

    fn capture(&mut self, channel: Option<Channel>) -> Result<CapturedPixel, CliError> {
        self.view.channel = channel;
        let Self { gpu, renderer, scene, target, view, pixel, .. } = self;
        Ok(capture_pixel(gpu, renderer, scene, view, target, *pixel)?)
    }

    /// An input of the nearest surface, which is of this primitive of a mesh; `None` if its shader has no use for it.
    pub(super) fn input(&mut self, input: Input, place: PrimitivePlace) -> Result<Option<DVec3>, CliError> {
        let drawable = self.scene.drawables.find(place);
        let is_read = drawable
            .is_some_and(|drawable| channel_is_read(input, &drawable.material_features, &drawable.vertex_features));
        if !is_read {
            return Ok(None);
        }
        let value = self.channel(Channel::Input(input))?;
        Ok(Some(if input == Input::Position { value + self.scene.drawables.origin_in_world } else { value }))
    }

    /// The set of texture coordinates that [`Input::Uv`] is of, for a primitive of a mesh.
    pub(super) fn uv_set(&self, place: PrimitivePlace) -> Option<usize> {
        let drawable = self.scene.drawables.find(place)?;
        drawable.vertex_features.uv_sets().next().map(|set| set as usize)
    }
}
