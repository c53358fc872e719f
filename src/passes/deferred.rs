//! Surfaces in passes of their own: which triangle each sample shows, whose each pixel is, then the shader of each draw
//! once a pixel.
//!
//! Where triangles are a few pixels in size, a rasteriser shades many more pixels than are seen: those beside an edge
//! once for every triangle, in blocks that are mostly empty, and those that are hidden later.

mod pipelines;

use crate::frame::{Draw, FramePlan, clip_from_origin, rectangle_around};
use crate::gpu::pipeline::PassError;
use crate::gpu::{DeviceLost, PassClock, filled_buffer, timed};
use crate::gpu_scene::{GpuScene, PulledGeometry, entry};
use crate::scene::View;
use crate::shader::types::PulledDraw;
use crate::shader::{SEEN_SAMPLES_BINDING, ShaderSources};
use glam::UVec2;
pub use pipelines::DeferredPipelines;
use pipelines::ShadingTarget;

/// What a frame is drawn into by way of the visibility of its triangles.
#[derive(Debug, Clone, Copy)]
pub struct DeferredTarget<'a> {
    /// Of the radiance.
    pub format: wgpu::TextureFormat,
    /// Of visibility and depth.
    pub samples: u32,
    /// In `formats::VISIBILITY`, to be sampled later.
    pub visibility: &'a wgpu::TextureView,
    /// In `formats::DEPTH`, with the samples of the visibility.
    pub depth: &'a wgpu::TextureView,
    /// In `formats::DEPTH`, one sample: whose each pixel is.
    pub covered: &'a wgpu::TextureView,
    pub radiance: &'a wgpu::TextureView,
    pub size_px: UVec2,
    /// Coverage where nothing is drawn: 0, or 1 where that is black and not transparent.
    pub coverage: f32,
}

/// One view of a frame, ready to be recorded.
#[derive(Debug)]
pub struct DeferredPass {
    draws: Vec<PreparedDraw>,
    cover: (wgpu::RenderPipeline, wgpu::BindGroup),
}

#[derive(Debug)]
struct PreparedDraw {
    draw: Draw,
    /// Corner and size of the part of the picture that it can be in.
    rectangle: [UVec2; 2],
    see: (wgpu::RenderPipeline, wgpu::BindGroup),
    shade: (wgpu::RenderPipeline, wgpu::BindGroup),
}

/// What frames into the same textures bind alike, whatever the camera.
#[derive(Debug)]
pub struct DeferredGroups {
    scene: wgpu::Buffer,
    visibility: wgpu::TextureView,
    size_px: UVec2,
    covered: wgpu::BindGroup,
    /// For the visibility pass and for shading, by drawable.
    draws: Vec<[wgpu::BindGroup; 2]>,
}

impl DeferredGroups {
    fn fit(&self, scene: &GpuScene, target: &DeferredTarget<'_>) -> bool {
        (&self.scene, &self.visibility, self.size_px) == (&scene.instances, target.visibility, target.size_px)
    }

    /// Buffers and bind groups.
    pub fn count(&self) -> u32 {
        1 + 3 * self.draws.len() as u32
    }
}

