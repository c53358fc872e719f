//! The well-known picture of the Disney BRDF: a row for each parameter, from 0 on the left to 1 on the right.
//!
//! `cargo run --release --example disney_grid` writes `docs/pictures/disney.png`; a path as the argument writes
//! elsewhere.

use glam::{DMat4, DVec3, UVec2, Vec3};
use image::ImageEncoder;
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use specula::bake::{environment, studio};
use specula::capture::{CaptureOptions, CaptureTarget, Wanted, submit};
use specula::gpu::{Gpu, GpuOptions, GpuRequest};
use specula::progress::Silent;
use specula::renderer::Renderer;
use specula::scene::{
    Background, Camera, Environment, Light, LightKind, Mesh, Node, Projection, Scene, ToneMap, View, disney_grid::ROWS,
    shapes,
};

const COLUMNS: u32 = 11;

/// Side of a sphere's cell in the picture, pixels.
const CELL_PX: u32 = 50;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let path = std::env::args().nth(1).unwrap_or_else(|| "docs/pictures/disney.png".into());
    let (size, pixels) = frame(CELL_PX)?;
    let file = std::io::BufWriter::new(std::fs::File::create(path)?);
    let png = PngEncoder::new_with_quality(file, CompressionType::Best, FilterType::Adaptive);
    png.write_image(&pixels, size.x, size.y, image::ExtendedColorType::Rgb8)?;
    Ok(())
}

/// The size of the picture with cells of `cell_px` pixels, and its pixels: three bytes each, from the top left.
pub fn frame(cell_px: u32) -> Result<(UVec2, Vec<u8>), Box<dyn std::error::Error>> {
    let gpu = Gpu::open(&GpuRequest::default(), GpuOptions::default())?;
    let (scene, view) = (scene(), view(cell_px));
    let maps = scene.environment.as_ref().map(|e| environment::bake(&e.image, &Default::default(), &Silent));
    let mut renderer = Renderer::new(&gpu.device, &gpu.queue);
    let mut uploaded = renderer.upload(&gpu.device, &gpu.queue, &scene, maps.as_ref())?;
    let target = CaptureTarget::new(&gpu, &view, CaptureOptions::default())?;
    let wanted = Wanted { radiance: false, display: true };
    let captured = submit(&gpu, &mut renderer, &mut uploaded, &view, &target, wanted)?.wait(&gpu)?;
    let rgba = captured.display.unwrap_or_default();
    Ok((view.size_px, rgba.chunks_exact(4).flat_map(|texel| [texel[0], texel[1], texel[2]]).collect()))
}

/// Unit cells, the first sphere at the origin, rows downward.
fn scene() -> Scene {
    let mut scene = Scene { environment: Some(Environment::new(studio::studio())), ..Scene::default() };
    for (row, (_, material_of)) in ROWS.iter().enumerate() {
        for column in 0..COLUMNS {
            let index = scene.meshes.len();
            scene.materials.push(material_of(column as f32 / (COLUMNS - 1) as f32));
            scene.meshes.push(Mesh { name: None, primitives: vec![shapes::sphere(0.44, 32, index)] });
            let place = DVec3::new(f64::from(column), -(row as f64), 0.0);
            scene.nodes.push(Node {
                parent_from_node: DMat4::from_translation(place),
                mesh: Some(index),
                ..Node::default()
            });
        }
    }
    let toward_light = Camera::look_at(
        DVec3::new(-0.9, 1.3, 1.6),
        DVec3::ZERO,
        DVec3::Y,
        Projection::Orthographic { height_m: 1.0 },
        0.1,
        1.0,
    );
    scene.lights.push(Light { name: None, kind: LightKind::Directional, color: DVec3::ONE, intensity: 1.6 });
    scene.nodes.push(Node { parent_from_node: toward_light.world_from_view, light: Some(0), ..Node::default() });
    scene.roots = (0..scene.nodes.len()).collect();
    scene
}

fn view(cell_px: u32) -> View {
    let rows = ROWS.len() as u32;
    let middle = 0.5 * DVec3::new(f64::from(COLUMNS - 1), 1.0 - f64::from(rows), 0.0);
    let projection = Projection::Orthographic { height_m: f64::from(rows) };
    View {
        camera: Camera::look_at(middle + 10.0 * DVec3::Z, middle, DVec3::Y, projection, 1.0, 20.0),
        size_px: UVec2::new(COLUMNS, rows) * cell_px,
        exposure_ev: -0.6,
        tone_map: ToneMap::Neutral,
        background: Background::Color(Vec3::splat(0.11)),
        background_blur: 0.0,
        energy_compensation: true,
        geometry: Default::default(),
        quality: Default::default(),
        term: None,
        channel: None,
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    const CELL_PX: u32 = 16;

    /// Mean difference of two cells, in steps of 255.
    fn difference(pixels: &[u8], row: u32, columns: [u32; 2]) -> f64 {
        let texel = |column: u32, x: u32, y: u32| {
            let place = (row * CELL_PX + y) * super::COLUMNS * CELL_PX + column * CELL_PX + x;
            &pixels[3 * place as usize..][..3]
        };
        let cell = (0..CELL_PX).flat_map(|y| (0..CELL_PX).map(move |x| (x, y)));
        let steps = cell.flat_map(|(x, y)| {
            let [a, b] = columns.map(|column| texel(column, x, y));
            [0, 1, 2].map(|channel| f64::from(a[channel].abs_diff(b[channel])))
        });
        steps.sum::<f64>() / f64::from(3 * CELL_PX * CELL_PX)
    }

    #[test]
    fn every_row_changes_from_left_to_right_and_more_so_the_farther() {
        let (size, pixels) = super::frame(CELL_PX).unwrap();
        assert_eq!(pixels.len() as u32, 3 * size.x * size.y);
        for row in 0..super::ROWS.len() as u32 {
            let [near, far] = [[0, 3], [0, 10]].map(|columns| difference(&pixels, row, columns));
            assert!(far > 1.0 && far > near, "row {row}: {near} and {far}");
        }
    }
}
