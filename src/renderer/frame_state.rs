//! What one picture keeps from frame to frame: its plan, its buffers, and what it shows.

use super::RadianceTarget;
use super::paint::Painting;
use crate::frame::{Culling, FramePlan, PlanOptions, Planner};
use crate::gpu::{DeviceLost, Identity, KeptUniform, PassClock, write_buffer};
use crate::gpu_scene::GpuScene;
use crate::passes::{BackgroundSource, DeferredGroups};
use crate::scene::View;
use glam::UVec2;
use std::sync::Arc;

/// The state of one picture (a window, a capture target) of one renderer. Keep it, and a frame that only turns the camera
/// makes no buffer and no bind group; a frame like the one before need not be recorded at all, see
/// [`super::Renderer::is_current`].
///
/// Uniforms are written when the queue is submitted to next. Record one frame a state and submission; pictures that are
/// drawn in one submission have a state each.
#[derive(Debug, Default)]
pub struct FrameState {
    planner: Planner,
    pub(super) plan: FramePlan,
    pub(super) pipeline_names: Arc<[String]>,
    /// The scene that the rest is about.
    scene: Option<Identity>,
    visible: Option<VisibleList>,
    /// Beside the uniform: instances, which of them are visible, clusters of lights, and whether the furnace is bound.
    pub(super) frame: KeptUniform<(wgpu::Buffer, wgpu::Buffer, Option<wgpu::Buffer>, bool)>,
    pub(super) background: KeptUniform<BackgroundSource>,
    pub(super) display: KeptUniform<wgpu::TextureView>,
    pub(super) deferred: Option<DeferredGroups>,
    pub(super) painting: Option<Painting>,
    /// Times the passes of every frame, where it is wanted.
    pub(crate) clock: Option<PassClock>,
    drawn: Option<Drawn>,
    /// The view that was displayed last, from which radiance and where.
    displayed: Option<(View, wgpu::TextureView, wgpu::TextureView)>,
    lists_made: u32,
}

/// The list of visible instances on the GPU, with room for all.
#[derive(Debug)]
struct VisibleList {
    buffer: wgpu::Buffer,
    /// What it holds.
    uploaded: Vec<u32>,
}

/// All that a frame's radiance depends on.
#[derive(Debug, PartialEq)]
struct Drawn {
    scene: Identity,
    revision: u64,
    view: View,
    culling: Culling,
    surfaces: [Option<wgpu::TextureView>; 4],
    depth: wgpu::TextureView,
    samples: u32,
    pixel: Option<UVec2>,
}

impl FrameState {
    /// Forgets what the target shows, after something else was drawn into it, or a recorded frame was not submitted.
    pub fn forget(&mut self) {
        self.drawn = None;
        self.displayed = None;
    }

    /// The plan of the last frame.
    pub fn plan(&self) -> &FramePlan {
        &self.plan
    }

    /// Buffers and bind groups made for this picture so far.
    pub fn resources_made(&self) -> u32 {
        let of_draws = self.deferred.as_ref().map_or(0, DeferredGroups::count);
        self.lists_made + self.frame.made() + self.background.made() + self.display.made() + of_draws
    }

    /// Plans the next frame and returns the list of its visible instances, uploaded where it is another.
    pub(super) fn plan_frame(
        &mut self,
        (device, queue): (&wgpu::Device, &wgpu::Queue),
        scene: &GpuScene,
        view: &View,
        options: PlanOptions,
    ) -> Result<wgpu::Buffer, DeviceLost> {
        if self.scene.as_ref() != Some(&scene.identity) {
            self.let_go();
            self.scene = Some(scene.identity.clone());
        }
        if self.planner.plan(&scene.drawables, scene.features, view, options, &mut self.plan) {
            self.pipeline_names = self.plan.pipelines.iter().map(|key| key.features.to_string()).collect();
        }
        let visible = self.visible.get_or_insert_with(|| {
            self.lists_made += 1;
            VisibleList::new(device, scene.drawables.placements.instances.len())
        });
        visible.upload(queue, &self.plan.visible)?;
        Ok(visible.buffer.clone())
    }

    /// Lets go of all that is of a scene, or of its device.
    fn let_go(&mut self) {
        self.planner = Planner::default();
        (self.visible, self.deferred, self.painting) = (None, None, None);
        self.frame.forget();
        self.background.forget();
        self.display.forget();
        self.forget();
    }

    pub(super) fn was_drawn(&mut self, scene: &GpuScene, view: &View, culling: Culling, target: &RadianceTarget<'_>) {
        self.drawn = Some(Drawn {
            scene: scene.identity.clone(),
            revision: scene.revision,
            view: view.clone(),
            culling,
            surfaces: target.surfaces.views().map(Option::<&wgpu::TextureView>::cloned),
            depth: target.depth.clone(),
            samples: target.samples,
            pixel: target.pixel,
        });
        self.displayed = None;
    }

    pub(super) fn was_displayed(&mut self, view: &View, radiance: &wgpu::TextureView, target: &wgpu::TextureView) {
        self.displayed = Some((view.clone(), radiance.clone(), target.clone()));
    }

    /// Whether the radiance of this frame is what was recorded last.
    pub(super) fn shows(&self, scene: &GpuScene, view: &View, culling: Culling, target: &RadianceTarget<'_>) -> bool {
        let RadianceTarget { format: _, samples, surfaces, depth, pixel } = *target;
        self.drawn.as_ref().is_some_and(|drawn| {
            (&drawn.scene, drawn.revision) == (&scene.identity, scene.revision)
                && (&drawn.view, drawn.culling) == (view, culling)
                && (drawn.surfaces.each_ref().map(Option::as_ref), &drawn.depth) == (surfaces.views(), depth)
                && (drawn.samples, drawn.pixel) == (samples, pixel)
        })
    }

    /// Whether this radiance, displayed in this way, is what was recorded last.
    pub(super) fn displays(&self, view: &View, radiance: &wgpu::TextureView, target: &wgpu::TextureView) -> bool {
        self.displayed
            .as_ref()
            .is_some_and(|displayed| (&displayed.0, &displayed.1, &displayed.2) == (view, radiance, target))
    }
}

impl VisibleList {
    fn new(device: &wgpu::Device, placements: usize) -> Self {
        let buffer = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("visible instances"),
            // An empty binding is not allowed.
            size: 4 * placements.max(1) as u64,
            usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        Self { buffer, uploaded: Vec::new() }
    }

    fn upload(&mut self, queue: &wgpu::Queue, visible: &[u32]) -> Result<(), DeviceLost> {
        if self.uploaded != visible {
            write_buffer(queue, &self.buffer, 0, bytemuck::cast_slice(visible))?;
            self.uploaded.clear();
            self.uploaded.extend_from_slice(visible);
        }
        Ok(())
    }
}
