//! Builds small glTF files in memory.

use crate::import::{ImportError, ImportOptions, Imported, model_from_slice};
use crate::scene::Primitive;
use base64::Engine;
use serde_json::{Map, Value, json};

pub(super) const U8: u32 = 5121;
pub(super) const I8: u32 = 5120;
pub(super) const I16: u32 = 5122;
pub(super) const U16: u32 = 5123;
pub(super) const U32: u32 = 5125;
pub(super) const F32: u32 = 5126;

/// A document and the data of its buffer 0.
#[derive(Debug, Clone)]
pub(super) struct Asset {
    pub(super) json: Value,
    pub(super) binary: Vec<u8>,
}

pub(super) fn bytes_of<T: bytemuck::NoUninit>(values: &[T]) -> Vec<u8> {
    bytemuck::cast_slice(values).to_vec()
}

impl Asset {
    pub(super) fn new() -> Self {
        Self { json: json!({ "asset": { "version": "2.0" } }), binary: Vec::new() }
    }

    /// One mesh with one primitive of these attributes, on one node of one scene.
    pub(super) fn of_primitive(build: impl FnOnce(&mut Self) -> Value) -> Self {
        let mut asset = Self::new();
        let primitive = build(&mut asset);
        asset.push("meshes", json!({ "primitives": [primitive] }));
        asset.push("nodes", json!({ "mesh": 0 }));
        asset.push("scenes", json!({ "nodes": [0] }));
        asset
    }

    /// A right triangle in the xy plane, without normals or material.
    pub(super) fn triangle() -> Self {
        Self::of_primitive(|asset| {
            let positions = asset.floats(&TRIANGLE);
            json!({ "attributes": { "POSITION": positions } })
        })
    }

    /// Appends to an array of the document; returns the index.
    pub(super) fn push(&mut self, array: &str, value: Value) -> usize {
        let members: &mut Map<String, Value> = self.json.as_object_mut().unwrap();
        let items = members.entry(array).or_insert_with(|| json!([])).as_array_mut().unwrap();
        items.push(value);
        items.len() - 1
    }

    /// Appends data as a buffer view of its own, at a multiple of four bytes.
    pub(super) fn view(&mut self, bytes: &[u8]) -> usize {
        let offset = self.binary.len();
        self.binary.extend(bytes);
        self.binary.resize(self.binary.len().next_multiple_of(4), 0);
        self.push("bufferViews", json!({ "buffer": 0, "byteOffset": offset, "byteLength": bytes.len() }))
    }

    pub(super) fn accessor(&mut self, bytes: &[u8], component: u32, kind: &str, count: usize) -> usize {
        let view = self.view(bytes);
        self.push("accessors", json!({ "bufferView": view, "componentType": component, "type": kind, "count": count }))
    }

    pub(super) fn floats<const N: usize>(&mut self, values: &[[f32; N]]) -> usize {
        let kind = ["", "SCALAR", "VEC2", "VEC3", "VEC4"][N];
        self.accessor(bytemuck::cast_slice(values.as_flattened()), F32, kind, values.len())
    }

    pub(super) fn indices(&mut self, values: &[u16]) -> usize {
        self.accessor(&bytes_of(values), U16, "SCALAR", values.len())
    }

    /// A material with this JSON on the only primitive.
    pub(super) fn with_material(mut self, material: Value) -> Self {
        let index = self.push("materials", material);
        self.json["meshes"][0]["primitives"][0]["material"] = json!(index);
        self
    }

    /// A texture of one texel, embedded as PNG; returns the texture's index.
    pub(super) fn texture(&mut self) -> usize {
        let view = self.view(&png(1, 1, image::ExtendedColorType::Rgba8, &[1, 2, 3, 4]));
        let image = self.push("images", json!({ "bufferView": view, "mimeType": "image/png" }));
        self.push("textures", json!({ "source": image }))
    }

    /// The document, with a buffer for the data unless it has buffers already.
    fn document(&self) -> Value {
        let mut json = self.json.clone();
        if !self.binary.is_empty() && json.get("buffers").is_none() {
            json["buffers"] = json!([{ "byteLength": self.binary.len() }]);
        }
        json
    }

