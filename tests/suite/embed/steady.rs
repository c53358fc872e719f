//! What a frame of a thousand objects allocates, once it has seen the largest.

use super::embed_cost::{Change, Crowd, OBJECTS};
use super::encoder;
use crate::support::gpu;
use allocation_counter::measure;
use specula::gpu::Gpu;
use specula::gpu::formats::Precision;

/// Allocations of preparing and of painting one frame of a field in its steady state: the least of some frames, as pools
/// of wgpu's grow now and then.
fn allocations(gpu: &Gpu, is_distinct: bool, change: Change) -> [u64; 2] {
    let mut crowd = Crowd::new(gpu, is_distinct).unwrap();
    let mut least = [u64::MAX; 2];
    for frame in 0..40 {
        crowd.change(change, frame).unwrap();
        let mut seconds = [0.0; 2];
        let prepared = measure(|| seconds = crowd.prepare(gpu).unwrap());
        assert!(seconds.iter().all(|&seconds| seconds >= 0.0));
        let mut encoder = encoder(gpu);
        let mut pass = crowd.begin(&mut encoder);
        let mut draws = 0;
        let painted = measure(|| draws = crowd.paint(&mut pass));
        assert_eq!(draws as usize, if is_distinct { OBJECTS } else { 1 });
        drop(pass);
        gpu.queue.submit([encoder.finish()]);
        gpu.wait().unwrap();
        if frame >= 20 {
            least = [least[0].min(prepared.count_total), least[1].min(painted.count_total)];
        }
    }
    least
}

/// Allocations of wgpu itself where a host writes `writes` buffers in a frame.
fn of_bare_writes(gpu: &Gpu, writes: usize) -> u64 {
    let usage = wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST;
    let descriptor = wgpu::BufferDescriptor { label: None, size: 256, usage, mapped_at_creation: false };
    let buffers: Vec<wgpu::Buffer> = (0..writes).map(|_| gpu.device.create_buffer(&descriptor)).collect();
    let mut least = u64::MAX;
    for frame in 0..40_u8 {
        let written = measure(|| buffers.iter().for_each(|buffer| gpu.queue.write_buffer(buffer, 0, &[frame; 256])));
        gpu.queue.submit([]);
        gpu.wait().unwrap();
        least = least.min(written.count_total);
    }
    least
}

#[test]
fn a_frame_of_a_thousand_objects_allocates_nothing_of_ours() {
    let gpu = gpu(Precision::Half);
    let writes: Vec<u64> = (0..4).map(|writes| of_bare_writes(&gpu, writes)).collect();
    println!("writes of wgpu alone: {writes:?}");
    for is_distinct in [true, false] {
        for change in [Change::Nothing, Change::Camera, Change::Objects] {
            let [prepared, painted] = allocations(&gpu, is_distinct, change);
            println!("distinct: {is_distinct}, {change:?}: {prepared} to prepare, {painted} to paint");
            // Uniform and list of instances; instances and, where their order is another, the list.
            let allowed = if change == Change::Nothing { 0 } else { writes[2] };
            assert!(prepared <= allowed, "{prepared} allocations, {allowed} of them wgpu's");
            // The list of commands is wgpu's, and grows by doubling.
            assert!(painted <= 12, "{painted}");
        }
    }
}
