//! What a render did, for `--stats` and `--json`.

use super::tier::TierStats;
use crate::clock::process_ms;
use crate::frame::Culled;
use crate::gpu::Gpu;
use serde::Serialize;
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

/// Everything that is known about one rendered picture.
#[derive(Debug, Serialize)]
pub(super) struct RenderStats {
    /// Name and version of this layout.
    pub(super) schema: &'static str,
    pub(super) specula: &'static str,
    pub(super) model: String,
    pub(super) output: String,
    /// `gpu` or `reference`.
    pub(super) renderer: &'static str,
    /// None for the reference renderer.
    pub(super) adapter: Option<AdapterStats>,
    pub(super) size_px: [u32; 2],
    /// Samples a pixel.
    pub(super) samples: u32,
    /// Estimated standard error relative to the radiance, where the reference renderer was asked for it.
    pub(super) relative_error: Option<f64>,
    /// How --max-error and --max-ms found the tier.
    pub(super) tier: Option<TierStats>,
    pub(super) gpu: Option<GpuStats>,
    pub(super) milliseconds: Vec<Stage>,
    pub(super) warnings: Vec<String>,
}

#[derive(Debug, Serialize)]
pub(super) struct AdapterStats {
    pub(super) name: String,
    pub(super) kind: String,
    pub(super) backend: String,
    pub(super) driver: String,
}

impl AdapterStats {
    pub(super) fn of(gpu: &Gpu) -> Self {
        let info = &gpu.info;
        Self {
            name: info.name.clone(),
            kind: format!("{:?}", info.device_type),
            backend: info.backend.to_string(),
            driver: format!("{} {}", info.driver, info.driver_info).trim().to_owned(),
        }
    }
}

#[derive(Debug, Serialize)]
pub(super) struct GpuStats {
    /// `forward`, `deferred`, or `mixed`: forward over deferred.
    pub(super) path: &'static str,
    pub(super) draws: u32,
    pub(super) triangles: u64,
    /// The features of each distinct forward pipeline.
    pub(super) pipelines: Vec<String>,
    /// Distinct primitives.
    pub(super) drawables: CulledStats,
    /// Primitives at their places.
    pub(super) placements: CulledStats,
    pub(super) geometry_bytes: u64,
    pub(super) texture_bytes: u64,
    pub(super) environment_bytes: u64,
    /// What the scene has, and so what the shaders contain.
    pub(super) punctual_lights: u32,
    pub(super) environment: bool,
    /// Where its maps have come from: `hit` (a file), `stored`, `off` or `unavailable` (they were baked). None without one.
    pub(super) environment_cache: Option<&'static str>,
}

/// How many of a number of things are drawn, and why the others are not.
#[derive(Debug, Serialize)]
pub(super) struct CulledStats {
    pub(super) all: u32,
    pub(super) drawn: u32,
    /// Beside the picture, before the near plane or beyond the far one.
    pub(super) outside: u32,
    /// So small that no sample of a pixel can see them.
    pub(super) between_samples: u32,
    /// Behind others.
    pub(super) hidden: u32,
}

impl CulledStats {
    pub(super) fn of(culled: Culled) -> Self {
        let Culled { all, outside, between_samples, hidden } = culled;
        Self { all, drawn: culled.drawn(), outside, between_samples, hidden }
    }
}

/// The time that one stage took. Stages may run beside each other.
#[derive(Debug, Clone, Serialize)]
pub(super) struct Stage {
    pub(super) stage: &'static str,
    /// On the wall, since the program began.
    pub(super) start: f64,
    pub(super) milliseconds: f64,
    /// Of the processors, while the stage ran: of all threads of the process, so of stages beside it too. None where the
    /// system does not tell.
    pub(super) processor: Option<f64>,
    /// Most memory that the process has held until the stage was done. None where the system does not tell.
    pub(super) peak_bytes: Option<u64>,
}

/// Most memory that this process has held so far, on Linux (VmHWM of proc(5)).
fn peak_bytes() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let kibibytes = status.lines().find_map(|line| line.strip_prefix("VmHWM:")?.trim().strip_suffix("kB"))?;
    Some(kibibytes.trim().parse::<u64>().ok()? << 10)
}

/// Measures stages, of any thread.
#[derive(Debug)]
pub(super) struct Stopwatch {
    began: Instant,
    stages: Mutex<Vec<Stage>>,
}

impl Default for Stopwatch {
    fn default() -> Self {
        Self { began: Instant::now(), stages: Mutex::default() }
    }
}

impl Stopwatch {
    /// Runs `work` and books its time under `stage`.
    pub(super) fn time<T>(&self, stage: &'static str, work: impl FnOnce() -> T) -> T {
        let (start, processor) = (self.began.elapsed(), process_ms());
        let result = work();
        let milliseconds = (self.began.elapsed() - start).as_secs_f64() * 1e3;
        let processor = processor.and_then(|before| Some(process_ms()? - before));
        let start = start.as_secs_f64() * 1e3;
        let booked = Stage { stage, start, milliseconds, processor, peak_bytes: peak_bytes() };
        self.stages.lock().unwrap_or_else(PoisonError::into_inner).push(booked);
        result
    }

    /// All of them, by their start.
    pub(super) fn stages(self) -> Vec<Stage> {
        let mut stages = self.stages.into_inner().unwrap_or_else(PoisonError::into_inner);
        stages.sort_by(|a, b| a.start.total_cmp(&b.start));
        stages
    }
}
