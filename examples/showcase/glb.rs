//! A minimal writer of binary glTF: appends data, hands out indices, joins JSON and bytes.

use super::geometry::Mesh;
use glam::DVec3;
use serde_json::{Value, json};

const FLOAT: u32 = 5126;
const UNSIGNED_SHORT: u32 = 5123;
const UNSIGNED_BYTE: u32 = 5121;
const ARRAY_BUFFER: u32 = 34962;
const ELEMENT_ARRAY_BUFFER: u32 = 34963;

/// A glTF file in the making. The methods append an object and return its index.
#[derive(Default)]
pub(crate) struct Glb {
    bytes: Vec<u8>,
    buffer_views: Vec<Value>,
    accessors: Vec<Value>,
    images: Vec<Value>,
    samplers: Vec<Value>,
    textures: Vec<Value>,
    materials: Vec<Value>,
    meshes: Vec<Value>,
    nodes: Vec<Value>,
}

impl Glb {
    /// The attributes and indices of a primitive, to be used with any number of materials.
    pub(crate) fn geometry(&mut self, mesh: &Mesh) -> Value {
        let positions: Vec<DVec3> = mesh.vertices.iter().map(|vertex| vertex.position).collect();
        let normals: Vec<DVec3> = mesh.vertices.iter().map(|vertex| vertex.normal).collect();
        let position = self.vectors(&positions);
        let normal = if positions == normals { position } else { self.vectors(&normals) };
        let mut attributes = json!({ "POSITION": position, "NORMAL": normal });
        if !mesh.uvs.is_empty() {
            let floats: Vec<u8> = mesh.uvs.iter().flat_map(|uv| uv.to_array()).flat_map(float_bytes).collect();
            attributes["TEXCOORD_0"] = self.accessor(&floats, ARRAY_BUFFER, FLOAT, "VEC2", mesh.uvs.len()).into();
        }
        if !mesh.colors.is_empty() {
            let channel = |value: f64| (value * 255.0).round() as u8;
            let bytes: Vec<u8> =
                mesh.colors.iter().flat_map(|c| [channel(c.x), channel(c.y), channel(c.z), 255]).collect();
            let accessor = self.accessor(&bytes, ARRAY_BUFFER, UNSIGNED_BYTE, "VEC4", mesh.colors.len());
            self.accessors[accessor]["normalized"] = true.into();
            attributes["COLOR_0"] = accessor.into();
        }
        let indices: Vec<u8> = mesh.triangles.iter().flatten().flat_map(|index| index.to_le_bytes()).collect();
        let count = 3 * mesh.triangles.len();
        let indices = self.accessor(&indices, ELEMENT_ARRAY_BUFFER, UNSIGNED_SHORT, "SCALAR", count);
        json!({ "attributes": attributes, "indices": indices })
    }

    /// A node with a mesh of one primitive: `geometry` in `material`.
    pub(crate) fn object(&mut self, name: &str, geometry: &Value, material: usize, place: Value) -> usize {
        let mut primitive = geometry.clone();
        primitive["material"] = material.into();
        let mesh = push(&mut self.meshes, json!({ "name": name, "primitives": [primitive] }));
        let mut node = place;
        node["name"] = name.into();
        node["mesh"] = mesh.into();
        push(&mut self.nodes, node)
    }

    pub(crate) fn node(&mut self, node: Value) -> usize {
        push(&mut self.nodes, node)
    }

    pub(crate) fn material(&mut self, material: Value) -> usize {
        push(&mut self.materials, material)
    }

    /// A texture of a PNG file, filtered trilinearly; `wrap` is a glTF constant.
    pub(crate) fn texture(&mut self, name: &str, png: &[u8], wrap: u32) -> usize {
        let view = self.buffer_view(png, None);
        let image = push(&mut self.images, json!({ "name": name, "bufferView": view, "mimeType": "image/png" }));
        let sampler = json!({ "magFilter": 9729, "minFilter": 9987, "wrapS": wrap, "wrapT": wrap });
        let known = self.samplers.iter().position(|other| *other == sampler);
        let sampler = known.unwrap_or_else(|| push(&mut self.samplers, sampler));
        push(&mut self.textures, json!({ "name": name, "source": image, "sampler": sampler }))
    }

    /// The finished file; `root` holds the rest of the top-level properties.
    pub(crate) fn finish(mut self, mut root: Value) -> Vec<u8> {
        pad(&mut self.bytes, 0);
        root["buffers"] = json!([{ "byteLength": self.bytes.len() }]);
        root["bufferViews"] = self.buffer_views.into();
        root["accessors"] = self.accessors.into();
        root["images"] = self.images.into();
        root["samplers"] = self.samplers.into();
        root["textures"] = self.textures.into();
        root["materials"] = self.materials.into();
        root["meshes"] = self.meshes.into();
        root["nodes"] = self.nodes.into();
        let mut json = root.to_string().into_bytes();
        pad(&mut json, b' ');

        let length = 12 + 8 + json.len() + 8 + self.bytes.len();
        let mut file = Vec::with_capacity(length);
        file.extend(b"glTF");
        for word in [2, length as u32, json.len() as u32] {
            file.extend(word.to_le_bytes());
        }
        file.extend(b"JSON");
        file.extend(json);
        file.extend((self.bytes.len() as u32).to_le_bytes());
        file.extend(b"BIN\0");
        file.extend(self.bytes);
        file
    }

    /// An accessor of float vectors, with its bounds.
    fn vectors(&mut self, vectors: &[DVec3]) -> usize {
        let floats: Vec<u8> = vectors.iter().flat_map(|v| v.to_array()).flat_map(float_bytes).collect();
        let index = self.accessor(&floats, ARRAY_BUFFER, FLOAT, "VEC3", vectors.len());
        let bound = |v: DVec3| v.to_array().map(stored);
        self.accessors[index]["min"] = json!(bound(vectors.iter().copied().fold(DVec3::INFINITY, DVec3::min)));
        self.accessors[index]["max"] = json!(bound(vectors.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max)));
        index
    }

    fn accessor(&mut self, bytes: &[u8], target: u32, component: u32, kind: &str, count: usize) -> usize {
        let view = self.buffer_view(bytes, Some(target));
        let accessor = json!({ "bufferView": view, "componentType": component, "type": kind, "count": count });
        push(&mut self.accessors, accessor)
    }

    fn buffer_view(&mut self, bytes: &[u8], target: Option<u32>) -> usize {
        pad(&mut self.bytes, 0);
        let mut view = json!({ "buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len() });
        if let Some(target) = target {
            view["target"] = target.into();
        }
        self.bytes.extend(bytes);
        push(&mut self.buffer_views, view)
    }
}

/// The value as it is stored: rounded, so that the file does not depend on the last bit of a platform's sine.
fn stored(value: f64) -> f32 {
    // Adding zero turns -0 into 0.
    ((value * 1e5).round() / 1e5 + 0.0) as f32
}

fn float_bytes(value: f64) -> [u8; 4] {
    stored(value).to_le_bytes()
}

fn push(list: &mut Vec<Value>, value: Value) -> usize {
    list.push(value);
    list.len() - 1
}

/// Every chunk and buffer view starts at a multiple of four bytes.
fn pad(bytes: &mut Vec<u8>, with: u8) {
    bytes.resize(bytes.len().next_multiple_of(4), with);
}
