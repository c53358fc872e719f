//! A floor with bodies under a field of many lights, made in code: what many lights are measured and tested by.

use super::{
    Background, Camera, Light, LightKind, Material, Mesh, Node, Primitive, Projection, Scene, Topology, View, framing,
    shapes,
};
use glam::{DMat4, DVec3, UVec2, Vec3, Vec4};

/// Side of the floor, metres.
pub const FLOOR_M: f32 = 64.0;
/// Bodies along each side of the floor.
const BODIES: u32 = 8;

/// How the lights are made.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LightField {
    /// Rounded up to a full square.
    pub lights: u32,
    /// Where each ends, metres.
    pub range_m: Option<f64>,
    /// Every so many of them is a spot light that looks down aslant; 0 is none, 1 all.
    pub spot_every: u32,
}

impl LightField {
    /// The scene: lights on a jittered square grid, a quarter to three quarters of its
    /// spacing above the floor, in all hues. However many there
    /// are, and however far they reach, the floor is about as bright.
    pub fn scene(&self) -> Scene {
        let mut scene = floor_with_bodies();
        let side = f64::from(self.lights).sqrt().ceil().max(1.0) as u32;
        let cell_m = f64::from(FLOOR_M) / f64::from(side);
        // Light of one in its cell, or of all of them that reach a point.
        let intensity = 6.0 * cell_m.powi(2) * (1.0 / self.range_m.map_or(1.0, |range_m| range_m.max(1.0))).min(1.0);
        for index in 0..side * side {
            let random = |salt: u32| unit(hash(index * 8 + salt));
            let cell = |along: u32, salt| (f64::from(along) + random(salt)) * cell_m - 0.5 * f64::from(FLOOR_M);
            let position = DVec3::new(cell(index % side, 0), cell_m * (0.25 + 0.5 * random(1)), cell(index / side, 2));
            let is_spot = self.spot_every > 0 && index % self.spot_every == 0;
            let direction = DVec3::new(random(3) - 0.5, -1.0, random(4) - 0.5).normalize();
            let outer_cone_rad = 0.2 + 0.7 * random(5);
            let kind = if is_spot {
                LightKind::Spot { range_m: self.range_m, inner_cone_rad: 0.5 * outer_cone_rad, outer_cone_rad }
            } else {
                LightKind::Point { range_m: self.range_m }
            };
            let light = Light { name: None, kind, color: hue(random(6)), intensity };
            scene.add_light(light, position, direction);
        }
        scene
    }
}

/// A square picture of `side_px` pixels on nothing, 1 cm further to the side in every round, so that lights are sorted
/// anew.
pub fn view(side_px: u32, round: u32) -> View {
    let mut camera = camera();
    camera.world_from_view.w_axis.x += 0.01 * f64::from(round);
    let view = framing::default_view(&Scene::default(), UVec2::splat(side_px));
    View { camera, background: Background::Transparent, ..view }
}

/// Looks over the field from one of its sides; the floor fills the picture.
pub fn camera() -> Camera {
    let projection = Projection::Perspective { fov_y_rad: 0.7 };
    Camera::look_at(DVec3::new(0.0, 14.0, 30.0), DVec3::new(0.0, 0.0, 6.0), DVec3::Y, projection, 0.1, 1000.0)
}

fn floor_with_bodies() -> Scene {
    let half = 0.5 * FLOOR_M;
    let corners = [(-half, half), (half, half), (half, -half), (-half, -half)];
    let floor = Primitive {
        topology: Topology::Triangles,
        positions: corners.map(|(x, z)| Vec3::new(x, 0.0, z)).to_vec(),
        normals: Some(vec![Vec3::Y; 4]),
        tangents: None,
        uvs: Vec::new(),
        colors: None,
        indices: vec![0, 1, 2, 0, 2, 3],
        material: 0,
    };
    let material = |base_color, metallic, perceptual_roughness| Material {
        base_color,
        metallic,
        perceptual_roughness,
        ..Default::default()
    };
    let mut scene = Scene {
        meshes: [floor, shapes::sphere(0.8, 24, 1)]
            .map(|primitive| Mesh { name: None, primitives: vec![primitive] })
            .into(),
        materials: vec![
            material(Vec4::new(0.6, 0.6, 0.6, 1.0), 0.0, 0.6),
            material(Vec4::new(0.9, 0.85, 0.8, 1.0), 1.0, 0.35),
        ],
        ..Default::default()
    };
    let cell = f64::from(FLOOR_M) / f64::from(BODIES);
    let place = |along: u32| (f64::from(along) + 0.5) * cell - 0.5 * f64::from(FLOOR_M);
    let bodies = (0..BODIES * BODIES).map(|i| (1, DVec3::new(place(i % BODIES), 0.8, place(i / BODIES))));
    for (mesh, position) in std::iter::once((0, DVec3::ZERO)).chain(bodies) {
        scene.roots.push(scene.nodes.len());
        scene.nodes.push(Node {
            parent_from_node: DMat4::from_translation(position),
            mesh: Some(mesh),
            ..Default::default()
        });
    }
    scene
}

/// Linear Rec.709 of a hue in [0, 1), the largest channel 1.
fn hue(turn: f64) -> DVec3 {
    let channel = |shift: f64| (0.5 + 0.5 * ((turn + shift) * std::f64::consts::TAU).cos()).powi(2);
    let color = DVec3::new(channel(0.0), channel(1.0 / 3.0), channel(2.0 / 3.0));
    color / color.max_element()
}

/// Uniform in [0, 1).
fn unit(bits: u32) -> f64 {
    f64::from(bits) / (f64::from(u32::MAX) + 1.0)
}

/// PCG hash (Jarzynski and Olano 2020, "Hash Functions for GPU Rendering").
fn hash(x: u32) -> u32 {
    let state = x.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
    let word = ((state >> ((state >> 28) + 4)) ^ state).wrapping_mul(277_803_737);
    (word >> 22) ^ word
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_field_has_the_lights_that_are_asked_for() {
        let field = LightField { lights: 64, range_m: Some(4.0), spot_every: 4 };
        let lights = field.scene().lights_in_world();
        assert_eq!(lights.len(), 64);
        let spots = lights.iter().filter(|light| matches!(light.kind, LightKind::Spot { .. })).count();
        assert_eq!(spots, 16);
        assert!(lights.iter().all(|light| light.intensity.max_element() > 0.0 && light.direction_in_world.y < 0.0));
        let half = 0.5 * f64::from(FLOOR_M);
        assert!(lights.iter().all(|light| light.position_in_world.abs().max_element() <= half));
    }
}
