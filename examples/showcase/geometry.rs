//! The shapes of the showcase, as parametric surfaces. Units are metres, triangles run counter-clockwise seen from
//! outside, normals point outward.

use glam::{DVec2, DVec3};
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, TAU};

/// One point of a surface.
#[derive(Clone, Copy)]
pub(crate) struct Vertex {
    pub(crate) position: DVec3,
    pub(crate) normal: DVec3,
}

#[derive(Default)]
pub(crate) struct Mesh {
    pub(crate) vertices: Vec<Vertex>,
    pub(crate) triangles: Vec<[u16; 3]>,
    /// One a vertex, or none.
    pub(crate) uvs: Vec<DVec2>,
    /// One a vertex, or none: linear, in [0, 1].
    pub(crate) colors: Vec<DVec3>,
}

impl Mesh {
    /// A grid of `columns` by `rows` cells over `point(column, row)`; outside is where the cross product of the steps
    /// along columns and rows points.
    fn add_grid(&mut self, columns: u16, rows: u16, point: impl Fn(u16, u16) -> Vertex) {
        let start = self.vertices.len() as u16;
        let index = |column: u16, row: u16| start + row * (columns + 1) + column;
        for row in 0..=rows {
            self.vertices.extend((0..=columns).map(|column| point(column, row)));
        }
        for row in 0..rows {
            for column in 0..columns {
                let [a, b] = [index(column, row), index(column + 1, row)];
                let [c, d] = [index(column + 1, row + 1), index(column, row + 1)];
                self.triangles.extend([[a, b, c], [a, c, d]]);
            }
        }
    }

    pub(crate) fn lowest(&self) -> f64 {
        self.vertices.iter().map(|vertex| vertex.position.y).fold(f64::INFINITY, f64::min)
    }
}

/// The three axes of each face of a cube: right, up, outward.
const FACES: [[DVec3; 3]; 6] = [
    [DVec3::Z, DVec3::Y, DVec3::NEG_X],
    [DVec3::NEG_Z, DVec3::Y, DVec3::X],
    [DVec3::X, DVec3::Z, DVec3::NEG_Y],
    [DVec3::X, DVec3::NEG_Z, DVec3::Y],
    [DVec3::NEG_X, DVec3::Y, DVec3::NEG_Z],
    [DVec3::X, DVec3::Y, DVec3::Z],
];

/// A sphere of radius 1 whose positions are its normals: a cube with `cells` squares along its edges, blown up. Equal
/// angles keep the squares alike in size.
pub(crate) fn unit_sphere(cells: u16) -> Mesh {
    let tangent = |i: u16| ((f64::from(i) / f64::from(cells) * 2.0 - 1.0) * FRAC_PI_4).tan();
    let mut mesh = Mesh::default();
    for [right, up, out] in FACES {
        mesh.add_grid(cells, cells, |column, row| {
            let position = (out + right * tangent(column) + up * tangent(row)).normalize();
            Vertex { position, normal: position }
        });
    }
    mesh
}

/// A box with rounded edges: each face is flat in the middle and bends toward its neighbours in `steps` steps.
pub(crate) fn rounded_box(half_size: DVec3, radius: f64, steps: u16) -> Mesh {
    let last = 2 * steps + 1;
    // Place along an axis on the cube around the box, so that the bend advances by equal angles.
    let along = |i: u16, half: f64| {
        let bend = |k: u16| (half - radius) + radius * (FRAC_PI_4 * f64::from(k) / f64::from(steps)).tan();
        if i <= steps { -bend(steps - i) } else { bend(i - steps - 1) }
    };
    let mut mesh = Mesh::default();
    for [right, up, out] in FACES {
        let half = |axis: DVec3| axis.abs().dot(half_size);
        mesh.add_grid(last, last, |column, row| {
            let on_cube = out * half(out) + right * along(column, half(right)) + up * along(row, half(up));
            let core = half_size - radius;
            let center = on_cube.clamp(-core, core);
            let normal = (on_cube - center).normalize();
            Vertex { position: center + normal * radius, normal }
        });
    }
    mesh
}

/// A tube around a closed curve that runs once for t in [0, 1]. The curve must not point at the origin.
pub(crate) fn closed_tube(curve: impl Fn(f64) -> DVec3, radius: f64, along: u16, around: u16) -> Mesh {
    let mut mesh = Mesh::default();
    mesh.add_grid(along, around, |column, row| {
        let t = f64::from(column % along) / f64::from(along);
        let (before, after) = (curve(t - 1e-4), curve(t + 1e-4));
        let tangent = (after - before).normalize();
        let side = tangent.cross(before + after).normalize();
        let (sin, cos) = (TAU * f64::from(row % around) / f64::from(around)).sin_cos();
        let normal = side.cross(tangent) * cos - side * sin;
        Vertex { position: curve(t) + normal * radius, normal }
    });
    mesh
}

pub(crate) fn circle(radius: f64) -> impl Fn(f64) -> DVec3 {
    move |t| DVec3::new((TAU * t).cos(), (TAU * t).sin(), 0.0) * radius
}

/// The trefoil knot, facing +Z, `size` from its middle to its tips.
pub(crate) fn trefoil(size: f64) -> impl Fn(f64) -> DVec3 {
    move |t| {
        let a = TAU * t;
        DVec3::new(a.sin() + 2.0 * (2.0 * a).sin(), a.cos() - 2.0 * (2.0 * a).cos(), -1.3 * (3.0 * a).sin()) * size
            / 3.0
    }
}

/// Where along a step's share of v its profile has points: foot, three points of the edge, inner end of the top.
pub(crate) const STEP_PROFILE: [f64; 5] = [0.02, 0.22, 0.25, 0.28, 0.98];

