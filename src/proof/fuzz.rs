//! Random materials, lights and views through the whole forward shader, extremes included: nothing that it stores may be
//! NaN, infinite or negative. Evaluations are made, judged and counted on the GPU, from a counter and a seed.

mod offender;
mod shaders;

pub use offender::Offender;
pub use shaders::{FUZZED, FuzzedShader};

use super::{ProofError, stage};
use crate::gpu::{Gpu, read_buffer};
use crate::shader::{ShaderSources, compose, create_module};
use serde::Serialize;
use shaders::Resources;
use wgpu::util::DeviceExt;

/// Evaluations of one submission: short enough for any watchdog.
const EVALUATIONS_A_SUBMISSION: u64 = 1 << 20;
/// As `EVALUATIONS_EACH` times the workgroup in `shaders/proof/fuzz.wgsl`.
const EVALUATIONS_A_WORKGROUP: u32 = 16 * 64;

/// How far to search.
#[derive(Debug, Clone, Copy)]
pub struct FuzzOptions {
    /// Of all shaders together; at most 2^32 - 1 for each.
    pub evaluations: u64,
    pub seed: u32,
}

/// What was found in one shader.
#[derive(Debug, Clone, Serialize)]
pub struct ShaderFindings {
    pub shader: &'static str,
    pub evaluations: u64,
    /// Evaluations that were not black.
    pub lit: u64,
    pub faults: [Fault; 3],
}

/// Evaluations with one kind of fault.
#[derive(Debug, Clone, Serialize)]
pub struct Fault {
    pub kind: &'static str,
    pub count: u64,
    /// The earliest of them.
    pub first: Option<Offender>,
}

/// The uniform of `shaders/proof/fuzz.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct Window {
    seed: u32,
    first: u32,
    count: u32,
    padding: u32,
}

/// The counters of `shaders/proof/fuzz.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct Findings {
    evaluations: u32,
    lit: u32,
    counts: [u32; 3],
    firsts: [u32; 3],
}

const KINDS: [&str; 3] = ["NaN", "infinite", "negative"];
const NONE: u32 = u32::MAX;

impl ShaderFindings {
    /// Whether nothing is wrong.
    pub fn is_clean(&self) -> bool {
        self.faults.iter().all(|fault| fault.count == 0)
    }
}

/// Searches all shaders of [`FUZZED`]; `done` is told of every evaluation that is behind.
///
/// # Errors
/// When a shader cannot be made or the device fails; faults that are found are no error.
pub fn fuzz(
    gpu: &Gpu,
    sources: &ShaderSources,
    options: FuzzOptions,
    mut done: impl FnMut(u64),
) -> Result<Vec<ShaderFindings>, ProofError> {
    let each = options.evaluations.div_ceil(FUZZED.len() as u64).min(u64::from(NONE - 1));
    FUZZED.iter().map(|shader| search(gpu, sources, shader, each, options.seed, &mut done)).collect()
}

/// Searches one shader; [`fuzz`] for all of them.
///
/// # Errors
/// As there.
pub fn search(
    gpu: &Gpu,
    sources: &ShaderSources,
    shader: &'static FuzzedShader,
    evaluations: u64,
    seed: u32,
    done: &mut impl FnMut(u64),
) -> Result<ShaderFindings, ProofError> {
    let features = (shader.features)();
    let composed = compose(&stage::sources(sources), "proof/fuzz.wgsl", &stage::slots(&features))?;
    let module = create_module(&gpu.device, shader.name, &composed)?;
    let resources = Resources::new(gpu, features, shader.environment_nits)?;
    let program = Program { gpu, module: &module, resources: &resources };

    let findings = Findings { evaluations: 0, lit: 0, counts: [0; 3], firsts: [NONE; 3] };
    let counters = program.storage(bytemuck::bytes_of(&findings));
    let search = program.pipeline("search");
    let mut first = 0;
    while first < evaluations {
        let count = (evaluations - first).min(EVALUATIONS_A_SUBMISSION);
        let window = Window { seed, first: first as u32, count: count as u32, padding: 0 };
        program.dispatch(&search, window, (1, &counters), window.count.div_ceil(EVALUATIONS_A_WORKGROUP))?;
        first += count;
        done(count);
    }
    let found: Findings = bytemuck::pod_read_unaligned(&program.read(&counters)?);

    let fault = |kind: usize| -> Result<Fault, ProofError> {
        let first = (found.firsts[kind] != NONE).then(|| program.describe(seed, found.firsts[kind])).transpose()?;
        Ok(Fault { kind: KINDS[kind], count: u64::from(found.counts[kind]), first })
    };
    Ok(ShaderFindings {
        shader: shader.name,
        evaluations: u64::from(found.evaluations),
        lit: u64::from(found.lit),
        faults: [fault(0)?, fault(1)?, fault(2)?],
    })
}

