//! Baked tables as textures.

use crate::gpu::formats;
use wgpu::util::DeviceExt;

/// A table of little-endian unorm16, row-major.
#[derive(Debug, Clone, Copy)]
pub struct Table {
    pub label: &'static str,
    pub width: u32,
    pub height: u32,
    /// One or four.
    pub channels: usize,
    pub bytes: &'static [u8],
}

impl Table {
    /// Uploads the table, in half floats where the device has no 16-bit normalised formats.
    pub fn upload(&self, device: &wgpu::Device, queue: &wgpu::Queue) -> wgpu::TextureView {
        let format = formats::table(device.features(), self.channels);
        let half = |pair: &[u8]| half::f16::from_f32(f32::from(u16::from_le_bytes([pair[0], pair[1]])) / 65535.0);
        let halves: Vec<half::f16>;
        let bytes = if formats::is_half_float(format) {
            halves = self.bytes.chunks_exact(2).map(half).collect();
            bytemuck::cast_slice(&halves)
        } else {
            self.bytes
        };
        let descriptor = wgpu::TextureDescriptor {
            label: Some(self.label),
            size: wgpu::Extent3d { width: self.width, height: self.height, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage: wgpu::TextureUsages::TEXTURE_BINDING,
            view_formats: &[],
        };
        device
            .create_texture_with_data(queue, &descriptor, wgpu::util::TextureDataOrder::LayerMajor, bytes)
            .create_view(&Default::default())
    }
}
