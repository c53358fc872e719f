//! From JSON text to the typed document, with a place for everything that does not fit.
//!
//! The types are those of the gltf crate. They are narrower than the specification in some points and, worse, wider in
//! others (an index of 2^32 reads as 0), so the JSON is tidied as a plain tree before it becomes typed. Validation is
//! ours throughout: that of the gltf crate panics on some documents.

use super::error::{Fault, Notes, quote};
use super::extensions;
use gltf::json::Root;
use serde::de::DeserializeOwned;
use serde_json::Value;

/// A document whose shape is right. Whether its indices and ranges are is for [`super::references`] to say.
#[derive(Debug)]
pub(super) struct Document {
    pub(super) root: Root,
    /// Kept apart, as JSON: nothing plays them yet and the gltf crate refuses legal ones (targets without a node).
    pub(super) animations: Value,
}

/// Parses the JSON that begins `offset` bytes into its file.
pub(super) fn parse(json: &[u8], offset: u64, notes: &mut Notes) -> Result<Document, Fault> {
    let mut tree: Value = serde_json::from_slice(json).map_err(|error| syntax_fault(&error, json, offset))?;
    check_version(&tree)?;
    extensions::check_declared(&tree, notes)?;
    tidy(&mut tree, &mut String::new(), Numbers::Any)?;
    for scene in tree.get_mut("scenes").and_then(Value::as_array_mut).into_iter().flatten() {
        if let Some(scene) = scene.as_object_mut() {
            // Scenes without nodes are legal; the typed document demands the list.
            scene.entry("nodes").or_insert_with(|| Value::Array(Vec::new()));
        }
    }
    let animations = tree.get_mut("animations").map(Value::take).unwrap_or_default();
    if let Some(object) = tree.as_object_mut() {
        object.remove("animations");
    }
    Ok(Document { root: typed(tree, "")?, animations })
}

/// Gives a JSON tree, which stands at `pointer` of the document, its type.
pub(super) fn typed<T: DeserializeOwned>(tree: Value, pointer: &str) -> Result<T, Fault> {
    serde_path_to_error::deserialize(tree).map_err(|error| {
        let place = format!("{pointer}{}", pointer_from_path(error.path()));
        Fault::at(if place.is_empty() { "/" } else { &place }, error.inner().to_string())
    })
}

fn pointer_from_path(path: &serde_path_to_error::Path) -> String {
    use serde_path_to_error::Segment;
    let mut pointer = String::new();
    for segment in path.iter() {
        match segment {
            Segment::Seq { index } => pointer += &format!("/{index}"),
            Segment::Map { key } | Segment::Enum { variant: key } => push_key(&mut pointer, key),
            Segment::Unknown => {}
        }
    }
    pointer
}

fn push_key(pointer: &mut String, key: &str) {
    pointer.push('/');
    let shown: String = key.chars().take(80).collect();
    pointer.push_str(&shown.replace('~', "~0").replace('/', "~1"));
}

fn syntax_fault(error: &serde_json::Error, json: &[u8], offset: u64) -> Fault {
    let lines_before = json.split_inclusive(|&byte| byte == b'\n').take(error.line().saturating_sub(1));
    let line_start: usize = lines_before.map(<[u8]>::len).sum();
    let message = error.to_string();
    let message = message.split(" at line ").next().unwrap_or_default();
    let at = offset + (line_start + error.column().saturating_sub(1)) as u64;
    Fault::at_byte(at, format!("the JSON is broken: {message}"))
}

/// `asset.version` must have the major version 2, `asset.minVersion` must be 2.0 (glTF 2.0, 3.2).
fn check_version(tree: &Value) -> Result<(), Fault> {
    let Some(version) = tree.pointer("/asset/version") else {
        return Err(Fault::at("/asset/version", "is missing: this is no glTF 2.0 document"));
    };
    let parse = |value: &Value| -> Option<(u32, u32)> {
        let (major, minor) = value.as_str()?.split_once('.')?;
        Some((major.parse().ok()?, minor.parse().ok()?))
    };
    match parse(version) {
        Some((2, _)) => {}
        _ => {
            return Err(Fault::at("/asset/version", format!("is {}, not 2.x", quote_value(version)))
                .advise("convert it to glTF 2.0"));
        }
    }
    match tree.pointer("/asset/minVersion") {
        Some(least) if parse(least) != Some((2, 0)) => {
            Err(Fault::at("/asset/minVersion", format!("is {}, only 2.0 is supported", quote_value(least)))
                .advise("convert it to glTF 2.0"))
        }
        _ => Ok(()),
    }
}

fn quote_value(value: &Value) -> String {
    quote(value.as_str().unwrap_or(&value.to_string()))
}

/// Keys whose numbers are indices or enumerants. The typed document cuts them to 32 bits without a word.
const NARROW_KEYS: [&str; 24] = [
    "buffer",
    "bufferView",
    "camera",
    "children",
    "componentType",
    "index",
    "indices",
    "input",
    "inverseBindMatrices",
    "joints",
    "magFilter",
    "material",
    "mesh",
    "minFilter",
    "mode",
    "node",
    "nodes",
    "output",
    "sampler",
    "scene",
    "skeleton",
    "skin",
    "source",
    "target",
];

/// Which numbers of a subtree are indices or enumerants.
#[derive(Clone, Copy, PartialEq)]
enum Numbers {
    Any,
    /// Those here and in arrays from here.
    Narrow,
    /// All below: the values of vertex attribute maps.
    AllNarrow,
}

/// Removes `extras`, which may be anything, and refuses indices and enumerants above 32 bits.
///
/// The recursion is bounded by serde_json's limit on depth (128).
fn tidy(value: &mut Value, pointer: &mut String, numbers: Numbers) -> Result<(), Fault> {
    match value {
        Value::Number(number) if numbers != Numbers::Any => match number.as_u64() {
            Some(wide) if wide > u64::from(u32::MAX) => Err(Fault::at(pointer, format!("{wide} is too large here"))),
            _ => Ok(()),
        },
        Value::Array(items) => {
            let length = pointer.len();
            for (index, item) in items.iter_mut().enumerate() {
                if item.is_number() && numbers == Numbers::Any {
                    continue;
                }
                *pointer += &format!("/{index}");
                tidy(item, pointer, numbers)?;
                pointer.truncate(length);
            }
            Ok(())
        }
        Value::Object(members) => {
            members.remove("extras");
            let length = pointer.len();
            for (key, member) in members.iter_mut().filter(|(key, _)| *key != "extensions") {
                let below = match key.as_str() {
                    _ if numbers == Numbers::AllNarrow => Numbers::AllNarrow,
                    "attributes" | "targets" => Numbers::AllNarrow,
                    "wrapS" | "wrapT" => Numbers::Narrow,
                    narrow if NARROW_KEYS.contains(&narrow) => Numbers::Narrow,
                    _ => Numbers::Any,
                };
                push_key(pointer, key);
                tidy(member, pointer, below)?;
                pointer.truncate(length);
            }
            Ok(())
        }
        _ => Ok(()),
    }
}
