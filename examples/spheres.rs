//! Writes the scene `assets/spheres.glb`: plastic, gold and white metal, from smooth to rough, for measuring light.
//!
//! `cargo run --example spheres` from the root of the project; a path as the argument writes elsewhere.

#[path = "showcase/geometry.rs"]
#[allow(dead_code, reason = "the showcase has more shapes")]
mod geometry;
#[path = "showcase/glb.rs"]
#[allow(dead_code, reason = "the showcase has textures")]
mod glb;

use geometry::unit_sphere;
use glb::Glb;
use serde_json::json;

/// Perceptual roughness goes from 0 to 1 in as many steps.
const COLUMNS: u32 = 6;
const SPACING_M: f64 = 2.2;
/// Cells on a side of each of the six patches of a sphere.
const CELLS: u16 = 16;

/// Name, base colour and metallic of each row, from the top.
const ROWS: [(&str, [f64; 3], f64); 3] =
    [("white metal", [0.95, 0.95, 0.95], 1.0), ("gold", [1.0, 0.77, 0.34], 1.0), ("plastic", [0.55, 0.08, 0.06], 0.0)];

fn main() -> std::io::Result<()> {
    let path = std::env::args().nth(1).unwrap_or_else(|| "assets/spheres.glb".into());
    std::fs::write(path, glb())
}

/// The file. The same bytes on every run.
pub fn glb() -> Vec<u8> {
    let mut glb = Glb::default();
    let sphere = glb.geometry(&unit_sphere(CELLS));
    let mut nodes = vec![lamp(&mut glb)];
    for (row, (name, color, metallic)) in ROWS.into_iter().enumerate() {
        for column in 0..COLUMNS {
            let perceptual_roughness = f64::from(column) / f64::from(COLUMNS - 1);
            let name = format!("{name} {perceptual_roughness}");
            let material = glb.material(json!({
                "name": name,
                "pbrMetallicRoughness": {
                    "baseColorFactor": [color[0], color[1], color[2], 1.0],
                    "metallicFactor": metallic,
                    "roughnessFactor": perceptual_roughness,
                },
            }));
            let x = SPACING_M * (f64::from(column) - 0.5 * f64::from(COLUMNS - 1));
            let y = SPACING_M * (1.0 - row as f64);
            nodes.push(glb.object(&name, &sphere, material, json!({ "translation": [x, y, 0.0] })));
        }
    }
    glb.finish(json!({
        "asset": { "version": "2.0", "generator": "Specula, examples/spheres" },
        "extensionsUsed": ["KHR_lights_punctual"],
        "extensions": { "KHR_lights_punctual": { "lights": [
            { "name": "lamp", "type": "point", "color": [1.0, 0.9, 0.8], "intensity": 120.0 },
        ] } },
        "scene": 0,
        "scenes": [{ "name": "spheres", "nodes": nodes }],
    }))
}

/// To the left, above and before the spheres.
fn lamp(glb: &mut Glb) -> usize {
    glb.node(json!({
        "name": "lamp",
        "translation": [-6.0, 7.0, 8.0],
        "extensions": { "KHR_lights_punctual": { "light": 0 } },
    }))
}

#[cfg(test)]
mod tests {
    #[test]
    fn the_file_is_small_and_the_one_that_is_committed() {
        let glb = super::glb();
        assert!(glb.len() < 60_000, "{} bytes", glb.len());
        let committed = std::fs::read("assets/spheres.glb").unwrap_or_default();
        assert!(glb == committed, "run `cargo run --example spheres`");
    }
}
