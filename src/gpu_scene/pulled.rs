//! Geometry as textures, for a fragment shader that fetches the corners of its triangle by itself: a texel is four
//! numbers in one fetch, where a buffer takes one for each. Vertices are brought to each of their places once and not at
//! every corner of every pixel.

use super::geometry::attribute_data;
use super::gpu_instance;
use crate::frame::{Drawable, Drawables, Rectangle, deferred, left_over};
use crate::gpu::formats;
use crate::scene::{Primitive, Scene, View};
use crate::shader::types::Instance;
use crate::shader::{PULLED_ROW_TEXELS, VertexFeatures, texels_per_vertex};
use glam::{Mat3, Vec3, Vec4};
use std::ops::Range;
use wgpu::util::{DeviceExt, TextureDataOrder};

/// Vertices, attributes side by side, and triangles.
#[derive(Debug)]
pub struct PulledGeometry {
    pub(crate) vertices: wgpu::Texture,
    pub(crate) triangles: wgpu::Texture,
    /// Drawable by drawable.
    pub(crate) places: Vec<PulledPlace>,
    /// By drawable, its range in `places`; empty for those that are not deferred.
    of_drawables: Vec<Range<usize>>,
}

/// A drawable at one place.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PulledPlace {
    pub(crate) drawable: usize,
    /// Index into [`Placements::instances`](crate::frame::Placements::instances).
    pub(crate) placement: usize,
    /// Where vertices and triangles begin, in texels.
    pub(crate) vertices: u32,
    pub(crate) triangles: u32,
    pub(crate) instance: Instance,
}

impl PulledGeometry {
    /// None where nothing can be deferred, or the device has no textures of this size.
    pub(crate) fn new(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        scene: &Scene,
        drawables: &Drawables,
    ) -> Option<Self> {
        let primitive = |drawable: &Drawable| &scene.meshes[drawable.mesh].primitives[drawable.primitive];
        let is_deferred = deferred(drawables, |drawable| primitive(drawable).positions.len());
        if !is_deferred.contains(&true) {
            return None;
        }
        let (mut vertices, mut triangles) = (Vec::<[f32; 4]>::new(), Vec::<[u32; 4]>::new());
        let (mut places, mut of_drawables) = (Vec::new(), Vec::new());
        for (drawable, found) in drawables.draws.iter().enumerate() {
            let first = places.len();
            if is_deferred[drawable] {
                let primitive = primitive(found);
                for placement in found.placements.clone() {
                    let instance = instance(drawables, placement);
                    let [vertex, triangle] = [vertices.len(), triangles.len()].map(|texels| texels as u32);
                    places.push(PulledPlace { drawable, placement, vertices: vertex, triangles: triangle, instance });
                    append_vertices(&mut vertices, primitive, &found.vertex_features, &instance);
                }
                triangles.extend(primitive.indices.chunks_exact(3).map(|t| [t[0], t[1], t[2], 0]));
            }
            of_drawables.push(first..places.len());
        }
        Some(Self {
            vertices: texture(device, queue, formats::PULLED_VERTICES, vertices)?,
            triangles: texture(device, queue, formats::PULLED_TRIANGLES, triangles)?,
            places,
            of_drawables,
        })
    }

    /// Whether a drawable is here.
    pub(crate) fn holds(&self, drawable: usize) -> bool {
        !self.of_drawables[drawable].is_empty()
    }

    /// Where a view may show something that is not here, draw by draw.
    pub(crate) fn left_over(&self, drawables: &Drawables, view: &View) -> impl Iterator<Item = Rectangle> {
        left_over(drawables, view, |drawable| self.holds(drawable))
    }

    /// Where in `places` a drawable is at an instance.
    pub(crate) fn find(&self, drawables: &Drawables, drawable: usize, instance: u32) -> Option<usize> {
        let placed = |place: &usize| drawables.placements.instances[self.places[*place].placement];
        self.of_drawables[drawable].clone().find(|place| placed(place) == instance)
    }

    pub(crate) fn bytes(&self) -> u64 {
        [&self.vertices, &self.triangles].map(|t| u64::from(t.width()) * u64::from(t.height()) * 16).iter().sum()
    }
}

/// As it is placed.
fn instance(drawables: &Drawables, placement: usize) -> Instance {
    let instance = drawables.placements.instances[placement];
    gpu_instance(&drawables.instances[instance as usize], drawables.origin_in_world)
}

/// The attributes of each vertex side by side, in whole texels, as the vertex shader of the forward pass hands them on.
fn append_vertices(texels: &mut Vec<[f32; 4]>, primitive: &Primitive, features: &VertexFeatures, instance: &Instance) {
    let data = attribute_data(primitive, features);
    let size = 4 * texels_per_vertex(features) as usize;
    let mut floats = Vec::with_capacity(size);
    for i in 0..primitive.positions.len() {
        data.iter().for_each(|(attribute, count)| floats.extend_from_slice(&attribute[i * count..][..*count]));
        floats.resize(size, 0.0);
        place(&mut floats, features, instance);
        texels.extend_from_slice(bytemuck::cast_slice(&floats));
        floats.clear();
    }
}

/// Brings position, normal and tangent, which come first, into the world.
fn place(vertex: &mut [f32], features: &VertexFeatures, instance: &Instance) {
    let rows = instance.world_from_object.map(Vec4::from_array);
    let in_world = |at: Vec4| Vec3::from_array(rows.map(|row| row.dot(at)));
    let position = in_world(Vec3::from_slice(vertex).extend(1.0));
    position.write_to_slice(vertex);
    let mut rest = &mut vertex[3..];
    if features.normal {
        let columns = instance.normal_from_object.map(|column| Vec4::from_array(column).truncate());
        let normal = Mat3::from_cols(columns[0], columns[1], columns[2]) * Vec3::from_slice(rest);
        unit_or_zero(normal).write_to_slice(rest);
        rest = &mut rest[3..];
    }
    if features.tangent {
        unit_or_zero(in_world(Vec3::from_slice(rest).extend(0.0))).write_to_slice(rest);
        rest[3] *= instance.handedness;
    }
}

/// Of any length, as small or large as float32 goes: hence in float64.
fn unit_or_zero(v: Vec3) -> Vec3 {
    v.as_dvec3().normalize_or_zero().as_vec3()
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
