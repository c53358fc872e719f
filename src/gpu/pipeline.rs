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

/// How vertices make primitives. Front faces are counterclockwise, clockwise where a transform mirrors.
pub fn primitive_state(topology: wgpu::PrimitiveTopology, mirrored: bool, cull_back: bool) -> wgpu::PrimitiveState {
    wgpu::PrimitiveState {
        topology,
        front_face: if mirrored { wgpu::FrontFace::Cw } else { wgpu::FrontFace::Ccw },
        cull_mode: cull_back.then_some(wgpu::Face::Back),
        ..Default::default()
    }
}

/// How a fullscreen pipeline uses the depth of its pass.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FullscreenDepth {
    /// The pass has none.
    None,
    /// Drawn where nothing is nearer.
    Behind,
    /// Drawn where the depth is the triangle's own.
    Equal,
    /// The fragment shader's depth is stored.
    Written,
}

impl FullscreenDepth {
    fn state(self) -> Option<wgpu::DepthStencilState> {
        let compared =
            |depth_compare| wgpu::DepthStencilState { depth_compare: Some(depth_compare), ..depth_state(false) };
        match self {
            Self::None => None,
            Self::Behind => Some(depth_state(false)),
            Self::Equal => Some(compared(wgpu::CompareFunction::Equal)),
            Self::Written => {
                let always = compared(wgpu::CompareFunction::Always);
                Some(wgpu::DepthStencilState { depth_write_enabled: Some(true), ..always })
            }
        }
    }
}

/// What a fullscreen pipeline draws into, and how.
#[derive(Debug, Clone, Copy)]
pub struct FullscreenTarget {
    /// None where only depth is written.
    pub format: Option<wgpu::TextureFormat>,
    pub samples: u32,
    pub depth: FullscreenDepth,
    pub blend: Option<wgpu::BlendState>,
}

/// A pipeline of one triangle without vertices, with the entry points `vertex` and `fragment`.
pub fn fullscreen_pipeline(
    device: &wgpu::Device,
    label: &str,
    layouts: &[Option<&wgpu::BindGroupLayout>],
    module: &wgpu::ShaderModule,
    target: FullscreenTarget,
) -> wgpu::RenderPipeline {
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some(label),
        bind_group_layouts: layouts,
        immediate_size: 0,
    });
    let color = target
        .format
        .map(|format| Some(wgpu::ColorTargetState { format, blend: target.blend, write_mask: wgpu::ColorWrites::ALL }));
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
        depth_stencil: target.depth.state(),
        multisample: wgpu::MultisampleState { count: target.samples, ..Default::default() },
        fragment: Some(wgpu::FragmentState {
            module,
            entry_point: Some("fragment"),
            compilation_options: Default::default(),
            targets: color.as_slice(),
        }),
        multiview_mask: None,
        cache: None,
    })
}
