//! What the choice of microfacet model looks like.
//!
//! `cargo run --release --example microfacets` writes two pictures into `docs/pictures`, or into the folder that is
//! given: `fresnel.png`, four metals (gold, copper, iron, aluminium) with Schlick's, Lazanyi's and the exact Fresnel curve; and
//! `anisotropic.png`, discs whose facets are spread along circles, with more and more anisotropy.

use glam::{DMat4, DVec3, UVec2, Vec2, Vec3, Vec4};
use specula::bake::{environment, studio};
use specula::capture::{CaptureOptions, CaptureTarget, Wanted, submit};
use specula::gpu::{Gpu, GpuOptions, GpuRequest};
use specula::progress::Silent;
use specula::reference::microfacet::Metal;
use specula::renderer::Renderer;
use specula::scene::{
    Background, Camera, Environment, EnvironmentImage, Light, LightKind, Material, Mesh, MetalFresnel, Node, Primitive,
    Projection, Scene, Topology, View, framing::default_view, shapes,
};
use std::f32::consts::TAU;
use std::path::{Path, PathBuf};

type Failure = Box<dyn std::error::Error>;

fn main() -> Result<(), Failure> {
    let folder: PathBuf = std::env::args().nth(1).unwrap_or_else(|| "docs/pictures".into()).into();
    let gpu = Gpu::open(&GpuRequest::default(), GpuOptions::default())?;
    for (name, scene, columns, rows) in [("fresnel", metals(studio::studio())?, 3, 4), ("anisotropic", discs(), 4, 1)] {
        let view = view(&scene, columns, rows, 130);
        let pixels = frame(&gpu, &scene, &view)?;
        save(&folder.join(format!("{name}.png")), view.size_px, &pixels)?;
    }
    Ok(())
}

fn save(path: &Path, size: UVec2, pixels: &[u8]) -> Result<(), Failure> {
    let rgb: Vec<u8> = pixels.chunks_exact(4).flat_map(|texel| [texel[0], texel[1], texel[2]]).collect();
    image::save_buffer(path, &rgb, size.x, size.y, image::ColorType::Rgb8)?;
    Ok(())
}

fn frame(gpu: &Gpu, scene: &Scene, view: &View) -> Result<Vec<u8>, Failure> {
    let maps = scene.environment.as_ref().map(|e| environment::bake(&e.image, &Default::default(), &Silent));
    let mut renderer = Renderer::new(&gpu.device, &gpu.queue);
    let mut uploaded = renderer.upload(&gpu.device, &gpu.queue, scene, maps.as_ref())?;
    let target = CaptureTarget::new(gpu, view, CaptureOptions::default())?;
    let wanted = Wanted { radiance: false, display: true };
    let captured = submit(gpu, &mut renderer, &mut uploaded, view, &target, wanted)?.wait(gpu)?;
    captured.display.ok_or_else(|| "the frame was not read back".into())
}

/// Rows: gold, copper, iron, aluminium. Columns: Schlick, Lazanyi, exact. They differ toward the rim, where metals dip
/// before they turn into mirrors.
fn metals(room: EnvironmentImage) -> Result<Scene, Failure> {
    let mut scene = Scene { environment: Some(Environment::new(room)), ..Default::default() };
    for (row, symbol) in ["au", "cu", "fe", "al"].into_iter().enumerate() {
        let metal = Metal::by_symbol(symbol).ok_or("a metal is missing in the table")?;
        let curves = [MetalFresnel::Schlick, MetalFresnel::Lazanyi { a: metal.a.as_vec3() }, metal.conductor()];
        for (column, curve) in curves.into_iter().enumerate() {
            let place = DVec3::new(column as f64, -(row as f64), 0.0);
            add(&mut scene, metal.material(0.25, curve), place, |material| shapes::sphere(0.46, 48, material));
        }
    }
    Ok(scene)
}

