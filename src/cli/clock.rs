//! How long a frame takes: on the wall, of the processors, and by the device's own clock.

use super::error::CliError;
use crate::capture::CaptureError;
use crate::clock::process_ms;
use crate::gpu::{Gpu, Timestamps};
use serde::Serialize;
use std::time::Instant;

/// The times of one frame, or their medians, ms.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub(super) struct FrameTimes {
    /// From the start of recording until the device is done.
    pub(super) wall_ms: f64,
    /// Of all threads of the process, a software driver's included. None where the system does not tell.
    pub(super) cpu_ms: Option<f64>,
    /// Between the first and the last command of the frame. None where the device has no timestamps.
    pub(super) gpu_ms: Option<f64>,
}

/// Which of the times settings are compared by.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum, Serialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum Basis {
    Wall,
    /// A software driver draws on the processors, and there other programs do not count.
    Cpu,
    Gpu,
}

impl Basis {
    /// The time that says most on a device.
    pub(super) fn suiting(gpu: &Gpu) -> Self {
        let is_software = gpu.info.device_type == wgpu::DeviceType::Cpu;
        match (is_software, process_ms().is_some(), gpu.device.features().contains(BETWEEN_COMMANDS)) {
            (true, true, _) => Self::Cpu,
            (false, _, true) => Self::Gpu,
            _ => Self::Wall,
        }
    }

    /// In reports.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Wall => "wall time",
            Self::Cpu => "processor time",
            Self::Gpu => "GPU time",
        }
    }

    /// Where [`FrameTimes`] has it.
    pub(super) fn field(self) -> &'static str {
        match self {
            Self::Wall => "wall_ms",
            Self::Cpu => "cpu_ms",
            Self::Gpu => "gpu_ms",
        }
    }

    /// Fails where some frame has no such time.
    pub(super) fn check<'f>(self, mut frames: impl Iterator<Item = &'f FrameTimes>) -> Result<(), CliError> {
        let unknown = || CliError::Usage(format!("{} is not known on this machine; take another --clock", self.name()));
        if frames.all(|frame| self.of(frame).is_some()) { Ok(()) } else { Err(unknown()) }
    }

    /// The time in question, where it is known.
    pub(super) fn of(self, times: &FrameTimes) -> Option<f64> {
        match self {
            Self::Wall => Some(times.wall_ms),
            Self::Cpu => times.cpu_ms,
            Self::Gpu => times.gpu_ms,
        }
    }
}

/// Marks can be set between commands.
const BETWEEN_COMMANDS: wgpu::Features =
    wgpu::Features::TIMESTAMP_QUERY.union(wgpu::Features::TIMESTAMP_QUERY_INSIDE_ENCODERS);

/// Room for the marks of [`time_frame`]; `None` where the device cannot set them.
pub(super) fn timestamps(gpu: &Gpu) -> Option<Timestamps> {
    Timestamps::new(&gpu.device, &gpu.queue, BETWEEN_COMMANDS, 2)
}

/// Times one frame: `record` fills the encoder.
pub(super) fn time_frame(
    gpu: &Gpu,
    timestamps: Option<&Timestamps>,
    record: impl FnOnce(&mut wgpu::CommandEncoder) -> Result<(), CaptureError>,
) -> Result<FrameTimes, CaptureError> {
    let (start, start_ms) = (Instant::now(), process_ms());
    let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("bench") });
    if let Some(timestamps) = timestamps {
        encoder.write_timestamp(&timestamps.queries, 0);
    }
    record(&mut encoder)?;
    let ticks = timestamps.map(|timestamps| {
        encoder.write_timestamp(&timestamps.queries, 1);
        timestamps.read(&gpu.device, &mut encoder, 2)
    });
    gpu.queue.submit([encoder.finish()]);
    gpu.wait()?;
    let wall_ms = start.elapsed().as_secs_f64() * 1e3;
    let cpu_ms = process_ms().zip(start_ms).map(|(end, start)| end - start);
    let ticks = ticks.map(|ticks| ticks.wait(gpu)).transpose()?;
    let gpu_ms = ticks.zip(timestamps).map(|(bytes, timestamps)| timestamps.between_ms(&bytes, 0, 1));
    Ok(FrameTimes { wall_ms, cpu_ms, gpu_ms })
}

/// The middle value, or the mean of the two in the middle; `None` of nothing.
pub(super) fn median(values: impl Iterator<Item = f64>) -> Option<f64> {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    let middle = values.len() / 2;
    match values.len() {
        0 => None,
        count if count % 2 == 1 => Some(values[middle]),
        _ => Some(0.5 * (values[middle - 1] + values[middle])),
    }
}

/// The median of one of the times; `None` of no frames, or where it is not known.
pub(super) fn median_ms(frames: &[FrameTimes], basis: Basis) -> Option<f64> {
    median(frames.iter().filter_map(|frame| basis.of(frame)))
}

/// The median of each time; of no frames, nothing.
pub(super) fn median_times(frames: &[FrameTimes]) -> Option<FrameTimes> {
    Some(FrameTimes {
        wall_ms: median_ms(frames, Basis::Wall)?,
        cpu_ms: median_ms(frames, Basis::Cpu),
        gpu_ms: median_ms(frames, Basis::Gpu),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn medians_are_in_the_middle() {
        assert_eq!(median([3.0, 1.0, 2.0].into_iter()), Some(2.0));
        assert_eq!(median([4.0, 1.0, 2.0, 100.0].into_iter()), Some(3.0));
        assert_eq!(median([].into_iter()), None);
    }
}
