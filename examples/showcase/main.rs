//! Writes the scene `assets/showcase.glb`: what the materials of glTF 2.0 look like, in one picture.
//!
//! `cargo run --example showcase` from the root of the project; a path as the argument writes elsewhere.

mod geometry;
mod glb;
mod layout;
mod materials;
mod textures;

use geometry::{backdrop, circle, closed_tube, rectangle, round_steps, rounded_box, trefoil, unit_sphere};
use glam::{DQuat, DVec2, DVec3};
use glb::Glb;
use image::ImageResult;
use layout as at;
use materials::Materials;
use serde_json::{Value, json};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let path = std::env::args().nth(1).unwrap_or_else(|| "assets/showcase.glb".into());
    std::fs::write(path, glb()?)?;
    Ok(())
}

/// The file. The same bytes on every run.
pub fn glb() -> ImageResult<Vec<u8>> {
    let mut glb = Glb::default();
    let materials = Materials::add(&mut glb)?;
    let mut nodes = Vec::new();
    nodes.extend(stage(&mut glb, &materials));
    nodes.extend(centerpiece(&mut glb, &materials));
    nodes.extend(spheres(&mut glb, &materials));
    nodes.push(painted_cube(&mut glb, &materials));
    nodes.extend(panels(&mut glb, &materials));
    nodes.push(camera(&mut glb));
    Ok(glb.finish(json!({
        "asset": { "version": "2.0", "generator": "Specula, examples/showcase" },
        "extensionsUsed": ["KHR_materials_emissive_strength", "KHR_materials_ior", "KHR_materials_specular"],
        "scene": 0,
        "scenes": [{ "name": "showcase", "nodes": nodes }],
        "cameras": [{
            "name": "front",
            "type": "perspective",
            "perspective": { "yfov": 0.56, "znear": 0.1 },
        }],
    })))
}

/// Backdrop and steps, both with the occlusion that the rest casts on them.
fn stage(glb: &mut Glb, materials: &Materials) -> [usize; 2] {
    let mut sheet = backdrop(24.0, 5.0, -3.6, 2.4, 9.0);
    sheet.uvs = sheet.vertices.iter().map(|vertex| at::ground_uv(vertex.position.xz_plane())).collect();
    let sheet = glb.geometry(&sheet);
    let steps = glb.geometry(&round_steps(&at::STEPS, 0.018, 64));
    [
        glb.object("backdrop", &sheet, materials.floor, json!({})),
        glb.object("steps", &steps, materials.steps, moved(at::STEPS_CENTER.on_ground(0.0))),
    ]
}

/// The knot and the ring of light behind it.
fn centerpiece(glb: &mut Glb, materials: &Materials) -> [usize; 2] {
    let top = at::STEPS[2].y;
    let knot = closed_tube(trefoil(at::KNOT_SIZE), at::KNOT_TUBE, 108, 12);
    let knot_place = at::STEPS_CENTER.on_ground(top - knot.lowest());
    let knot = glb.geometry(&knot);
    let halo = closed_tube(circle(at::HALO_RADIUS), at::HALO_TUBE, 64, 8);
    let halo_place = at::STEPS_CENTER.on_ground(top - halo.lowest()) + DVec3::Z * at::HALO_Z;
    let halo = glb.geometry(&halo);
    [
        glb.object("knot", &knot, materials.steel, moved(knot_place)),
        glb.object("halo", &halo, materials.halo, moved(halo_place)),
    ]
}

/// Three rows over perceptual roughness, and the one of glass.
fn spheres(glb: &mut Glb, materials: &Materials) -> Vec<usize> {
    let sphere = glb.geometry(&unit_sphere(14));
    let place = |ground: DVec2, height: f64, radius: f64| {
        let mut place = moved(ground.on_ground(height + radius));
        place["scale"] = json!([radius, radius, radius]);
        place
    };
    let mut nodes = Vec::new();
    for (row, of_row) in materials.rows.iter().enumerate() {
        for (ground, material) in at::row_places(row).into_iter().zip(of_row) {
            let place = place(ground, at::row_height(row), at::SPHERE_RADIUS);
            nodes.push(glb.object("sphere", &sphere, *material, place));
        }
    }
    nodes.push(glb.object("glass", &sphere, materials.glass, place(at::GLASS_CENTER, 0.0, at::GLASS_RADIUS)));
    nodes
}

