//! The attributes of a primitive's vertices: read, agreed in number, and finite.

use super::accessor::Accessors;
use super::error::{Fault, Notes};
use super::references::semantic_name;
use glam::{Vec2, Vec3, Vec4};
use gltf::json::mesh::{Primitive, Semantic};
use gltf::json::validation::Checked;

/// Texture coordinate sets that are read. The specification asks for two; a file may number them up to 2^32.
pub(super) const MAX_UV_SETS: u32 = 8;

/// Attributes side by side, each as long as the positions.
#[derive(Debug, Default, PartialEq)]
pub(super) struct Vertices {
    pub(super) positions: Vec<Vec3>,
    pub(super) normals: Option<Vec<Vec3>>,
    pub(super) tangents: Option<Vec<Vec4>>,
    pub(super) uvs: Vec<Vec<Vec2>>,
    pub(super) colors: Option<Vec<Vec4>>,
}

impl Vertices {
    /// The vertices that `indices` list, in that order.
    pub(super) fn gather(&self, indices: &[u32]) -> Self {
        fn pick<T: Copy>(values: &[T], indices: &[u32]) -> Vec<T> {
            indices.iter().map(|&index| values[index as usize]).collect()
        }
        Self {
            positions: pick(&self.positions, indices),
            normals: self.normals.as_ref().map(|values| pick(values, indices)),
            tangents: self.tangents.as_ref().map(|values| pick(values, indices)),
            uvs: self.uvs.iter().map(|values| pick(values, indices)).collect(),
            colors: self.colors.as_ref().map(|values| pick(values, indices)),
        }
    }

    /// Size of one vertex with normal and tangent, in 32-bit words.
    pub(super) fn words_per_vertex(&self) -> usize {
        3 + 3 + 4 + 2 * self.uvs.len() + if self.colors.is_some() { 4 } else { 0 }
    }

    /// The same vertices with repetitions left out, and the indices that restore them.
    ///
    /// Vertices are the same when every attribute has the same bits.
    pub(super) fn weld(&self) -> (Self, Vec<u32>) {
        let words = self.words();
        let count = self.positions.len();
        let stride = words.len() / count.max(1);
        let mut first_seen = std::collections::HashMap::with_capacity(count);
        let mut kept = Vec::new();
        let mut indices = Vec::with_capacity(count);
        for vertex in 0..count {
            let index = *first_seen.entry(&words[vertex * stride..][..stride]).or_insert(kept.len() as u32);
            if index as usize == kept.len() {
                kept.push(vertex as u32);
            }
            indices.push(index);
        }
        (self.gather(&kept), indices)
    }

    /// The bits of all attributes, vertex by vertex.
    fn words(&self) -> Vec<u32> {
        let mut words = Vec::with_capacity(self.positions.len() * self.words_per_vertex());
        for vertex in 0..self.positions.len() {
            words.extend(self.positions[vertex].to_array().map(f32::to_bits));
            words.extend(self.normals.iter().flat_map(|values| values[vertex].to_array().map(f32::to_bits)));
            words.extend(self.tangents.iter().flat_map(|values| values[vertex].to_array().map(f32::to_bits)));
            words.extend(self.uvs.iter().flat_map(|values| values[vertex].to_array().map(f32::to_bits)));
            words.extend(self.colors.iter().flat_map(|values| values[vertex].to_array().map(f32::to_bits)));
        }
        words
    }
}

