//! Geometry as textures, for a fragment shader that fetches the corners of its triangle by itself: a texel is four
//! numbers in one fetch, where a buffer takes one for each.

use super::geometry::attribute_data;
use super::gpu_instance;
use crate::frame::{Drawable, Drawables};
use crate::gpu::formats;
use crate::scene::{Primitive, Scene};
use crate::shader::types::Instance;
use crate::shader::{PULLED_ROW_TEXELS, VertexFeatures, texels_per_vertex};
use std::collections::HashMap;
use wgpu::util::{DeviceExt, TextureDataOrder};

/// Vertices, attributes side by side, and triangles.
#[derive(Debug)]
pub struct PulledGeometry {
    pub(crate) vertices: wgpu::Texture,
    pub(crate) triangles: wgpu::Texture,
    /// By drawable.
    pub(crate) places: Vec<PulledPlace>,
    /// By drawable, its only one.
    pub(crate) instances: Vec<Instance>,
}

/// Where a primitive begins, in texels.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PulledPlace {
    pub(crate) vertices: u32,
    pub(crate) triangles: u32,
}

impl PulledGeometry {
    /// None where the device has no textures of this size.
    pub(crate) fn new(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        scene: &Scene,
        drawables: &Drawables,
    ) -> Option<Self> {
        let (mut vertices, mut triangles) = (Vec::<[f32; 4]>::new(), Vec::<[u32; 4]>::new());
        let mut uploaded = HashMap::new();
        let mut places = Vec::new();
        for drawable in &drawables.draws {
            let place = *uploaded.entry((drawable.mesh, drawable.primitive)).or_insert_with(|| {
                let place = PulledPlace { vertices: vertices.len() as u32, triangles: triangles.len() as u32 };
                let primitive = &scene.meshes[drawable.mesh].primitives[drawable.primitive];
                triangles.extend(primitive.indices.chunks_exact(3).map(|t| [t[0], t[1], t[2], 0]));
                append_vertices(&mut vertices, primitive, &drawable.vertex_features);
                place
            });
            places.push(place);
        }
        Some(Self {
            vertices: texture(device, queue, formats::PULLED_VERTICES, vertices)?,
            triangles: texture(device, queue, formats::PULLED_TRIANGLES, triangles)?,
            places,
            instances: drawables.draws.iter().map(|drawable| instance(drawables, drawable)).collect(),
        })
    }

    pub(crate) fn bytes(&self) -> u64 {
        [&self.vertices, &self.triangles].map(|t| u64::from(t.width()) * u64::from(t.height()) * 16).iter().sum()
    }
}

/// As it places the only instance.
fn instance(drawables: &Drawables, drawable: &Drawable) -> Instance {
    let placement = drawables.placements.instances[drawable.placements.start];
    gpu_instance(&drawables.instances[placement as usize], drawables.origin_in_world)
}

/// The attributes of each vertex side by side, in whole texels.
fn append_vertices(texels: &mut Vec<[f32; 4]>, primitive: &Primitive, features: &VertexFeatures) {
    let data = attribute_data(primitive, features);
    let size = 4 * texels_per_vertex(features) as usize;
    let mut floats = Vec::with_capacity(size);
    for i in 0..primitive.positions.len() {
        data.iter().for_each(|(attribute, count)| floats.extend_from_slice(&attribute[i * count..][..*count]));
        floats.resize(size, 0.0);
        texels.extend_from_slice(bytemuck::cast_slice(&floats));
        floats.clear();
    }
}

/// Rows of [`PULLED_ROW_TEXELS`] texels of 16 bytes.
fn texture<T: bytemuck::Pod>(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    format: wgpu::TextureFormat,
    mut texels: Vec<[T; 4]>,
) -> Option<wgpu::Texture> {
    let row = PULLED_ROW_TEXELS as usize;
    texels.resize(texels.len().next_multiple_of(row).max(row), [T::zeroed(); 4]);
    let height = (texels.len() / row) as u32;
    let limit = device.limits().max_texture_dimension_2d;
    (height <= limit && PULLED_ROW_TEXELS <= limit).then(|| {
        let descriptor = wgpu::TextureDescriptor {
            label: Some("pulled geometry"),
            size: wgpu::Extent3d { width: PULLED_ROW_TEXELS, height, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage: wgpu::TextureUsages::TEXTURE_BINDING,
            view_formats: &[],
        };
        device.create_texture_with_data(queue, &descriptor, TextureDataOrder::LayerMajor, bytemuck::cast_slice(&texels))
    })
}
