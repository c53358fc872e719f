//! Geometry: one vertex layout for everything, triangles (or lines or points) by index.

use glam::{Vec2, Vec3, Vec4};

/// How the indices of a primitive group into shapes. Importers unroll strips, loops and fans into lists.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Topology {
    Points,
    Lines,
    Triangles,
}

impl Topology {
    /// Indices in one point, line or triangle.
    pub fn indices_per_shape(self) -> usize {
        match self {
            Self::Points => 1,
            Self::Lines => 2,
            Self::Triangles => 3,
        }
    }
}

/// One draw's worth of geometry with one material.
///
/// Every attribute that is present has `positions.len()` entries; every index is below that; the number of indices
/// is a multiple of [`Topology::indices_per_shape`].
#[derive(Debug, Clone)]
pub struct Primitive {
    pub topology: Topology,
    /// Object space, metres, finite.
    pub positions: Vec<Vec3>,
    /// Unit vectors. `None` only for points and lines, which are then drawn unlit (glTF 2.0, 3.7.2.1).
    pub normals: Option<Vec<Vec3>>,
    /// xyz: unit tangent toward +u; w: +1 or -1, the sign of the bitangent `cross(normal, tangent.xyz) * w`.
    /// Present whenever the material has a normal texture and there are normals.
    pub tangents: Option<Vec<Vec4>>,
    /// Texture coordinate sets, `TEXCOORD_0` first.
    pub uvs: Vec<Vec<Vec2>>,
    /// Linear RGBA, multiplied with the base colour.
    pub colors: Option<Vec<Vec4>>,
    pub indices: Vec<u32>,
    pub material: usize,
}

/// Primitives that are placed together.
#[derive(Debug, Clone, Default)]
pub struct Mesh {
    pub name: Option<String>,
    pub primitives: Vec<Primitive>,
}
