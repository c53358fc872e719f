//! What the reference's tests share: small scenes, and a chi-square test for samplers.

mod paths;
mod pictures;

use super::sampling::PixelSampler;
use super::*;
use crate::math::spaces::direction_from_equirect;
use crate::progress::Silent;
use crate::scene::*;
use glam::{DMat4, DVec2, DVec3, UVec2, Vec2, Vec3, Vec4};
use std::f64::consts::{PI, TAU};

/// A camera at (0, 0, 4) that looks at the origin through 64 x 64 pixels; nothing behind the scene.
pub(in crate::reference) fn view() -> View {
    let projection = Projection::Perspective { fov_y_rad: 0.6 };
    View {
        camera: Camera::look_at(DVec3::Z * 4.0, DVec3::ZERO, DVec3::Y, projection, 0.1, 100.0),
        size_px: UVec2::splat(64),
        exposure_ev: 0.0,
        tone_map: ToneMap::Neutral,
        background: Background::Transparent,
        background_blur: 0.0,
        energy_compensation: true,
        geometry: Geometry::default(),
        quality: Default::default(),
        term: None,
        channel: None,
    }
}

/// A unit sphere of `rings` by `2 rings` quads with smooth normals, and tangents toward +u.
pub(in crate::reference) fn sphere(rings: u32) -> Primitive {
    let (mut positions, mut normals, mut tangents, mut uvs) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    let columns = 2 * rings;
    for row in 0..=rings {
        for column in 0..=columns {
            let uv = DVec2::new(f64::from(column) / f64::from(columns), f64::from(row) / f64::from(rings));
            // Mirrored, so that u runs to the right as seen from outside.
            // The last column repeats the first, and the poles themselves, to the bit: a closed surface.
            let turn = f64::from(column % columns) / f64::from(columns);
            let normal = match row {
                0 => DVec3::Y,
                _ if row == rings => DVec3::NEG_Y,
                _ => direction_from_equirect(DVec2::new(1.0 - turn, uv.y)),
            };
            let ahead = direction_from_equirect(DVec2::new(0.75 - turn, 0.5));
            positions.push(normal.as_vec3());
            normals.push(normal.as_vec3());
            tangents.push(ahead.as_vec3().extend(1.0));
            uvs.push(uv.as_vec2());
        }
    }
    let mut indices = Vec::new();
    for row in 0..rings {
        for column in 0..columns {
            let corner = row * (columns + 1) + column;
            let below = corner + columns + 1;
            indices.extend([corner, below, corner + 1, corner + 1, below, below + 1]);
        }
    }
    Primitive {
        topology: Topology::Triangles,
        positions,
        normals: Some(normals),
        tangents: Some(tangents),
        uvs: vec![uvs],
        colors: None,
        indices,
        material: 0,
    }
}

/// A square of side 2 in the plane z = `z` that faces +Z.
pub(in crate::reference) fn square(z: f32, material: usize) -> Primitive {
    Primitive {
        topology: Topology::Triangles,
        positions: [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, y)| Vec3::new(x, y, z)).to_vec(),
        normals: Some(vec![Vec3::Z; 4]),
        tangents: None,
        uvs: vec![[(0.0, 1.0), (1.0, 1.0), (1.0, 0.0), (0.0, 0.0)].map(|(u, v)| Vec2::new(u, v)).to_vec()],
        colors: None,
        indices: vec![0, 1, 2, 0, 2, 3],
        material,
    }
}

/// One mesh of one primitive, at the origin.
pub(in crate::reference) fn scene_of(primitive: Primitive, material: Material) -> Scene {
    Scene {
        nodes: vec![Node { mesh: Some(0), parent_from_node: DMat4::IDENTITY, ..Node::default() }],
        roots: vec![0],
        meshes: vec![Mesh { name: None, primitives: vec![primitive] }],
        materials: vec![material],
        ..Scene::default()
    }
}

