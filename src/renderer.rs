//! The facade: scenes in, passes recorded.
//!
//! [`Renderer`] holds what lives as long as the device. It never prints, and frames it records into the
//! caller's encoder. It submits nothing and waits for nothing, unless it is told to with [`Uploads::Bounded`].

mod channel;
mod draws;
mod error;
mod frame_state;
mod host;
mod lifetime;
mod paint;
mod pass_format;
mod pick;
mod radiance;
mod target;
mod uniforms;

use crate::bake::{EmbeddedTable, dfg, disney, fresnel_tail, taps};
use crate::frame::{Culled, Culling, Draw, FramePlan, PlanOptions, RenderPath, are_small, plan};
use crate::gpu::formats::{self, Precision};
use crate::gpu::{Identity, LostFlag, Staging, Uploads};
use crate::gpu_scene::{GpuScene, SharedTextures, Table, TextureLevels, WhiteFurnace};
use crate::passes::{
    BackgroundPass, BackgroundPipeline, BackgroundSource, BackgroundTarget, DeferredPipelines, DisplayPipelines,
    ForwardPipelines, ForwardTarget,
};
use crate::scene::{Background, Channel, EnvironmentMaps, Scene, Topology, View};
use crate::shader::types::FrameUniform;
use crate::shader::{Backdrop, DisplayFeatures, ShaderSources};
use radiance::Frame;
use std::sync::Arc;
use uniforms::{background_uniform, display_uniform, frame_uniform};

pub use error::RenderError;
pub use frame_state::FrameState;
pub use host::{HostTarget, HostView};
pub use paint::Prepared;
pub use pass_format::{Output, PassFormat};
pub use pick::{Pick, PickedSurface};
pub use target::{RadianceTarget, SurfaceTarget};

/// What a recorded frame consists of.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct FrameStats {
    pub path: RenderPath,
    /// Draw calls.
    pub draws: u32,
    pub triangles: u64,
    /// Names of the distinct forward pipelines, sorted.
    pub pipelines: Arc<[String]>,
    /// Distinct primitives, and why some are not drawn.
    pub drawables: Culled,
    /// Primitives at their places.
    pub placements: Culled,
}

/// Which paths a renderer may take from triangles to radiance.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum PathChoice {
    /// Always forward: what an engine expects of a pass of its own.
    #[default]
    Forward,
    /// Deferred where a scene has a few draws of small triangles; measured to be faster on software drivers.
    Faster,
    /// Deferred wherever something can be.
    Deferred,
}

impl PathChoice {
    /// What suits a kind of device.
    pub fn for_device(kind: wgpu::DeviceType) -> Self {
        if kind == wgpu::DeviceType::Cpu { Self::Faster } else { Self::Forward }
    }

    /// As reports have it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Forward => "forward",
            Self::Faster => "faster",
            Self::Deferred => "deferred",
        }
    }
}

