//! The facade: scenes in, passes recorded.
//!
//! [`Renderer`] holds what lives as long as the device. It never polls or prints, and frames it records into the
//! caller's encoder; only uploads are submitted.

use crate::bake::{EmbeddedTable, dfg, disney, fresnel_tail, taps};
use crate::frame::{FramePlan, plan};
use crate::gpu::formats;
use crate::gpu_scene::{GpuScene, SharedTextures, Table, TextureLevels, UploadError};
use crate::math::color::linear_from_srgb;
use crate::passes::{BackgroundPipeline, DisplayPipelines, ForwardPipelines, ForwardTarget, draw};
use crate::scene::{Background, Camera, EnvironmentMaps, Projection, Scene, ToneMap, View};
use crate::shader::types::{BackgroundUniform, DisplayUniform, FrameUniform};
use crate::shader::{DisplayFeatures, ShaderError, ShaderSources, channel_uniform};
use glam::{DMat3, DVec2, DVec3, DVec4, UVec2};
use wgpu::util::DeviceExt;

/// Why a frame could not be recorded.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum RenderError {
    #[error(transparent)]
    Upload(#[from] UploadError),
    #[error("a shader of this version is broken, please report it: {0}")]
    Shader(#[from] ShaderError),
    #[error("the picture is {width} x {height} pixels; both must be between 1 and {allowed}")]
    Size { width: u32, height: u32, allowed: u32 },
}

/// Where the radiance of a frame goes. All views have the size of the [`View`].
#[derive(Debug, Clone, Copy)]
pub struct RadianceTarget<'a> {
    pub format: wgpu::TextureFormat,
    pub samples: u32,
    /// Multisampled when `samples > 1`.
    pub color: &'a wgpu::TextureView,
    /// Given exactly when `samples > 1`.
    pub resolve: Option<&'a wgpu::TextureView>,
    /// In [`formats::DEPTH`], with the same number of samples.
    pub depth: &'a wgpu::TextureView,
    /// The only pixel that is drawn, from the top left; inside of the picture. `None` draws all.
    pub pixel: Option<UVec2>,
}

/// What a recorded frame consists of.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct FrameStats {
    pub draws: u32,
    pub triangles: u64,
    /// Names of the distinct forward pipelines, sorted.
    pub pipelines: Vec<String>,
}

/// Pipelines and tables for one device.
#[derive(Debug)]
pub struct Renderer {
    sources: ShaderSources,
    shared: SharedTextures,
    forward: ForwardPipelines,
    background: BackgroundPipeline,
    display: DisplayPipelines,
}

impl Renderer {
    pub fn new(device: &wgpu::Device, queue: &wgpu::Queue) -> Self {
        Self::with_shaders(device, queue, ShaderSources::default())
    }

    /// A renderer some of whose shader files are replaced.
    pub fn with_shaders(device: &wgpu::Device, queue: &wgpu::Queue, sources: ShaderSources) -> Self {
        Self {
            sources,
            shared: shared_textures(device, queue),
            forward: ForwardPipelines::default(),
            background: BackgroundPipeline::new(device),
            display: DisplayPipelines::new(device),
        }
    }

    /// Uploads a scene. `maps` are baked from its environment (`bake::environment`) and needed when it has one.
    pub fn upload(
        &self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        scene: &Scene,
        maps: Option<&EnvironmentMaps>,
    ) -> Result<GpuScene, RenderError> {
        let levels = TextureLevels::of(scene, device.limits().max_texture_dimension_2d);
        self.upload_with(device, queue, scene, levels, maps)
    }

    /// [`Self::upload`] with levels of its textures that were made beside other work. Of the scene's images only the
    /// sizes are read.
    pub fn upload_with(
        &self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        scene: &Scene,
        levels: TextureLevels,
        maps: Option<&EnvironmentMaps>,
    ) -> Result<GpuScene, RenderError> {
        Ok(GpuScene::new(device, queue, scene, levels, maps, &table(&disney::TABLE))?)
    }

    /// Makes the pipelines that this view needs, so that [`Self::encode_radiance`] compiles nothing.
    pub fn prepare(
        &mut self,
        device: &wgpu::Device,
        scene: &GpuScene,
        view: &View,
        target: ForwardTarget,
    ) -> Result<FramePlan, RenderError> {
        let plan = plan(&scene.drawables, scene.features, view);
        self.forward.prepare(device, &self.sources, scene, &plan, target)?;
        Ok(plan)
    }

