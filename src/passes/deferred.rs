//! Surfaces in passes of their own: which triangle each sample shows, whose each pixel is, then the shader of each draw
//! once a pixel.
//!
//! Where triangles are a few pixels in size, a rasteriser shades many more pixels than are seen: those beside an edge
//! once for every triangle, in blocks that are mostly empty, and those that are hidden later.

mod pipelines;

use crate::frame::{FramePlan, Rectangle, clip_from_origin};
use crate::gpu::pipeline::PassError;
use crate::gpu::{DeviceLost, PassClock, filled_buffer, timed};
use crate::gpu_scene::{GpuScene, PulledGeometry, PulledPlace, entry};
use crate::scene::View;
use crate::shader::types::PulledDraw;
use crate::shader::{OVER_SAMPLES_BINDING, SEEN_SAMPLES_BINDING, Seen, ShaderError, ShaderSources};
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
    /// Given where anything is drawn over what is deferred.
    pub over: Option<OverTarget<'a>>,
    pub radiance: &'a wgpu::TextureView,
    pub size_px: UVec2,
    /// Coverage where nothing is drawn: 0, or 1 where that is black and not transparent.
    pub coverage: f32,
}

/// What lies over deferred surfaces, and where.
#[derive(Debug, Clone, Copy)]
pub struct OverTarget<'a> {
    /// In the format of the radiance, with the samples of the visibility, to be sampled later.
    pub color: &'a wgpu::TextureView,
    pub rectangle: Rectangle,
}

impl DeferredTarget<'_> {
    fn seen(&self) -> Seen {
        Seen { samples: self.samples, under: self.over.is_some() }
    }
}

/// One view of a frame, ready to be recorded.
#[derive(Debug)]
pub struct DeferredPass {
    draws: Vec<PreparedDraw>,
    cover: (Sides, wgpu::BindGroup),
    over: Option<(wgpu::RenderPipeline, wgpu::BindGroup)>,
}

/// Pipelines for what lies beside anything that is drawn over, and under it.
#[derive(Debug)]
struct Sides {
    beside: Option<wgpu::RenderPipeline>,
    under: Option<wgpu::RenderPipeline>,
}

/// A drawable at one of its places.
#[derive(Debug)]
struct PreparedDraw {
    drawable: usize,
    /// Where it can be.
    rectangle: Rectangle,
    see: (wgpu::RenderPipeline, wgpu::BindGroup),
    shade: (Sides, wgpu::BindGroup),
}

/// What frames into the same textures bind alike, whatever the camera.
#[derive(Debug)]
pub struct DeferredGroups {
    scene: wgpu::Buffer,
    visibility: wgpu::TextureView,
    over: Option<(wgpu::TextureView, wgpu::BindGroup)>,
    size_px: UVec2,
    covered: wgpu::BindGroup,
    /// For the visibility pass and for shading, place by place.
    places: Vec<[wgpu::BindGroup; 2]>,
}

impl DeferredGroups {
    fn fit(&self, scene: &GpuScene, target: &DeferredTarget<'_>) -> bool {
        (&self.scene, &self.visibility, self.size_px) == (&scene.instances, target.visibility, target.size_px)
            && self.over.as_ref().map(|(over, _)| over) == target.over.as_ref().map(|over| over.color)
    }

    /// Buffers and bind groups.
    pub fn count(&self) -> u32 {
        1 + u32::from(self.over.is_some()) + 3 * self.places.len() as u32
    }
}

