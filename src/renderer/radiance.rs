//! The passes from triangles to radiance, on each path.

use super::draws::{PlanPipelines, draw_plan};
use super::{FrameState, RadianceTarget, RenderError, Renderer, SurfaceTarget};
use crate::frame::{FramePlan, Rectangle, RenderPath};
use crate::gpu::{PassClock, timed};
use crate::gpu_scene::{GpuScene, PulledGeometry};
use crate::passes::{BackgroundPass, DeferredTarget, ForwardTarget, OverTarget};
use crate::scene::View;

/// What the passes of one frame have in common.
pub(super) struct Frame<'a> {
    pub(super) view: &'a View,
    pub(super) target: &'a RadianceTarget<'a>,
    pub(super) group: wgpu::BindGroup,
    /// With forward surfaces.
    pub(super) panorama: Option<BackgroundPass>,
    /// Behind deferred ones.
    pub(super) behind: Option<BackgroundPass>,
    /// Where nothing is drawn.
    pub(super) coverage: f32,
}

impl Frame<'_> {
    fn forward_target(&self) -> ForwardTarget {
        ForwardTarget::radiance(self.target.format, self.target.samples)
    }
}

impl Renderer {
    /// Records the path that the target is for.
    pub(super) fn encode_path(
        &mut self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        scene: &GpuScene,
        frame: &Frame<'_>,
        state: &mut FrameState,
    ) -> Result<RenderPath, RenderError> {
        match frame.target.surfaces {
            SurfaceTarget::Forward { color, resolve } => {
                let pipelines = self.plan_pipelines(device, scene, frame, (&state.plan, None))?;
                let mut pass = begin_forward((encoder, &mut state.clock), frame, (color, resolve));
                if let Some(pixel) = frame.target.pixel {
                    pass.set_scissor_rect(pixel.x, pixel.y, 1, 1);
                }
                let draws = (&state.plan, frame.panorama.as_ref(), None);
                draw_plan(&mut pass, &pipelines, scene, &frame.group, draws);
                Ok(RenderPath::Forward)
            }
            SurfaceTarget::Deferred { visibility, covered, over, color: radiance } => {
                let (RadianceTarget { format, samples, depth, .. }, view) = (*frame.target, frame.view);
                let (size_px, coverage) = (view.size_px, frame.coverage);
                let (Some(geometry), None) = (&scene.pulled, frame.target.pixel) else {
                    return Err(RenderError::NotDeferrable);
                };
                let over = match (over, geometry.left_over(&scene.drawables, view).reduce(Rectangle::with)) {
                    (Some(color), Some(rectangle)) => Some(OverTarget { color, rectangle }),
                    (None, Some(_)) => return Err(RenderError::NotDeferrable),
                    (_, None) => None,
                };
                let into =
                    DeferredTarget { format, samples, visibility, depth, covered, over, radiance, size_px, coverage };
                self.encode_deferred(device, encoder, (scene, geometry), frame, &into, state)
            }
        }
    }

    fn encode_deferred(
        &mut self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        (scene, geometry): (&GpuScene, &PulledGeometry),
        frame: &Frame<'_>,
        into: &DeferredTarget<'_>,
        state: &mut FrameState,
    ) -> Result<RenderPath, RenderError> {
        let (plan, kept) = ((&state.plan, frame.view), &mut state.deferred);
        let pass = self.deferred.prepare(device, &self.sources, (scene, geometry), plan, into, kept)?;
        let behind = |pass: &mut wgpu::RenderPass<'_>| frame.behind.iter().for_each(|behind| behind.draw(pass));
        if into.over.is_none() {
            pass.encode((encoder, &mut state.clock), scene, &frame.group, into, |_| {}, behind);
            return Ok(RenderPath::Deferred);
        }
        let pipelines = self.plan_pipelines(device, scene, frame, (&state.plan, Some(geometry)))?;
        let draws = (&state.plan, frame.panorama.as_ref(), Some(geometry));
        let over = |pass: &mut wgpu::RenderPass<'_>| draw_plan(pass, &pipelines, scene, &frame.group, draws);
        pass.encode((encoder, &mut state.clock), scene, &frame.group, into, over, behind);
        Ok(RenderPath::Mixed)
    }

    /// The forward pipelines of what is not deferred.
    fn plan_pipelines(
        &mut self,
        device: &wgpu::Device,
        scene: &GpuScene,
        frame: &Frame<'_>,
        (plan, deferred): (&FramePlan, Option<&PulledGeometry>),
    ) -> Result<PlanPipelines, RenderError> {
        self.prepare_forward(device, scene, (plan, deferred), frame.forward_target())?;
        let mut pipelines = PlanPipelines::default();
        pipelines.replace(self, frame.view, plan, frame.forward_target());
        Ok(pipelines)
    }

    /// Makes them.
    pub(super) fn prepare_forward(
        &mut self,
        device: &wgpu::Device,
        scene: &GpuScene,
        (plan, deferred): (&FramePlan, Option<&PulledGeometry>),
        target: ForwardTarget,
    ) -> Result<(), RenderError> {
        match deferred {
            None => self.forward.prepare(device, &self.sources, scene, plan.pipelines.iter().copied(), target)?,
            Some(geometry) => {
                let drawn = plan.opaque.iter().chain(&plan.blended).filter(|draw| !geometry.holds(draw.drawable));
                let keys = drawn.map(|draw| plan.pipelines[draw.pipeline]);
                self.forward.prepare(device, &self.sources, scene, keys, target)?;
            }
        }
        Ok(())
    }
}

fn begin_forward<'encoder>(
    (encoder, clock): (&'encoder mut wgpu::CommandEncoder, &mut Option<PassClock>),
    frame: &Frame<'_>,
    (color, resolve): (&wgpu::TextureView, Option<&wgpu::TextureView>),
) -> wgpu::RenderPass<'encoder> {
    // The multisampled colour is not needed once it is resolved; depth is read by nobody yet.
    let store = if resolve.is_some() { wgpu::StoreOp::Discard } else { wgpu::StoreOp::Store };
    let clear = wgpu::Color { r: 0.0, g: 0.0, b: 0.0, a: f64::from(frame.coverage) };
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some("forward"),
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view: color,
            depth_slice: None,
            resolve_target: resolve,
            ops: wgpu::Operations { load: wgpu::LoadOp::Clear(clear), store },
        })],
        depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
            view: frame.target.depth,
            depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store: wgpu::StoreOp::Discard }),
            stencil_ops: None,
        }),
        timestamp_writes: timed(clock, "forward"),
        occlusion_query_set: None,
        multiview_mask: None,
    })
}
