//! A [`Scene`] on the GPU: buffers, textures and bind groups, made once.

mod edit;
mod environment;
mod geometry;
mod lights;
mod materials;
pub mod mips;
mod packing;
mod pulled;
mod tables;
mod textures;

use crate::frame::{Drawables, PlacedInstance};
use crate::gpu::bindings::{self, frame_layout};
use crate::gpu::{DeviceLost, Identity, Staging, filled_buffer};
use crate::scene::{EnvironmentMaps, MAX_SUNS, Scene};
use crate::shader::{MaterialFeatures, SceneFeatures, types};
use geometry::{GpuPrimitive, upload_primitives};
use glam::{DMat3, DMat4, DVec3};
use std::collections::HashMap;

pub use environment::Panorama;
pub(crate) use environment::{GpuEnvironment, WhiteFurnace};
pub(crate) use lights::GpuClusters;
use lights::GpuLights;
use materials::GpuMaterial;
pub use pulled::PulledGeometry;
pub(crate) use pulled::PulledPlace;
pub use tables::Table;
use textures::TextureCache;
pub use textures::{HostTextures, TextureLevels};

/// Why a scene cannot be put on this device.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum UploadError {
    #[error("{what} needs {needed} bytes, the device allows {allowed}")]
    TooLarge { what: &'static str, needed: u64, allowed: u64 },
    #[error("the environment is {width} x {height}, the device allows textures up to {allowed}; use a smaller one")]
    EnvironmentTooLarge { width: u32, height: u32, allowed: u32 },
    #[error("the tiles of the environment's maps do not lie as a bake lays them out")]
    EnvironmentLayout,
    #[error("the scene has an environment, but no maps baked from it were given")]
    MissingMaps,
    #[error("image {image} is a host's texture that was not given for this device")]
    NoHostTexture { image: usize },
    #[error("image {image} is a host's texture and read as {what}, which is not possible")]
    HostTexture { image: usize, what: &'static str },
    #[error(transparent)]
    DeviceLost(#[from] DeviceLost),
}

/// Bytes of GPU memory that a scene takes, by kind.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct UploadedBytes {
    pub geometry: u64,
    pub textures: u64,
    pub environment: u64,
}

/// What a drawable binds.
#[derive(Debug)]
pub(crate) struct GpuDraw {
    pub(crate) primitive: GpuPrimitive,
    pub(crate) material: GpuMaterial,
}

impl GpuDraw {
    fn new((primitive, material): (GpuPrimitive, GpuMaterial)) -> Self {
        Self { primitive, material }
    }
}

/// What drawing reads of a scene.
#[derive(Debug)]
pub struct GpuScene {
    pub features: SceneFeatures,
    pub drawables: Drawables,
    pub bytes: UploadedBytes,
    /// Things that were drawn with less than was asked for.
    pub warnings: Vec<String>,
    pub(crate) vertices: wgpu::Buffer,
    pub(crate) indices: wgpu::Buffer,
    pub(crate) instances: wgpu::Buffer,
    /// What each of the drawables binds.
    pub(crate) draws: Vec<GpuDraw>,
    pub(crate) material_layouts: HashMap<MaterialFeatures, wgpu::BindGroupLayout>,
    /// For shading in a pass of its own, where that was asked for and can be.
    pub(crate) pulled: Option<PulledGeometry>,
    pub(crate) lights: Option<GpuLights>,
    pub(crate) environment: Option<GpuEnvironment>,
    textures: TextureCache,
    /// Instances on their way to the device.
    moved: Vec<types::Instance>,
    pub(crate) frame_layout: wgpu::BindGroupLayout,
    pub(crate) identity: Identity,
    /// Counts the edits since the upload.
    pub(crate) revision: u64,
}

/// The device-lifetime resources that a scene's bind groups point at.
#[derive(Debug)]
pub struct SharedTextures {
    pub dfg: wgpu::TextureView,
    pub fresnel_tail: wgpu::TextureView,
    pub taps: wgpu::TextureView,
    pub clamp_sampler: wgpu::Sampler,
}

impl GpuScene {
    /// Uploads `scene` through `staging` with the `levels` of its textures. `maps` are baked from its environment and needed when it has
    /// one; `disney_table` goes to the GPU when something reads it.
    pub fn new(
        staging: Staging<'_>,
        scene: &Scene,
        levels: TextureLevels,
        maps: Option<&EnvironmentMaps>,
        disney_table: &Table,
    ) -> Result<Self, UploadError> {
        Self::with_textures(staging, scene, (TextureCache::new(levels), None), maps, disney_table)
    }

    /// The same of a scene of which all but the images is another now, with the textures of this one; and with those of
    /// its environment, where `same_light` says that image and maps are the same.
    pub fn again(
        self,
        staging: Staging<'_>,
        scene: &Scene,
        (maps, same_light): (Option<&EnvironmentMaps>, bool),
        disney_table: &Table,
    ) -> Result<Self, UploadError> {
        let environment = self.environment.filter(|_| same_light);
        Self::with_textures(staging, scene, (self.textures, environment), maps, disney_table)
    }

    fn with_textures(
        mut staging: Staging<'_>,
        scene: &Scene,
        (mut textures, light): (TextureCache, Option<GpuEnvironment>),
        maps: Option<&EnvironmentMaps>,
        disney_table: &Table,
    ) -> Result<Self, UploadError> {
        let mut features = SceneFeatures::of(scene);
        features.suns = maps.filter(|_| features.environment).map_or(0, |maps| maps.suns.len().min(MAX_SUNS) as u8);
        let mut drawables = Drawables::new(scene, features);
        drawables.find_occluders(scene);
        let origin_in_world = drawables.origin_in_world;
        let device = staging.device;
        let geometry = upload_primitives(device, scene, &drawables)?;
        let materials = materials::upload(&mut staging, scene, &drawables, &mut textures, disney_table)?;
        textures.forget_levels();
        let environment = match (features.environment, &scene.environment, maps) {
            (true, Some(environment), Some(maps)) => Some(GpuEnvironment::new(&mut staging, environment, maps, light)?),
            (true, ..) => return Err(UploadError::MissingMaps),
            (false, ..) => None,
        };
        staging.finish();
        let lights = if features.punctual {
            Some(GpuLights::new(device, &scene.lights_in_world(), origin_in_world, features.light_list)?)
        } else {
            None
        };
        let instance_data: Vec<types::Instance> =
            drawables.instances.iter().map(|placed| gpu_instance(placed, origin_in_world)).collect();
        let storage = |label, contents: &[u8]| {
            // An empty binding is not allowed; nothing reads the padding.
            let contents = if contents.is_empty() { &[0; 128] } else { contents };
            let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST;
            filled_buffer(device, label, contents, usage)
        };
        Ok(Self {
            features,
            bytes: UploadedBytes {
                geometry: geometry.vertices.size() + geometry.indices.size(),
                textures: textures.bytes,
                environment: environment.as_ref().map_or(0, GpuEnvironment::bytes),
            },
            warnings: textures.warnings.clone(),
            textures,
            moved: Vec::new(),
            instances: storage("instances", bytemuck::cast_slice(&instance_data))?,
            lights,
            draws: geometry.primitives.into_iter().zip(materials.groups).map(GpuDraw::new).collect(),
            drawables,
            vertices: geometry.vertices,
            indices: geometry.indices,
            material_layouts: materials.layouts,
            pulled: None,
            environment,
            frame_layout: frame_layout(device, features),
            identity: Identity::default(),
            revision: 0,
        })
    }

    /// Replaces the host's textures, for the next upload with the textures of this one.
    pub fn set_host_textures(&mut self, of_host: HostTextures) {
        self.textures.of_host = of_host;
    }

    /// Uploads the geometry of `scene`, of which this was made, once more, so that surfaces can be shaded in a pass of
    /// their own. Does nothing where they cannot.
    pub(crate) fn pull(&mut self, device: &wgpu::Device, queue: &wgpu::Queue, scene: &Scene) {
        self.pulled = PulledGeometry::new(device, queue, scene, &self.drawables);
        self.bytes.geometry += self.pulled.as_ref().map_or(0, PulledGeometry::bytes);
    }

    /// Group 0 of the forward pass, with the uniform of one view, its list of visible instances and its clusters; and with
    /// the `furnace` in place of the environment, if there is one.
    pub(crate) fn frame_group(
        &self,
        device: &wgpu::Device,
        shared: &SharedTextures,
        (frame, visible): (&wgpu::Buffer, &wgpu::Buffer),
        clusters: Option<&GpuClusters>,
        furnace: Option<&WhiteFurnace>,
    ) -> wgpu::BindGroup {
        let mut entries = vec![
            entry(bindings::FRAME_UNIFORM, frame.as_entire_binding()),
            entry(bindings::FRAME_INSTANCES, self.instances.as_entire_binding()),
            entry(bindings::FRAME_VISIBLE, visible.as_entire_binding()),
        ];
        if self.features.is_lit() {
            entries.push(entry(bindings::FRAME_DFG, wgpu::BindingResource::TextureView(&shared.dfg)));
            entries.push(entry(bindings::FRAME_SAMPLER, wgpu::BindingResource::Sampler(&shared.clamp_sampler)));
        }
        if let Some(lights) = &self.lights {
            entries.push(entry(bindings::FRAME_LIGHTS, lights.buffer.as_entire_binding()));
        }
        if let Some(clusters) = clusters {
            entries.push(entry(bindings::FRAME_CLUSTERS, clusters.uniform.as_entire_binding()));
            entries.push(entry(bindings::FRAME_CLUSTER_TABLE, clusters.table.as_entire_binding()));
        }
        if let Some(environment) = &self.environment {
            let own = (&environment.uniform, &environment.atlas);
            let (uniform, atlas) = furnace.map_or(own, |furnace| (&furnace.uniform, &furnace.atlas));
            entries.push(entry(bindings::FRAME_ENVIRONMENT, uniform.as_entire_binding()));
            entries.push(entry(bindings::FRAME_ATLAS, wgpu::BindingResource::TextureView(atlas)));
            entries.push(entry(bindings::FRAME_TAPS, wgpu::BindingResource::TextureView(&shared.taps)));
        }
        if self.features.is_lit() && self.features.fresnel_tail {
            let tail = wgpu::BindingResource::TextureView(&shared.fresnel_tail);
            entries.push(entry(bindings::FRAME_FRESNEL_TAIL, tail));
        }
        device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("frame"),
            layout: &self.frame_layout,
            entries: &entries,
        })
    }
}

