//! A frame inside a pass that somebody else has begun.

use super::draws::{PlanPipelines, draw_plan};
use super::uniforms::frame_uniform;
use super::{FrameState, FrameStats, PassFormat, RenderError, Renderer, check_size, frame_stats};
use crate::frame::{PlanOptions, clip_from_origin};
use crate::gpu::Identity;
use crate::gpu::pipeline::DepthTarget;
use crate::gpu_scene::GpuScene;
use crate::passes::BackgroundPass;
use crate::scene::View;
use glam::{UVec2, Vec2};

/// What a frame binds, kept in the [`FrameState`] from its preparation to the pass.
#[derive(Debug)]
pub(super) struct Painting {
    scene: Identity,
    frame_group: wgpu::BindGroup,
    pipelines: PlanPipelines,
    panorama: Option<BackgroundPass>,
    at_px: Vec2,
    size_px: UVec2,
}

/// A frame that only needs a pass to be painted in.
#[derive(Debug, Clone, Copy)]
pub struct Prepared<'a> {
    scene: &'a GpuScene,
    state: &'a FrameState,
    painting: &'a Painting,
}

impl Renderer {
    /// Makes ready what a view needs in a pass of the host's, so that [`Prepared::paint`] only records draws. The picture
    /// lies in the pass's attachments from the pixel `at_px` on and is `view.size_px` large.
    ///
    /// Everything is drawn that the forward path draws: opaque surfaces, the panorama behind what the depth buffer holds
    /// (if the view's background is the environment), then blended surfaces. Nothing is recorded here, and nothing
    /// submitted; uniforms are written when the queue is submitted to next.
    ///
    /// # Errors
    /// [`RenderError::NeedsOwnPass`] for a background colour and for passes without depth, [`RenderError::Pass`] for a pass
    /// that this device cannot draw in.
    pub fn prepare_frame<'a>(
        &mut self,
        (device, queue): (&wgpu::Device, &wgpu::Queue),
        scene: &'a mut GpuScene,
        (view, at_px): (&View, UVec2),
        pass: &PassFormat,
        state: &'a mut FrameState,
    ) -> Result<Prepared<'a>, RenderError> {
        self.prepare_at((device, queue), scene, (view, at_px.as_vec2()), pass, state)
    }

    /// The same anywhere, even beside the attachments.
    pub(super) fn prepare_at<'a>(
        &mut self,
        (device, queue): (&wgpu::Device, &wgpu::Queue),
        scene: &'a mut GpuScene,
        (view, at_px): (&View, Vec2),
        pass: &PassFormat,
        state: &'a mut FrameState,
    ) -> Result<Prepared<'a>, RenderError> {
        let mut pipelines = state.painting.take().map(|painting| painting.pipelines).unwrap_or_default();
        self.check_device()?;
        check_size(device, view)?;
        let target = pass.forward_target(device, view)?;
        self.check_channel(device, scene, view, target.format)?;
        // A host's depth may be so coarse that what is behind is as near.
        let culling = if target.depth == DepthTarget::OWN { self.culling } else { self.culling.but_hidden() };
        let options = PlanOptions { samples: target.samples, culling };
        let visible = state.plan_frame((device, queue), scene, view, options)?;
        let panorama = self.panorama((device, queue), scene, view, (target, false), state)?;
        let mut uniform = frame_uniform(scene, view);
        let own = clip_from_origin(view, scene.drawables.origin_in_world);
        uniform.clip_from_world = pass.clip(&view.camera, own).to_cols_array_2d();
        let frame_group = self.frame_group((device, queue), scene, (view, visible), &uniform, state)?;
        self.prepare_forward(device, scene, (&state.plan, None), target)?;
        pipelines.replace(self, view, &state.plan, target);
        let identity = scene.identity.clone();
        let size_px = view.size_px;
        state.painting = Some(Painting { scene: identity, frame_group, pipelines, panorama, at_px, size_px });
        state.forget();
        state.prepared(scene).ok_or(RenderError::NotPrepared)
    }
}

impl FrameState {
    /// The frame that was prepared last, if it was one of this scene.
    pub fn prepared<'a>(&'a self, scene: &'a GpuScene) -> Option<Prepared<'a>> {
        let painting = self.painting.as_ref().filter(|painting| painting.scene == scene.identity)?;
        Some(Prepared { scene, state: self, painting })
    }
}

impl Prepared<'_> {
    /// Records the draws of the frame. The pass has the attachments that the frame was prepared for, and is left with
    /// another viewport, other bind groups, buffers and pipelines; its scissor rectangle is respected.
    pub fn paint(&self, pass: &mut wgpu::RenderPass<'_>) {
        let Painting { frame_group, pipelines, panorama, at_px, size_px, .. } = self.painting;
        let (at, size) = (at_px, size_px.as_vec2());
        pass.set_viewport(at.x, at.y, size.x, size.y, 0.0, 1.0);
        draw_plan(pass, pipelines, self.scene, frame_group, (&self.state.plan, panorama.as_ref(), None));
    }

    /// What the frame consists of.
    pub fn stats(&self) -> FrameStats {
        frame_stats(self.scene, self.state)
    }
}
