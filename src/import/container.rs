//! The GLB container (glTF 2.0, 4.4): a header, a JSON chunk, and maybe a binary one.

use super::error::{Fault, Notes};

const MAGIC: &[u8] = b"glTF";
const HEADER_BYTES: usize = 12;
const CHUNK_HEADER_BYTES: usize = 8;
const CHUNK_JSON: u32 = u32::from_le_bytes(*b"JSON");
const CHUNK_BIN: u32 = u32::from_le_bytes(*b"BIN\0");

/// The parts of a .gltf or .glb file.
#[derive(Debug)]
pub(super) struct Container<'a> {
    pub(super) json: &'a [u8],
    /// Offset of `json` in the file.
    pub(super) json_offset: u64,
    /// The chunk that buffer 0 lies in.
    pub(super) binary: Option<&'a [u8]>,
}

/// Splits a file, by its first bytes, into the parts of a GLB or into JSON alone.
pub(super) fn split<'a>(bytes: &'a [u8], notes: &mut Notes) -> Result<Container<'a>, Fault> {
    if bytes.starts_with(MAGIC) {
        return split_glb(bytes, notes);
    }
    let json_offset = if bytes.starts_with(b"\xEF\xBB\xBF") { 3 } else { 0 };
    let json = &bytes[json_offset..];
    match json.iter().position(|byte| !byte.is_ascii_whitespace()) {
        Some(first) if json[first] == b'{' => Ok(Container { json, json_offset: json_offset as u64, binary: None }),
        Some(_) => Err(Fault::at_byte(json_offset as u64, "is neither a GLB nor glTF JSON")
            .advise("give a .glb or .gltf file of glTF 2.0")),
        None => Err(Fault::at_byte(0, "is empty").advise("give a .glb or .gltf file of glTF 2.0")),
    }
}

fn split_glb<'a>(bytes: &'a [u8], notes: &mut Notes) -> Result<Container<'a>, Fault> {
    let (Some(version), Some(length)) = (u32_at(bytes, 4), u32_at(bytes, 8)) else {
        return Err(Fault::at_byte(bytes.len() as u64, "ends inside the GLB header"));
    };
    if version != 2 {
        return Err(Fault::at_byte(4, format!("is GLB version {version}")).advise("convert it to glTF 2.0"));
    }
    let length = length as usize;
    if length > bytes.len() {
        let problem = format!("the GLB header says {length} bytes, the file has {}", bytes.len());
        return Err(Fault::at_byte(8, problem).advise("transfer the file again, it is cut short"));
    }
    if length < bytes.len() {
        notes.add("/", format!("{} bytes after the end of the GLB are ignored", bytes.len() - length));
    }
    let bytes = &bytes[..length];

    let Some((json, kind)) = chunk_at(bytes, HEADER_BYTES)? else {
        return Err(Fault::at_byte(HEADER_BYTES as u64, "the GLB has no JSON chunk"));
    };
    if kind != CHUNK_JSON {
        return Err(Fault::at_byte(HEADER_BYTES as u64 + 4, "the first chunk of the GLB is not JSON"));
    }
    let mut binary = None;
    let mut at = HEADER_BYTES + CHUNK_HEADER_BYTES + json.len();
    // Chunks of other kinds are to be ignored (glTF 2.0, 4.4.3.1).
    while let Some((chunk, kind)) = chunk_at(bytes, at)? {
        if kind == CHUNK_BIN && binary.is_none() {
            binary = Some(chunk);
        }
        at += CHUNK_HEADER_BYTES + chunk.len();
    }
    Ok(Container { json, json_offset: (HEADER_BYTES + CHUNK_HEADER_BYTES) as u64, binary })
}

/// The chunk whose header begins at `at`, with its type; `None` at the end of the file.
fn chunk_at(bytes: &[u8], at: usize) -> Result<Option<(&[u8], u32)>, Fault> {
    if at == bytes.len() {
        return Ok(None);
    }
    let (Some(length), Some(kind)) = (u32_at(bytes, at), u32_at(bytes, at + 4)) else {
        return Err(Fault::at_byte(at as u64, "the GLB ends inside a chunk header"));
    };
    let rest = &bytes[at + CHUNK_HEADER_BYTES..];
    match rest.get(..length as usize) {
        Some(chunk) => Ok(Some((chunk, kind))),
        None => {
            let problem = format!("the chunk says {length} bytes, the GLB has {} left", rest.len());
            Err(Fault::at_byte(at as u64, problem))
        }
    }
}

fn u32_at(bytes: &[u8], at: usize) -> Option<u32> {
    let four = bytes.get(at..at.checked_add(4)?)?;
    Some(u32::from_le_bytes(four.try_into().ok()?))
}