/// Pipelines and tables for one device.
#[derive(Debug)]
pub struct Renderer {
    sources: ShaderSources,
    shared: SharedTextures,
    path: PathChoice,
    blends_float: bool,
    forward: ForwardPipelines,
    deferred: DeferredPipelines,
    background: BackgroundPipeline,
    display: DisplayPipelines,
    /// For hosts that have no depth buffer.
    own_depth: Option<wgpu::TextureView>,
    /// Of the channel that shows it, once that was asked for.
    furnace: Option<WhiteFurnace>,
    uploads: Uploads,
    lost: LostFlag,
    pub(crate) identity: Identity,
    /// `Off` draws the same pictures with more work.
    pub culling: Culling,
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
            path: PathChoice::default(),
            blends_float: device.features().contains(wgpu::Features::FLOAT32_BLENDABLE),
            forward: ForwardPipelines::default(),
            deferred: DeferredPipelines::default(),
            background: BackgroundPipeline::new(device),
            display: DisplayPipelines::new(device),
            own_depth: None,
            furnace: None,
            uploads: Uploads::default(),
            lost: LostFlag::default(),
            identity: Identity::default(),
            culling: Culling::On,
        }
    }

    /// With other paths than the forward one, for scenes that are uploaded from now on. Devices without
    /// `PRIMITIVE_INDEX` stay with that.
    pub fn with_paths(self, path: PathChoice) -> Self {
        Self { path, ..self }
    }

    /// The same for frames from now on. Scenes that were uploaded for the forward path alone stay on it.
    pub fn set_paths(&mut self, path: PathChoice) {
        self.path = path;
    }

    /// The path that a frame takes, and so what its [`RadianceTarget`] needs.
    pub fn path(&self, scene: &GpuScene, view: &View, target: ForwardTarget) -> RenderPath {
        let blends = target.format != Precision::Float.hdr_format() || self.blends_float;
        // A channel asks for neighbours in the picture.
        let Some(geometry) = scene.pulled.as_ref().filter(|_| view.channel.is_none() && blends) else {
            return RenderPath::Forward;
        };
        let triangles =
            |index: usize| geometry.holds(index).then(|| scene.draws[index].primitive.indices.len() as u64 / 3);
        let is_deferred = match self.path {
            PathChoice::Forward => false,
            PathChoice::Faster => are_small(&scene.drawables, scene.features, view, target.samples, triangles),
            PathChoice::Deferred => true,
        };
        match is_deferred {
            false => RenderPath::Forward,
            true if geometry.left_over(&scene.drawables, view).next().is_some() => RenderPath::Mixed,
            true => RenderPath::Deferred,
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
        let uploaded = GpuScene::new(self.staging(device, queue)?, scene, levels, maps, &table(&disney::TABLE))?;
        Ok(self.deferrable((device, queue), scene, uploaded))
    }

    /// Uploads a scene once more, of which all but the images may have changed: its textures are those of `previous`, and
    /// so are those of its environment where `same_light` says that image and maps have not changed.
    pub fn upload_again(
        &self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        scene: &Scene,
        (maps, same_light): (Option<&EnvironmentMaps>, bool),
        previous: GpuScene,
    ) -> Result<GpuScene, RenderError> {
        let uploaded =
            previous.again(self.staging(device, queue)?, scene, (maps, same_light), &table(&disney::TABLE))?;
        Ok(self.deferrable((device, queue), scene, uploaded))
    }

    /// With what the deferred path needs, where that may be taken.
    fn deferrable(
        &self,
        (device, queue): (&wgpu::Device, &wgpu::Queue),
        scene: &Scene,
        mut uploaded: GpuScene,
    ) -> GpuScene {
        if self.path != PathChoice::Forward && device.features().contains(wgpu::Features::PRIMITIVE_INDEX) {
            uploaded.pull(device, queue, scene);
        }
        uploaded
    }

    /// Makes the forward pipelines that this view needs, so that [`Self::encode_radiance`] compiles nothing.
    pub fn prepare(
        &mut self,
        device: &wgpu::Device,
        scene: &GpuScene,
        view: &View,
        target: ForwardTarget,
    ) -> Result<FramePlan, RenderError> {
        let options = PlanOptions { samples: target.samples, culling: self.culling };
        let plan = plan(&scene.drawables, scene.features, view, options);
        match self.path(scene, view, target) {
            RenderPath::Forward => self.prepare_forward(device, scene, (&plan, None), target)?,
            RenderPath::Deferred => {}
            RenderPath::Mixed => self.prepare_forward(device, scene, (&plan, scene.pulled.as_ref()), target)?,
        }
        Ok(plan)
    }

    /// Whether the last frame recorded with `state` has left in the targets what recording this one would: then nothing
    /// needs to be recorded, and asking has cost no allocation. `display` is where the radiance is displayed, if it is.
    pub fn is_current(
        &self,
        state: &FrameState,
        scene: &GpuScene,
        view: &View,
        target: &RadianceTarget<'_>,
        display: Option<&wgpu::TextureView>,
    ) -> bool {
        let radiance = target.surfaces.radiance();
        state.shows(scene, view, self.culling, target)
            && display.is_none_or(|display| state.displays(view, radiance, display))
    }

    /// Records linear radiance, multiplied with coverage.
    pub fn encode_radiance(
        &mut self,
        (device, queue): (&wgpu::Device, &wgpu::Queue),
        encoder: &mut wgpu::CommandEncoder,
        scene: &mut GpuScene,
        view: &View,
        target: &RadianceTarget<'_>,
        state: &mut FrameState,
    ) -> Result<FrameStats, RenderError> {
        self.check_device()?;
        check_size(device, view)?;
        if let Some(clock) = &mut state.clock {
            clock.begin();
        }
        let forward_target = ForwardTarget::radiance(target.format, target.samples);
        self.check_channel(device, scene, view, target.format)?;
        let options = PlanOptions { samples: target.samples, culling: self.culling };
        let visible = state.plan_frame((device, queue), scene, view, options)?;
        let mut panorama = |under| self.panorama((device, queue), scene, view, (forward_target, under), state);
        let (panorama, behind) = match target.surfaces {
            SurfaceTarget::Forward { .. } => (panorama(false)?, None),
            SurfaceTarget::Deferred { over: None, .. } => (None, panorama(true)?),
            SurfaceTarget::Deferred { over: Some(_), .. } => (panorama(false)?, panorama(true)?),
        };
        let uniform = frame_uniform(scene, view);
        let group = self.frame_group((device, queue), scene, (view, visible), &uniform, state)?;
        // Without a panorama, an environment background is the black of a scene without light.
        let is_black = view.background == Background::Environment && !state.plan.panorama && view.channel.is_none();
        let frame = Frame { view, target, group, panorama, behind, coverage: f32::from(is_black) };
        let path = self.encode_path(device, encoder, scene, &frame, state)?;
        state.was_drawn(scene, view, self.culling, target);
        Ok(FrameStats { path, ..frame_stats(scene, state) })
    }

    /// Group 0 of the frame.
    fn frame_group(
        &mut self,
        (device, queue): (&wgpu::Device, &wgpu::Queue),
        scene: &mut GpuScene,
        (view, visible): (&View, wgpu::Buffer),
        uniform: &FrameUniform,
        state: &mut FrameState,
    ) -> Result<wgpu::BindGroup, RenderError> {
        let furnace = match (&mut self.furnace, view.channel) {
            (Some(furnace), Some(Channel::Furnace)) => Some(&*furnace),
            (none, Some(Channel::Furnace)) => {
                Some(&*none.insert(WhiteFurnace::new(Staging::new(device, queue, self.uploads))?))
            }
            _ => None,
        };
        let origin_in_world = scene.drawables.origin_in_world;
        let clusters = scene.lights.as_mut().map(|lights| lights.clusters(device, origin_in_world, view));
        let clusters = clusters.transpose()?.flatten();
        let table = clusters.as_ref().map(|clusters| clusters.table.clone());
        Ok(state.frame.group(
            (device, queue),
            "frame",
            bytemuck::bytes_of(uniform),
            (scene.instances.clone(), visible, table, furnace.is_some()),
            |frame, (_, visible, ..)| {
                scene.frame_group(device, &self.shared, (frame, visible), clusters.as_ref(), furnace)
            },
        )?)
    }

    /// The panorama of the frame, where it has one.
    fn panorama(
        &mut self,
        (device, queue): (&wgpu::Device, &wgpu::Queue),
        scene: &mut GpuScene,
        view: &View,
        (target, under): (ForwardTarget, bool),
        state: &mut FrameState,
    ) -> Result<Option<BackgroundPass>, RenderError> {
        let (Some(environment), true) = (&mut scene.environment, state.plan.panorama) else { return Ok(None) };
        let from_world = environment.environment_from_world;
        let (source, backdrop, scale) = if view.background_blur > 0.0 {
            let (uniform, atlas) = (environment.uniform.clone(), environment.atlas.clone());
            let source = BackgroundSource::Environment(uniform, atlas, self.shared.clamp_sampler.clone());
            (source, Backdrop::Blurred, 1.0)
        } else {
            let panorama = environment.panorama(Staging::new(device, queue, self.uploads))?;
            (BackgroundSource::Panorama(panorama.view), Backdrop::Sharp, panorama.scale)
        };
        let uniform = background_uniform(view, from_world, environment.intensity * scale);
        let ForwardTarget { format, samples, depth, light } = target;
        let samples = if under { 1 } else { samples };
        let into = BackgroundTarget { format, samples, depth, light, under, backdrop };
        let uniform = (&uniform, &mut state.background);
        Ok(Some(self.background.prepare((device, queue), &self.sources, into, source, uniform)?))
    }

    /// Records exposure, tone map and sRGB from `radiance` into `target`.
    pub fn encode_display(
        &mut self,
        (device, queue): (&wgpu::Device, &wgpu::Queue),
        encoder: &mut wgpu::CommandEncoder,
        view: &View,
        radiance: &wgpu::TextureView,
        (target, format): (&wgpu::TextureView, wgpu::TextureFormat),
        state: &mut FrameState,
    ) -> Result<(), RenderError> {
        self.check_device()?;
        let features = DisplayFeatures { tone_map: view.tone_map, encode_srgb: !formats::encodes_srgb(format) };
        let uniform = display_uniform(view);
        let uniform = (&uniform, &mut state.display);
        let pass = self.display.prepare((device, queue), &self.sources, features, format, radiance, uniform)?;
        pass.encode(encoder, target, &mut state.clock);
        state.was_displayed(view, radiance, target);
        Ok(())
    }

    /// Name and text of every WGSL module in use, sorted by name.
    pub fn wgsl_sources(&self) -> Vec<(String, String)> {
        let background = self.background.sources().map(|text| ("background".to_owned(), text));
        let all = self.forward.sources().chain(self.deferred.sources()).chain(self.display.sources()).chain(background);
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

fn frame_stats(scene: &GpuScene, state: &FrameState) -> FrameStats {
    let plan = &state.plan;
    let drawn = || plan.opaque.iter().chain(&plan.blended);
    let of_triangles = |draw: &&Draw| scene.drawables.draws[draw.drawable].topology == Topology::Triangles;
    let triangles = |draw: &Draw| {
        let indices = scene.draws[draw.drawable].primitive.indices.len();
        indices as u64 / 3 * draw.instances.len() as u64
    };
    FrameStats {
        path: RenderPath::Forward,
        draws: drawn().count() as u32,
        triangles: drawn().filter(of_triangles).map(triangles).sum(),
        pipelines: Arc::clone(&state.pipeline_names),
        drawables: plan.drawables,
        placements: plan.placements,
    }
}
