//! Material uniforms and bind groups: one a material and set of features, with only what those features read.

use super::tables::Table;
use super::textures::{TextureCache, textures_of};
use super::{UploadError, entry};
use crate::frame::Drawables;
use crate::gpu::bindings::material_layout;
use crate::gpu::{DeviceLost, Staging, filled_buffer, write_buffer};
use crate::scene::{AlphaMode, Disney, Material, MetalFresnel, Scene, TextureSlot};
use crate::shader::{
    MATERIAL_SAMPLER_BINDING, MATERIAL_UNIFORM_BINDING, MaterialFeatures, Shading, disney_binding, material_samplers,
    material_texture_binding, types,
};
use glam::Vec3;
use std::collections::HashMap;

/// Bind groups of group 1 and their layouts.
#[derive(Debug, Default)]
pub(crate) struct Materials {
    /// Of each drawable.
    pub(crate) groups: Vec<GpuMaterial>,
    pub(crate) layouts: HashMap<MaterialFeatures, wgpu::BindGroupLayout>,
}

/// What a draw binds of its material, and the buffers in it.
#[derive(Debug, Clone)]
pub(crate) struct GpuMaterial {
    pub(crate) group: wgpu::BindGroup,
    uniform: wgpu::Buffer,
    disney: Option<wgpu::Buffer>,
}

impl GpuMaterial {
    /// Writes the numbers of another material with the same features and textures.
    pub(super) fn write(&self, queue: &wgpu::Queue, material: &Material) -> Result<(), DeviceLost> {
        write_buffer(queue, &self.uniform, 0, bytemuck::bytes_of(&uniform(material)))?;
        if let (Some(buffer), Some(disney)) = (&self.disney, &material.disney) {
            write_buffer(queue, buffer, 0, bytemuck::bytes_of(&disney_uniform(disney)))?;
        }
        Ok(())
    }
}

/// Uploads what the draws read, and what of their textures `cache` does not have.
pub(crate) fn upload(
    staging: &mut Staging<'_>,
    scene: &Scene,
    drawables: &Drawables,
    cache: &mut TextureCache,
    disney_table: &Table,
) -> Result<Materials, UploadError> {
    let (device, queue) = (staging.device, staging.queue);
    let mut materials = Materials::default();
    let mut bound: HashMap<(usize, MaterialFeatures), GpuMaterial> = HashMap::new();
    let reads_table = drawables.draws.iter().any(|drawable| drawable.material_features.disney_table);
    let disney_table = reads_table.then(|| disney_table.upload(device, queue));
    for drawable in &drawables.draws {
        let key = (drawable.material, drawable.material_features);
        let layout = materials.layouts.entry(key.1).or_insert_with(|| material_layout(device, &key.1));
        let group = match bound.get(&key) {
            Some(group) => group.clone(),
            None => bind(staging, scene, (cache, disney_table.as_ref()), layout, key)?,
        };
        bound.insert(key, group.clone());
        materials.groups.push(group);
    }
    Ok(materials)
}

fn bind(
    staging: &mut Staging<'_>,
    scene: &Scene,
    (cache, disney_table): (&mut TextureCache, Option<&wgpu::TextureView>),
    layout: &wgpu::BindGroupLayout,
    (index, features): (usize, MaterialFeatures),
) -> Result<GpuMaterial, UploadError> {
    let (device, material) = (staging.device, &scene.materials[index]);
    let name = material.name.as_deref().unwrap_or("material");
    let uniform = uniform_buffer(device, name, bytemuck::bytes_of(&uniform(material)))?;
    let sampler_count = features.sampler_count();
    let samplers: Vec<wgpu::Sampler> = material_samplers(&features, material, scene)
        .into_iter()
        .map(|sampler| cache.sampler(device, sampler))
        .collect();
    let textures = textures_of(scene, material, &features).into_iter();
    let views = textures.map(|key| cache.view(staging, scene, key)).collect::<Result<Vec<_>, _>>()?;
    let mut entries = vec![entry(MATERIAL_UNIFORM_BINDING, uniform.as_entire_binding())];
    for (index, sampler) in samplers.iter().enumerate() {
        let binding = MATERIAL_SAMPLER_BINDING + index as u32;
        entries.push(entry(binding, wgpu::BindingResource::Sampler(sampler)));
    }
    for (index, view) in views.iter().enumerate() {
        let binding = material_texture_binding(sampler_count, index);
        entries.push(entry(binding, wgpu::BindingResource::TextureView(view)));
    }
    let disney = material.disney.filter(|_| features.shading == Shading::Disney);
    let disney = disney.map(|disney| uniform_buffer(device, "disney", bytemuck::bytes_of(&disney_uniform(&disney))));
    let disney = disney.transpose()?;
    if let Some(disney) = &disney {
        entries.push(entry(disney_binding(&features), disney.as_entire_binding()));
    }
    if let (true, Some(table)) = (features.disney_table, disney_table) {
        entries.push(entry(disney_binding(&features) + 1, wgpu::BindingResource::TextureView(table)));
    }
    let label = material.name.as_deref();
    let group = device.create_bind_group(&wgpu::BindGroupDescriptor { label, layout, entries: &entries });
    Ok(GpuMaterial { group, uniform, disney })
}

fn uniform_buffer(device: &wgpu::Device, label: &str, contents: &[u8]) -> Result<wgpu::Buffer, DeviceLost> {
    filled_buffer(device, label, contents, wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST)
}

fn disney_uniform(disney: &Disney) -> types::DisneyUniform {
    types::DisneyUniform {
        subsurface: disney.subsurface,
        specular: disney.specular,
        specular_tint: disney.specular_tint,
        anisotropic: disney.anisotropic,
        sheen: disney.sheen,
        sheen_tint: disney.sheen_tint,
        clearcoat: disney.clearcoat,
        clearcoat_gloss: disney.clearcoat_gloss,
    }
}

fn uniform(material: &Material) -> types::MaterialUniform {
    let mut uv_transforms = [[0.0; 4]; 2 * TextureSlot::ALL.len()];
    for (slot, texture) in material.textures() {
        let rows = texture.transform.matrix().transpose();
        let row = 2 * slot as usize;
        uv_transforms[row] = rows.x_axis.extend(0.0).to_array();
        uv_transforms[row + 1] = rows.y_axis.extend(0.0).to_array();
    }
    let (lazanyi_a, conductor_n, conductor_k) = match material.metal_fresnel {
        MetalFresnel::Schlick => Default::default(),
        MetalFresnel::Lazanyi { a } => (a, Vec3::ONE, Vec3::ZERO),
        MetalFresnel::Conductor { n, k, a } => (a, n, k),
    };
    let (sin, cos) = material.anisotropy_rotation_rad.sin_cos();
    let alpha_cutoff = if let AlphaMode::Mask { cutoff } = material.alpha_mode { cutoff } else { 0.0 };
    types::MaterialUniform {
        base_color: material.base_color.to_array(),
        emissive: material.emissive_nits.to_array(),
        metallic: material.metallic,
        specular_color: material.specular_color.to_array(),
        specular: material.specular,
        perceptual_roughness: material.perceptual_roughness,
        dielectric_F0: material.dielectric_f0(),
        normal_scale: material.normal_scale,
        occlusion_strength: material.occlusion_strength,
        alpha_cutoff,
        anisotropy: [material.anisotropy_strength, cos, sin, 0.0],
        lazanyi_a: lazanyi_a.to_array(),
        conductor_n: conductor_n.to_array(),
        conductor_k: conductor_k.to_array(),
        uv_transforms,
        ..Default::default()
    }
}
