//! Reading accessors: every component type, normalised or not, strided, sparse, or without any data.

use super::buffers::Buffers;
use super::error::Fault;
use super::limits::{Budget, Limits};
use super::references::{accessor_types, element_bytes, stride};
use gltf::json::Root;
use gltf::json::accessor::{Accessor, ComponentType, Type};
use gltf::json::validation::Checked;

/// The accessors of a document whose ranges have been checked.
#[derive(Debug, Clone, Copy)]
pub(super) struct Accessors<'a> {
    pub(super) root: &'a Root,
    pub(super) buffers: &'a Buffers<'a>,
    pub(super) budget: &'a Budget,
    pub(super) limits: &'a Limits,
}

/// Indices as read, with the value that would restart a strip: it must not occur (glTF 2.0, 3.7.2.1).
#[derive(Debug)]
pub(super) struct Indices {
    pub(super) values: Vec<u32>,
    pub(super) restart: u32,
}

impl Accessors<'_> {
    pub(super) fn count(&self, index: usize) -> u64 {
        self.root.accessors[index].count.0
    }

    /// Components in one element: 1 for scalars up to 16 for 4x4 matrices.
    pub(super) fn components(&self, index: usize) -> Result<usize, Fault> {
        Ok(accessor_types(&self.root.accessors[index], index)?.0.multiplicity())
    }

    /// Elements of `N` components as floats. Integers map to [0, 1] or [-1, 1] when the accessor is normalised, or
    /// when `force_normalized`; else they keep their value (KHR_mesh_quantization).
    pub(super) fn floats<const N: usize>(&self, index: usize, force_normalized: bool) -> Result<Vec<[f32; N]>, Fault> {
        let accessor = &self.root.accessors[index];
        let (kind, component) = accessor_types(accessor, index)?;
        let vector = match N {
            2 => Type::Vec2,
            3 => Type::Vec3,
            _ => Type::Vec4,
        };
        if kind != vector {
            let problem = format!("is {kind:?}, an attribute that uses it is {vector:?}");
            return Err(Fault::at(format_args!("/accessors/{index}/type"), problem));
        }
        if component == ComponentType::U32 {
            let problem = "is UNSIGNED_INT, which vertex attributes must not be";
            return Err(Fault::at(format_args!("/accessors/{index}/componentType"), problem));
        }
        let normalized = accessor.normalized || force_normalized;
        let size = component.size();
        let decode = |bytes: &[u8]| {
            std::array::from_fn(|i| component_as_float(component, normalized, &bytes[i * size..][..size]))
        };
        self.read(index, [0.0; N], decode)
    }

    /// Vertex indices.
    pub(super) fn indices(&self, index: usize) -> Result<Indices, Fault> {
        let (kind, component) = accessor_types(&self.root.accessors[index], index)?;
        let restart = match (kind, component) {
            (Type::Scalar, ComponentType::U8) => u32::from(u8::MAX),
            (Type::Scalar, ComponentType::U16) => u32::from(u16::MAX),
            (Type::Scalar, ComponentType::U32) => u32::MAX,
            _ => {
                let problem = "is used for indices, which are scalars of an unsigned integer type";
                return Err(Fault::at(format_args!("/accessors/{index}"), problem));
            }
        };
        Ok(Indices { values: self.read(index, 0, |bytes| unsigned(component, bytes))?, restart })
    }

    /// All elements, each decoded from its bytes; `zero` where there are none.
    fn read<T: Copy>(&self, index: usize, zero: T, decode: impl Fn(&[u8]) -> T) -> Result<Vec<T>, Fault> {
        let accessor = &self.root.accessors[index];
        let (kind, component) = accessor_types(accessor, index)?;
        let (element, packed) = element_bytes(kind, component);
        let count = accessor.count.0;
        if accessor.buffer_view.is_none() && count > self.limits.elements_without_data {
            let problem = format!("asks for {count} elements and has no data for them");
            return Err(Fault::at(format_args!("/accessors/{index}/count"), problem));
        }
        self.budget.take(count, size_of::<T>() as u64, format_args!("/accessors/{index}"))?;
        let mut values = match accessor.buffer_view {
            Some(view) => {
                let bytes = self.buffers.view(view.value())?;
                let stride = stride(self.root, view.value()).unwrap_or(packed);
                let offset = accessor.byte_offset.map_or(0, |offset| offset.0);
                elements(bytes, offset, count, stride, element).map(&decode).collect()
            }
            None => vec![zero; count as usize],
        };
        self.substitute(accessor, index, &mut values, decode)?;
        Ok(values)
    }

    /// Overwrites the elements that a sparse accessor lists.
    fn substitute<T>(
        &self,
        accessor: &Accessor,
        index: usize,
        values: &mut [T],
        decode: impl Fn(&[u8]) -> T,
    ) -> Result<(), Fault> {
        let Some(sparse) = &accessor.sparse else { return Ok(()) };
        let (kind, component) = accessor_types(accessor, index)?;
        let (element, packed) = element_bytes(kind, component);
        let Checked::Valid(index_type) = sparse.indices.component_type else { return Ok(()) };
        let index_size = index_type.0.size() as u64;
        let count = sparse.count.0;
        let places = self.buffers.view(sparse.indices.buffer_view.value())?;
        let places = elements(places, sparse.indices.byte_offset.0, count, index_size, index_size);
        let replacements = self.buffers.view(sparse.values.buffer_view.value())?;
        let replacements = elements(replacements, sparse.values.byte_offset.0, count, packed, element);
        let mut least = 0;
        for (n, (place, replacement)) in places.zip(replacements).enumerate() {
            let place = unsigned(index_type.0, place) as usize;
            if place < least || place >= values.len() {
                let problem = format!("entry {n} is {place}: not increasing, or beyond {} elements", values.len());
                return Err(Fault::at(format_args!("/accessors/{index}/sparse/indices"), problem));
            }
            values[place] = decode(replacement);
            least = place + 1;
        }
        Ok(())
    }
}

/// The bytes of each of `count` elements. The range has been checked; were it wrong, fewer would come out.
fn elements(bytes: &[u8], offset: u64, count: u64, stride: u64, element: u64) -> impl Iterator<Item = &[u8]> {
    (0..count as usize).map_while(move |i| {
        let start = offset as usize + i * stride as usize;
        bytes.get(start..start + element as usize)
    })
}

fn unsigned(component: ComponentType, bytes: &[u8]) -> u32 {
    match component {
        ComponentType::U8 => u32::from(bytes[0]),
        ComponentType::U16 => u32::from(u16::from_le_bytes([bytes[0], bytes[1]])),
        _ => u32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]),
    }
}

/// One component; integers divide by their largest value, and -128 as -127 gives -1 (glTF 2.0, 3.11).
fn component_as_float(component: ComponentType, normalized: bool, bytes: &[u8]) -> f32 {
    let (value, largest) = match component {
        ComponentType::I8 => (f32::from(i8::from_le_bytes([bytes[0]])), f32::from(i8::MAX)),
        ComponentType::U8 => (f32::from(bytes[0]), f32::from(u8::MAX)),
        ComponentType::I16 => (f32::from(i16::from_le_bytes([bytes[0], bytes[1]])), f32::from(i16::MAX)),
        ComponentType::U16 => (f32::from(u16::from_le_bytes([bytes[0], bytes[1]])), f32::from(u16::MAX)),
        ComponentType::U32 | ComponentType::F32 => {
            return f32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]);
        }
    };
    if normalized { (value / largest).max(-1.0) } else { value }
}
