//! What some channels need beside their shaders.

use super::{RenderError, Renderer};
use crate::gpu::formats::Precision;
use crate::gpu_scene::GpuScene;
use crate::scene::{Channel, View};

impl Renderer {
    /// Whether this device can draw the channel of a view of this scene.
    pub(super) fn check_channel(
        &self,
        device: &wgpu::Device,
        scene: &GpuScene,
        view: &View,
        format: wgpu::TextureFormat,
    ) -> Result<(), RenderError> {
        let lacks = |feature| !device.features().contains(feature);
        match view.channel {
            Some(Channel::Furnace) if scene.environment.is_none() => Err(RenderError::NoFurnace),
            Some(Channel::Wireframe) if lacks(wgpu::Features::POLYGON_MODE_LINE) => {
                Err(RenderError::Device { what: "edges of triangles", feature: "POLYGON_MODE_LINE" })
            }
            Some(Channel::Overdraw) if format == Precision::Float.hdr_format() && !self.blends_float => {
                Err(RenderError::Device { what: "layers in a float32 target", feature: "FLOAT32_BLENDABLE" })
            }
            _ => Ok(()),
        }
    }
}
