//! Every bind-group layout. Group 0 belongs to the frame and its light, group 1 to the material.

use crate::shader::{
    Backdrop, MATERIAL_SAMPLER_BINDING, MATERIAL_UNIFORM_BINDING, MaterialFeatures, OVER_SAMPLES_BINDING,
    SEEN_SAMPLES_BINDING, SceneFeatures, Seen, Shading, disney_binding, material_texture_binding,
};
use wgpu::{BindGroupLayout, BindGroupLayoutEntry, BindingType, BufferBindingType, Device, ShaderStages};

/// Bindings of group 0 in the forward pass.
pub const FRAME_UNIFORM: u32 = 0;
pub const FRAME_INSTANCES: u32 = 1;
pub const FRAME_DFG: u32 = 2;
pub const FRAME_SAMPLER: u32 = 3;
pub const FRAME_LIGHTS: u32 = 4;
pub const FRAME_ENVIRONMENT: u32 = 5;
pub const FRAME_ATLAS: u32 = 6;
pub const FRAME_FRESNEL_TAIL: u32 = 7;
pub const FRAME_TAPS: u32 = 8;
pub const FRAME_CLUSTERS: u32 = 9;
pub const FRAME_CLUSTER_TABLE: u32 = 10;
pub const FRAME_VISIBLE: u32 = 11;

/// Group 0 of the forward pass: what the scene's light needs is bound, the rest has no binding.
pub fn frame_entries(features: SceneFeatures) -> Vec<BindGroupLayoutEntry> {
    let mut entries = vec![
        buffer(FRAME_UNIFORM, ShaderStages::VERTEX_FRAGMENT, BufferBindingType::Uniform),
        buffer(FRAME_INSTANCES, ShaderStages::VERTEX, BufferBindingType::Storage { read_only: true }),
        buffer(FRAME_VISIBLE, ShaderStages::VERTEX, BufferBindingType::Storage { read_only: true }),
    ];
    if features.is_lit() {
        entries.extend([texture(FRAME_DFG, true), sampler(FRAME_SAMPLER)]);
    }
    if features.punctual {
        let ty = match features.light_list.is_uniform() {
            true => BufferBindingType::Uniform,
            false => BufferBindingType::Storage { read_only: true },
        };
        entries.push(buffer(FRAME_LIGHTS, ShaderStages::FRAGMENT, ty));
    }
    if features.punctual && features.light_list.is_clustered() {
        entries.extend([
            buffer(FRAME_CLUSTERS, ShaderStages::FRAGMENT, BufferBindingType::Uniform),
            buffer(FRAME_CLUSTER_TABLE, ShaderStages::FRAGMENT, BufferBindingType::Storage { read_only: true }),
        ]);
    }
    if features.environment {
        entries.extend([
            buffer(FRAME_ENVIRONMENT, ShaderStages::FRAGMENT, BufferBindingType::Uniform),
            texture(FRAME_ATLAS, true),
            texture(FRAME_TAPS, true),
        ]);
    }
    if features.is_lit() && features.fresnel_tail {
        entries.push(texture(FRAME_FRESNEL_TAIL, true));
    }
    entries
}

/// Group 1 of the forward pass: the uniform, the samplers and the textures that are read, and what a Disney material
/// has beside.
pub fn material_entries(features: &MaterialFeatures) -> Vec<BindGroupLayoutEntry> {
    let samplers = features.sampler_count();
    let mut entries = vec![buffer(MATERIAL_UNIFORM_BINDING, ShaderStages::FRAGMENT, BufferBindingType::Uniform)];
    entries.extend((0..samplers).map(|index| sampler(MATERIAL_SAMPLER_BINDING + index)));
    let textures = features.textures().enumerate();
    entries.extend(textures.map(|(index, _)| texture(material_texture_binding(samplers, index), true)));
    if features.shading == Shading::Disney {
        entries.push(buffer(disney_binding(features), ShaderStages::FRAGMENT, BufferBindingType::Uniform));
    }
    if features.disney_table {
        entries.push(texture(disney_binding(features) + 1, true));
    }
    entries
}

/// The panorama behind the scene: uniform, texture, sampler; blurred, what shading reads of the environment.
pub fn background_entries(backdrop: Backdrop) -> Vec<BindGroupLayoutEntry> {
    let uniform = buffer(0, ShaderStages::VERTEX_FRAGMENT, BufferBindingType::Uniform);
    match backdrop {
        Backdrop::Sharp => vec![uniform, texture(1, true), sampler(2)],
        Backdrop::Blurred => vec![
            uniform,
            sampler(FRAME_SAMPLER),
            buffer(FRAME_ENVIRONMENT, ShaderStages::FRAGMENT, BufferBindingType::Uniform),
            texture(FRAME_ATLAS, true),
        ],
    }
}

