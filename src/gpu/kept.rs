//! What a pass binds, kept from frame to frame.

use super::lost::{DeviceLost, filled_buffer, write_buffer};
use std::sync::Arc;

/// Tells a thing from all others, for as long as somebody remembers it. Handles of wgpu do not: those of two instances may
/// be equal, so that what is kept of a lost device is mistaken for something of the next.
#[derive(Debug, Clone, Default)]
pub struct Identity(Arc<()>);

impl PartialEq for Identity {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

/// A uniform buffer in a bind group: both are made when first asked for, or when the group has to bind something else,
/// and otherwise the buffer alone is written, if its contents are others.
#[derive(Debug)]
pub struct KeptUniform<K> {
    kept: Option<Kept<K>>,
    made: u32,
}

#[derive(Debug)]
struct Kept<K> {
    beside: K,
    contents: Vec<u8>,
    buffer: wgpu::Buffer,
    group: wgpu::BindGroup,
}

impl<K> Default for KeptUniform<K> {
    fn default() -> Self {
        Self { kept: None, made: 0 }
    }
}

impl<K: PartialEq> KeptUniform<K> {
    /// The group that `bind` makes of a uniform buffer with `contents` and of what is `beside` it.
    ///
    /// The contents are written when the queue is submitted to next: one group serves one frame of a submission.
    ///
    /// # Errors
    /// [`DeviceLost`] where nothing can be made or written.
    pub fn group(
        &mut self,
        (device, queue): (&wgpu::Device, &wgpu::Queue),
        label: &str,
        contents: &[u8],
        beside: K,
        bind: impl FnOnce(&wgpu::Buffer, &K) -> wgpu::BindGroup,
    ) -> Result<wgpu::BindGroup, DeviceLost> {
        let kept = self.kept.take().filter(|kept| kept.beside == beside && kept.contents.len() == contents.len());
        let mut kept = match kept {
            Some(kept) => kept,
            None => {
                let usage = wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST;
                let buffer = filled_buffer(device, label, contents, usage)?;
                let group = bind(&buffer, &beside);
                self.made += 2;
                Kept { beside, contents: contents.to_vec(), buffer, group }
            }
        };
        if kept.contents != contents {
            write_buffer(queue, &kept.buffer, 0, contents)?;
            kept.contents.copy_from_slice(contents);
        }
        let group = kept.group.clone();
        self.kept = Some(kept);
        Ok(group)
    }

    /// Lets go of buffer and group.
    pub fn forget(&mut self) {
        self.kept = None;
    }

    /// Buffers and bind groups made so far.
    pub fn made(&self) -> u32 {
        self.made
    }
}
