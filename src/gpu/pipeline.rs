//! What render pipelines have in common.

use super::formats;

/// Depth test against the reversed buffer: nearer or equal passes.
pub fn depth_state(write: bool) -> wgpu::DepthStencilState {
    wgpu::DepthStencilState {
        format: formats::DEPTH,
        depth_write_enabled: Some(write),
        depth_compare: Some(wgpu::CompareFunction::GreaterEqual),
        stencil: Default::default(),
        bias: Default::default(),
    }
}

/// What a fullscreen pipeline draws into.
#[derive(Debug, Clone, Copy)]
pub struct FullscreenTarget {
    pub format: wgpu::TextureFormat,
    pub samples: u32,
    /// Whether there is a depth attachment, which is tested and not written.
    pub depth_tested: bool,
}

/// A pipeline of one triangle without vertices, with the entry points `vertex` and `fragment` and one bind group.
pub fn fullscreen_pipeline(
    device: &wgpu::Device,
    label: &str,
    layout: &wgpu::BindGroupLayout,
    module: &wgpu::ShaderModule,
    target: FullscreenTarget,
) -> wgpu::RenderPipeline {
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some(label),
        bind_group_layouts: &[Some(layout)],
        immediate_size: 0,
    });
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(label),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module,
            entry_point: Some("vertex"),
            compilation_options: Default::default(),
            buffers: &[],
        },
        primitive: Default::default(),
        depth_stencil: target.depth_tested.then(|| depth_state(false)),
        multisample: wgpu::MultisampleState { count: target.samples, ..Default::default() },
        fragment: Some(wgpu::FragmentState {
            module,
            entry_point: Some("fragment"),
            compilation_options: Default::default(),
            targets: &[Some(target.format.into())],
        }),
        multiview_mask: None,
        cache: None,
    })
}
