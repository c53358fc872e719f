//! Fields of small patches, made in code: what instances, culling, order of depth and materials are measured by.

use super::{
    Background, Camera, Light, LightKind, Material, Mesh, MetalFresnel, Node, Primitive, Projection, Scene, Topology,
    View, framing, shapes::sphere,
};
use glam::{DMat4, DVec3, UVec2, Vec3};

/// Quads across and down a patch: 100 triangles.
const QUADS: (u32, u32) = (10, 5);

/// Where the camera stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sight {
    /// Before ten by ten patches.
    Near,
    /// Before a field of patches one unit wide.
    Far,
}

/// A square picture of `side_px` pixels. Every round but each seventh looks from another place, 0.1 mm to the side, so that
/// every frame is planned anew.
pub fn view(sight: Sight, side_px: u32, round: usize) -> View {
    let (distance, height_m) = match sight {
        Sight::Near => (12.0, 10.0),
        Sight::Far => (2.0, 1.0),
    };
    let eye = DVec3::new(1e-4 * (round % 7) as f64, 0.0, distance);
    let projection = Projection::Perspective { fov_y_rad: 2.0 * (0.5 * height_m / distance).atan() };
    let camera = Camera::look_at(eye, DVec3::ZERO, DVec3::Y, projection, 0.1, 100.0);
    let background = Background::Color(Vec3::splat(0.16));
    View { camera, background, ..framing::default_view(&Default::default(), UVec2::splat(side_px)) }
}

/// How those beside the picture are made.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    Copies,
    /// No two are the same.
    Meshes,
}

/// Patches of half a unit: some in ten by ten units before the camera, others behind it and to the sides.
pub fn crowd(visible: usize, hidden: usize, kind: Kind) -> Scene {
    let mut scene = lit();
    for i in 0..visible {
        let place = DVec3::new((i % 10) as f64 - 4.5, (i / 10 % 10) as f64 - 4.5, 0.0) * 0.9;
        push(&mut scene, 0, place, 0.8);
    }
    for i in 0..hidden {
        let side = if i % 2 == 0 { 1.0 } else { -1.0 };
        let (row, column) = ((i / 2 % 100) as f64, (i / 200) as f64);
        let place = if i % 3 == 0 {
            DVec3::new(row - 50.0, column - 25.0, 30.0 + side)
        } else {
            DVec3::new(side * (20.0 + row), column - 25.0, -5.0)
        };
        let mesh = if kind == Kind::Meshes { scene.meshes.len() } else { 0 };
        if kind == Kind::Meshes {
            scene.meshes.push(Mesh { name: None, primitives: vec![patch(&[(1.0 + 1e-3 * i as f32, Vec3::ZERO)])] });
        }
        push(&mut scene, mesh, place, 0.8);
    }
    scene
}

/// A closed sphere of 16 128 triangles that has patches inside, out of sight.
pub fn hull(inside: usize) -> Scene {
    let mut scene = lit();
    scene.meshes.push(Mesh { name: None, primitives: vec![sphere(1.0, 64, 0)] });
    push(&mut scene, 1, DVec3::ZERO, 4.0);
    let across = (inside as f64).cbrt().ceil().max(1.0) as usize;
    for i in 0..inside {
        let steps = [i % across, i / across % across, i / across / across];
        let [x, y, z] = steps.map(|step| (step as f64 + 0.5) / across as f64 - 0.5);
        push(&mut scene, 0, 4.0 * DVec3::new(x, y, z), 2.0 / across as f64);
    }
    scene
}

/// How sheets are listed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Order {
    FrontToBack,
    BackToFront,
}

/// Patches that fill the picture, one behind the other, of so many materials with six pipelines at most.
pub fn sheets(order: Order, materials: usize) -> Scene {
    let mut scene = Scene { meshes: Vec::new(), ..lit() };
    of_materials(&mut scene, materials);
    for i in 0..32 {
        let depth = if order == Order::FrontToBack { i } else { 31 - i };
        // Materials in an order of their own.
        push(&mut scene, i * 13 % materials, DVec3::NEG_Z * depth as f64, 50.0);
    }
    scene
}

/// A thousand small meshes beside each other, no two the same, of so many materials with six pipelines.
pub fn mixture(materials: usize) -> Scene {
    let mut scene = Scene { meshes: Vec::new(), ..lit() };
    of_materials(&mut scene, materials);
    for i in 0..1000 {
        let place = DVec3::new((i % 32) as f64 - 16.0, (i / 32) as f64 - 16.0, (i * 7 % 13) as f64 * 0.01) * 0.28;
        let shape = patch(&[(1.0 + 1e-4 * i as f32, Vec3::ZERO)]);
        let primitives = vec![Primitive { material: i % materials, ..shape }];
        let mesh = scene.meshes.len();
        scene.meshes.push(Mesh { name: None, primitives });
        push(&mut scene, mesh, place, 0.25);
    }
    scene
}