impl DeferredPipelines {
    /// Makes ready to draw what of `plan` can be deferred. `kept` holds what frames have in common; it is made anew where it is
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
        let (seen, format) = (target.seen(), target.format);
        let into = ShadingTarget { format, seen, is_filled: target.coverage > 0.0 };
        if !kept.as_ref().is_some_and(|groups| groups.fit(scene, target)) {
            *kept = None;
        }
        let groups = match kept {
            Some(groups) => groups,
            None => kept.insert(self.groups(device, scene, geometry, target)?),
        };
        let hole = target.over.map(|over| over.rectangle);
        let clip = clip_from_origin(view, scene.drawables.origin_in_world);
        let mut draws = Vec::with_capacity(plan.opaque.len());
        let places = plan.opaque.iter().flat_map(|draw| {
            let instances = &plan.visible[draw.instances.start as usize..draw.instances.end as usize];
            let place = |&instance: &u32| geometry.find(&scene.drawables, draw.drawable, instance);
            instances.iter().filter_map(place).map(|place| (place, &plan.pipelines[draw.pipeline]))
        });
        for (place, key) in places {
            let PulledPlace { drawable, placement, .. } = geometry.places[place];
            let bounds = scene.drawables.placements.boxes.get(placement);
            let Some(rectangle) = Rectangle::around(bounds, &clip, target.size_px) else { continue };
            let [see, shade] = groups.places[place].clone();
            let see = (self.visibility(device, sources, scene, key, seen)?, see);
            let shading = |under| self.shading(device, sources, scene, &key.features, (into, under));
            let shade = (sides(rectangle, hole, shading)?, shade);
            draws.push(PreparedDraw { drawable, rectangle, see, shade });
        }
        let whole = Rectangle::whole(target.size_px);
        let cover = sides(whole, hole, |under| self.covered(device, sources, (seen, under)))?;
        let cover = (cover, groups.covered.clone());
        let over = match &groups.over {
            Some((_, group)) => Some((self.over(device, sources, into)?, group.clone())),
            None => None,
        };
        Ok(DeferredPass { draws, cover, over })
    }

    fn groups(
        &mut self,
        device: &wgpu::Device,
        scene: &GpuScene,
        geometry: &PulledGeometry,
        target: &DeferredTarget<'_>,
    ) -> Result<DeferredGroups, DeviceLost> {
        let layouts = self.layouts(device, target.seen());
        let [vertices, triangles] =
            [&geometry.vertices, &geometry.triangles].map(|texture| texture.create_view(&Default::default()));
        let color = target.over.map(|over| over.color);
        let over = color.map(|color| entry(OVER_SAMPLES_BINDING, wgpu::BindingResource::TextureView(color)));
        let seen = entry(SEEN_SAMPLES_BINDING, wgpu::BindingResource::TextureView(target.visibility));
        let seen: Vec<_> = [Some(seen), over.clone()].into_iter().flatten().collect();
        let group = |label, layout, entries: &[wgpu::BindGroupEntry<'_>]| {
            device.create_bind_group(&wgpu::BindGroupDescriptor { label: Some(label), layout, entries })
        };
        let of_place = |(number, place): (u32, &PulledPlace)| {
            let contents = pulled_draw(scene, place, number, target.size_px);
            let usage = wgpu::BufferUsages::UNIFORM;
            let uniform = filled_buffer(device, "pulled draw", bytemuck::bytes_of(&contents), usage)?;
            let own = [
                entry(0, uniform.as_entire_binding()),
                entry(1, wgpu::BindingResource::TextureView(&vertices)),
                entry(2, wgpu::BindingResource::TextureView(&triangles)),
            ];
            let visibility = group("visibility", &layouts.visibility, &own[..1]);
            Ok([visibility, group("deferred", &layouts.pulled, &[&own[..], &seen].concat())])
        };
        Ok(DeferredGroups {
            scene: scene.instances.clone(),
            visibility: target.visibility.clone(),
            size_px: target.size_px,
            covered: group("covered", &layouts.covered, &seen),
            over: target
                .over
                .map(|over| over.color.clone())
                .zip(over.zip(layouts.over.as_ref()).map(|(over, layout)| group("over", layout, &[over]))),
            places: (1..).zip(&geometry.places).map(of_place).collect::<Result<_, DeviceLost>>()?,
        })
    }
}

fn pulled_draw(scene: &GpuScene, place: &PulledPlace, number: u32, size_px: UVec2) -> PulledDraw {
    PulledDraw {
        first_triangle: place.triangles,
        first_vertex: place.vertices,
        number,
        front: if scene.drawables.draws[place.drawable].mirrored { -1.0 } else { 1.0 },
        world_from_object: place.instance.world_from_object,
        ndc_step: [2.0 / size_px.x as f32, -2.0 / size_px.y as f32],
        ..Default::default()
    }
}

/// The pipelines that a part of the picture needs, with the `hole` in it.
fn sides(
    all: Rectangle,
    hole: Option<Rectangle>,
    mut pipeline: impl FnMut(bool) -> Result<wgpu::RenderPipeline, ShaderError>,
) -> Result<Sides, ShaderError> {
    let beside = all.beside(hole).next().map(|_| pipeline(false)).transpose()?;
    let under = hole.and_then(|hole| all.within(hole)).map(|_| pipeline(true)).transpose()?;
    Ok(Sides { beside, under })
}