/// Anisotropy from none to full, under one light and in the dim studio.
fn discs() -> Scene {
    let studio = Environment { intensity: 0.3, ..Environment::new(studio::studio()) };
    let mut scene = Scene { environment: Some(studio), ..Default::default() };
    for (column, anisotropy_strength) in [0.0, 0.4, 0.7, 1.0].into_iter().enumerate() {
        let material = Material {
            base_color: Vec4::new(0.91, 0.92, 0.92, 1.0),
            perceptual_roughness: 0.3,
            anisotropy_strength,
            ..Default::default()
        };
        add(&mut scene, material, DVec3::new(column as f64, 0.0, 0.0), disc);
    }
    let sun = Camera::look_at(DVec3::new(0.5, 0.8, 2.0), DVec3::ZERO, DVec3::Y, ORTHOGRAPHIC, 0.1, 1.0);
    scene.lights.push(Light { name: None, kind: LightKind::Directional, color: DVec3::ONE, intensity: 2.0 });
    scene.roots.push(scene.nodes.len());
    scene.nodes.push(Node { parent_from_node: sun.world_from_view, light: Some(0), ..Default::default() });
    scene
}

const ORTHOGRAPHIC: Projection = Projection::Orthographic { height_m: 1.0 };

fn add(scene: &mut Scene, material: Material, place: DVec3, shape: impl Fn(usize) -> Primitive) {
    let index = scene.meshes.len();
    scene.meshes.push(Mesh { name: None, primitives: vec![shape(index)] });
    scene.materials.push(material);
    scene.roots.push(scene.nodes.len());
    scene.nodes.push(Node {
        parent_from_node: DMat4::from_translation(place),
        mesh: Some(index),
        ..Default::default()
    });
}

/// A flat ring that faces +Z. Its tangents point outward: grooves run around it, and facets lean across them.
fn disc(material: usize) -> Primitive {
    const SEGMENTS: u32 = 128;
    let ring = |radius: f32| {
        (0..=SEGMENTS).map(move |i| Vec2::from_angle(TAU * i as f32 / SEGMENTS as f32) * radius).collect::<Vec<_>>()
    };
    let points = [ring(0.06), ring(0.47)].concat();
    let quad = |i: u32| {
        let outer = i + SEGMENTS + 1;
        [i, outer, outer + 1, i, outer + 1, i + 1]
    };
    Primitive {
        topology: Topology::Triangles,
        positions: points.iter().map(|point| point.extend(0.0)).collect(),
        normals: Some(vec![Vec3::Z; points.len()]),
        tangents: Some(points.iter().map(|point| point.normalize().extend(0.0).extend(1.0)).collect()),
        uvs: Vec::new(),
        colors: None,
        indices: (0..SEGMENTS).flat_map(quad).collect(),
        material,
    }
}

/// Cells of one metre, the first at the origin, rows downward.
fn view(scene: &Scene, columns: u32, rows: u32, cell_px: u32) -> View {
    let middle = 0.5 * DVec3::new(f64::from(columns) - 1.0, 1.0 - f64::from(rows), 0.0);
    let projection = Projection::Orthographic { height_m: f64::from(rows) };
    View {
        camera: Camera::look_at(middle + 10.0 * DVec3::Z, middle, DVec3::Y, projection, 1.0, 20.0),
        background: Background::Color(Vec3::splat(0.11)),
        ..default_view(scene, UVec2::new(columns, rows) * cell_px)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn the_models_differ_where_they_should() {
        let gpu = Gpu::open(&GpuRequest::default(), GpuOptions::default()).unwrap();
        // In a white room nothing but the curve differs.
        let scene = metals(studio::white()).unwrap();
        let view = view(&scene, 3, 4, 32);
        let pixels = frame(&gpu, &scene, &view).unwrap();
        // Mean of a cell's red: Schlick's iron is too bright at the rim, Lazanyi's follows the exact curve.
        let mean = |column: u32, row: u32| {
            let texel = |x: u32, y: u32| pixels[4 * (((row * 32 + y) * 96) + column * 32 + x) as usize];
            (0..32 * 32).map(|i| f64::from(texel(i % 32, i / 32))).sum::<f64>() / 1024.0
        };
        for row in [2, 3] {
            let [schlick, lazanyi, exact] = [0, 1, 2].map(|column| mean(column, row));
            assert!(schlick > exact + 0.2, "row {row}: {schlick} {exact}");
            assert!((lazanyi - exact).abs() < 0.5 * (schlick - exact), "row {row}: {schlick} {lazanyi} {exact}");
        }
    }
}