/// Round steps about the Y axis, each `(radius, height of its top)`, from the lowest to the highest; edges are rounded
/// with radius `bevel`. Texture coordinates: u runs around, v from 0 at the foot of the lowest step to 1 in the middle;
/// each step has the same share of it, see [`STEP_PROFILE`].
pub(crate) fn round_steps(steps: &[DVec2], bevel: f64, around: u16) -> Mesh {
    let mut mesh = Mesh::default();
    for (i, step) in steps.iter().enumerate() {
        let bottom = if i == 0 { 0.0 } else { steps[i - 1].y };
        let inside = steps.get(i + 1).map_or(0.0, |next| next.x);
        let bend = |k: f64| {
            let (up, out) = (FRAC_PI_2 * k / 2.0).sin_cos();
            let normal = DVec2::new(out, up);
            (*step - bevel + normal * bevel, normal)
        };
        let profile = [
            (DVec2::new(step.x, bottom), DVec2::X),
            bend(0.0),
            bend(1.0),
            bend(2.0),
            (DVec2::new(inside, step.y), DVec2::Y),
        ];
        mesh.add_grid(around, profile.len() as u16 - 1, |column, row| {
            let (sin, cos) = (TAU * f64::from(column % around) / f64::from(around)).sin_cos();
            let (point, normal) = profile[row as usize];
            let turn = |p: DVec2| DVec3::new(p.x * sin, p.y, p.x * cos);
            Vertex { position: turn(point), normal: turn(normal) }
        });
        for v in STEP_PROFILE {
            let v = (i as f64 + v) / steps.len() as f64;
            mesh.uvs.extend((0..=around).map(|column| DVec2::new(f64::from(column) / f64::from(around), v)));
        }
    }
    // The innermost row of the highest step is one point: half of its triangles have no area.
    let Mesh { vertices, triangles, .. } = &mut mesh;
    let place = |i: u16| vertices[i as usize].position;
    triangles.retain(|t| (place(t[1]) - place(t[0])).cross(place(t[2]) - place(t[0])).length() > 1e-12);
    mesh
}

/// The backdrop of a photographer: floor, bend and wall in one sheet, `width` wide; the wall stands at `wall_z`.
pub(crate) fn backdrop(width: f64, front_z: f64, wall_z: f64, bend: f64, wall_height: f64) -> Mesh {
    const BEND_STEPS: u16 = 16;
    // From the top of the wall down and to the front: (z, y) and the normal of the sheet.
    let profile = |row: u16| {
        let up = DVec2::new(1.0, 0.0);
        match row {
            0 => (DVec2::new(wall_z, wall_height), up),
            row if row > BEND_STEPS + 1 => (DVec2::new(front_z, 0.0), DVec2::new(0.0, 1.0)),
            row => {
                let (sin, cos) = (FRAC_PI_2 * f64::from(row - 1) / f64::from(BEND_STEPS)).sin_cos();
                let normal = DVec2::new(cos, sin);
                (DVec2::new(wall_z + bend, bend) - normal * bend, normal)
            }
        }
    };
    let mut mesh = Mesh::default();
    mesh.add_grid(BEND_STEPS + 2, 1, |column, row| {
        let (point, normal) = profile(column);
        let x = (f64::from(row) - 0.5) * width;
        Vertex { position: DVec3::new(x, point.y, point.x), normal: DVec3::new(0.0, normal.y, normal.x) }
    });
    mesh
}

/// A rectangle that faces +Z, `half_size` along X and Y; texture coordinates are `repeats` along its width.
pub(crate) fn rectangle(half_size: DVec2, repeats: f64) -> Mesh {
    let mut mesh = Mesh::default();
    mesh.add_grid(1, 1, |column, row| {
        let corner = DVec2::new(f64::from(column), f64::from(row)) * 2.0 - 1.0;
        Vertex { position: (corner * half_size).extend(0.0), normal: DVec3::Z }
    });
    let uv = |p: DVec3| DVec2::new(half_size.x + p.x, half_size.y - p.y) / (2.0 * half_size.x) * repeats;
    mesh.uvs = mesh.vertices.iter().map(|vertex| uv(vertex.position)).collect();
    mesh
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn triangles_run_counter_clockwise_and_normals_point_outward() {
        let shapes = [
            ("sphere", unit_sphere(6)),
            ("box", rounded_box(DVec3::new(1.0, 0.5, 0.2), 0.1, 2)),
            ("knot", closed_tube(trefoil(1.0), 0.15, 112, 12)),
            ("ring", closed_tube(circle(1.0), 0.1, 24, 8)),
            ("steps", round_steps(&[DVec2::new(1.0, 0.2), DVec2::new(0.5, 0.4)], 0.02, 24)),
            ("backdrop", backdrop(4.0, 3.0, -2.0, 1.0, 3.0)),
            ("rectangle", rectangle(DVec2::ONE, 2.0)),
        ];
        for (name, mesh) in &shapes {
            let mut volume = 0.0;
            for triangle in &mesh.triangles {
                let [a, b, c] = triangle.map(|index| mesh.vertices[index as usize]);
                let face = (b.position - a.position).cross(c.position - a.position);
                volume += a.position.dot(face) / 6.0;
                assert!(face.length() > 1e-9, "{name}: {triangle:?} has no area");
                for vertex in [a, b, c] {
                    assert!((vertex.normal.length() - 1.0).abs() < 1e-12, "{name}: {triangle:?}");
                    assert!(vertex.normal.dot(face.normalize()) > 0.5, "{name}: {triangle:?}");
                }
            }
            let closed = ["sphere", "box", "knot", "ring"].contains(name);
            assert!(!closed || volume > 0.0, "{name} is inside out");
        }
    }
}
