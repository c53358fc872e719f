//! Vertices and indices: two buffers for the whole scene, holding only the attributes that some draw reads.

use super::UploadError;
use crate::frame::{Drawables, PrimitivePlace};
use crate::gpu::filled_buffer;
use crate::scene::{Primitive, Scene};
use crate::shader::VertexFeatures;
use std::collections::HashMap;
use std::ops::Range;

/// Where a primitive's data lie.
#[derive(Debug, Clone)]
pub(crate) struct GpuPrimitive {
    /// Byte ranges in the vertex buffer, in the order of [`crate::shader::attributes`].
    pub(crate) attributes: Vec<Range<u64>>,
    /// Range in the index buffer, counted in indices.
    pub(crate) indices: Range<u32>,
}

pub(crate) struct Geometry {
    pub(crate) vertices: wgpu::Buffer,
    pub(crate) indices: wgpu::Buffer,
    /// Of each drawable.
    pub(crate) primitives: Vec<GpuPrimitive>,
}

/// Uploads every primitive that is drawn, once.
pub(crate) fn upload_primitives(
    device: &wgpu::Device,
    scene: &Scene,
    drawables: &Drawables,
) -> Result<Geometry, UploadError> {
    let (mut vertices, mut indices) = (Vec::<u8>::new(), Vec::<u32>::new());
    let mut uploaded: HashMap<PrimitivePlace, GpuPrimitive> = HashMap::new();
    let mut primitives = Vec::with_capacity(drawables.draws.len());
    for drawable in &drawables.draws {
        let key = (drawable.mesh, drawable.primitive);
        let primitive = uploaded.entry(key).or_insert_with(|| {
            let primitive = &scene.meshes[drawable.mesh].primitives[drawable.primitive];
            let attributes = append_attributes(&mut vertices, primitive, &drawable.vertex_features);
            let first = indices.len() as u32;
            indices.extend_from_slice(&primitive.indices);
            GpuPrimitive { attributes, indices: first..indices.len() as u32 }
        });
        primitives.push(primitive.clone());
    }
    let buffer = |what, contents: &[u8], usage| {
        let (needed, allowed) = (contents.len() as u64, device.limits().max_buffer_size);
        if needed > allowed {
            return Err(UploadError::TooLarge { what, needed, allowed });
        }
        Ok(filled_buffer(device, what, contents, usage)?)
    };
    Ok(Geometry {
        vertices: buffer("vertex data", &vertices, wgpu::BufferUsages::VERTEX)?,
        indices: buffer("index data", bytemuck::cast_slice(&indices), wgpu::BufferUsages::INDEX)?,
        primitives,
    })
}

fn append_attributes(bytes: &mut Vec<u8>, primitive: &Primitive, features: &VertexFeatures) -> Vec<Range<u64>> {
    let append = |(floats, _): (&[f32], usize)| {
        let start = bytes.len() as u64;
        bytes.extend_from_slice(bytemuck::cast_slice(floats));
        start..bytes.len() as u64
    };
    attribute_data(primitive, features).into_iter().map(append).collect()
}

/// The attributes that are read, in the order of [`crate::shader::attributes`], each with its floats a vertex.
pub(super) fn attribute_data<'a>(primitive: &'a Primitive, features: &VertexFeatures) -> Vec<(&'a [f32], usize)> {
    let mut data: Vec<(&[f32], usize)> = vec![(bytemuck::cast_slice(&primitive.positions), 3)];
    if let (true, Some(normals)) = (features.normal, &primitive.normals) {
        data.push((bytemuck::cast_slice(normals), 3));
    }
    if let (true, Some(tangents)) = (features.tangent, &primitive.tangents) {
        data.push((bytemuck::cast_slice(tangents), 4));
    }
    if let (true, Some(colors)) = (features.color, &primitive.colors) {
        data.push((bytemuck::cast_slice(colors), 4));
    }
    data.extend(features.uv_sets().map(|set| (bytemuck::cast_slice(&primitive.uvs[set as usize]), 2)));
    data
}
