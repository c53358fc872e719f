//! What render pipelines have in common.

use super::formats;
use super::lost::DeviceLost;
use crate::shader::ShaderError;

/// Why a pass could not be made ready.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum PassError {
    #[error(transparent)]
    Shader(#[from] ShaderError),
    #[error(transparent)]
    DeviceLost(#[from] DeviceLost),
}

/// The depth buffer of a pass.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct DepthTarget {
    pub format: wgpu::TextureFormat,
    /// Whether what is nearer has the greater depth: 1 at the near plane.
    pub reversed: bool,
}

impl DepthTarget {
    /// That of our own passes.
    pub const OWN: Self = Self { format: formats::DEPTH, reversed: true };

    /// The depth of what is farthest: what a buffer is cleared to.
    pub fn farthest(self) -> f32 {
        if self.reversed { 0.0 } else { 1.0 }
    }
}

/// Depth test: nearer or equal passes. Stencils are left as they are.
pub fn depth_state(target: DepthTarget, write: bool) -> wgpu::DepthStencilState {
    let nearer = if target.reversed { wgpu::CompareFunction::GreaterEqual } else { wgpu::CompareFunction::LessEqual };
    wgpu::DepthStencilState {
        format: target.format,
        depth_write_enabled: Some(write),
        depth_compare: Some(nearer),
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
    Behind(DepthTarget),
    /// Drawn where the depth is the triangle's own.
    Equal,
    /// The fragment shader's depth is stored.
    Written,
}

impl FullscreenDepth {
    fn state(self) -> Option<wgpu::DepthStencilState> {
        let own = depth_state(DepthTarget::OWN, false);
        let compared = |depth_compare| wgpu::DepthStencilState { depth_compare: Some(depth_compare), ..own.clone() };
        match self {
            Self::None => None,
            Self::Behind(target) => Some(depth_state(target, false)),
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