pub(crate) fn entry(binding: u32, resource: wgpu::BindingResource<'_>) -> wgpu::BindGroupEntry<'_> {
    wgpu::BindGroupEntry { binding, resource }
}

fn gpu_instance(placed: &PlacedInstance, origin_in_world: DVec3) -> types::Instance {
    let world = DMat4::from_translation(-origin_in_world) * placed.instance.world_from_object;
    let rows = world.transpose();
    let sign = if placed.mirrored { -1.0 } else { 1.0 };
    let linear = DMat3::from_mat4(world);
    let (x, y, z) = (linear.x_axis, linear.y_axis, linear.z_axis);
    // Scaled to unit size, so that a model in micrometres does not underflow when squared in f32.
    let cofactor = [y.cross(z), z.cross(x), x.cross(y)];
    let largest = cofactor.iter().map(|column| column.abs().max_element()).fold(0.0, f64::max);
    let scale = if largest > 0.0 { sign / largest } else { 0.0 };
    types::Instance {
        world_from_object: [rows.x_axis, rows.y_axis, rows.z_axis].map(|row| row.as_vec4().to_array()),
        normal_from_object: cofactor.map(|column| (column * scale).extend(0.0).as_vec4().to_array()),
        handedness: sign as f32,
        ..Default::default()
    }
}
