//! What is at a pixel, without waiting for it.

use super::{FrameState, PassFormat, RenderError, Renderer};
use crate::frame::FramePlan;
use crate::gpu::pipeline::DepthTarget;
use crate::gpu::{DeviceLost, Download, formats, read_texture};
use crate::gpu_scene::GpuScene;
use crate::scene::{Background, Camera, Channel, Number, Projection, View, from_digits};
use glam::{DVec3, UVec2, Vec2};

/// The nearest surface at a pixel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PickedSurface {
    /// Index into the scene's nodes.
    pub node: usize,
    pub mesh: usize,
    /// Index into the primitives of the mesh.
    pub primitive: usize,
    pub material: usize,
    /// Where the ray through the middle of the pixel meets it, metres.
    pub position_in_world: DVec3,
    /// From the plane of the eye along the line of sight, metres.
    pub depth_m: f64,
}

/// A question to the device, answered when that is polled after the submission.
#[derive(Debug)]
pub struct Pick {
    download: Download,
    /// What each instance that is drawn is of.
    placements: Vec<Placement>,
    camera: Camera,
    pixel: UVec2,
    size_px: UVec2,
}

#[derive(Debug, Clone, Copy)]
struct Placement {
    node: usize,
    mesh: usize,
    primitive: usize,
    material: usize,
}

impl Renderer {
    /// Records what tells which surface of `scene` is at a pixel of `view`, counted from the top left: that pixel is drawn
    /// into two texels of our own, and copied. Transparent surfaces count as soon as they cover anything, masked ones where
    /// they are not cut out.
    ///
    /// # Errors
    /// Those of [`Self::prepare_frame`], and [`RenderError::Pass`] for a pixel outside the view.
    pub fn pick(
        &mut self,
        (device, queue): (&wgpu::Device, &wgpu::Queue),
        encoder: &mut wgpu::CommandEncoder,
        scene: &mut GpuScene,
        view: &View,
        pixel: UVec2,
    ) -> Result<Pick, RenderError> {
        if pixel.cmpge(view.size_px).any() {
            return Err(RenderError::Pass(format!("the pixel {pixel} lies outside of a view of {}", view.size_px)));
        }
        let format = PassFormat::own(1);
        let [color, depth] = [format.color, formats::DEPTH].map(|format| texels(device, format));
        let mut states = [FrameState::default(), FrameState::default()];
        for ((state, number), texel) in states.iter_mut().zip([Number::Placement, Number::DepthBits]).zip([0.0, 1.0]) {
            let channel = Some(Channel::Digits(number));
            let asked = View { channel, term: None, background: Background::Transparent, ..view.clone() };
            // The pixel falls on the texel.
            let at_px = Vec2::new(texel, 0.0) - pixel.as_vec2();
            self.prepare_at((device, queue), scene, (&asked, at_px), &format, state)?;
        }
        let placements = placements(scene, states[0].plan());
        {
            let mut pass = begin(encoder, &color, &depth);
            for (state, texel) in states.iter().zip(0..) {
                pass.set_scissor_rect(texel, 0, 1, 1);
                if let Some(prepared) = state.prepared(scene) {
                    prepared.paint(&mut pass);
                }
            }
        }
        let download = read_texture(device, encoder, &color).on_submit(encoder);
        Ok(Pick { download, placements, camera: view.camera.clone(), pixel, size_px: view.size_px })
    }
}

impl Pick {
    /// The surface, as it was when the question was recorded; `None` inside where there is none, and outside as long as the
    /// device has not answered: the host submits the encoder and polls.
    ///
    /// # Errors
    /// [`DeviceLost`] where there will be no answer.
    pub fn try_get(&self) -> Option<Result<Option<PickedSurface>, DeviceLost>> {
        Some(self.download.try_bytes()?.map(|bytes| self.answer(&bytes)))
    }

    fn answer(&self, bytes: &[u8]) -> Option<PickedSurface> {
        let texels = formats::Precision::Half.texels(bytes);
        let [placement, depth] =
            texels.first_chunk()?.map(|texel| (texel.w > 0.0).then(|| from_digits(texel.truncate())));
        let Placement { node, mesh, primitive, material } = *self.placements.get(placement? as usize)?;
        let depth = f64::from(f32::from_bits(depth?));
        let Self { camera, pixel, size_px, .. } = self;
        let depth_m = match camera.projection {
            Projection::Perspective { .. } => camera.near_m / depth,
            Projection::Orthographic { .. } => camera.far_m - depth * (camera.far_m - camera.near_m),
        };
        let (origin, direction) = camera.ray(pixel.as_dvec2() + 0.5, *size_px);
        let forward = camera.forward_in_world();
        let along = (depth_m - (origin - camera.position_in_world()).dot(forward)) / direction.dot(forward);
        Some(PickedSurface { node, mesh, primitive, material, position_in_world: origin + along * direction, depth_m })
    }
}

/// What the instances of a plan are of, in its order.
fn placements(scene: &GpuScene, plan: &FramePlan) -> Vec<Placement> {
    let nothing = Placement { node: usize::MAX, mesh: 0, primitive: 0, material: 0 };
    let mut placements = vec![nothing; plan.visible.len()];
    for draw in plan.opaque.iter().chain(&plan.blended) {
        let drawable = &scene.drawables.draws[draw.drawable];
        let drawn = draw.instances.start as usize..draw.instances.end as usize;
        for (placement, &instance) in placements[drawn.clone()].iter_mut().zip(&plan.visible[drawn]) {
            let instance = scene.drawables.instances[instance as usize].instance;
            let primitive = scene.drawables.primitive_of(instance.mesh, drawable);
            let (node, mesh, material) = (instance.node, instance.mesh, drawable.material);
            *placement = Placement { node, mesh, primitive, material };
        }
    }
    placements
}

/// Two texels of a target.
fn texels(device: &wgpu::Device, format: wgpu::TextureFormat) -> wgpu::Texture {
    device.create_texture(&wgpu::TextureDescriptor {
        label: Some("pick"),
        size: wgpu::Extent3d { width: 2, height: 1, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    })
}

fn begin<'e>(
    encoder: &'e mut wgpu::CommandEncoder,
    color: &wgpu::Texture,
    depth: &wgpu::Texture,
) -> wgpu::RenderPass<'e> {
    let [color, depth] = [color, depth].map(|texture| texture.create_view(&Default::default()));
    let farthest = wgpu::LoadOp::Clear(DepthTarget::OWN.farthest());
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some("pick"),
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view: &color,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT), store: wgpu::StoreOp::Store },
        })],
        depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
            view: &depth,
            depth_ops: Some(wgpu::Operations { load: farthest, store: wgpu::StoreOp::Discard }),
            stencil_ops: None,
        }),
        timestamp_writes: None,
        occlusion_query_set: None,
        multiview_mask: None,
    })
}
