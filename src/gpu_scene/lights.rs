//! Punctual lights on the GPU, and which of them reach which part of a view.

use super::UploadError;
use crate::frame::{Reach, clusters};
use crate::gpu::{DeviceLost, filled_buffer, write_buffer};
use crate::scene::{Camera, LightInWorld, LightKind, View};
use crate::shader::{FEW_LIGHTS, LightList, types};
use glam::{DVec3, UVec2};

/// The lights of a scene.
#[derive(Debug)]
pub(crate) struct GpuLights {
    pub(super) buffer: wgpu::Buffer,
    /// As they were when they were written.
    lights: Vec<LightInWorld>,
    sorted: Sorted,
    list: LightList,
    last: Option<GpuClusters>,
}

/// Which lights are where in the buffer.
#[derive(Debug)]
struct Sorted {
    /// How many of them shine; dark ones come last.
    lit: u32,
    /// How many of those reach everything; they come first.
    unbounded: u32,
    /// Of the lights in between.
    reaches: Vec<Reach>,
    /// Place in the buffer of each light, in the order of [`crate::scene::Scene::lights_in_world`].
    places: Vec<u32>,
}

/// The clusters of one view.
#[derive(Debug, Clone)]
pub(crate) struct GpuClusters {
    camera: Camera,
    size_px: UVec2,
    pub(super) uniform: wgpu::Buffer,
    pub(crate) table: wgpu::Buffer,
}

impl Sorted {
    fn new(lights: &[LightInWorld], origin_in_world: DVec3, list: LightList) -> (Self, Vec<types::Light>) {
        let reach = |light: &LightInWorld| Reach::new(light, origin_in_world);
        let is_dark = |light: &LightInWorld| light.intensity == DVec3::ZERO;
        let mut order: Vec<usize> = (0..lights.len()).collect();
        order.sort_by_key(|&i| (is_dark(&lights[i]), reach(&lights[i]).is_some()));
        let mut places = vec![0; lights.len()];
        for (&light, place) in order.iter().zip(0..) {
            places[light] = place;
        }
        let lit: Vec<usize> = order.iter().copied().filter(|&i| !is_dark(&lights[i])).collect();
        let reaches: Vec<Reach> = lit.iter().filter_map(|&i| reach(&lights[i])).collect();
        let mut data: Vec<types::Light> = order.iter().map(|&i| gpu_light(&lights[i], origin_in_world)).collect();
        if list.is_uniform() {
            // The shader declares an array of this length.
            data.resize(FEW_LIGHTS, types::Light::default());
        }
        let unbounded = (lit.len() - reaches.len()) as u32;
        (Self { lit: lit.len() as u32, unbounded, reaches, places }, data)
    }
}

impl GpuLights {
    pub(super) fn new(
        device: &wgpu::Device,
        lights: &[LightInWorld],
        origin_in_world: DVec3,
        list: LightList,
    ) -> Result<Self, UploadError> {
        let (sorted, data) = Sorted::new(lights, origin_in_world, list);
        let (needed, limits) = (size_of_val(&data[..]) as u64, device.limits());
        let allowed = limits.max_storage_buffer_binding_size.min(limits.max_buffer_size);
        if needed > allowed {
            return Err(UploadError::TooLarge { what: "the array of lights", needed, allowed });
        }
        let usage = match list.is_uniform() {
            true => wgpu::BufferUsages::UNIFORM,
            false => wgpu::BufferUsages::STORAGE,
        };
        let usage = usage | wgpu::BufferUsages::COPY_DST;
        let buffer = filled_buffer(device, "lights", bytemuck::cast_slice(&data), usage)?;
        Ok(Self { buffer, lights: lights.to_vec(), sorted, list, last: None })
    }

    /// Replaces the lights by others that are found in the same way. Returns false, and nothing has changed, where they need
    /// more room or less, and on a lost device.
    pub(super) fn replace(&mut self, queue: &wgpu::Queue, lights: &[LightInWorld], origin_in_world: DVec3) -> bool {
        if self.lights == lights {
            return true;
        }
        let (sorted, data) = Sorted::new(lights, origin_in_world, self.list);
        let fits = size_of_val(&data[..]) as u64 == self.buffer.size();
        if !fits || write_buffer(queue, &self.buffer, 0, bytemuck::cast_slice(&data)).is_err() {
            return false;
        }
        (self.sorted, self.last) = (sorted, None);
        self.lights.clear();
        self.lights.extend_from_slice(lights);
        true
    }

    /// How many lights shine; dark ones come last.
    pub(crate) fn lit(&self) -> u32 {
        self.sorted.lit
    }

    /// The place in the buffer of a light of the scene.
    pub(crate) fn place(&self, light: u32) -> u32 {
        self.sorted.places.get(light as usize).copied().unwrap_or(light)
    }

    /// The clusters of a view, where the lights are sorted into any; those of the last one while nothing moves.
    ///
    /// Another view gets buffers of its own: the last one may be in a command buffer that is still to be submitted.
    pub(crate) fn clusters(
        &mut self,
        device: &wgpu::Device,
        origin_in_world: DVec3,
        view: &View,
    ) -> Result<Option<GpuClusters>, DeviceLost> {
        if !self.list.is_clustered() {
            return Ok(None);
        }
        let is_same = |last: &&GpuClusters| last.camera == view.camera && last.size_px == view.size_px;
        if let Some(last) = self.last.as_ref().filter(is_same) {
            return Ok(Some(last.clone()));
        }
        let clusters =
            clusters(&self.sorted.reaches, self.sorted.unbounded, origin_in_world, &view.camera, view.size_px);
        let uniform = bytemuck::bytes_of(&clusters.uniform);
        let uniform = filled_buffer(device, "clusters", uniform, wgpu::BufferUsages::UNIFORM)?;
        let table = bytemuck::cast_slice(&clusters.table);
        let table = filled_buffer(device, "lights of clusters", table, wgpu::BufferUsages::STORAGE)?;
        let made = GpuClusters { camera: view.camera.clone(), size_px: view.size_px, uniform, table };
        self.last = Some(made.clone());
        Ok(Some(made))
    }
}

fn gpu_light(light: &LightInWorld, origin_in_world: DVec3) -> types::Light {
    let placed = types::Light {
        position: (light.position_in_world - origin_in_world).as_vec3().to_array(),
        w: 1.0,
        intensity: light.intensity.as_vec3().to_array(),
        inverse_range_squared: light.inverse_range_squared(),
        direction: light.direction_in_world.as_vec3().to_array(),
        spot_offset: 1.0,
        ..Default::default()
    };
    match light.kind {
        LightKind::Point { .. } => placed,
        LightKind::Spot { inner_cone_rad, outer_cone_rad, .. } => {
            let scale = 1.0 / (inner_cone_rad.cos() - outer_cone_rad.cos()).max(1e-3);
            types::Light { spot_scale: scale as f32, spot_offset: (-outer_cone_rad.cos() * scale) as f32, ..placed }
        }
        LightKind::Directional => {
            types::Light { position: (-light.direction_in_world).as_vec3().to_array(), w: 0.0, ..placed }
        }
    }
}