/// Replaces the materials by so many, with a mesh of one patch for each.
fn of_materials(scene: &mut Scene, count: usize) {
    scene.materials = (0..count).map(material).collect();
    let mesh = |material| vec![Primitive { material, ..patch(&[(1.0, Vec3::ZERO)]) }];
    scene.meshes = (0..count).map(|material| Mesh { name: None, primitives: mesh(material) }).collect();
}

/// Materials of six pipelines, in turn.
fn material(index: usize) -> Material {
    let (n, k, a) = (Vec3::ONE, Vec3::ONE, Vec3::ONE);
    let curves = [MetalFresnel::Schlick, MetalFresnel::Lazanyi { a }, MetalFresnel::Conductor { n, k, a }];
    let (metal_fresnel, double_sided) = (curves[index % 3], index / 3 % 2 == 1);
    Material { metallic: 0.5 + 0.01 * (index % 50) as f32, metal_fresnel, double_sided, ..Default::default() }
}

/// `count` patches that fill a square of one unit: each an instance, or all one mesh.
pub fn field(count: usize, one_mesh: bool) -> Scene {
    let mut scene = lit();
    let across = (count as f64).sqrt().ceil() as usize;
    let size = 0.9 / across as f64;
    let place = |i: usize| {
        let [x, y] = [i % across, i / across].map(|step| (step as f64 + 0.5) / across as f64 - 0.5);
        // Away from the camera, so that none leaves the picture.
        DVec3::new(x, y, -0.01 * (i % 17) as f64)
    };
    if one_mesh {
        let places: Vec<(f32, Vec3)> = (0..count).map(|i| (size as f32, place(i).as_vec3())).collect();
        scene.meshes = vec![Mesh { name: None, primitives: vec![patch(&places)] }];
        push(&mut scene, 0, DVec3::ZERO, 1.0);
    } else {
        (0..count).for_each(|i| push(&mut scene, 0, place(i), size));
    }
    scene
}

/// A mesh of one patch, and a light.
fn lit() -> Scene {
    let light = Light { name: None, kind: LightKind::Directional, color: DVec3::ONE, intensity: 3.0 };
    let toward = DMat4::from_rotation_x(-0.5);
    Scene {
        nodes: vec![Node { parent_from_node: toward, light: Some(0), ..Default::default() }],
        roots: vec![0],
        meshes: vec![Mesh { name: None, primitives: vec![patch(&[(1.0, Vec3::ZERO)])] }],
        materials: vec![Material { metallic: 0.0, ..Default::default() }],
        lights: vec![light],
        ..Default::default()
    }
}

fn push(scene: &mut Scene, mesh: usize, place: DVec3, size: f64) {
    let parent_from_node = DMat4::from_translation(place) * DMat4::from_scale(DVec3::splat(size));
    scene.roots.push(scene.nodes.len());
    scene.nodes.push(Node { parent_from_node, mesh: Some(mesh), ..Default::default() });
}

/// Bulging squares toward +Z, of these sizes at these places.
fn patch(places: &[(f32, Vec3)]) -> Primitive {
    let (across, down) = QUADS;
    let (mut positions, mut normals, mut indices) = (Vec::new(), Vec::new(), Vec::new());
    for &(size, place) in places {
        let first = positions.len() as u32;
        for i in 0..(across + 1) * (down + 1) {
            let [x, y] = [(i % (across + 1)) as f32 / across as f32, (i / (across + 1)) as f32 / down as f32]
                .map(|fraction| fraction - 0.5);
            let point = Vec3::new(x, y, (1.0 - x * x - y * y).sqrt() - 0.9);
            positions.push(place + point * size);
            normals.push((point + 0.9 * Vec3::Z).normalize());
        }
        for (row, column) in (0..down).flat_map(|row| (0..across).map(move |column| (row, column))) {
            let a = first + row * (across + 1) + column;
            let b = a + across + 1;
            indices.extend([a, a + 1, b + 1, a, b + 1, b]);
        }
    }
    Primitive {
        topology: Topology::Triangles,
        positions,
        normals: Some(normals),
        tangents: None,
        uvs: Vec::new(),
        colors: None,
        indices,
        material: 0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_hold_what_they_are_asked_for() {
        let instances = |scene: &Scene| scene.instances().len();
        assert_eq!(instances(&crowd(100, 1000, Kind::Copies)), 1100);
        let meshes = crowd(100, 1000, Kind::Meshes);
        assert_eq!((instances(&meshes), meshes.meshes.len()), (1100, 1001));
        assert_eq!(instances(&hull(1000)), 1001);
        assert_eq!(instances(&sheets(Order::BackToFront, 4)), 32);
        let mixture = mixture(200);
        assert_eq!((instances(&mixture), mixture.materials.len()), (1000, 200));
        let triangles = |scene: &Scene| scene.meshes[0].primitives[0].indices.len() / 3 * instances(scene);
        let [one, many] = [true, false].map(|one_mesh| field(400, one_mesh));
        assert_eq!((instances(&one), instances(&many)), (1, 400));
        assert_eq!((triangles(&one), triangles(&many)), (40_000, 40_000));
    }
}
