//! From a primitive of the document to one of the scene.

use super::accessor::Accessors;
use super::error::{Fault, Notes};
use super::vertices::{self, Vertices};
use super::{normals, tangents, topology};
use crate::scene::{Material, Primitive, TextureRef, TextureSlot, Topology};
use gltf::json;
use gltf::json::validation::Checked;

/// Builds the primitive at `here`, which has the scene's material number `material`.
///
/// `None`, with a note, when there is nothing to draw in it.
pub(super) fn build(
    accessors: &Accessors<'_>,
    primitive: &json::mesh::Primitive,
    here: &str,
    (material, appearance): (usize, &Material),
    notes: &mut Notes,
) -> Result<Option<Primitive>, Fault> {
    let Checked::Valid(mode) = primitive.mode else {
        return Err(Fault::at(format_args!("{here}/mode"), "is not a primitive mode"));
    };
    let uv_sets = appearance.textures().map(|(_, texture)| texture.uv_set + 1).max().unwrap_or(0);
    let Some(vertices) = vertices::read(accessors, primitive, here, uv_sets, notes)? else { return Ok(None) };
    let listed = indices(accessors, primitive, here, vertices.positions.len())?;
    let shapes_at_most = 3 * listed.len() as u64;
    accessors.budget.take(shapes_at_most, size_of::<u32>() as u64, here)?;
    let indices = topology::unroll(mode, listed);
    if indices.is_empty() {
        notes.add(here, "the primitive has no complete point, line or triangle and is left out");
        return Ok(None);
    }

    let topology = topology::topology(mode);
    let mut shape = Shape { vertices, indices };
    shape.complete_normals(topology, accessors, here, notes)?;
    let uv_set = tangent_uv_set(appearance, &shape.vertices);
    if appearance.anisotropy_strength > 0.0 && uv_set.is_none() && shape.vertices.tangents.is_none() {
        notes.add(
            here,
            "has neither tangents nor texture coordinates, so its anisotropy has no direction and is ignored",
        );
    }
    shape.complete_tangents(topology, uv_set, accessors, here)?;

    let Shape { vertices: Vertices { positions, normals, tangents, uvs, colors }, indices } = shape;
    Ok(Some(Primitive { topology, positions, normals, tangents, uvs, colors, indices, material }))
}

/// The texture coordinates whose directions a material needs along the surface, if it needs any.
fn tangent_uv_set(appearance: &Material, vertices: &Vertices) -> Option<usize> {
    let of_texture = |slot| appearance.texture(slot).map(|texture: &TextureRef| texture.uv_set as usize);
    let of_mesh = || (appearance.anisotropy_strength > 0.0 && !vertices.uvs.is_empty()).then_some(0);
    of_texture(TextureSlot::Normal).or_else(|| of_texture(TextureSlot::Anisotropy)).or_else(of_mesh)
}

/// The primitive's indices, each below `vertex_count`; 0, 1, 2... when it has none.
fn indices(
    accessors: &Accessors<'_>,
    primitive: &json::mesh::Primitive,
    here: &str,
    vertex_count: usize,
) -> Result<Vec<u32>, Fault> {
    let Some(accessor) = primitive.indices else {
        let count = u32::try_from(vertex_count).map_err(|_| {
            Fault::at(here, format!("{vertex_count} vertices are more than 32-bit indices can tell apart"))
        })?;
        accessors.budget.take(u64::from(count), size_of::<u32>() as u64, here)?;
        return Ok((0..count).collect());
    };
    let indices = accessors.indices(accessor.value())?;
    let bad = |&index: &u32| index as usize >= vertex_count || index == indices.restart;
    if let Some(place) = indices.values.iter().position(bad) {
        let index = indices.values[place];
        let problem = if index == indices.restart {
            format!("entry {place} is {index}, the reserved value that restarts a primitive")
        } else {
            format!("entry {place} is {index}, but there are {vertex_count} vertices")
        };
        return Err(Fault::at(format_args!("{here}/indices"), problem));
    }
    Ok(indices.values)
}

/// Vertices and the list of shapes between them.
struct Shape {
    vertices: Vertices,
    indices: Vec<u32>,
}

impl Shape {
    /// Gives every corner a vertex of its own.
    fn unweld(&mut self, accessors: &Accessors<'_>, here: &str) -> Result<(), Fault> {
        let bytes = 4 * self.vertices.words_per_vertex() as u64;
        accessors.budget.take(self.indices.len() as u64, bytes, here)?;
        self.vertices = self.vertices.gather(&self.indices);
        self.indices = (0..self.indices.len() as u32).collect();
        Ok(())
    }

    /// Triangles without normals are flat, and supplied tangents are then ignored (glTF 2.0, 3.7.2.1).
    fn complete_normals(
        &mut self,
        topology: Topology,
        accessors: &Accessors<'_>,
        here: &str,
        notes: &mut Notes,
    ) -> Result<(), Fault> {
        let triangles = if topology == Topology::Triangles { self.indices.as_slice() } else { &[] };
        if let Some(normals) = &mut self.vertices.normals {
            let repaired = normals::repair(normals, &self.vertices.positions, triangles);
            if repaired > 0 {
                let problem = format!("{repaired} normals have no length and are computed");
                notes.add(format_args!("{here}/attributes/NORMAL"), problem);
            }
        } else {
            self.vertices.tangents = None;
            if topology == Topology::Triangles {
                self.unweld(accessors, here)?;
                self.vertices.normals = Some(normals::flat(&self.vertices.positions));
            }
        }
        Ok(())
    }

    /// Tangents are made along the texture coordinates `uv_set`, where something needs them.
    fn complete_tangents(
        &mut self,
        topology: Topology,
        uv_set: Option<usize>,
        accessors: &Accessors<'_>,
        here: &str,
    ) -> Result<(), Fault> {
        let Vertices { normals: Some(normals), tangents, .. } = &mut self.vertices else { return Ok(()) };
        if let Some(tangents) = tangents {
            tangents::repair(tangents, normals);
            return Ok(());
        }
        let Some(uv_set) = uv_set else { return Ok(()) };
        if topology != Topology::Triangles {
            // Points and lines have no gradient of u: any direction across the normal is as good as another.
            *tangents = Some(normals.iter().map(|normal| normal.any_orthonormal_vector().extend(1.0)).collect());
            return Ok(());
        }
        self.unweld(accessors, here)?;
        self.vertices.tangents = Some(tangents::generate(&self.vertices, uv_set));
        (self.vertices, self.indices) = self.vertices.weld();
        Ok(())
    }
}
