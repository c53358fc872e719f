//! How long a frame took.

use crate::capture::CaptureTarget;
use crate::clock::process_ms;
use crate::gpu::{Gpu, GpuError, PassClock, PassTime};
use std::time::Instant;

/// Of a frame that was waited for.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct FrameTiming {
    /// What was to be done before the device could begin: plan, uniforms and commands.
    pub(super) recording_ms: f64,
    /// From there until the device was done, and what is made of its answer in memory.
    pub(super) device_ms: f64,
    /// Of all threads of the process, a software driver's included. `None` where the system does not tell.
    pub(super) processor_ms: Option<f64>,
    /// By the device's clock; `None` where it has none.
    pub(super) passes: Option<Vec<PassTime>>,
}

/// A frame that is being timed.
#[derive(Debug)]
pub(super) struct Timer {
    began: Instant,
    processor_ms: Option<f64>,
    submitted: Option<Instant>,
}

impl Timer {
    /// Begins a frame into `target`, whose passes are timed from now on.
    pub(super) fn start(gpu: &Gpu, target: &CaptureTarget) -> Self {
        let mut state = target.state();
        if state.clock.is_none() {
            state.clock = PassClock::new(&gpu.device, &gpu.queue);
        }
        Self { began: Instant::now(), processor_ms: process_ms(), submitted: None }
    }

    /// All commands are with the device.
    pub(super) fn submitted(&mut self) {
        self.submitted = Some(Instant::now());
    }

    /// Waits until the device is done.
    pub(super) fn stop(self, gpu: &Gpu, target: &CaptureTarget) -> Result<FrameTiming, GpuError> {
        gpu.wait()?;
        let (done, processor_ms) = (Instant::now(), process_ms());
        let submitted = self.submitted.unwrap_or(done);
        let ms = |from: Instant, to: Instant| 1e3 * to.duration_since(from).as_secs_f64();
        let passes = target.state().clock.as_ref().map(|clock| clock.times(gpu)).transpose()?;
        Ok(FrameTiming {
            recording_ms: ms(self.began, submitted),
            device_ms: ms(submitted, done),
            processor_ms: processor_ms.zip(self.processor_ms).map(|(after, before)| after - before),
            passes,
        })
    }
}