/// The compute shader and what it reads.
struct Program<'a> {
    gpu: &'a Gpu,
    module: &'a wgpu::ShaderModule,
    resources: &'a Resources,
}

impl Program<'_> {
    fn pipeline(&self, entry_point: &str) -> wgpu::ComputePipeline {
        self.gpu.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some(entry_point),
            layout: None,
            module: self.module,
            entry_point: Some(entry_point),
            compilation_options: Default::default(),
            cache: None,
        })
    }

    fn storage(&self, contents: &[u8]) -> wgpu::Buffer {
        self.gpu.device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some("fuzz"),
            contents,
            usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC,
        })
    }

    /// Runs a pipeline with its window at binding 0 and `output` at a binding of its own.
    fn dispatch(
        &self,
        pipeline: &wgpu::ComputePipeline,
        window: Window,
        (binding, output): (u32, &wgpu::Buffer),
        workgroups: u32,
    ) -> Result<(), ProofError> {
        let device = &self.gpu.device;
        let window = device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some("fuzz window"),
            contents: bytemuck::bytes_of(&window),
            usage: wgpu::BufferUsages::UNIFORM,
        });
        let own = [(0, window.as_entire_binding()), (binding, output.as_entire_binding())];
        let group = |index: u32, entries: Vec<(u32, wgpu::BindingResource<'_>)>| {
            let entries: Vec<_> =
                entries.into_iter().map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource }).collect();
            let layout = pipeline.get_bind_group_layout(index);
            device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some("fuzz"),
                layout: &layout,
                entries: &entries,
            })
        };
        let groups = [group(0, self.resources.entries()), group(1, own.into())];
        let mut encoder = device.create_command_encoder(&Default::default());
        let mut pass = encoder.begin_compute_pass(&Default::default());
        pass.set_pipeline(pipeline);
        for (index, group) in (0..).zip(&groups) {
            pass.set_bind_group(index, group, &[]);
        }
        pass.dispatch_workgroups(workgroups, 1, 1);
        drop(pass);
        self.gpu.queue.submit([encoder.finish()]);
        let poll = device.poll(wgpu::PollType::wait_indefinitely());
        poll.map_err(|error| crate::gpu::GpuError::Failed(error.to_string()))?;
        Ok(self.gpu.check()?)
    }

    fn read(&self, buffer: &wgpu::Buffer) -> Result<Vec<u8>, ProofError> {
        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        let readback = read_buffer(&self.gpu.device, &mut encoder, buffer);
        self.gpu.queue.submit([encoder.finish()]);
        Ok(readback.wait(self.gpu)?)
    }

    /// Makes one evaluation once more, to tell what it was.
    fn describe(&self, seed: u32, evaluation: u32) -> Result<Offender, ProofError> {
        let case = self.storage(&vec![0; offender::CASE_BYTES]);
        let window = Window { seed, first: evaluation, count: 1, padding: 0 };
        self.dispatch(&self.pipeline("describe"), window, (2, &case), 1)?;
        Ok(Offender::read(evaluation, &self.read(&case)?))
    }
}
