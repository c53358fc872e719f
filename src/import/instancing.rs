//! Meshes placed many times by one node: EXT_mesh_gpu_instancing.

use super::accessor::Accessors;
use super::error::{Fault, Notes};
use super::extensions::{self, MeshInstancing};
use super::references::within;
use crate::scene::Node;
use glam::{DMat4, DQuat, DVec3};
use std::collections::BTreeMap;

const NAME: &str = "EXT_mesh_gpu_instancing";

/// Gives the nodes that have the extension the places of their meshes.
pub(super) fn import(accessors: &Accessors<'_>, nodes: &mut [Node], notes: &mut Notes) -> Result<(), Fault> {
    for (n, (json, node)) in accessors.root.nodes.iter().zip(nodes).enumerate() {
        let raw = json.extensions.as_ref().map(|raw| &raw.others);
        let here = format!("/nodes/{n}");
        let Some(MeshInstancing { attributes }) = extensions::find(raw, NAME, &here)? else { continue };
        let here = format!("{here}/extensions/{NAME}");
        if node.mesh.is_none() {
            notes.add(here, "the node has no mesh to place, and the extension is ignored");
            continue;
        }
        let reader = Reader { accessors, attributes: &attributes, here: format!("{here}/attributes") };
        node.node_from_objects = Some(reader.places(notes)?);
    }
    Ok(())
}

struct Reader<'a> {
    accessors: &'a Accessors<'a>,
    attributes: &'a BTreeMap<String, u64>,
    here: String,
}

impl Reader<'_> {
    /// Translation, rotation and scale of each instance; what is not given is nothing, none and 1.
    fn places(&self, notes: &mut Notes) -> Result<Vec<DMat4>, Fault> {
        let count = self.count()?;
        let translations = self.finite::<3>("TRANSLATION")?;
        let rotations = self.finite::<4>("ROTATION")?;
        let scales = self.finite::<3>("SCALE")?;
        self.accessors.budget.take(count, size_of::<DMat4>() as u64, &self.here)?;
        let vector = |values: &Option<Vec<[f64; 3]>>, i: usize, otherwise| {
            values.as_ref().map_or(otherwise, |values| DVec3::from_array(values[i]))
        };
        let mut odd = 0_usize;
        let place = |i: usize| {
            let rotation = rotations.as_ref().map_or(DQuat::IDENTITY, |values| DQuat::from_array(values[i]));
            let length = rotation.length();
            // Bytes leave quaternions a little off; far off is an error of the file.
            odd += usize::from((length - 1.0).abs() > 2e-2);
            let rotation = if length > 0.0 { rotation / length } else { DQuat::IDENTITY };
            let scale = vector(&scales, i, DVec3::ONE);
            DMat4::from_scale_rotation_translation(scale, rotation, vector(&translations, i, DVec3::ZERO))
        };
        let places = (0..count as usize).map(place).collect();
        if odd > 0 {
            let problem = format!("{odd} quaternions do not have length 1 and are normalised");
            notes.add(format_args!("{}/ROTATION", self.here), problem);
        }
        Ok(places)
    }

    /// Elements of every attribute, those of the file's own included: all must be there, and have as many.
    fn count(&self) -> Result<u64, Fault> {
        let mut known: Option<(&str, u64)> = None;
        for (name, &index) in self.attributes {
            let pointer = format!("{}/{name}", self.here);
            let index = within(index, self.accessors.root.accessors.len(), "accessors", &pointer)?;
            let count = self.accessors.count(index);
            let (first, expected) = *known.get_or_insert((name, count));
            if count != expected {
                return Err(Fault::at(pointer, format!("has {count} elements, {first} has {expected}")));
            }
        }
        let missing = || Fault::at(&self.here, "names no attribute, so nothing says how often the mesh is placed");
        known.map(|(_, count)| count).ok_or_else(missing)
    }

    fn finite<const N: usize>(&self, name: &str) -> Result<Option<Vec<[f64; N]>>, Fault> {
        let Some(&index) = self.attributes.get(name) else { return Ok(None) };
        let values = self.accessors.floats::<N>(index as usize, false)?;
        if let Some(i) = values.iter().position(|value| !value.iter().all(|x| x.is_finite())) {
            return Err(Fault::at(format_args!("{}/{name}", self.here), format!("element {i} is not finite")));
        }
        Ok(Some(values.into_iter().map(|value| value.map(f64::from)).collect()))
    }
}