/// Group 1 of the visibility pass: the draw.
pub fn visibility_entries() -> Vec<BindGroupLayoutEntry> {
    vec![buffer(0, ShaderStages::VERTEX_FRAGMENT, BufferBindingType::Uniform)]
}

/// What the visibility pass has left, and what was drawn over it.
pub fn covered_entries(seen: Seen) -> Vec<BindGroupLayoutEntry> {
    let mut entries = vec![whole_numbers(SEEN_SAMPLES_BINDING, seen.samples > 1)];
    if seen.under {
        entries.extend(over_entries(seen.samples));
    }
    entries
}

/// What was drawn over it, alone.
pub fn over_entries(samples: u32) -> Vec<BindGroupLayoutEntry> {
    vec![texture_of(OVER_SAMPLES_BINDING, wgpu::TextureSampleType::Float { filterable: false }, samples > 1)]
}

/// Group 2 of the deferred pass: the draw, vertices, triangles, and [`covered_entries`].
pub fn pulled_entries(seen: Seen) -> Vec<BindGroupLayoutEntry> {
    let uniform = buffer(0, ShaderStages::VERTEX_FRAGMENT, BufferBindingType::Uniform);
    [vec![uniform, texture(1, false), whole_numbers(2, false)], covered_entries(seen)].concat()
}

/// Scene radiance to display: uniform, texture.
pub fn display_entries() -> Vec<BindGroupLayoutEntry> {
    vec![buffer(0, ShaderStages::FRAGMENT, BufferBindingType::Uniform), texture(1, false)]
}

/// Finished pictures to a window: uniform, and two of them.
pub fn present_entries() -> Vec<BindGroupLayoutEntry> {
    vec![buffer(0, ShaderStages::FRAGMENT, BufferBindingType::Uniform), texture(1, false), texture(2, false)]
}

/// The layout of [`frame_entries`].
pub fn frame_layout(device: &Device, features: SceneFeatures) -> BindGroupLayout {
    layout(device, "frame", &frame_entries(features))
}

/// The layout of [`material_entries`].
pub fn material_layout(device: &Device, features: &MaterialFeatures) -> BindGroupLayout {
    layout(device, "material", &material_entries(features))
}

/// The layout of [`background_entries`].
pub fn background_layout(device: &Device, backdrop: Backdrop) -> BindGroupLayout {
    layout(device, "background", &background_entries(backdrop))
}

/// The layout of [`display_entries`].
pub fn display_layout(device: &Device) -> BindGroupLayout {
    layout(device, "display", &display_entries())
}

/// The layout of [`present_entries`].
pub fn present_layout(device: &Device) -> BindGroupLayout {
    layout(device, "present", &present_entries())
}

/// The layout of [`visibility_entries`].
pub fn visibility_layout(device: &Device) -> BindGroupLayout {
    layout(device, "visibility", &visibility_entries())
}

/// The layout of [`covered_entries`].
pub fn covered_layout(device: &Device, seen: Seen) -> BindGroupLayout {
    layout(device, "covered", &covered_entries(seen))
}

/// The layout of [`over_entries`].
pub fn over_layout(device: &Device, samples: u32) -> BindGroupLayout {
    layout(device, "over", &over_entries(samples))
}

/// The layout of [`pulled_entries`].
pub fn pulled_layout(device: &Device, seen: Seen) -> BindGroupLayout {
    layout(device, "pulled", &pulled_entries(seen))
}

fn layout(device: &Device, label: &str, entries: &[BindGroupLayoutEntry]) -> BindGroupLayout {
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some(label), entries })
}

fn buffer(binding: u32, visibility: ShaderStages, ty: BufferBindingType) -> BindGroupLayoutEntry {
    let ty = BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None };
    BindGroupLayoutEntry { binding, visibility, ty, count: None }
}

fn texture(binding: u32, filterable: bool) -> BindGroupLayoutEntry {
    texture_of(binding, wgpu::TextureSampleType::Float { filterable }, false)
}

fn whole_numbers(binding: u32, multisampled: bool) -> BindGroupLayoutEntry {
    texture_of(binding, wgpu::TextureSampleType::Uint, multisampled)
}

fn texture_of(binding: u32, sample_type: wgpu::TextureSampleType, multisampled: bool) -> BindGroupLayoutEntry {
    let ty = BindingType::Texture { sample_type, view_dimension: wgpu::TextureViewDimension::D2, multisampled };
    BindGroupLayoutEntry { binding, visibility: ShaderStages::FRAGMENT, ty, count: None }
}

fn sampler(binding: u32) -> BindGroupLayoutEntry {
    let ty = BindingType::Sampler(wgpu::SamplerBindingType::Filtering);
    BindGroupLayoutEntry { binding, visibility: ShaderStages::FRAGMENT, ty, count: None }
}
