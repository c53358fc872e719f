//! The device's own clock: when passes began and ended.

use super::device::{Gpu, GpuError};
use super::readback::{Readback, read_buffer};

/// Marks on the device's clock.
#[derive(Debug)]
pub struct Timestamps {
    pub queries: wgpu::QuerySet,
    ticks: wgpu::Buffer,
    ms_per_tick: f64,
}

impl Timestamps {
    /// Room for so many marks; `None` where the device lacks one of `needed`, which say where marks can be set.
    pub fn new(device: &wgpu::Device, queue: &wgpu::Queue, needed: wgpu::Features, count: u32) -> Option<Self> {
        let create = || Self {
            queries: device.create_query_set(&wgpu::QuerySetDescriptor {
                label: Some("timestamps"),
                ty: wgpu::QueryType::Timestamp,
                count,
            }),
            ticks: device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("timestamps"),
                size: u64::from(count) * wgpu::QUERY_SIZE as u64,
                usage: wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC,
                mapped_at_creation: false,
            }),
            ms_per_tick: f64::from(queue.get_timestamp_period()) * 1e-6,
        };
        device.features().contains(needed).then(create)
    }

    /// Records the way of the first `count` marks to memory.
    pub fn read(&self, device: &wgpu::Device, encoder: &mut wgpu::CommandEncoder, count: u32) -> Readback {
        encoder.resolve_query_set(&self.queries, 0..count, &self.ticks, 0);
        read_buffer(device, encoder, &self.ticks)
    }

    /// From mark `from` to mark `to` of those that were read, ms.
    pub fn between_ms(&self, bytes: &[u8], from: usize, to: usize) -> f64 {
        let tick = |mark: usize| bytes.chunks_exact(8).nth(mark).map_or(0, bytemuck::pod_read_unaligned::<u64>);
        tick(to).wrapping_sub(tick(from)) as f64 * self.ms_per_tick
    }
}

/// How long a pass took by the device's clock.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PassTime {
    pub name: &'static str,
    pub ms: f64,
}

/// Times the passes of one frame after the other.
#[derive(Debug)]
pub struct PassClock {
    marks: Timestamps,
    /// Of the passes of the frame that is being recorded, or was last.
    names: Vec<&'static str>,
}

/// Passes of a frame that are timed; later ones are not.
const PASSES: usize = 8;

impl PassClock {
    /// `None` where the device has no clock.
    pub fn new(device: &wgpu::Device, queue: &wgpu::Queue) -> Option<Self> {
        let marks = Timestamps::new(device, queue, wgpu::Features::TIMESTAMP_QUERY, 2 * PASSES as u32)?;
        Some(Self { marks, names: Vec::new() })
    }

    /// A frame begins.
    pub fn begin(&mut self) {
        self.names.clear();
    }

    /// What the next pass of the frame is told to write.
    pub fn of_pass(&mut self, name: &'static str) -> Option<wgpu::RenderPassTimestampWrites<'_>> {
        if self.names.len() == PASSES {
            return None;
        }
        let begin = 2 * self.names.len() as u32;
        self.names.push(name);
        Some(wgpu::RenderPassTimestampWrites {
            query_set: &self.marks.queries,
            beginning_of_pass_write_index: Some(begin),
            end_of_pass_write_index: Some(begin + 1),
        })
    }

    /// The times of the frame that was submitted last, in its order. Waits for it.
    pub fn times(&self, gpu: &Gpu) -> Result<Vec<PassTime>, GpuError> {
        if self.names.is_empty() {
            return Ok(Vec::new());
        }
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("times") });
        let readback = self.marks.read(&gpu.device, &mut encoder, 2 * self.names.len() as u32);
        gpu.queue.submit([encoder.finish()]);
        let bytes = readback.wait(gpu)?;
        let time =
            |(name, i): (&&'static str, usize)| PassTime { name, ms: self.marks.between_ms(&bytes, 2 * i, 2 * i + 1) };
        Ok(self.names.iter().zip(0..).map(time).collect())
    }
}

/// What the next pass is told to write, where there is a clock.
pub fn timed<'clock>(
    clock: &'clock mut Option<PassClock>,
    name: &'static str,
) -> Option<wgpu::RenderPassTimestampWrites<'clock>> {
    clock.as_mut()?.of_pass(name)
}
