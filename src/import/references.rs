//! Every index and every byte range of a document, checked once, so that later stages may look things up.

use super::document::Document;
use super::error::{EXPORT_AGAIN, Fault};
use gltf::json::accessor::{Accessor, ComponentType, Type};
use gltf::json::mesh::Semantic;
use gltf::json::validation::Checked;
use gltf::json::{Root, texture};
use serde_json::Value;
use std::fmt::{Arguments, Display};

/// Texture source of the typed document when the file gives none.
pub(super) const NO_SOURCE: usize = u32::MAX as usize;

/// Refuses a document in which anything refers to what is not there.
pub(super) fn check(document: &Document) -> Result<(), Fault> {
    let root = &document.root;
    check_views(root)?;
    for (index, accessor) in root.accessors.iter().enumerate() {
        check_accessor(root, accessor, index)?;
    }
    check_meshes(root)?;
    check_nodes(root)?;
    check_skins(root)?;
    check_textures(root)?;
    check_animations(root, &document.animations)
}

/// Refuses `index` unless the document's array of this name, with `length` entries, has it.
pub(super) fn within(index: u64, length: usize, array: &str, pointer: impl Display) -> Result<usize, Fault> {
    if index < length as u64 {
        return Ok(index as usize);
    }
    Err(Fault::at(pointer, format!("refers to /{array}/{index}, but /{array} has {length} entries"))
        .advise(EXPORT_AGAIN))
}

fn within_optional<T>(
    index: Option<gltf::json::Index<T>>,
    length: usize,
    array: &str,
    pointer: Arguments<'_>,
) -> Result<(), Fault> {
    index.map_or(Ok(()), |index| within(index.value() as u64, length, array, pointer).map(drop))
}

/// Refuses a range of bytes that leaves what it lies in.
fn inside(offset: u64, length: u64, available: u64, parent: &str, pointer: impl Display) -> Result<(), Fault> {
    match offset.checked_add(length) {
        Some(end) if end <= available => Ok(()),
        _ => Err(Fault::at(
            pointer,
            format!("{length} bytes at {offset} do not fit in the {available} bytes of {parent}"),
        )),
    }
}

fn check_views(root: &Root) -> Result<(), Fault> {
    for (index, view) in root.buffer_views.iter().enumerate() {
        let buffer = within(
            view.buffer.value() as u64,
            root.buffers.len(),
            "buffers",
            format_args!("/bufferViews/{index}/buffer"),
        )?;
        let offset = view.byte_offset.map_or(0, |offset| offset.0);
        let available = root.buffers[buffer].byte_length.0;
        inside(offset, view.byte_length.0, available, "its buffer", format_args!("/bufferViews/{index}"))?;
    }
    Ok(())
}

/// Bytes of one element, and the distance between tightly packed ones; columns of matrices begin at multiples of four
/// bytes (glTF 2.0, 3.6.2.4).
pub(super) fn element_bytes(kind: Type, component: ComponentType) -> (u64, u64) {
    let component = component.size() as u64;
    let (columns, rows) = match kind {
        Type::Scalar => (1, 1),
        Type::Vec2 => (1, 2),
        Type::Vec3 => (1, 3),
        Type::Vec4 => (1, 4),
        Type::Mat2 => (2, 2),
        Type::Mat3 => (3, 3),
        Type::Mat4 => (4, 4),
    };
    let column = rows * component;
    if columns == 1 {
        return (column, column);
    }
    let padded = column.next_multiple_of(4);
    ((columns - 1) * padded + column, columns * padded)
}

/// The types of an accessor, which the JSON may have given as something that does not exist.
pub(super) fn accessor_types(accessor: &Accessor, index: usize) -> Result<(Type, ComponentType), Fault> {
    let Checked::Valid(kind) = accessor.type_ else {
        return Err(Fault::at(format_args!("/accessors/{index}/type"), "is not a type of accessor"));
    };
    let Checked::Valid(component) = accessor.component_type else {
        return Err(Fault::at(format_args!("/accessors/{index}/componentType"), "is not a component type"));
    };
    Ok((kind, component.0))
}

