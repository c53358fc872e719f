//! The bytes of the document's buffers.

use super::error::{Fault, quote};
use super::resources::Resources;
use gltf::json::Root;
use std::borrow::Cow;

/// The bytes of every buffer that has some. Buffers without a uri may be placeholders that nothing reads.
#[derive(Debug)]
pub(super) struct Buffers<'a> {
    root: &'a Root,
    data: Vec<Option<Cow<'a, [u8]>>>,
}

impl<'a> Buffers<'a> {
    /// `binary` is the binary chunk of a GLB: the data of buffer 0 if that has no uri.
    pub(super) fn load(root: &'a Root, binary: Option<&'a [u8]>, resources: &Resources<'_>) -> Result<Self, Fault> {
        let load = |(index, buffer): (usize, &gltf::json::Buffer)| {
            let bytes = match &buffer.uri {
                Some(uri) => Some(Cow::Owned(resources.load(uri, &format!("/buffers/{index}/uri"))?)),
                None => binary.filter(|_| index == 0).map(Cow::Borrowed),
            };
            let needed = buffer.byte_length.0;
            match bytes {
                Some(bytes) if (bytes.len() as u64) < needed => {
                    let source = buffer.uri.as_deref().map_or("the binary chunk".into(), quote);
                    let problem = format!("says {needed} bytes, {source} has {}", bytes.len());
                    Err(Fault::at(format_args!("/buffers/{index}/byteLength"), problem))
                }
                bytes => Ok(bytes),
            }
        };
        let data = root.buffers.iter().enumerate().map(load).collect::<Result<_, _>>()?;
        Ok(Self { root, data })
    }

    /// The bytes of a buffer view, whose range has been checked against its buffer's declared length.
    pub(super) fn view(&self, view: usize) -> Result<&[u8], Fault> {
        let pointer = format_args!("/bufferViews/{view}");
        let json = &self.root.buffer_views[view];
        let Some(bytes) = &self.data[json.buffer.value()] else {
            return Err(Fault::at(pointer, format!("lies in /buffers/{}, which has no data", json.buffer.value())));
        };
        let start = json.byte_offset.map_or(0, |offset| offset.0) as usize;
        bytes
            .get(start..)
            .and_then(|bytes| bytes.get(..json.byte_length.0 as usize))
            .ok_or_else(|| Fault::at(pointer, "lies outside its buffer"))
    }
}
