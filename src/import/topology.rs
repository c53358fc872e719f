//! The seven primitive modes, unrolled to lists of points, lines and triangles.

use crate::scene::Topology;
use gltf::json::mesh::Mode;

/// What a mode draws.
pub(super) fn topology(mode: Mode) -> Topology {
    match mode {
        Mode::Points => Topology::Points,
        Mode::Lines | Mode::LineLoop | Mode::LineStrip => Topology::Lines,
        Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan => Topology::Triangles,
    }
}

/// Unrolls `indices` to a list, in the order of glTF 2.0, 3.7.2.1, which keeps the winding of strips and fans.
/// Vertices that complete no shape are left out.
pub(super) fn unroll(mode: Mode, mut indices: Vec<u32>) -> Vec<u32> {
    let shapes = |vertices: usize| indices.len().saturating_sub(vertices - 1);
    match mode {
        Mode::Points => indices,
        Mode::Lines | Mode::Triangles => {
            let whole = indices.len() - indices.len() % topology(mode).indices_per_shape();
            indices.truncate(whole);
            indices
        }
        Mode::LineStrip => indices.windows(2).flatten().copied().collect(),
        Mode::LineLoop if indices.len() < 2 => Vec::new(),
        Mode::LineLoop => {
            let closing = [indices[indices.len() - 1], indices[0]];
            indices.windows(2).flatten().copied().chain(closing).collect()
        }
        Mode::TriangleStrip => {
            (0..shapes(3)).flat_map(|i| [indices[i], indices[i + 1 + i % 2], indices[i + 2 - i % 2]]).collect()
        }
        Mode::TriangleFan => (0..shapes(3)).flat_map(|i| [indices[i + 1], indices[i + 2], indices[0]]).collect(),
    }
}