impl Sides {
    /// Draws each part of `all` with its pipeline.
    fn draw(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        all: Rectangle,
        hole: Option<Rectangle>,
        draw: impl Fn(&mut wgpu::RenderPass<'_>),
    ) {
        let under = hole.and_then(|hole| all.within(hole));
        for (pipeline, part) in
            all.beside(hole).map(|part| (&self.beside, part)).chain(under.map(|part| (&self.under, part)))
        {
            let Some(pipeline) = pipeline else { continue };
            pass.set_pipeline(pipeline);
            keep_within(pass, part);
            draw(pass);
        }
    }
}

fn keep_within(pass: &mut wgpu::RenderPass<'_>, part: Rectangle) {
    let size = part.size();
    pass.set_scissor_rect(part.first.x, part.first.y, size.x, size.y);
}

impl DeferredPass {
    /// Records all passes. `over` draws what lies over, where the target has a place for it; `behind` draws into the last pass,
    /// where nothing is and where pixels are shared.
    pub fn encode(
        &self,
        (encoder, clock): (&mut wgpu::CommandEncoder, &mut Option<PassClock>),
        scene: &GpuScene,
        frame_group: &wgpu::BindGroup,
        target: &DeferredTarget<'_>,
        over: impl FnOnce(&mut wgpu::RenderPass<'_>),
        behind: impl Fn(&mut wgpu::RenderPass<'_>),
    ) {
        let (clear, keep, discard) = (wgpu::LoadOp::Clear(0.0), wgpu::StoreOp::Store, wgpu::StoreOp::Discard);
        let (whole, hole) = (Rectangle::whole(target.size_px), target.over.map(|over| over.rectangle));
        {
            let color = attachment(target.visibility, wgpu::Color::TRANSPARENT);
            let after = if target.over.is_some() { keep } else { discard };
            let mut pass =
                begin((encoder, clock), "visibility", Some(color), depth_attachment(target.depth, clear, after));
            self.see(&mut pass, scene, frame_group);
        }
        if let Some(OverTarget { color, rectangle }) = target.over {
            let color = attachment(color, wgpu::Color::TRANSPARENT);
            let depth = depth_attachment(target.depth, wgpu::LoadOp::Load, discard);
            let mut pass = begin((encoder, clock), "over", Some(color), depth);
            keep_within(&mut pass, rectangle);
            over(&mut pass);
        }
        {
            let mut pass = begin((encoder, clock), "covered", None, depth_attachment(target.covered, clear, keep));
            pass.set_bind_group(0, &self.cover.1, &[]);
            self.cover.0.draw(&mut pass, whole, hole, |pass| pass.draw(0..3, 0..1));
        }
        let empty = wgpu::Color { a: f64::from(target.coverage), ..wgpu::Color::TRANSPARENT };
        let color = attachment(target.radiance, empty);
        let mut pass = begin(
            (encoder, clock),
            "deferred",
            Some(color),
            depth_attachment(target.covered, wgpu::LoadOp::Load, discard),
        );
        if let (Some((pipeline, group)), Some(hole)) = (&self.over, hole) {
            pass.set_pipeline(pipeline);
            pass.set_bind_group(0, group, &[]);
            keep_within(&mut pass, hole);
            pass.draw(0..3, 0..1);
        }
        self.shade(&mut pass, scene, frame_group, hole);
        for part in whole.beside(hole) {
            keep_within(&mut pass, part);
            behind(&mut pass);
        }
    }

    fn see(&self, pass: &mut wgpu::RenderPass<'_>, scene: &GpuScene, frame_group: &wgpu::BindGroup) {
        pass.set_bind_group(0, frame_group, &[]);
        pass.set_index_buffer(scene.indices.slice(..), wgpu::IndexFormat::Uint32);
        for prepared in &self.draws {
            let primitive = &scene.draws[prepared.drawable].primitive;
            pass.set_pipeline(&prepared.see.0);
            pass.set_bind_group(1, &prepared.see.1, &[]);
            pass.set_vertex_buffer(0, scene.vertices.slice(primitive.attributes[0].clone()));
            pass.draw_indexed(primitive.indices.clone(), 0, 0..1);
        }
    }

    fn shade(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        scene: &GpuScene,
        frame_group: &wgpu::BindGroup,
        hole: Option<Rectangle>,
    ) {
        pass.set_bind_group(0, frame_group, &[]);
        for prepared in &self.draws {
            pass.set_bind_group(1, &scene.draws[prepared.drawable].material.group, &[]);
            pass.set_bind_group(2, &prepared.shade.1, &[]);
            // Pixels that are the draw's alone, and those that it shares.
            prepared.shade.0.draw(pass, prepared.rectangle, hole, |pass| pass.draw(0..3, 0..2));
        }
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
