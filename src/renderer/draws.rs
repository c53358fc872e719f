//! The draws of a plan, in their order.

use super::Renderer;
use crate::frame::{Draw, FramePlan};
use crate::gpu_scene::{GpuScene, PulledGeometry};
use crate::passes::{BackgroundPass, ForwardTarget, draw};
use crate::scene::{Channel, View};

/// The pipelines of a plan, each in its place.
#[derive(Debug, Default)]
pub(super) struct PlanPipelines {
    surfaces: Vec<Option<wgpu::RenderPipeline>>,
    /// Drawn over all surfaces; empty unless the view shows edges.
    edges: Vec<Option<wgpu::RenderPipeline>>,
}

impl PlanPipelines {
    /// Those of a plan that `renderer` has prepared.
    pub(super) fn replace(&mut self, renderer: &Renderer, view: &View, plan: &FramePlan, target: ForwardTarget) {
        self.surfaces.clear();
        self.surfaces.extend(renderer.forward.of_plan(plan, target));
        self.edges.clear();
        if view.channel == Some(Channel::Wireframe) {
            self.edges.extend(renderer.forward.edges_of_plan(plan, target));
        }
    }
}

/// Records all that a plan draws on the forward path, but what is deferred.
pub(super) fn draw_plan(
    pass: &mut wgpu::RenderPass<'_>,
    pipelines: &PlanPipelines,
    scene: &GpuScene,
    frame_group: &wgpu::BindGroup,
    (plan, panorama, deferred): (&FramePlan, Option<&BackgroundPass>, Option<&PulledGeometry>),
) {
    let PlanPipelines { surfaces, edges } = pipelines;
    let is_left = |draw: &&Draw| deferred.is_none_or(|geometry| !geometry.holds(draw.drawable));
    draw(pass, surfaces, scene, frame_group, plan.opaque.iter().filter(is_left));
    if let Some(panorama) = panorama {
        panorama.draw(pass);
    }
    draw(pass, surfaces, scene, frame_group, &plan.blended);
    if !edges.is_empty() {
        draw(pass, edges, scene, frame_group, &plan.opaque);
        draw(pass, edges, scene, frame_group, &plan.blended);
    }
}