impl DeferredPipelines {
    /// Makes ready to draw the opaque part of `plan`. `kept` holds what frames have in common; it is made anew where it is
    /// for something else.
    pub fn prepare(
        &mut self,
        device: &wgpu::Device,
        sources: &ShaderSources,
        (scene, geometry): (&GpuScene, &PulledGeometry),
        (plan, view): (&FramePlan, &View),
        target: &DeferredTarget<'_>,
        kept: &mut Option<DeferredGroups>,
    ) -> Result<DeferredPass, PassError> {
        let DeferredTarget { format, samples, coverage, .. } = *target;
        let into = ShadingTarget { format, samples, is_filled: coverage > 0.0 };
        if !kept.as_ref().is_some_and(|groups| groups.fit(scene, target)) {
            *kept = None;
        }
        let groups = match kept {
            Some(groups) => groups,
            None => kept.insert(self.groups(device, scene, geometry, target)?),
        };
        let clip = clip_from_origin(view, scene.drawables.origin_in_world);
        let mut draws = Vec::with_capacity(plan.opaque.len());
        for draw in &plan.opaque {
            let bounds = scene.drawables.draws[draw.drawable].bounds;
            let Some(rectangle) = rectangle_around(bounds, &clip, target.size_px) else { continue };
            let key = plan.pipelines[draw.pipeline];
            let [see, shade] = groups.draws[draw.drawable].clone();
            draws.push(PreparedDraw {
                draw: draw.clone(),
                rectangle,
                see: (self.visibility(device, sources, scene, &key, samples)?, see),
                shade: (self.shading(device, sources, scene, &key.features, into)?, shade),
            });
        }
        let cover = (self.covered(device, sources, samples)?, groups.covered.clone());
        Ok(DeferredPass { draws, cover })
    }

    fn groups(
        &mut self,
        device: &wgpu::Device,
        scene: &GpuScene,
        geometry: &PulledGeometry,
        target: &DeferredTarget<'_>,
    ) -> Result<DeferredGroups, DeviceLost> {
        let layouts = self.layouts(device, target.samples);
        let [vertices, triangles] =
            [&geometry.vertices, &geometry.triangles].map(|texture| texture.create_view(&Default::default()));
        let seen = entry(SEEN_SAMPLES_BINDING, wgpu::BindingResource::TextureView(target.visibility));
        let group = |label, layout, entries: &[wgpu::BindGroupEntry<'_>]| {
            device.create_bind_group(&wgpu::BindGroupDescriptor { label: Some(label), layout, entries })
        };
        let of_draw = |drawable: usize| {
            let contents = pulled_draw(scene, geometry, drawable, target.size_px);
            let usage = wgpu::BufferUsages::UNIFORM;
            let uniform = filled_buffer(device, "pulled draw", bytemuck::bytes_of(&contents), usage)?;
            let entries = [
                entry(0, uniform.as_entire_binding()),
                entry(1, wgpu::BindingResource::TextureView(&vertices)),
                entry(2, wgpu::BindingResource::TextureView(&triangles)),
                seen.clone(),
            ];
            Ok([group("visibility", &layouts.visibility, &entries[..1]), group("deferred", &layouts.pulled, &entries)])
        };
        Ok(DeferredGroups {
            scene: scene.instances.clone(),
            visibility: target.visibility.clone(),
            size_px: target.size_px,
            covered: group("covered", &layouts.covered, std::slice::from_ref(&seen)),
            draws: (0..scene.draws.len()).map(of_draw).collect::<Result<_, DeviceLost>>()?,
        })
    }
}

fn pulled_draw(scene: &GpuScene, geometry: &PulledGeometry, drawable: usize, size_px: UVec2) -> PulledDraw {
    let place = &geometry.places[drawable];
    PulledDraw {
        first_triangle: place.triangles,
        first_vertex: place.vertices,
        number: drawable as u32 + 1,
        front: if scene.drawables.draws[drawable].mirrored { -1.0 } else { 1.0 },
        world_from_object: place.instance.world_from_object,
        ndc_step: [2.0 / size_px.x as f32, -2.0 / size_px.y as f32],
        ..Default::default()
    }
}