/// A cube whose colour is its place in the colour cube.
fn painted_cube(glb: &mut Glb, materials: &Materials) -> usize {
    let mut cube = rounded_box(DVec3::splat(at::CUBE_HALF), 0.035, 2);
    let color = |p: DVec3| 0.12 + 0.5 * (p / at::CUBE_HALF * 0.5 + 0.5);
    cube.colors = cube.vertices.iter().map(|vertex| color(vertex.position)).collect();
    let cube = glb.geometry(&cube);
    glb.object(
        "cube",
        &cube,
        materials.painted,
        turned(at::CUBE_CENTER.on_ground(at::CUBE_HALF), at::CUBE_TURN_DEGREES),
    )
}

/// The perforated sheet on the left, the enamelled tile in its frame on the right.
fn panels(glb: &mut Glb, materials: &Materials) -> [usize; 3] {
    let half = at::PANEL_HALF;
    let place = |side: usize, forward: f64| {
        let turn = at::PANEL_TURNS_DEGREES[side];
        let offset = DQuat::from_rotation_y(turn.to_radians()) * DVec3::Z * forward;
        turned(at::PANEL_CENTERS[side].on_ground(half.y) + offset, turn)
    };
    let grille = glb.geometry(&rectangle(half.truncate(), 6.0));
    let tile = glb.geometry(&rectangle(half.truncate() - 0.06, 4.0));
    let frame = glb.geometry(&rounded_box(half, 0.02, 2));
    // The tile lies 2 mm before its frame.
    [
        glb.object("grille", &grille, materials.grille, place(0, 0.0)),
        glb.object("frame", &frame, materials.frame, place(1, 0.0)),
        glb.object("tile", &tile, materials.enamel, place(1, half.z + 0.002)),
    ]
}

fn camera(glb: &mut Glb) -> usize {
    let (eye, target) = (DVec3::new(-0.4, 2.35, 6.6), DVec3::new(0.0, 0.74, 0.0));
    let forward = target - eye;
    let pitch = forward.y.atan2(forward.x.hypot(forward.z));
    let yaw = (-forward.x).atan2(-forward.z);
    let mut node = moved(eye);
    node["rotation"] = rotation(DQuat::from_rotation_y(yaw) * DQuat::from_rotation_x(pitch));
    node["name"] = "front".into();
    node["camera"] = 0.into();
    glb.node(node)
}

fn moved(translation: DVec3) -> Value {
    json!({ "translation": translation.to_array().map(rounded) })
}

/// Moved, and turned about +Y.
fn turned(translation: DVec3, degrees: f64) -> Value {
    let mut node = moved(translation);
    node["rotation"] = rotation(DQuat::from_rotation_y(degrees.to_radians()));
    node
}

fn rotation(rotation: DQuat) -> Value {
    json!(rotation.to_array().map(rounded))
}

/// A millionth is enough, and free of the last bits of a platform's sine.
fn rounded(value: f64) -> f64 {
    (value * 1e6).round() / 1e6 + 0.0
}

/// Between places on the ground, (x, z), and space.
trait OnGround {
    fn on_ground(self, height: f64) -> DVec3;
}

impl OnGround for DVec2 {
    fn on_ground(self, height: f64) -> DVec3 {
        DVec3::new(self.x, height, self.y)
    }
}

trait FromAbove {
    fn xz_plane(self) -> DVec2;
}

impl FromAbove for DVec3 {
    fn xz_plane(self) -> DVec2 {
        DVec2::new(self.x, self.z)
    }
}

#[cfg(test)]
mod tests {
    #[test]
    fn the_file_is_small_and_the_one_that_is_committed() {
        let glb = super::glb().unwrap();
        assert!(glb.len() < 200_000, "{} bytes", glb.len());
        let committed = std::fs::read("assets/showcase.glb").unwrap();
        assert!(glb == committed, "run `cargo run --example showcase` and look at the picture");
    }
}
