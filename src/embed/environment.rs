//! Panoramas that a host has on its device.

use super::EmbedError;
use crate::gpu::formats::Precision;
use crate::gpu::{Download, read_texture};
use crate::scene::EnvironmentImage;

/// A panorama on its way from a host's texture, to be baked and given to [`super::LiveScene::set_environment`].
#[derive(Debug)]
pub struct EnvironmentDownload {
    download: Download,
    precision: Precision,
    size: [u32; 2],
}

impl EnvironmentDownload {
    /// Records the copy of level 0 of an equirectangular panorama into the host's encoder: linear Rec.709 radiance in cd/m2,
    /// laid out as [`EnvironmentImage`] is.
    ///
    /// # Errors
    /// For textures that are not one picture of half floats or floats with four channels that can be copied from.
    pub fn record(
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        panorama: &wgpu::Texture,
    ) -> Result<Self, EmbedError> {
        let precisions = [Precision::Half, Precision::Float];
        let precision = precisions.into_iter().find(|precision| precision.hdr_format() == panorama.format());
        let is_picture = panorama.dimension() == wgpu::TextureDimension::D2
            && (panorama.depth_or_array_layers(), panorama.sample_count()) == (1, 1);
        let fault = |what: &str| Err(EmbedError::Asset(format!("the panorama of the host {what}")));
        let Some(precision) = precision else { return fault("does not hold four floats a texel") };
        if !is_picture {
            return fault("is not one picture");
        }
        if !panorama.usage().contains(wgpu::TextureUsages::COPY_SRC) {
            return fault("was not made to be copied from");
        }
        let download = read_texture(device, encoder, panorama).on_submit(encoder);
        Ok(Self { download, precision, size: [panorama.width(), panorama.height()] })
    }

    /// The panorama, once the host's device was polled after the copy; `None` before. What is below 0 or no number is black.
    ///
    /// # Errors
    /// Where the device was lost on the way.
    pub fn try_image(&self) -> Option<Result<EnvironmentImage, EmbedError>> {
        let bytes = match self.download.try_bytes()? {
            Ok(bytes) => bytes,
            Err(lost) => return Some(Err(EmbedError::Render(lost.into()))),
        };
        let light = |value: f32| if value.is_finite() { value.max(0.0) } else { 0.0 };
        let texels = self.precision.texels(&bytes).into_iter().map(|texel| texel.truncate().map(light)).collect();
        let [width, height] = self.size;
        Some(Ok(EnvironmentImage { width, height, texels }))
    }
}