    /// Records the forward pass: linear radiance, multiplied with coverage.
    pub fn encode_radiance(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        encoder: &mut wgpu::CommandEncoder,
        scene: &mut GpuScene,
        view: &View,
        target: &RadianceTarget<'_>,
    ) -> Result<FrameStats, RenderError> {
        check_size(device, view)?;
        let forward_target = ForwardTarget { format: target.format, samples: target.samples };
        let plan = self.prepare(device, scene, view, forward_target)?;
        let panorama = match (&mut scene.environment, plan.panorama) {
            (Some(environment), true) => {
                let panorama = environment.panorama(device, queue)?;
                let uniform = background_uniform(
                    &view.camera,
                    view,
                    environment.environment_from_world,
                    environment.intensity * panorama.scale,
                );
                Some(self.background.prepare(device, &self.sources, forward_target, &panorama, &uniform)?)
            }
            _ => None,
        };
        let frame = device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some("frame"),
            contents: bytemuck::bytes_of(&frame_uniform(scene, view)),
            usage: wgpu::BufferUsages::UNIFORM,
        });
        let frame_group = scene.frame_group(device, &self.shared, &frame);
        // Without a panorama, an environment background is the black of a scene without light.
        let coverage = if view.background == Background::Environment && panorama.is_none() && view.channel.is_none() {
            1.0
        } else {
            0.0
        };
        let mut pass = begin_forward(encoder, target, coverage);
        if let Some(pixel) = target.pixel {
            pass.set_scissor_rect(pixel.x, pixel.y, 1, 1);
        }
        draw(&mut pass, &self.forward, forward_target, scene, &frame_group, &plan, &plan.opaque);
        if let Some(panorama) = &panorama {
            panorama.draw(&mut pass);
        }
        draw(&mut pass, &self.forward, forward_target, scene, &frame_group, &plan, &plan.blended);
        Ok(frame_stats(scene, &plan))
    }

    /// Records exposure, tone map and sRGB from `radiance` into `target`.
    pub fn encode_display(
        &mut self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        view: &View,
        radiance: &wgpu::TextureView,
        (target, format): (&wgpu::TextureView, wgpu::TextureFormat),
    ) -> Result<(), RenderError> {
        let features = DisplayFeatures { tone_map: view.tone_map, encode_srgb: !formats::encodes_srgb(format) };
        let pass = self.display.prepare(device, &self.sources, features, format, radiance, &display_uniform(view))?;
        pass.encode(encoder, target);
        Ok(())
    }

    /// Name and text of every WGSL module in use, sorted by name.
    pub fn wgsl_sources(&self) -> Vec<(String, String)> {
        let background = self.background.source().map(|text| ("background".to_owned(), text));
        let all = self.forward.sources().chain(self.display.sources()).chain(background);
        let mut sources: Vec<_> = all.map(|(name, text)| (name, text.to_owned())).collect();
        sources.sort();
        sources
    }
}

fn check_size(device: &wgpu::Device, view: &View) -> Result<(), RenderError> {
    let allowed = device.limits().max_texture_dimension_2d;
    let (width, height) = (view.size_px.x, view.size_px.y);
    let fits = (1..=allowed).contains(&width) && (1..=allowed).contains(&height);
    if fits { Ok(()) } else { Err(RenderError::Size { width, height, allowed }) }
}

/// An embedded table, ready for upload.
pub(crate) fn table(embedded: &EmbeddedTable) -> Table {
    let EmbeddedTable { file: label, width, height, channels, bytes, .. } = *embedded;
    Table { label, width: width as u32, height: height as u32, channels, bytes }
}

/// What every lit scene reads: the split-sum table, its companion, and the sampler for tables.
pub(crate) fn shared_textures(device: &wgpu::Device, queue: &wgpu::Queue) -> SharedTextures {
    let clamp_sampler = device.create_sampler(&wgpu::SamplerDescriptor {
        label: Some("clamp"),
        mag_filter: wgpu::FilterMode::Linear,
        min_filter: wgpu::FilterMode::Linear,
        ..Default::default()
    });
    SharedTextures {
        dfg: table(&dfg::TABLE).upload(device, queue),
        fresnel_tail: table(&fresnel_tail::TABLE).upload(device, queue),
        taps: table(&taps::TABLE).upload(device, queue),
        clamp_sampler,
    }
}