pub(in crate::reference) fn add_light(scene: &mut Scene, kind: LightKind, intensity: f64, place: DVec3) {
    scene.lights.push(Light { name: None, kind, color: DVec3::ONE, intensity });
    let node = Node {
        light: Some(scene.lights.len() - 1),
        parent_from_node: DMat4::from_translation(place),
        ..Node::default()
    };
    scene.roots.push(scene.nodes.len());
    scene.nodes.push(node);
}

pub(in crate::reference) fn options(samples: u32) -> ReferenceOptions<'static> {
    ReferenceOptions { samples, seed: 1, progress: &Silent }
}

pub(in crate::reference) fn texel(image: &RadianceImage, x: u32, y: u32) -> glam::DVec4 {
    image.texels[(y * image.width + x) as usize].as_dvec4()
}

/// Pearson's statistic of a sampler against its density.
#[derive(Debug)]
pub(in crate::reference) struct ChiSquare {
    statistic: f64,
    degrees: f64,
}

impl ChiSquare {
    /// Within five standard deviations of its mean. A chi-square of k degrees has mean k and variance 2k.
    pub(in crate::reference) fn is_plausible(&self) -> bool {
        self.statistic < self.degrees + 5.0 * (2.0 * self.degrees).sqrt()
    }
}

/// Draws 100 000 directions and compares their histogram over 16 x 32 cells of equal solid angle with the density.
pub(in crate::reference) fn chi_square_of_directions(
    sample: impl Fn(DVec2) -> DVec3,
    pdf: impl Fn(DVec3) -> f64,
) -> ChiSquare {
    const ROWS: usize = 16;
    const COLUMNS: usize = 32;
    const SAMPLES: u32 = 100_000;
    let mut observed = vec![0.0; ROWS * COLUMNS];
    for i in 0..SAMPLES {
        // Every index is a pixel of its own: independent numbers, as the test presumes.
        let d = sample(PixelSampler::new(99, i, 0).pair(0, 0));
        let row = ((0.5 - 0.5 * d.z) * ROWS as f64) as usize;
        let column = ((d.y.atan2(d.x) / TAU).rem_euclid(1.0) * COLUMNS as f64) as usize;
        observed[row.min(ROWS - 1) * COLUMNS + column.min(COLUMNS - 1)] += 1.0;
    }
    // Cells that expect few samples are thrown together.
    let (mut statistic, mut degrees, mut rest) = (0.0, -1.0, (0.0, 0.0));
    let mut add = |observed: f64, expected: f64| {
        statistic += (observed - expected).powi(2) / expected;
        degrees += 1.0;
    };
    for (cell, &count) in observed.iter().enumerate() {
        let expected = f64::from(SAMPLES) * cell_probability(&pdf, cell / COLUMNS, cell % COLUMNS, ROWS, COLUMNS);
        if expected < 10.0 {
            rest = (rest.0 + count, rest.1 + expected);
        } else {
            add(count, expected);
        }
    }
    if rest.0 > 0.0 || rest.1 > 1.0 {
        add(rest.0, rest.1.max(1e-9));
    }
    ChiSquare { statistic, degrees }
}

/// Integral of a density over a cell, by midpoints: densities may have steps.
fn cell_probability(pdf: &impl Fn(DVec3) -> f64, row: usize, column: usize, rows: usize, columns: usize) -> f64 {
    const N: usize = 40;
    let mut sum = 0.0;
    for i in 0..N {
        let z = 1.0 - 2.0 * (row as f64 + (i as f64 + 0.5) / N as f64) / rows as f64;
        let sin = (1.0 - z * z).sqrt();
        for j in 0..N {
            let phi = TAU * (column as f64 + (j as f64 + 0.5) / N as f64) / columns as f64;
            sum += pdf(DVec3::new(sin * phi.cos(), sin * phi.sin(), z));
        }
    }
    sum * 4.0 * PI / (rows * columns * N * N) as f64
}
