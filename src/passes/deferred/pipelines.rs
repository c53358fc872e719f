//! The pipelines of the deferred path, made when they are first needed.

use crate::frame::PipelineKey;
use crate::gpu::bindings::{covered_layout, over_layout, pulled_layout, visibility_layout};
use crate::gpu::formats;
use crate::gpu::pipeline::{
    DepthTarget, FullscreenDepth, FullscreenTarget, depth_state, fullscreen_pipeline, primitive_state,
};
use crate::gpu_scene::GpuScene;
use crate::shader::{
    Composed, ForwardFeatures, SceneFeatures, Seen, ShaderError, ShaderSources, covered_module, create_module,
    deferred_module, over_module, visibility_module,
};
use std::collections::HashMap;

/// Pipelines by what they draw and into what.
#[derive(Debug, Default)]
pub struct DeferredPipelines {
    layouts: HashMap<Seen, Layouts>,
    modules: HashMap<String, (Composed, wgpu::ShaderModule)>,
    /// A pipeline fits the group of a frame by what the scene has of light.
    visibility: HashMap<(SceneFeatures, bool, bool, u32), wgpu::RenderPipeline>,
    covered: HashMap<(Seen, bool), wgpu::RenderPipeline>,
    over: HashMap<ShadingTarget, wgpu::RenderPipeline>,
    shading: HashMap<(ForwardFeatures, ShadingTarget, bool), wgpu::RenderPipeline>,
}

/// By what is read of the picture.
#[derive(Debug, Clone)]
pub(super) struct Layouts {
    pub(super) visibility: wgpu::BindGroupLayout,
    pub(super) covered: wgpu::BindGroupLayout,
    pub(super) over: Option<wgpu::BindGroupLayout>,
    pub(super) pulled: wgpu::BindGroupLayout,
}

/// What tells shading pipelines apart beside the shader.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) struct ShadingTarget {
    pub(super) format: wgpu::TextureFormat,
    pub(super) seen: Seen,
    /// Coverage is 1 from the start.
    pub(super) is_filled: bool,
}

impl ShadingTarget {
    /// Draws that share a pixel add up.
    fn blend(self) -> wgpu::BlendState {
        let add = |src_factor| wgpu::BlendComponent {
            src_factor,
            dst_factor: wgpu::BlendFactor::One,
            operation: wgpu::BlendOperation::Add,
        };
        let alpha = if self.is_filled { wgpu::BlendFactor::Zero } else { wgpu::BlendFactor::One };
        wgpu::BlendState { color: add(wgpu::BlendFactor::One), alpha: add(alpha) }
    }
}

impl DeferredPipelines {
    /// Name and text of every module made so far.
    pub fn sources(&self) -> impl Iterator<Item = (String, &str)> {
        self.modules.iter().map(|(name, (composed, _))| (name.clone(), composed.text.as_str()))
    }

    pub(super) fn layouts(&mut self, device: &wgpu::Device, seen: Seen) -> Layouts {
        let make = || Layouts {
            visibility: visibility_layout(device),
            covered: covered_layout(device, seen),
            over: seen.under.then(|| over_layout(device, seen.samples)),
            pulled: pulled_layout(device, seen),
        };
        self.layouts.entry(seen).or_insert_with(make).clone()
    }

    fn module(
        &mut self,
        device: &wgpu::Device,
        name: String,
        compose: impl FnOnce() -> Result<Composed, ShaderError>,
    ) -> Result<wgpu::ShaderModule, ShaderError> {
        if let Some((_, module)) = self.modules.get(&name) {
            return Ok(module.clone());
        }
        let composed = compose()?;
        let module = create_module(device, &name, &composed)?;
        self.modules.insert(name, (composed, module.clone()));
        Ok(module)
    }