fn check_accessor(root: &Root, accessor: &Accessor, index: usize) -> Result<(), Fault> {
    let (kind, component) = accessor_types(accessor, index)?;
    let (element, packed) = element_bytes(kind, component);
    let count = accessor.count.0;
    if let Some(view) = accessor.buffer_view {
        let pointer = format_args!("/accessors/{index}");
        let view =
            within(view.value() as u64, root.buffer_views.len(), "bufferViews", format_args!("{pointer}/bufferView"))?;
        let stride = stride(root, view).unwrap_or(packed);
        if stride < element {
            let problem = format!("is {stride}, less than the {element} bytes of one element of /accessors/{index}");
            return Err(Fault::at(format_args!("/bufferViews/{view}/byteStride"), problem));
        }
        let offset = accessor.byte_offset.map_or(0, |offset| offset.0);
        let length = strided_length(count, stride, element);
        let available = root.buffer_views[view].byte_length.0;
        inside(offset, length, available, "its buffer view", pointer)?;
    }
    let Some(sparse) = &accessor.sparse else { return Ok(()) };
    let pointer = format!("/accessors/{index}/sparse");
    let changed = sparse.count.0;
    if changed > count {
        return Err(Fault::at(format!("{pointer}/count"), format!("is {changed}, the accessor has {count} elements")));
    }
    let Checked::Valid(index_type) = sparse.indices.component_type else {
        return Err(Fault::at(format!("{pointer}/indices/componentType"), "is not a type of index"));
    };
    let parts = [
        ("indices", sparse.indices.buffer_view, sparse.indices.byte_offset.0, index_type.0.size() as u64),
        ("values", sparse.values.buffer_view, sparse.values.byte_offset.0, packed),
    ];
    for (part, view, offset, size) in parts {
        let pointer = format!("{pointer}/{part}");
        let view =
            within(view.value() as u64, root.buffer_views.len(), "bufferViews", format_args!("{pointer}/bufferView"))?;
        let available = root.buffer_views[view].byte_length.0;
        inside(offset, strided_length(changed, size, size.min(element)), available, "its buffer view", pointer)?;
    }
    Ok(())
}

/// Distance of elements in a view that says so; 0 counts as not said.
pub(super) fn stride(root: &Root, view: usize) -> Option<u64> {
    root.buffer_views[view].byte_stride.map(|stride| stride.0 as u64).filter(|&stride| stride != 0)
}

/// Bytes from the first to the last of `count` elements; more than any file when that overflows.
fn strided_length(count: u64, stride: u64, element: u64) -> u64 {
    if count == 0 { 0 } else { (count - 1).saturating_mul(stride).saturating_add(element) }
}

/// The name of a vertex attribute. The typed document has one name for all that the specification does not define.
pub(super) fn semantic_name(semantic: &Checked<Semantic>) -> String {
    match semantic {
        Checked::Valid(semantic) => semantic.to_string(),
        Checked::Invalid => "_".into(),
    }
}

fn check_meshes(root: &Root) -> Result<(), Fault> {
    let accessors = root.accessors.len();
    for (m, mesh) in root.meshes.iter().enumerate() {
        for (p, primitive) in mesh.primitives.iter().enumerate() {
            let here = format_args!("/meshes/{m}/primitives/{p}").to_string();
            for (semantic, accessor) in &primitive.attributes {
                let name = semantic_name(semantic);
                within(accessor.value() as u64, accessors, "accessors", format_args!("{here}/attributes/{name}"))?;
            }
            within_optional(primitive.indices, accessors, "accessors", format_args!("{here}/indices"))?;
            within_optional(primitive.material, root.materials.len(), "materials", format_args!("{here}/material"))?;
            for (t, target) in primitive.targets.iter().flatten().enumerate() {
                for (name, accessor) in
                    [("POSITION", target.positions), ("NORMAL", target.normals), ("TANGENT", target.tangents)]
                {
                    within_optional(accessor, accessors, "accessors", format_args!("{here}/targets/{t}/{name}"))?;
                }
            }
        }
    }
    Ok(())
}