    pub(super) fn glb(&self) -> Vec<u8> {
        glb_of(&serde_json::to_vec(&self.document()).unwrap(), Some(&self.binary))
    }

    /// The same as JSON text, with the data in a data URI unless buffer 0 has a uri already.
    pub(super) fn gltf(&self) -> Vec<u8> {
        let mut json = self.document();
        if let Some(buffer) = json.pointer_mut("/buffers/0").filter(|buffer| buffer.get("uri").is_none()) {
            let data = base64::engine::general_purpose::STANDARD.encode(&self.binary);
            buffer["uri"] = json!(format!("data:application/octet-stream;base64,{data}"));
        }
        serde_json::to_vec(&json).unwrap()
    }

    pub(super) fn load(&self) -> Result<Imported, ImportError> {
        load(&self.glb())
    }

    /// The import, which must succeed without a warning.
    pub(super) fn loaded(&self) -> Imported {
        let imported = self.load().unwrap();
        assert!(imported.warnings.is_empty(), "{:?}", imported.warnings);
        imported
    }

    /// The only primitive of the import.
    pub(super) fn primitive(&self) -> Primitive {
        let mut imported = self.load().unwrap();
        assert_eq!(imported.scene.meshes.len(), 1);
        assert_eq!(imported.scene.meshes[0].primitives.len(), 1);
        imported.scene.meshes.remove(0).primitives.remove(0)
    }

    /// What the warnings say, all in one.
    pub(super) fn warnings(&self) -> String {
        self.load().unwrap().warnings.iter().map(|warning| format!("{warning}\n")).collect()
    }
}

pub(super) const TRIANGLE: [[f32; 3]; 3] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];

pub(super) fn load(bytes: &[u8]) -> Result<Imported, ImportError> {
    model_from_slice(bytes, "model", None, &ImportOptions::default())
}

/// A GLB of these chunks.
pub(super) fn glb_of(json: &[u8], binary: Option<&[u8]>) -> Vec<u8> {
    let mut chunks = Vec::new();
    let mut chunk = |kind: &[u8; 4], data: &[u8], padding: u8| {
        let length = data.len().next_multiple_of(4);
        chunks.extend((length as u32).to_le_bytes());
        chunks.extend(kind);
        chunks.extend(data);
        chunks.resize(chunks.len() + length - data.len(), padding);
    };
    chunk(b"JSON", json, b' ');
    if let Some(binary) = binary {
        chunk(b"BIN\0", binary, 0);
    }
    let mut glb = b"glTF".to_vec();
    glb.extend(2_u32.to_le_bytes());
    glb.extend((12 + chunks.len() as u32).to_le_bytes());
    glb.extend(chunks);
    glb
}

pub(super) fn png(width: u32, height: u32, color: image::ExtendedColorType, data: &[u8]) -> Vec<u8> {
    use image::ImageEncoder;
    let mut file = Vec::new();
    image::codecs::png::PngEncoder::new(&mut file).write_image(data, width, height, color).unwrap();
    file
}

/// A PNG that says any size, with a valid checksum and next to no data.
pub(super) fn png_header(width: u32, height: u32) -> Vec<u8> {
    let mut file = b"\x89PNG\r\n\x1a\n".to_vec();
    let mut header = b"IHDR".to_vec();
    header.extend(width.to_be_bytes());
    header.extend(height.to_be_bytes());
    header.extend([8, 6, 0, 0, 0]);
    for chunk in [header, b"IDAT\x78\x9c\x03\x00\x00\x00\x00\x01".to_vec(), b"IEND".to_vec()] {
        file.extend((chunk.len() as u32 - 4).to_be_bytes());
        file.extend(&chunk);
        file.extend(crc32(&chunk).to_be_bytes());
    }
    file
}

/// CRC-32 of ISO 3309, as PNG wants it.
pub(super) fn crc32(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(!0, |crc, &byte| {
        (0..8).fold(crc ^ u32::from(byte), |crc, _| if crc & 1 == 1 { (crc >> 1) ^ 0xEDB8_8320 } else { crc >> 1 })
    })
}