fn frame_uniform(scene: &GpuScene, view: &View) -> FrameUniform {
    let mut camera = view.camera.clone();
    let eye = camera.position_in_world() - scene.origin_in_world;
    camera.world_from_view.w_axis = eye.extend(1.0);
    let clip_from_view = camera.clip_from_view(view.size_px).as_dmat4();
    let viewer: DVec4 = match camera.projection {
        Projection::Perspective { .. } => eye.extend(1.0),
        Projection::Orthographic { .. } => (-camera.forward_in_world()).extend(0.0),
    };
    let [channel, channel_index, channel_components] = view.channel.map_or([0; 3], channel_uniform);
    FrameUniform {
        clip_from_world: (clip_from_view * camera.world_from_view.inverse()).as_mat4().to_cols_array_2d(),
        viewer: viewer.as_vec4().to_array(),
        light_count: scene.light_count,
        channel,
        channel_index,
        channel_components,
    }
}

/// The ray direction is affine in the picture plane, so three corners of it give the whole map.
fn background_uniform(
    camera: &Camera,
    view: &View,
    environment_from_world: DMat3,
    radiance_scale: f32,
) -> BackgroundUniform {
    let size = view.size_px.as_dvec2();
    let direction = |ndc: DVec2| {
        let pixel = DVec2::new((ndc.x + 1.0) * 0.5, (1.0 - ndc.y) * 0.5) * size;
        let along: DVec3 = camera.ray(pixel, view.size_px).1;
        environment_from_world * (along / along.dot(camera.forward_in_world()))
    };
    let center = direction(DVec2::ZERO);
    let direction_from_ndc = DMat3::from_cols(direction(DVec2::X) - center, direction(DVec2::Y) - center, center);
    BackgroundUniform {
        direction_from_ndc: [direction_from_ndc.x_axis, direction_from_ndc.y_axis, direction_from_ndc.z_axis]
            .map(|column| column.extend(0.0).as_vec4().to_array()),
        radiance_scale,
        ..Default::default()
    }
}

fn display_uniform(view: &View) -> DisplayUniform {
    let background = match view.background {
        Background::Color(color) => {
            let linear = color.to_array().map(|channel| linear_from_srgb(f64::from(channel)) as f32);
            [linear[0], linear[1], linear[2], 1.0]
        }
        Background::Environment | Background::Transparent => [0.0; 4],
    };
    let exposure = if view.tone_map == ToneMap::None { 1.0 } else { view.exposure_ev.exp2() };
    DisplayUniform { background, exposure, ..Default::default() }
}

fn begin_forward<'encoder>(
    encoder: &'encoder mut wgpu::CommandEncoder,
    target: &RadianceTarget<'_>,
    coverage: f64,
) -> wgpu::RenderPass<'encoder> {
    // The multisampled colour is not needed once it is resolved; depth is read by nobody yet.
    let store = if target.resolve.is_some() { wgpu::StoreOp::Discard } else { wgpu::StoreOp::Store };
    let clear = wgpu::Color { r: 0.0, g: 0.0, b: 0.0, a: coverage };
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some("forward"),
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view: target.color,
            depth_slice: None,
            resolve_target: target.resolve,
            ops: wgpu::Operations { load: wgpu::LoadOp::Clear(clear), store },
        })],
        depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
            view: target.depth,
            depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store: wgpu::StoreOp::Discard }),
            stencil_ops: None,
        }),
        timestamp_writes: None,
        occlusion_query_set: None,
        multiview_mask: None,
    })
}

fn frame_stats(scene: &GpuScene, plan: &FramePlan) -> FrameStats {
    let drawn = plan.opaque.iter().chain(&plan.blended).map(|draw| &scene.drawables.draws[draw.drawable]);
    let triangles = drawn.clone().filter(|drawable| drawable.topology == crate::scene::Topology::Triangles);
    let count = |drawable: &crate::frame::Drawable| {
        let indices = scene.primitives.get(&(drawable.mesh, drawable.primitive)).map_or(0, |p| p.indices.len());
        (indices / 3 * drawable.instances.len()) as u64
    };
    FrameStats {
        draws: drawn.count() as u32,
        triangles: triangles.map(count).sum(),
        pipelines: plan.pipelines.iter().map(|key| key.features.to_string()).collect(),
    }
}
