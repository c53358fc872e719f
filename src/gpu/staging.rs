//! Texels on their way to the device.

use std::collections::VecDeque;

/// How the texels of an upload get to the device.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Uploads {
    /// All are staged until the queue is submitted to next; nothing is submitted, polled or waited for.
    #[default]
    Queued,
    /// At most [`Staging::LIMIT_BYTES`] are staged at a time: uploads submit, and wait until the device has everything.
    Bounded,
}

/// Writes textures: what is written is staged once more, and stays so until the device is done with the submission that
/// takes it.
#[derive(Debug)]
pub struct Staging<'a> {
    pub device: &'a wgpu::Device,
    pub queue: &'a wgpu::Queue,
    uploads: Uploads,
    /// Written, but not submitted yet.
    written_bytes: u64,
    /// What earlier submissions take, the oldest first.
    submitted: VecDeque<(wgpu::SubmissionIndex, u64)>,
}

impl<'a> Staging<'a> {
    /// What is staged at most, if no single level has more: two times 2048 x 2048 texels of four bytes, so that one is
    /// staged while the device copies another.
    pub const LIMIT_BYTES: u64 = 32 << 20;

    /// From here on a submission is worth its cost.
    const SUBMITTED_BYTES: u64 = 4 << 20;

    pub fn new(device: &'a wgpu::Device, queue: &'a wgpu::Queue, uploads: Uploads) -> Self {
        Self { device, queue, uploads, written_bytes: 0, submitted: VecDeque::new() }
    }

    /// Writes `bytes`, tightly packed rows from the top, to a whole level. Bounded uploads may wait for what was
    /// written before.
    pub fn write(&mut self, texture: &wgpu::Texture, mip_level: u32, bytes: &[u8]) {
        let count = bytes.len() as u64;
        let is_bounded = self.uploads == Uploads::Bounded;
        while is_bounded && self.staged_bytes() > 0 && self.staged_bytes() + count > Self::LIMIT_BYTES {
            self.wait_for_the_oldest();
        }
        let side = |side: u32| (side >> mip_level).max(1);
        let size = wgpu::Extent3d {
            width: side(texture.width()),
            height: side(texture.height()),
            depth_or_array_layers: texture.depth_or_array_layers(),
        };
        let rows = size.height * size.depth_or_array_layers;
        let layout = wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(bytes.len() as u32 / rows),
            rows_per_image: Some(size.height),
        };
        let target = wgpu::TexelCopyTextureInfo { mip_level, ..texture.as_image_copy() };
        self.queue.write_texture(target, bytes, layout, size);
        self.written_bytes += count;
        if is_bounded && self.written_bytes >= Self::SUBMITTED_BYTES {
            self.submit();
        }
    }

    /// Waits until the device has all that was written, and so nothing is staged, if uploads are bounded.
    pub fn finish(&mut self) {
        while self.uploads == Uploads::Bounded && self.staged_bytes() > 0 {
            self.wait_for_the_oldest();
        }
    }

    fn staged_bytes(&self) -> u64 {
        self.written_bytes + self.submitted.iter().map(|(_, bytes)| bytes).sum::<u64>()
    }

    fn submit(&mut self) {
        self.submitted.push_back((self.queue.submit([]), std::mem::take(&mut self.written_bytes)));
    }

    fn wait_for_the_oldest(&mut self) {
        if self.submitted.is_empty() {
            self.submit();
        }
        if let Some((submission, _)) = self.submitted.pop_front() {
            let submission_index = Some(submission);
            // A device that fails tells its error handler, and whoever waits for a picture.
            let _ = self.device.poll(wgpu::PollType::Wait { submission_index, timeout: None });
        }
    }
}
