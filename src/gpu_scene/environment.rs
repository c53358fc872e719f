//! An environment on the GPU: the prefiltered atlas, its uniform, and the panorama when it is seen.

use super::UploadError;
use crate::gpu::{DeviceLost, Staging, filled_buffer, formats, write_buffer};
use crate::scene::{Environment, EnvironmentImage, EnvironmentMaps, MAX_SUNS, SpecularTile};
use crate::shader::types::EnvironmentUniform;
use crate::threads::*;
use glam::{DMat3, Vec3};
use half::f16;
use half::slice::HalfFloatSliceExt;
use std::sync::Arc;

/// Radiance that half floats hold with room for a filter's rounding.
const HALF_MAX: f32 = 65000.0;

/// What the forward pass reads.
#[derive(Debug)]
pub(crate) struct GpuEnvironment {
    pub(crate) atlas: wgpu::TextureView,
    /// What its texels are divided by.
    atlas_scale: f32,
    pub(crate) uniform: wgpu::Buffer,
    pub(crate) environment_from_world: DMat3,
    pub(crate) intensity: f32,
    image: Arc<EnvironmentImage>,
    panorama: Option<Panorama>,
}

/// The panorama as a texture, divided by `scale` so that its brightest texel is a half float.
#[derive(Debug, Clone)]
pub struct Panorama {
    pub(crate) view: wgpu::TextureView,
    pub(crate) scale: f32,
}

/// The same radiance from everywhere, 1 cd/m2, for scenes with any environment to be drawn in.
#[derive(Debug)]
pub(crate) struct WhiteFurnace {
    pub(crate) atlas: wgpu::TextureView,
    pub(crate) uniform: wgpu::Buffer,
}

impl WhiteFurnace {
    pub(crate) fn new(mut staging: Staging<'_>) -> Result<Self, UploadError> {
        // Wherever a lookup falls, it finds this texel.
        let (atlas, scale) = upload(&mut staging, "white furnace", 1, 1, &[Vec3::ONE])?;
        let mut irradiance_over_pi = [[0.0; 4]; 9];
        irradiance_over_pi[0] = [1.0; 4];
        let uniform = EnvironmentUniform {
            irradiance_over_pi,
            atlas: [1.0; 4],
            environment_from_world: columns(DMat3::IDENTITY),
            radiance_scale: scale,
            ..Default::default()
        };
        let uniform = uniform_buffer(staging.device, &uniform)?;
        staging.finish();
        Ok(Self { atlas, uniform })
    }
}

impl GpuEnvironment {
    /// With the textures of the `previous` one, if that was made of the same image and maps.
    pub(crate) fn new(
        staging: &mut Staging<'_>,
        environment: &Environment,
        maps: &EnvironmentMaps,
        previous: Option<Self>,
    ) -> Result<Self, UploadError> {
        let (atlas, scale, panorama) = match previous {
            Some(previous) => (previous.atlas, previous.atlas_scale, previous.panorama),
            None => {
                let (width, height) = (maps.atlas_width, maps.atlas_height);
                let (atlas, scale) = upload(staging, "environment atlas", width, height, &maps.texels)?;
                (atlas, scale, None)
            }
        };
        let sides = tile_sides(maps)?;
        let contents = uniform(environment, maps, scale, sides);
        let uniform = uniform_buffer(staging.device, &contents)?;
        Ok(Self {
            atlas,
            atlas_scale: scale,
            uniform,
            environment_from_world: environment_from_world(environment),
            intensity: environment.intensity as f32,
            image: Arc::clone(&environment.image),
            panorama,
        })
    }

    /// Turns and dims the environment as it is now. Returns false, and nothing has changed, where it is of another image, and on a
    /// lost device.
    pub(super) fn replace(&mut self, queue: &wgpu::Queue, environment: &Environment, maps: &EnvironmentMaps) -> bool {
        let size = self.atlas.texture().size();
        let is_same = Arc::ptr_eq(&self.image, &environment.image)
            && (size.width, size.height) == (maps.atlas_width, maps.atlas_height);
        let (true, Ok(sides)) = (is_same, tile_sides(maps)) else { return false };
        let contents = uniform(environment, maps, self.atlas_scale, sides);
        if write_buffer(queue, &self.uniform, 0, bytemuck::bytes_of(&contents)).is_err() {
            return false;
        }
        self.environment_from_world = environment_from_world(environment);
        self.intensity = environment.intensity as f32;
        true
    }

    pub(crate) fn bytes(&self) -> u64 {
        let size = self.atlas.texture().size();
        u64::from(size.width) * u64::from(size.height) * 8
    }

    /// The panorama, uploaded when it is first seen.
    pub(crate) fn panorama(&mut self, mut staging: Staging<'_>) -> Result<Panorama, UploadError> {
        if let Some(panorama) = &self.panorama {
            return Ok(panorama.clone());
        }
        let EnvironmentImage { width, height, ref texels } = *self.image;
        let (view, scale) = upload(&mut staging, "panorama", width, height, texels)?;
        let panorama = Panorama { view, scale };
        self.panorama = Some(panorama.clone());
        Ok(panorama)
    }
}