impl DeferredPass {
    /// Records all passes; `behind` draws into the last one, where nothing is and where pixels are shared.
    pub fn encode(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        scene: &GpuScene,
        frame_group: &wgpu::BindGroup,
        target: &DeferredTarget<'_>,
        clock: &mut Option<PassClock>,
        behind: impl FnOnce(&mut wgpu::RenderPass<'_>),
    ) {
        let (clear, keep, discard) = (wgpu::LoadOp::Clear(0.0), wgpu::StoreOp::Store, wgpu::StoreOp::Discard);
        {
            let color = attachment(target.visibility, wgpu::Color::TRANSPARENT);
            let depth = depth_attachment(target.depth, clear, discard);
            let mut pass = begin((encoder, clock), "visibility", Some(color), depth);
            self.see(&mut pass, scene, frame_group);
        }
        {
            let mut pass = begin((encoder, clock), "covered", None, depth_attachment(target.covered, clear, keep));
            pass.set_pipeline(&self.cover.0);
            pass.set_bind_group(0, &self.cover.1, &[]);
            pass.draw(0..3, 0..1);
        }
        let empty = wgpu::Color { a: f64::from(target.coverage), ..wgpu::Color::TRANSPARENT };
        let color = attachment(target.radiance, empty);
        let depth = depth_attachment(target.covered, wgpu::LoadOp::Load, discard);
        let mut pass = begin((encoder, clock), "deferred", Some(color), depth);
        self.shade(&mut pass, scene, frame_group, target);
        behind(&mut pass);
    }

    fn see(&self, pass: &mut wgpu::RenderPass<'_>, scene: &GpuScene, frame_group: &wgpu::BindGroup) {
        pass.set_bind_group(0, frame_group, &[]);
        pass.set_index_buffer(scene.indices.slice(..), wgpu::IndexFormat::Uint32);
        for prepared in &self.draws {
            let primitive = &scene.draws[prepared.draw.drawable].primitive;
            pass.set_pipeline(&prepared.see.0);
            pass.set_bind_group(1, &prepared.see.1, &[]);
            pass.set_vertex_buffer(0, scene.vertices.slice(primitive.attributes[0].clone()));
            pass.draw_indexed(primitive.indices.clone(), 0, prepared.draw.instances.clone());
        }
    }

    fn shade(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        scene: &GpuScene,
        frame_group: &wgpu::BindGroup,
        target: &DeferredTarget<'_>,
    ) {
        pass.set_bind_group(0, frame_group, &[]);
        for prepared in &self.draws {
            pass.set_pipeline(&prepared.shade.0);
            pass.set_bind_group(1, &scene.draws[prepared.draw.drawable].material.group, &[]);
            pass.set_bind_group(2, &prepared.shade.1, &[]);
            let [corner, size] = prepared.rectangle;
            pass.set_scissor_rect(corner.x, corner.y, size.x, size.y);
            // Pixels that are the draw's alone, and those that it shares.
            pass.draw(0..3, 0..2);
        }
        pass.set_scissor_rect(0, 0, target.size_px.x, target.size_px.y);
    }
}

fn attachment(view: &wgpu::TextureView, clear: wgpu::Color) -> wgpu::RenderPassColorAttachment<'_> {
    wgpu::RenderPassColorAttachment {
        view,
        depth_slice: None,
        resolve_target: None,
        ops: wgpu::Operations { load: wgpu::LoadOp::Clear(clear), store: wgpu::StoreOp::Store },
    }
}

fn depth_attachment(
    view: &wgpu::TextureView,
    load: wgpu::LoadOp<f32>,
    store: wgpu::StoreOp,
) -> wgpu::RenderPassDepthStencilAttachment<'_> {
    wgpu::RenderPassDepthStencilAttachment {
        view,
        depth_ops: Some(wgpu::Operations { load, store }),
        stencil_ops: None,
    }
}

fn begin<'encoder>(
    (encoder, clock): (&'encoder mut wgpu::CommandEncoder, &mut Option<PassClock>),
    label: &'static str,
    color: Option<wgpu::RenderPassColorAttachment<'_>>,
    depth: wgpu::RenderPassDepthStencilAttachment<'_>,
) -> wgpu::RenderPass<'encoder> {
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some(label),
        color_attachments: color.map(Some).as_slice(),
        depth_stencil_attachment: Some(depth),
        timestamp_writes: timed(clock, label),
        occlusion_query_set: None,
        multiview_mask: None,
    })
}
