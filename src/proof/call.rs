//! One dispatch of a compute module, from numbers to numbers.

use super::ProofError;
use crate::gpu::{Gpu, read_buffer};
use wgpu::util::DeviceExt;

/// A NaN that no arithmetic makes: what a cell holds that no invocation wrote.
pub(super) const UNWRITTEN: u32 = 0xffff_dead;

/// Dispatches the entry point `main` of a module, whose bindings are results (0) and, where there are any, arguments (1).
/// Returns `results` numbers.
///
/// # Errors
/// When the device reports one.
pub fn call(gpu: &Gpu, shader: &wgpu::ShaderModule, arguments: &[f32], results: usize) -> Result<Vec<f32>, ProofError> {
    let device = &gpu.device;
    let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: Some("twin"),
        layout: None,
        module: shader,
        entry_point: Some("main"),
        compilation_options: Default::default(),
        cache: None,
    });
    let buffer = |contents: &[u8], usage| {
        device.create_buffer_init(&wgpu::util::BufferInitDescriptor { label: Some("twin"), contents, usage })
    };
    let storage = wgpu::BufferUsages::STORAGE;
    let output = buffer(bytemuck::cast_slice(&vec![UNWRITTEN; results]), storage | wgpu::BufferUsages::COPY_SRC);
    let input = (!arguments.is_empty()).then(|| buffer(bytemuck::cast_slice(arguments), storage));
    let entries: Vec<wgpu::BindGroupEntry<'_>> = std::iter::once(&output)
        .chain(&input)
        .zip(0..)
        .map(|(buffer, binding)| wgpu::BindGroupEntry { binding, resource: buffer.as_entire_binding() })
        .collect();
    let layout = pipeline.get_bind_group_layout(0);
    let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("twin"),
        layout: &layout,
        entries: &entries,
    });
    let mut encoder = device.create_command_encoder(&Default::default());
    let mut pass = encoder.begin_compute_pass(&Default::default());
    pass.set_pipeline(&pipeline);
    pass.set_bind_group(0, &group, &[]);
    // Every point has at least one component, so this many workgroups reach every point.
    pass.dispatch_workgroups(results.div_ceil(64) as u32, 1, 1);
    drop(pass);
    let readback = read_buffer(device, &mut encoder, &output);
    gpu.queue.submit([encoder.finish()]);
    let bytes = readback.wait(gpu)?;
    Ok(bytes.chunks_exact(4).map(bytemuck::pod_read_unaligned).collect())
}