fn check_nodes(root: &Root) -> Result<(), Fault> {
    for (n, node) in root.nodes.iter().enumerate() {
        within_optional(node.mesh, root.meshes.len(), "meshes", format_args!("/nodes/{n}/mesh"))?;
        within_optional(node.camera, root.cameras.len(), "cameras", format_args!("/nodes/{n}/camera"))?;
        within_optional(node.skin, root.skins.len(), "skins", format_args!("/nodes/{n}/skin"))?;
        for (c, child) in node.children.iter().flatten().enumerate() {
            let pointer = format_args!("/nodes/{n}/children/{c}");
            within(child.value() as u64, root.nodes.len(), "nodes", pointer)?;
        }
    }
    within_optional(root.scene, root.scenes.len(), "scenes", format_args!("/scene"))?;
    for (s, scene) in root.scenes.iter().enumerate() {
        for (n, node) in scene.nodes.iter().enumerate() {
            within(node.value() as u64, root.nodes.len(), "nodes", format_args!("/scenes/{s}/nodes/{n}"))?;
        }
    }
    Ok(())
}

fn check_skins(root: &Root) -> Result<(), Fault> {
    for (s, skin) in root.skins.iter().enumerate() {
        let pointer = format_args!("/skins/{s}/inverseBindMatrices");
        within_optional(skin.inverse_bind_matrices, root.accessors.len(), "accessors", pointer)?;
        within_optional(skin.skeleton, root.nodes.len(), "nodes", format_args!("/skins/{s}/skeleton"))?;
        for (j, joint) in skin.joints.iter().enumerate() {
            within(joint.value() as u64, root.nodes.len(), "nodes", format_args!("/skins/{s}/joints/{j}"))?;
        }
    }
    Ok(())
}

fn check_textures(root: &Root) -> Result<(), Fault> {
    for (t, texture) in root.textures.iter().enumerate() {
        within_optional::<texture::Sampler>(
            texture.sampler,
            root.samplers.len(),
            "samplers",
            format_args!("/textures/{t}/sampler"),
        )?;
        if texture.source.value() != NO_SOURCE {
            within(texture.source.value() as u64, root.images.len(), "images", format_args!("/textures/{t}/source"))?;
        }
    }
    for (i, image) in root.images.iter().enumerate() {
        let pointer = format_args!("/images/{i}/bufferView");
        within_optional(image.buffer_view, root.buffer_views.len(), "bufferViews", pointer)?;
    }
    Ok(())
}

fn check_animations(root: &Root, animations: &Value) -> Result<(), Fault> {
    let list = |value: &Value, key: &str| value.get(key).and_then(Value::as_array).cloned().unwrap_or_default();
    let check = |value: &Value, keys: &str, length: usize, array: &str, pointer: String| match value
        .pointer(keys)
        .and_then(Value::as_u64)
    {
        Some(index) => within(index, length, array, format_args!("{pointer}{keys}")).map(drop),
        None => Ok(()),
    };
    for (a, animation) in animations.as_array().into_iter().flatten().enumerate() {
        let samplers = list(animation, "samplers");
        for (s, sampler) in samplers.iter().enumerate() {
            for key in ["/input", "/output"] {
                let pointer = format!("/animations/{a}/samplers/{s}");
                check(sampler, key, root.accessors.len(), "accessors", pointer)?;
            }
        }
        for (c, channel) in list(animation, "channels").iter().enumerate() {
            let pointer = format!("/animations/{a}/channels/{c}");
            check(channel, "/sampler", samplers.len(), &format!("animations/{a}/samplers"), pointer.clone())?;
            check(channel, "/target/node", root.nodes.len(), "nodes", pointer)?;
        }
    }
    Ok(())
}