/// Reads the vertices of the primitive at `here`; `None`, with a note, for a primitive without positions.
///
/// Sets of texture coordinates below `uv_sets` that the primitive lacks are filled with zeros.
pub(super) fn read(
    accessors: &Accessors<'_>,
    primitive: &Primitive,
    here: &str,
    uv_sets: u32,
    notes: &mut Notes,
) -> Result<Option<Vertices>, Fault> {
    let attribute = |semantic| primitive.attributes.get(&Checked::Valid(semantic)).map(|index| index.value());
    let Some(positions) = attribute(Semantic::Positions) else {
        notes.add(here, "the primitive has no POSITION and is left out");
        return Ok(None);
    };
    let count = accessors.count(positions);
    check_counts(accessors, primitive, here, count)?;

    let mut reader = Reader { accessors, here, notes };
    let mut vertices = Vertices { positions: reader.positions(positions)?, ..Vertices::default() };
    if let Some(normals) = attribute(Semantic::Normals) {
        let normals = reader.finite(normals, "NORMAL", false)?;
        vertices.normals = Some(normals.into_iter().map(Vec3::from_array).collect());
    }
    if let Some(tangents) = attribute(Semantic::Tangents) {
        let tangents = reader.finite(tangents, "TANGENT", false)?;
        vertices.tangents = Some(tangents.into_iter().map(Vec4::from_array).collect());
    }
    if let Some(colors) = attribute(Semantic::Colors(0)) {
        vertices.colors = Some(reader.colors(colors)?);
    }
    let present = (0..MAX_UV_SETS).filter(|&set| attribute(Semantic::TexCoords(set)).is_some()).max();
    for set in 0..uv_sets.max(present.map_or(0, |set| set + 1)) {
        let uvs = match attribute(Semantic::TexCoords(set)) {
            Some(uvs) => reader.finite(uvs, &format!("TEXCOORD_{set}"), false)?,
            None => reader.missing_uvs(set, count, set < uv_sets)?,
        };
        vertices.uvs.push(uvs.into_iter().map(Vec2::from_array).collect());
    }
    Ok(Some(vertices))
}

/// All attributes of a primitive must have the same number of elements (glTF 2.0, 3.7.2.1).
fn check_counts(accessors: &Accessors<'_>, primitive: &Primitive, here: &str, count: u64) -> Result<(), Fault> {
    for (semantic, accessor) in &primitive.attributes {
        let other = accessors.count(accessor.value());
        if other != count {
            let name = semantic_name(semantic);
            let problem = format!("has {other} elements, POSITION has {count}");
            return Err(Fault::at(format_args!("{here}/attributes/{name}"), problem));
        }
    }
    Ok(())
}

struct Reader<'a> {
    accessors: &'a Accessors<'a>,
    here: &'a str,
    notes: &'a mut Notes,
}

impl Reader<'_> {
    fn positions(&self, accessor: usize) -> Result<Vec<Vec3>, Fault> {
        let positions = self.accessors.floats::<3>(accessor, false)?;
        if let Some(vertex) = positions.iter().position(|position| !position.iter().all(|x| x.is_finite())) {
            let problem = format!("position {vertex} is not finite");
            return Err(Fault::at(format_args!("{}/attributes/POSITION", self.here), problem));
        }
        Ok(positions.into_iter().map(Vec3::from_array).collect())
    }

    /// An attribute with zeros in place of what is not finite.
    fn finite<const N: usize>(
        &mut self,
        accessor: usize,
        name: &str,
        normalized: bool,
    ) -> Result<Vec<[f32; N]>, Fault> {
        let mut values = self.accessors.floats::<N>(accessor, normalized)?;
        let mut replaced = 0_usize;
        for value in values.as_flattened_mut().iter_mut().filter(|value| !value.is_finite()) {
            *value = 0.0;
            replaced += 1;
        }
        if replaced > 0 {
            let problem = format!("{replaced} numbers are not finite and count as 0");
            self.notes.add(format_args!("{}/attributes/{name}", self.here), problem);
        }
        Ok(values)
    }

    /// Colours are always normalised: as plain integers they would be far too bright.
    fn colors(&mut self, accessor: usize) -> Result<Vec<Vec4>, Fault> {
        if self.accessors.components(accessor)? == 3 {
            let colors = self.finite::<3>(accessor, "COLOR_0", true)?;
            return Ok(colors.into_iter().map(|color| Vec3::from_array(color).extend(1.0)).collect());
        }
        let colors = self.finite::<4>(accessor, "COLOR_0", true)?;
        Ok(colors.into_iter().map(Vec4::from_array).collect())
    }

    fn missing_uvs(&mut self, set: u32, count: u64, asked: bool) -> Result<Vec<[f32; 2]>, Fault> {
        if asked {
            let problem = format!("TEXCOORD_{set} is missing, but the material may use it; it counts as zero");
            self.notes.add(format_args!("{}/attributes", self.here), problem);
        }
        self.accessors.budget.take(count, size_of::<[f32; 2]>() as u64, self.here)?;
        Ok(vec![[0.0; 2]; count as usize])
    }
}
