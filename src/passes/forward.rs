//! Surfaces: every draw with the shader of its features.

use crate::frame::{Draw, FramePlan, PipelineKey, Raster};
use crate::gpu::pipeline::{DepthTarget, depth_state, primitive_state};
use crate::gpu_scene::{GpuDraw, GpuScene};
use crate::scene::Topology;
use crate::shader::{
    Alpha, Composed, ForwardFeatures, ShaderError, ShaderSources, TargetLight, attributes, create_module,
    forward_module_into,
};
use std::collections::HashMap;

/// The attachments that forward pipelines are made for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct ForwardTarget {
    pub format: wgpu::TextureFormat,
    pub samples: u32,
    pub depth: DepthTarget,
    pub light: TargetLight,
}

impl ForwardTarget {
    /// A target of radiance with the depth of our own passes.
    pub fn radiance(format: wgpu::TextureFormat, samples: u32) -> Self {
        Self { format, samples, depth: DepthTarget::OWN, light: TargetLight::Radiance }
    }
}

/// Forward pipelines by what they draw and into what.
#[derive(Debug, Default)]
pub struct ForwardPipelines {
    modules: HashMap<(ForwardFeatures, TargetLight), (Composed, wgpu::ShaderModule)>,
    /// Of the host, for what the driver compiles.
    cache: Option<wgpu::PipelineCache>,
    pipelines: HashMap<(PipelineKey, ForwardTarget), wgpu::RenderPipeline>,
}

impl ForwardPipelines {
    /// With the host's memory of what its driver has compiled.
    pub fn with_cache(cache: Option<wgpu::PipelineCache>) -> Self {
        Self { cache, ..Default::default() }
    }

    /// Makes the pipelines that do not exist yet, of those that `keys` names.
    pub fn prepare(
        &mut self,
        device: &wgpu::Device,
        sources: &ShaderSources,
        scene: &GpuScene,
        keys: impl IntoIterator<Item = PipelineKey>,
        target: ForwardTarget,
    ) -> Result<(), ShaderError> {
        for key in keys.into_iter().flat_map(|key| [Some(key), key.edges()]).flatten() {
            if self.pipelines.contains_key(&(key, target)) {
                continue;
            }
            let module = self.module(device, sources, &key.features, target.light)?;
            let pipeline = create_pipeline(device, &module, scene, &key, (target, self.cache.as_ref()));
            self.pipelines.insert((key, target), pipeline);
        }
        Ok(())
    }

    fn module(
        &mut self,
        device: &wgpu::Device,
        sources: &ShaderSources,
        features: &ForwardFeatures,
        light: TargetLight,
    ) -> Result<wgpu::ShaderModule, ShaderError> {
        let features = features.module_key();
        let key = (features, light);
        if let Some((_, module)) = self.modules.get(&key) {
            return Ok(module.clone());
        }
        let composed = forward_module_into(sources, &features, light)?;
        let module = create_module(device, &format!("forward/{features}"), &composed)?;
        self.modules.insert(key, (composed, module.clone()));
        Ok(module)
    }

    /// Name and text of every module made so far.
    pub fn sources(&self) -> impl Iterator<Item = (String, &str)> {
        let name = |features: &ForwardFeatures, light: &TargetLight| match light {
            TargetLight::Radiance => format!("forward+{features}"),
            TargetLight::Display(display) => {
                format!("forward+{features}+display.{:?}", display.tone_map).to_lowercase()
            }
        };
        self.modules
            .iter()
            .map(move |((features, light), (composed, _))| (name(features, light), composed.text.as_str()))
    }

    /// The pipelines of a prepared plan, in its order.
    pub fn of_plan(
        &self,
        plan: &FramePlan,
        target: ForwardTarget,
    ) -> impl Iterator<Item = Option<wgpu::RenderPipeline>> {
        plan.pipelines.iter().map(move |key| self.pipelines.get(&(*key, target)).cloned())
    }

    /// Those of the edges that are drawn over them; of most plans there are none.
    pub fn edges_of_plan(
        &self,
        plan: &FramePlan,
        target: ForwardTarget,
    ) -> impl Iterator<Item = Option<wgpu::RenderPipeline>> {
        plan.pipelines.iter().map(move |key| self.pipelines.get(&(key.edges()?, target)).cloned())
    }
}

/// Records `draws` of a plan with its pipelines. State that two draws in a row share is set once.
pub fn draw<'a>(
    pass: &mut wgpu::RenderPass<'_>,
    pipelines: &[Option<wgpu::RenderPipeline>],
    scene: &'a GpuScene,
    frame_group: &wgpu::BindGroup,
    draws: impl IntoIterator<Item = &'a Draw>,
) {
    pass.set_bind_group(0, frame_group, &[]);
    if scene.indices.size() > 0 {
        pass.set_index_buffer(scene.indices.slice(..), wgpu::IndexFormat::Uint32);
    }
    let (mut bound_pipeline, mut bound_material, mut bound_primitive) = (None, None, None);
    for draw in draws {
        let drawable = &scene.drawables.draws[draw.drawable];
        let GpuDraw { primitive, material } = &scene.draws[draw.drawable];
        let Some(pipeline) = &pipelines[draw.pipeline] else { continue };
        if bound_pipeline.replace(draw.pipeline) != Some(draw.pipeline) {
            pass.set_pipeline(pipeline);
        }
        if bound_material.replace(&material.group) != Some(&material.group) {
            pass.set_bind_group(1, &material.group, &[]);
        }
        let place = (drawable.mesh, drawable.primitive);
        if bound_primitive.replace(place) != Some(place) {
            for (slot, range) in primitive.attributes.iter().enumerate() {
                pass.set_vertex_buffer(slot as u32, scene.vertices.slice(range.clone()));
            }
        }
        pass.draw_indexed(primitive.indices.clone(), 0, draw.instances.clone());
    }
}