fn uniform_buffer(device: &wgpu::Device, contents: &EnvironmentUniform) -> Result<wgpu::Buffer, DeviceLost> {
    let usage = wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST;
    filled_buffer(device, "environment", bytemuck::bytes_of(contents), usage)
}

fn environment_from_world(environment: &Environment) -> DMat3 {
    DMat3::from_rotation_y(-environment.rotation_rad)
}

fn uniform(
    environment: &Environment,
    maps: &EnvironmentMaps,
    atlas_scale: f32,
    [mirror_side, finest_side]: [u32; 2],
) -> EnvironmentUniform {
    let intensity = environment.intensity;
    let (width, height) = (maps.atlas_width as f32, maps.atlas_height as f32);
    let (suns, sun_illuminance) = suns(maps, environment);
    EnvironmentUniform {
        suns,
        sun_illuminance,
        irradiance_over_pi: maps.irradiance_over_pi.map(|c| (c * intensity).as_vec3().extend(0.0).to_array()),
        atlas: [1.0 / width, 1.0 / height, mirror_side as f32, finest_side as f32],
        environment_from_world: columns(environment_from_world(environment)),
        radiance_scale: atlas_scale * intensity as f32,
        ..Default::default()
    }
}

/// Sides of the tiles of levels 0 and 1, which say where all are.
fn tile_sides(maps: &EnvironmentMaps) -> Result<[u32; 2], UploadError> {
    let sides = [0, 1].map(|level| maps.tiles.get(level).map_or(0, |tile| tile.size));
    let tiles = (0..EnvironmentMaps::LEVELS).map(|level| SpecularTile::of_level(level, sides[0], sides[1]));
    if maps.tiles.iter().copied().eq(tiles) { Ok(sides) } else { Err(UploadError::EnvironmentLayout) }
}

/// Directions in the world with the squared radius of each disc's half vectors, seen along the normal; illuminances.
///
/// Half vectors turn by half as much as the light, R / 2. Their variance along each axis is s^2 = R^2 / 16, and near its
/// peak GGX with alpha^2 + 4 s^2 is GGX convolved with a variance of s^2: the number is also what widens alpha^2.
fn suns(maps: &EnvironmentMaps, environment: &Environment) -> ([[f32; 4]; MAX_SUNS], [[f32; 4]; MAX_SUNS]) {
    let (mut directions, mut illuminances) = ([[0.0; 4]; MAX_SUNS], [[0.0; 4]; MAX_SUNS]);
    for (i, sun) in maps.suns.iter().take(MAX_SUNS).enumerate() {
        let widening = 0.25 * sun.angular_radius_rad * sun.angular_radius_rad;
        let toward = environment.world_from_environment(sun.direction);
        directions[i] = toward.extend(widening).as_vec4().to_array();
        illuminances[i] = (sun.illuminance * environment.intensity).extend(0.0).as_vec4().to_array();
    }
    (directions, illuminances)
}

/// A rotation as the columns of a WGSL mat3x3f.
pub(crate) fn columns(matrix: DMat3) -> [[f32; 4]; 3] {
    [matrix.x_axis, matrix.y_axis, matrix.z_axis].map(|column| column.as_vec3().extend(0.0).to_array())
}

fn upload(
    staging: &mut Staging<'_>,
    label: &str,
    width: u32,
    height: u32,
    texels: &[Vec3],
) -> Result<(wgpu::TextureView, f32), UploadError> {
    let allowed = staging.device.limits().max_texture_dimension_2d;
    if width.max(height) > allowed {
        return Err(UploadError::EnvironmentTooLarge { width, height, allowed });
    }
    let peak = texels.par_iter().map(|texel| texel.max_element()).max_by(f32::total_cmp).unwrap_or(0.0);
    let scale = (peak / HALF_MAX).max(1.0);
    let halves = halves(texels, scale);
    let texture = staging.device.create_texture(&wgpu::TextureDescriptor {
        label: Some(label),
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: formats::ENVIRONMENT,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    });
    staging.write(&texture, 0, bytemuck::cast_slice(&halves));
    Ok((texture.create_view(&Default::default()), scale))
}

/// Radiance over `scale`, with a fourth channel of 1.
fn halves(texels: &[Vec3], scale: f32) -> Vec<[f16; 4]> {
    // So many at a time fit in a core's cache, as floats too.
    const TEXELS: usize = 1024;
    let mut halves: Vec<[f16; 4]> = bytemuck::zeroed_vec(texels.len());
    halves.par_chunks_mut(TEXELS).zip(texels.par_chunks(TEXELS)).for_each(|(out, texels)| {
        let mut floats = [[0.0_f32; 4]; TEXELS];
        for (float, texel) in floats.iter_mut().zip(texels) {
            *float = (*texel / scale).extend(1.0).to_array();
        }
        let floats: &[f32] = bytemuck::cast_slice(&floats[..texels.len()]);
        bytemuck::cast_slice_mut::<_, f16>(out).convert_from_f32_slice(floats);
    });
    halves
}
