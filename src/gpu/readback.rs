//! Copying textures and buffers back to memory.

use super::device::{Gpu, GpuError};
use super::lost::DeviceLost;
use glam::UVec2;
use std::sync::{Arc, OnceLock};

/// A texture or a buffer on its way to memory.
#[derive(Debug)]
pub struct Readback {
    buffer: wgpu::Buffer,
    row_bytes: usize,
    padded_row_bytes: usize,
    rows: usize,
}

/// Records the copy of level 0 of `texture`; the bytes are there after the encoder was submitted.
pub fn read_texture(device: &wgpu::Device, encoder: &mut wgpu::CommandEncoder, texture: &wgpu::Texture) -> Readback {
    read_region(device, encoder, texture.as_image_copy(), texture.size())
}

/// The same of one texel.
pub fn read_texel(
    device: &wgpu::Device,
    encoder: &mut wgpu::CommandEncoder,
    texture: &wgpu::Texture,
    at: UVec2,
) -> Readback {
    let origin = wgpu::Origin3d { x: at.x, y: at.y, z: 0 };
    let one = wgpu::Extent3d { width: 1, height: 1, depth_or_array_layers: 1 };
    read_region(device, encoder, wgpu::TexelCopyTextureInfo { origin, ..texture.as_image_copy() }, one)
}

fn read_region(
    device: &wgpu::Device,
    encoder: &mut wgpu::CommandEncoder,
    source: wgpu::TexelCopyTextureInfo<'_>,
    size: wgpu::Extent3d,
) -> Readback {
    let texel_bytes = source.texture.format().block_copy_size(None).unwrap_or(0) as usize;
    let row_bytes = size.width as usize * texel_bytes;
    let padded_row_bytes = row_bytes.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT as usize);
    let buffer = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("readback"),
        size: (padded_row_bytes * size.height as usize) as u64,
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    let layout =
        wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(padded_row_bytes as u32), rows_per_image: None };
    encoder.copy_texture_to_buffer(source, wgpu::TexelCopyBufferInfo { buffer: &buffer, layout }, size);
    Readback { buffer, row_bytes, padded_row_bytes, rows: size.height as usize }
}

/// Records the copy of `source`, whose size is a multiple of 4; the bytes are there after the encoder was submitted.
pub fn read_buffer(device: &wgpu::Device, encoder: &mut wgpu::CommandEncoder, source: &wgpu::Buffer) -> Readback {
    let buffer = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("readback"),
        size: source.size(),
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    encoder.copy_buffer_to_buffer(source, 0, &buffer, 0, source.size());
    let bytes = source.size() as usize;
    Readback { buffer, row_bytes: bytes, padded_row_bytes: bytes, rows: 1 }
}

impl Readback {
    /// Waits for the copy and returns the bytes, row-major without padding. Fails when the device reported an error.
    pub fn wait(self, gpu: &Gpu) -> Result<Vec<u8>, GpuError> {
        let (sender, receiver) = std::sync::mpsc::channel();
        self.buffer.slice(..).map_async(wgpu::MapMode::Read, move |result| {
            // The receiver is alive until this function returns; a failed send has no one to tell.
            let _ = sender.send(result);
        });
        gpu.wait()?;
        match receiver.try_recv() {
            Ok(Ok(())) => {}
            Ok(Err(error)) => return Err(GpuError::Failed(format!("mapping the result: {error}"))),
            Err(_) => return Err(GpuError::Failed("mapping the result: no answer".into())),
        }
        self.bytes().map_err(|error| GpuError::Failed(error.to_string()))
    }

    /// Has the bytes mapped when `encoder` is submitted: whoever polls the device makes them come.
    pub fn on_submit(self, encoder: &wgpu::CommandEncoder) -> Download {
        let arrived = Arc::new(OnceLock::new());
        let answer = Arc::clone(&arrived);
        encoder.map_buffer_on_submit(&self.buffer, wgpu::MapMode::Read, .., move |result| {
            // Called once.
            let _ = answer.set(result.is_ok());
        });
        Download { readback: self, arrived }
    }

    /// What has been mapped.
    fn bytes(&self) -> Result<Vec<u8>, wgpu::MapRangeError> {
        let mapped = self.buffer.slice(..).get_mapped_range()?;
        let mut bytes = Vec::with_capacity(self.row_bytes * self.rows);
        for row in mapped.chunks_exact(self.padded_row_bytes) {
            bytes.extend_from_slice(&row[..self.row_bytes]);
        }
        Ok(bytes)
    }
}

/// Bytes on their way to memory, for which nobody waits.
#[derive(Debug)]
pub struct Download {
    readback: Readback,
    /// Whether they could be mapped.
    arrived: Arc<OnceLock<bool>>,
}

impl Download {
    /// The bytes, row-major without padding, once the submission is done and the device was polled; `None` before.
    ///
    /// # Errors
    /// [`DeviceLost`] where they never come.
    pub fn try_bytes(&self) -> Option<Result<Vec<u8>, DeviceLost>> {
        let is_mapped = *self.arrived.get()?;
        Some(if is_mapped { self.readback.bytes().map_err(|_| DeviceLost) } else { Err(DeviceLost) })
    }
}