fn create_pipeline(
    device: &wgpu::Device,
    module: &wgpu::ShaderModule,
    scene: &GpuScene,
    key: &PipelineKey,
    (target, cache): (ForwardTarget, Option<&wgpu::PipelineCache>),
) -> wgpu::RenderPipeline {
    let material_layout = scene.material_layouts.get(&key.features.material);
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some("forward"),
        bind_group_layouts: &[Some(&scene.frame_layout), material_layout],
        immediate_size: 0,
    });
    let vertex_attributes: Vec<[wgpu::VertexAttribute; 1]> = attributes(&key.features.vertex)
        .iter()
        .enumerate()
        .map(|(location, a)| [vertex_attribute(location, a.wgsl)])
        .collect();
    let buffers: Vec<Option<wgpu::VertexBufferLayout<'_>>> =
        vertex_attributes.iter().map(|attribute| Some(buffer_layout(attribute))).collect();
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(&format!("forward/{}", key.features)),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module,
            entry_point: Some("vertex"),
            compilation_options: Default::default(),
            buffers: &buffers,
        },
        primitive: wgpu::PrimitiveState {
            polygon_mode: match key.raster {
                Raster::Edges => wgpu::PolygonMode::Line,
                _ => wgpu::PolygonMode::Fill,
            },
            ..primitive_state(topology(key), key.mirrored, key.cull_back)
        },
        depth_stencil: Some(depth_test(key, target.depth)),
        multisample: wgpu::MultisampleState { count: target.samples, ..Default::default() },
        fragment: Some(wgpu::FragmentState {
            module,
            entry_point: Some("fragment"),
            compilation_options: Default::default(),
            targets: &[Some(wgpu::ColorTargetState {
                format: target.format,
                blend: blend_state(key),
                write_mask: match key.raster {
                    Raster::Behind => wgpu::ColorWrites::ALPHA,
                    _ => wgpu::ColorWrites::ALL,
                },
            })],
        }),
        multiview_mask: None,
        cache,
    })
}

/// Of a channel the nearest surface counts, however little it covers.
fn is_blended(key: &PipelineKey) -> bool {
    key.features.material.alpha == Alpha::Blend && !key.features.channel
}

fn blend_state(key: &PipelineKey) -> Option<wgpu::BlendState> {
    let one_and_one = |operation| wgpu::BlendComponent {
        src_factor: wgpu::BlendFactor::One,
        dst_factor: wgpu::BlendFactor::One,
        operation,
    };
    match key.raster {
        Raster::Layers => Some(wgpu::BlendState {
            color: one_and_one(wgpu::BlendOperation::Add),
            alpha: one_and_one(wgpu::BlendOperation::Max),
        }),
        _ => is_blended(key).then_some(wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING),
    }
}

fn depth_test(key: &PipelineKey, target: DepthTarget) -> wgpu::DepthStencilState {
    let nearest = depth_state(target, !is_blended(key));
    match key.raster {
        Raster::Layers => wgpu::DepthStencilState {
            depth_write_enabled: Some(false),
            depth_compare: Some(wgpu::CompareFunction::Always),
            ..nearest
        },
        Raster::Behind => {
            // The samples of a line are up to half a pixel beside the edge along either axis, where the surface is
            // nearer by no more than its slope. The constant is for surfaces that face the viewer.
            let away = if target.reversed { -1 } else { 1 };
            let bias = wgpu::DepthBiasState { constant: 8 * away, slope_scale: 1.5 * away as f32, clamp: 0.0 };
            wgpu::DepthStencilState { bias, ..nearest }
        }
        Raster::Surface | Raster::Edges => nearest,
    }
}

fn topology(key: &PipelineKey) -> wgpu::PrimitiveTopology {
    match key.features.topology {
        Topology::Points => wgpu::PrimitiveTopology::PointList,
        Topology::Lines => wgpu::PrimitiveTopology::LineList,
        Topology::Triangles => wgpu::PrimitiveTopology::TriangleList,
    }
}

fn vertex_attribute(location: usize, wgsl: &str) -> wgpu::VertexAttribute {
    let format = match wgsl {
        "vec2f" => wgpu::VertexFormat::Float32x2,
        "vec3f" => wgpu::VertexFormat::Float32x3,
        _ => wgpu::VertexFormat::Float32x4,
    };
    wgpu::VertexAttribute { format, offset: 0, shader_location: location as u32 }
}

fn buffer_layout(attribute: &[wgpu::VertexAttribute; 1]) -> wgpu::VertexBufferLayout<'_> {
    wgpu::VertexBufferLayout {
        array_stride: attribute[0].format.size(),
        step_mode: wgpu::VertexStepMode::Vertex,
        attributes: attribute,
    }
}
