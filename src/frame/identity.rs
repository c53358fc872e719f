//! Which primitives are the same, whatever mesh they are listed in: exporters write one mesh a node.

use crate::scene::{Primitive, Scene};
use std::collections::HashMap;
use std::hash::{DefaultHasher, Hash, Hasher};

/// A primitive by its mesh and its place in it.
pub type PrimitivePlace = (usize, usize);

/// For every primitive of every mesh, the first that is drawn in the same way: the same bits and the same material.
///
/// Data are hashed only of primitives that are as large as another one, and believed only when compared.
pub(super) fn first_of_same(scene: &Scene) -> Vec<Vec<PrimitivePlace>> {
    let mut by_shape: HashMap<_, Vec<PrimitivePlace>> = HashMap::new();
    for (m, mesh) in scene.meshes.iter().enumerate() {
        for (p, primitive) in mesh.primitives.iter().enumerate() {
            by_shape.entry(shape(primitive)).or_default().push((m, p));
        }
    }
    let mut first: Vec<Vec<PrimitivePlace>> =
        scene.meshes.iter().enumerate().map(|(m, mesh)| (0..mesh.primitives.len()).map(|p| (m, p)).collect()).collect();
    for places in by_shape.into_values().filter(|places| places.len() > 1) {
        let mut by_data: HashMap<u64, Vec<PrimitivePlace>> = HashMap::new();
        for place in places {
            let primitive = at(scene, place);
            let known = by_data.entry(hash(primitive)).or_default();
            match known.iter().find(|&&other| are_same(primitive, at(scene, other))) {
                Some(&same) => first[place.0][place.1] = same,
                None => known.push(place),
            }
        }
    }
    first
}

fn at(scene: &Scene, (mesh, primitive): PrimitivePlace) -> &Primitive {
    &scene.meshes[mesh].primitives[primitive]
}

/// What is known without reading the data.
fn shape(primitive: &Primitive) -> impl Hash + Eq + use<> {
    let Primitive { topology, positions, normals, tangents, uvs, colors, indices, material } = primitive;
    let attributes = (normals.is_some(), tangents.is_some(), colors.is_some(), uvs.len());
    (*material, *topology, positions.len(), indices.len(), attributes)
}

/// The bytes of all attributes and of the indices, in the same order for primitives of one shape.
fn data(primitive: &Primitive) -> impl Iterator<Item = &[u8]> {
    fn bytes<T: bytemuck::NoUninit>(values: &[T]) -> &[u8] {
        bytemuck::cast_slice(values)
    }
    [bytes(&primitive.positions), bytes(&primitive.indices)]
        .into_iter()
        .chain(primitive.normals.iter().map(|values| bytes(values)))
        .chain(primitive.tangents.iter().map(|values| bytes(values)))
        .chain(primitive.colors.iter().map(|values| bytes(values)))
        .chain(primitive.uvs.iter().map(|values| bytes(values)))
}

fn hash(primitive: &Primitive) -> u64 {
    let mut hasher = DefaultHasher::new();
    data(primitive).for_each(|bytes| hasher.write(bytes));
    hasher.finish()
}

fn are_same(a: &Primitive, b: &Primitive) -> bool {
    data(a).eq(data(b))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Mesh, shapes};

    #[test]
    fn copies_are_found_and_what_differs_in_a_bit_is_not_one() {
        let sphere = shapes::sphere(1.0, 8, 0);
        let mut other_position = sphere.clone();
        other_position.positions[7].x += 1e-6;
        let mut other_index = sphere.clone();
        other_index.indices.swap(0, 1);
        let other_material = Primitive { material: 1, ..sphere.clone() };
        let without_uvs = Primitive { uvs: Vec::new(), ..sphere.clone() };
        let mesh = |primitives: Vec<Primitive>| Mesh { name: None, primitives };
        let scene = Scene {
            meshes: vec![
                mesh(vec![sphere.clone(), other_position, other_index]),
                mesh(vec![other_material.clone(), without_uvs, sphere.clone()]),
                mesh(vec![sphere, other_material]),
            ],
            ..Default::default()
        };
        let expected = [vec![(0, 0), (0, 1), (0, 2)], vec![(1, 0), (1, 1), (0, 0)], vec![(0, 0), (1, 0)]];
        assert_eq!(first_of_same(&scene), expected);
    }
}
