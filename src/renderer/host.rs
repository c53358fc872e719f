//! Frames in a pass of our own, on attachments of the host.

use super::{FrameState, FrameStats, PassFormat, RenderError, Renderer};
use crate::frame::Culled;
use crate::gpu::formats;
use crate::gpu::pipeline::DepthTarget;
use crate::gpu_scene::GpuScene;
use crate::scene::View;
use glam::UVec2;

/// What views are drawn into, and what becomes of what is there.
#[derive(Debug, Clone, Copy)]
pub struct HostTarget<'a> {
    pub color: &'a wgpu::TextureView,
    /// Where samples are resolved to, if they are.
    pub resolve: Option<&'a wgpu::TextureView>,
    pub load: wgpu::LoadOp<wgpu::Color>,
    /// With a `PassFormat::depth` of that format; without, a depth buffer of our own is cleared for each call.
    pub depth: Option<&'a wgpu::TextureView>,
    /// For the host's depth alone.
    pub depth_load: wgpu::LoadOp<f32>,
}

/// A view in its part of the target.
#[derive(Debug)]
pub struct HostView<'a> {
    pub view: &'a View,
    /// Where the part begins, pixels from the top left; it is as large as the view.
    pub at_px: UVec2,
    /// One for each view, kept from frame to frame.
    pub state: &'a mut FrameState,
}

impl Renderer {
    /// Records all `views` of a scene as one pass in the host's encoder, each in its part of the target. With
    /// `LoadOp::Load` on both attachments, what the host has drawn stays where it is nearer, and what it draws later is
    /// hidden where we are.
    ///
    /// # Errors
    /// Those of [`Self::prepare_frame`], and [`RenderError::Pass`] where the attachments do not fit the views or each other.
    /// Nothing has been recorded then.
    pub fn encode(
        &mut self,
        (device, queue): (&wgpu::Device, &wgpu::Queue),
        encoder: &mut wgpu::CommandEncoder,
        scene: &mut GpuScene,
        views: &mut [HostView<'_>],
        (pass, target): (&PassFormat, &HostTarget<'_>),
    ) -> Result<FrameStats, RenderError> {
        check_attachments(pass, target, views)?;
        let pass = &PassFormat { depth: pass.depth.or(Some(DepthTarget::OWN)), ..*pass };
        for HostView { view, at_px, state } in views.iter_mut() {
            self.prepare_frame((device, queue), scene, (view, *at_px), pass, state)?;
        }
        let depth_format = pass.depth.unwrap_or(DepthTarget::OWN);
        let (depth, depth_load) = match target.depth {
            Some(depth) => (depth, target.depth_load),
            None => {
                let depth = self.own_depth(device, target.color, pass.samples);
                (depth, wgpu::LoadOp::Clear(depth_format.farthest()))
            }
        };
        let keep = if target.depth.is_some() { wgpu::StoreOp::Store } else { wgpu::StoreOp::Discard };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("views"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: target.color,
                depth_slice: None,
                resolve_target: target.resolve,
                ops: wgpu::Operations { load: target.load, store: wgpu::StoreOp::Store },
            })],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: depth,
                depth_ops: Some(wgpu::Operations { load: depth_load, store: keep }),
                stencil_ops: depth_format.format.has_stencil_aspect().then_some(wgpu::Operations {
                    load: if target.depth.is_some() { wgpu::LoadOp::Load } else { wgpu::LoadOp::Clear(0) },
                    store: keep,
                }),
            }),
            timestamp_writes: None,
            occlusion_query_set: None,
            multiview_mask: None,
        });
        let mut stats = FrameStats::default();
        for HostView { state, .. } in views.iter() {
            let Some(prepared) = state.prepared(scene) else { continue };
            prepared.paint(&mut pass);
            add(&mut stats, prepared.stats());
        }
        Ok(stats)
    }

    /// A depth buffer as large as a colour attachment, kept while the size stays.
    fn own_depth(&mut self, device: &wgpu::Device, color: &wgpu::TextureView, samples: u32) -> &wgpu::TextureView {
        let size = color.texture().size();
        let size = wgpu::Extent3d { depth_or_array_layers: 1, ..size };
        let fits =
            |depth: &wgpu::TextureView| depth.texture().size() == size && depth.texture().sample_count() == samples;
        let depth = self.own_depth.take().filter(fits).unwrap_or_else(|| {
            let texture = device.create_texture(&wgpu::TextureDescriptor {
                label: Some("depth"),
                size,
                mip_level_count: 1,
                sample_count: samples,
                dimension: wgpu::TextureDimension::D2,
                format: formats::DEPTH,
                usage: wgpu::TextureUsages::RENDER_ATTACHMENT,
                view_formats: &[],
            });
            texture.create_view(&Default::default())
        });
        self.own_depth.insert(depth)
    }
}

fn check_attachments(pass: &PassFormat, target: &HostTarget<'_>, views: &[HostView<'_>]) -> Result<(), RenderError> {
    if target.depth.is_some() != pass.depth.is_some() {
        return Err(RenderError::Pass("a depth format is given without its buffer, or the other way round".to_owned()));
    }
    let size = target.color.texture().size();
    for attachment in [Some(target.color), target.depth].into_iter().flatten() {
        let texture = attachment.texture();
        if texture.sample_count() != pass.samples {
            let samples = texture.sample_count();
            return Err(RenderError::Pass(format!("an attachment has {samples} samples, the pass {}", pass.samples)));
        }
        if (texture.width(), texture.height()) != (size.width, size.height) {
            return Err(RenderError::Pass("colour and depth are not of one size".to_owned()));
        }
    }
    let end = |view: &HostView<'_>| view.at_px.saturating_add(view.view.size_px);
    match views.iter().map(end).find(|end| end.x > size.width || end.y > size.height) {
        Some(end) => {
            let (width, height) = (size.width, size.height);
            Err(RenderError::Pass(format!("a view ends at {end}, the target at [{width}, {height}]")))
        }
        None => Ok(()),
    }
}

/// Counts another view of the same scene in.
fn add(stats: &mut FrameStats, of_view: FrameStats) {
    let sum = |a: Culled, b: Culled| Culled {
        all: a.all + b.all,
        outside: a.outside + b.outside,
        between_samples: a.between_samples + b.between_samples,
        hidden: a.hidden + b.hidden,
    };
    *stats = FrameStats {
        draws: stats.draws + of_view.draws,
        triangles: stats.triangles + of_view.triangles,
        drawables: sum(stats.drawables, of_view.drawables),
        placements: sum(stats.placements, of_view.placements),
        ..of_view
    };
}