    /// Positions alone.
    pub(super) fn visibility(
        &mut self,
        device: &wgpu::Device,
        sources: &ShaderSources,
        scene: &GpuScene,
        key: &PipelineKey,
        seen: Seen,
    ) -> Result<wgpu::RenderPipeline, ShaderError> {
        let index = (scene.features, key.mirrored, key.cull_back, seen.samples);
        if let Some(pipeline) = self.visibility.get(&index) {
            return Ok(pipeline.clone());
        }
        let module = self.module(device, "visibility".to_owned(), || visibility_module(sources))?;
        let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("visibility"),
            bind_group_layouts: &[Some(&scene.frame_layout), Some(&self.layouts(device, seen).visibility)],
            immediate_size: 0,
        });
        let position = wgpu::VertexAttribute { format: wgpu::VertexFormat::Float32x3, offset: 0, shader_location: 0 };
        let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("visibility"),
            layout: Some(&layout),
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some("vertex"),
                compilation_options: Default::default(),
                buffers: &[Some(wgpu::VertexBufferLayout {
                    array_stride: position.format.size(),
                    step_mode: wgpu::VertexStepMode::Vertex,
                    attributes: &[position],
                })],
            },
            primitive: primitive_state(wgpu::PrimitiveTopology::TriangleList, key.mirrored, key.cull_back),
            depth_stencil: Some(depth_state(DepthTarget::OWN, true)),
            multisample: wgpu::MultisampleState { count: seen.samples, ..Default::default() },
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some("fragment"),
                compilation_options: Default::default(),
                targets: &[Some(formats::VISIBILITY.into())],
            }),
            multiview_mask: None,
            cache: None,
        });
        self.visibility.insert(index, pipeline.clone());
        Ok(pipeline)
    }

    /// Whose each pixel is.
    pub(super) fn covered(
        &mut self,
        device: &wgpu::Device,
        sources: &ShaderSources,
        (bound, under): (Seen, bool),
    ) -> Result<wgpu::RenderPipeline, ShaderError> {
        if let Some(pipeline) = self.covered.get(&(bound, under)) {
            return Ok(pipeline.clone());
        }
        let seen = Seen { under, ..bound };
        let module = self.module(device, format!("covered.{seen}"), || covered_module(sources, seen))?;
        let into = FullscreenTarget { format: None, samples: 1, depth: FullscreenDepth::Written, blend: None };
        let layouts = self.layouts(device, bound);
        let pipeline = fullscreen_pipeline(device, "covered", &[Some(&layouts.covered)], &module, into);
        self.covered.insert((bound, under), pipeline.clone());
        Ok(pipeline)
    }

    /// What was drawn over, into the radiance.
    pub(super) fn over(
        &mut self,
        device: &wgpu::Device,
        sources: &ShaderSources,
        target: ShadingTarget,
    ) -> Result<wgpu::RenderPipeline, ShaderError> {
        if let Some(pipeline) = self.over.get(&target) {
            return Ok(pipeline.clone());
        }
        let samples = target.seen.samples;
        let module = self.module(device, format!("over.{samples}"), || over_module(sources, samples))?;
        let into = FullscreenTarget {
            format: Some(target.format),
            samples: 1,
            depth: FullscreenDepth::Behind(DepthTarget::OWN),
            blend: Some(target.blend()),
        };
        let layouts = self.layouts(device, target.seen);
        let pipeline = fullscreen_pipeline(device, "over", &[layouts.over.as_ref()], &module, into);
        self.over.insert(target, pipeline.clone());
        Ok(pipeline)
    }

    /// The shader of a draw.
    pub(super) fn shading(
        &mut self,
        device: &wgpu::Device,
        sources: &ShaderSources,
        scene: &GpuScene,
        features: &ForwardFeatures,
        (target, under): (ShadingTarget, bool),
    ) -> Result<wgpu::RenderPipeline, ShaderError> {
        let features = features.module_key();
        if let Some(pipeline) = self.shading.get(&(features, target, under)) {
            return Ok(pipeline.clone());
        }
        let seen = Seen { under, ..target.seen };
        let name = format!("deferred.{seen}+{features}");
        let module = self.module(device, name, || deferred_module(sources, &features, seen))?;
        let layouts = self.layouts(device, target.seen);
        let material = scene.material_layouts.get(&features.material);
        let groups = [Some(&scene.frame_layout), material, Some(&layouts.pulled)];
        let into = FullscreenTarget {
            format: Some(target.format),
            samples: 1,
            depth: FullscreenDepth::Equal,
            blend: Some(target.blend()),
        };
        let pipeline = fullscreen_pipeline(device, "deferred", &groups, &module, into);
        self.shading.insert((features, target, under), pipeline.clone());
        Ok(pipeline)
    }
}
