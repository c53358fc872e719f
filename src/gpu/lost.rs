//! Devices that are gone: what tells it, and what does not panic on one.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use wgpu::util::DeviceExt;

/// The device is lost, or has no memory left, so that nothing can be made or written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("the device is lost; restore the renderer on another one")]
pub struct DeviceLost;

/// Whether a device is lost, shared by the one callback that wgpu tells it to and all who ask.
#[derive(Debug, Clone, Default)]
pub struct LostFlag(Arc<AtomicBool>);

impl LostFlag {
    /// Takes the callback of a device that nobody else listens to. A host that does listen makes a flag of its own and
    /// raises that.
    pub fn watch(device: &wgpu::Device) -> Self {
        let flag = Self::default();
        let raised = flag.clone();
        device.set_device_lost_callback(move |_, _| raised.raise());
        flag
    }

    pub fn raise(&self) {
        self.0.store(true, Ordering::Relaxed);
    }

    pub fn is_raised(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }

    /// # Errors
    /// [`DeviceLost`] once the flag is raised.
    pub fn check(&self) -> Result<(), DeviceLost> {
        if self.is_raised() { Err(DeviceLost) } else { Ok(()) }
    }
}

/// A buffer with `contents`. wgpu's own function panics where a device is lost.
///
/// # Errors
/// [`DeviceLost`] where the device makes no buffers any more.
pub fn filled_buffer(
    device: &wgpu::Device,
    label: &str,
    contents: &[u8],
    usage: wgpu::BufferUsages,
) -> Result<wgpu::Buffer, DeviceLost> {
    let label = Some(label);
    if contents.is_empty() {
        return Ok(device.create_buffer_init(&wgpu::util::BufferInitDescriptor { label, contents, usage }));
    }
    let size = (contents.len() as u64).next_multiple_of(wgpu::COPY_BUFFER_ALIGNMENT);
    let buffer = device.create_buffer(&wgpu::BufferDescriptor { label, size, usage, mapped_at_creation: true });
    let mut mapped = buffer.get_mapped_range_mut(..).map_err(|_| DeviceLost)?;
    mapped.slice(..contents.len()).copy_from_slice(contents);
    drop(mapped);
    buffer.unmap();
    Ok(buffer)
}

/// Writes `contents`, a multiple of four bytes, when the queue is submitted to next.
///
/// # Errors
/// [`DeviceLost`] where the device takes nothing any more.
pub fn write_buffer(
    queue: &wgpu::Queue,
    buffer: &wgpu::Buffer,
    offset: u64,
    contents: &[u8],
) -> Result<(), DeviceLost> {
    let Some(size) = wgpu::BufferSize::new(contents.len() as u64) else { return Ok(()) };
    queue.write_buffer_with(buffer, offset, size).ok_or(DeviceLost)?.slice(..).copy_from_slice(contents);
    Ok(())
}
