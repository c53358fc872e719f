//! The floor of a frame: what the device takes at best for the same pixels, lookups and targets.

use super::Rates;
use super::kinds::{Fill, Op, Tap, Target};
use super::work::{Work, fragment_work};
use crate::cli::clock::{Basis, FrameTimes};
use crate::frame::{Drawables, forward_features};
use crate::gpu::formats::Precision;
use crate::reference::geometry::Ray;
use crate::reference::surface::World;
use crate::scene::{Background, Scene, View};
use crate::shader::{
    Backdrop, DisplayFeatures, SceneFeatures, ShaderError, ShaderSources, background_module, display_module,
    forward_module,
};
use rayon::prelude::*;
use serde::Serialize;
use std::collections::BTreeMap;

/// Rays through the picture that tell what its pixels show.
const RAYS: u32 = 1 << 16;
/// The lights that reach a point are counted for every so many rays.
const LIGHTS_EVERY: u32 = 8;
/// Scenes of more triangles are not traced: their places alone take gigabytes.
const TRIANGLES_MAX: usize = 3_000_000;

/// What a frame consists of.
#[derive(Debug, Clone, Copy)]
pub(in crate::cli) struct FloorOf<'a> {
    pub(in crate::cli) scene: &'a Scene,
    pub(in crate::cli) view: &'a View,
    /// As uploaded.
    pub(in crate::cli) features: SceneFeatures,
    pub(in crate::cli) precision: Precision,
    pub(in crate::cli) samples: u32,
}

/// The floor, and what is in it: every pixel of the radiance target is filled once, with its samples, depth and resolve,
/// and once in the picture that is displayed; the nearest surface of each pixel (and those that are seen through) is
/// shaded once, in its middle, by the forward shader, with the lights that reach it; the panorama is seen in the rest.
/// Vertices, triangles, edges, hidden surfaces, lights that are looked at in vain, and reads of buffers are not in it.
#[derive(Debug, Clone, Serialize)]
pub(in crate::cli) struct Floor {
    pixels: u64,
    /// Pixels that a surface covers, of all, in [0, 1]; more where surfaces are seen through others.
    covered: f64,
    /// Point, spot and directional lights that reach a covered pixel, on average.
    lights_a_covered_pixel: f64,
    /// Lookups and operations of a covered pixel, on average.
    taps_a_covered_pixel: f64,
    multiply_adds_a_covered_pixel: f64,
    /// Targets and resolve, of radiance and display.
    fill_ms: f64,
    /// Of surfaces, panorama and display.
    taps_ms: f64,
    /// As the shaders are written.
    arithmetic_ms: f64,
    /// All of it.
    pub(in crate::cli) ms: f64,
    /// The median of the frames over it.
    pub(in crate::cli) ratio: Option<f64>,
    /// The same without the arithmetic: pixels, lookups and resolve alone.
    pub(in crate::cli) ratio_to_fill_and_taps: Option<f64>,
}

/// How many pixels show what.
struct Seen {
    /// By mesh and primitive, each layer that is seen.
    surfaces: BTreeMap<(usize, usize), f64>,
    /// Not hidden by any surface.
    background: f64,
    /// That reach a surface, on average.
    lights: f64,
}

impl FloorOf<'_> {
    /// The fills that [`Self::floor`] asks for.
    pub(in crate::cli) fn fills(&self) -> [Fill; 2] {
        let radiance = Fill { target: Target::Radiance(self.precision), samples: self.samples, depth: true };
        [radiance, Fill { target: Target::Display, samples: 1, depth: false }]
    }

    /// The floor with rates that were measured, and `median` of the frame's times over it. `None` for scenes that are too
    /// large to be traced.
    ///
    /// # Errors
    /// When a shader is broken.
    pub(in crate::cli) fn floor(&self, rates: &Rates, median: &FrameTimes) -> Result<Option<Floor>, ShaderError> {
        let triangles = |mesh: usize| self.scene.meshes[mesh].primitives.iter().map(|p| p.indices.len() / 3);
        let placed = self.scene.instances().iter().flat_map(|instance| triangles(instance.mesh)).sum::<usize>();
        let fills: Option<Vec<f64>> = self.fills().into_iter().map(|fill| rates.fill_ns(fill)).collect();
        let (Some(fills), true) = (fills, placed <= TRIANGLES_MAX) else { return Ok(None) };
        let seen = self.seen();
        let surfaces = self.surface_work(&seen)?;
        let size = self.view.size_px;
        let pixels = f64::from(size.x) * f64::from(size.y);
        let mut work = surfaces;
        work.add(&self.display_work()?, pixels);
        if self.view.background == Background::Environment && self.features.environment {
            let panorama = fragment_work(&background_module(&ShaderSources::default(), Backdrop::Sharp)?.parse()?);
            work.add(&panorama.unwrap_or_default().pixel, seen.background);
        }
        let covered: f64 = seen.surfaces.values().sum();
        let fill_ms = fills.iter().sum::<f64>() * pixels * 1e-6;
        let (taps_ms, arithmetic_ms) = rates.ms_of(&work);
        let ms = fill_ms + taps_ms + arithmetic_ms;
        let measured = rates.basis.of(median);
        let (surface_taps, surface_ops) = counts(&surfaces);
        Ok(Some(Floor {
            pixels: u64::from(size.x) * u64::from(size.y),
            covered: covered / pixels,
            lights_a_covered_pixel: seen.lights,
            taps_a_covered_pixel: surface_taps / covered.max(1.0),
            multiply_adds_a_covered_pixel: surface_ops / covered.max(1.0),
            fill_ms,
            taps_ms,
            arithmetic_ms,
            ms,
            ratio: measured.map(|measured| measured / ms),
            ratio_to_fill_and_taps: measured.map(|measured| measured / (fill_ms + taps_ms)),
        }))
    }

    fn seen(&self) -> Seen {
        let world = World::new(self.scene, self.view);
        let lights = self.scene.lights_in_world();
        let (width, height) = (self.view.size_px.x, self.view.size_px.y);
        let step = (f64::from(width) * f64::from(height) / f64::from(RAYS)).sqrt().ceil().max(1.0) as u32;
        let (columns, rows) = (width.div_ceil(step), height.div_ceil(step));
        let surfaces_at = |i: u32| {
            let pixel = glam::UVec2::new(i % columns, i / columns) * step;
            let (origin, direction) = self.view.camera.ray(pixel.as_dvec2() + 0.5, self.view.size_px);
            let layers = world.layers(&Ray { origin, direction, t_min: 0.0, t_max: f64::INFINITY });
            let is_open = layers.iter().all(|layer| layer.alpha < 1.0);
            let draws = layers.iter().map(|layer| world.geometry.draw(&layer.hit));
            let places: Vec<_> = draws.map(|draw| (draw.instance.mesh, draw.primitive_index)).collect();
            let first = layers.first().filter(|_| i.is_multiple_of(LIGHTS_EVERY));
            let reaching = first.map(|layer| {
                let point = origin + direction * layer.hit.t;
                lights.iter().filter(|light| light.reaches(point)).count()
            });
            (places, is_open, reaching)
        };
        let rays: Vec<_> = (0..columns * rows).into_par_iter().map(surfaces_at).collect();
        let weight = f64::from(width) * f64::from(height) / rays.len().max(1) as f64;
        let (lit, count) =
            rays.iter().filter_map(|(.., reaching)| *reaching).fold((0, 0), |(l, n), at| (l + at, n + 1));
        let mut seen =
            Seen { surfaces: BTreeMap::new(), background: 0.0, lights: lit as f64 / f64::from(count.max(1)) };
        for (places, is_open, _) in rays {
            places.into_iter().for_each(|place| *seen.surfaces.entry(place).or_default() += weight);
            seen.background += if is_open { weight } else { 0.0 };
        }
        seen
    }

    /// Of all pixels that surfaces cover.
    fn surface_work(&self, seen: &Seen) -> Result<Work, ShaderError> {
        let drawables = Drawables::new(self.scene, self.features);
        let mut of_shader: BTreeMap<_, f64> = BTreeMap::new();
        for (place, pixels) in &seen.surfaces {
            let Some(drawable) = drawables.find(*place) else { continue };
            *of_shader.entry(forward_features(self.features, self.view, drawable).module_key()).or_default() += pixels;
        }
        let mut work = Work::default();
        for (features, pixels) in of_shader {
            let module = forward_module(&ShaderSources::default(), &features)?.parse()?;
            let shader = fragment_work(&module).unwrap_or_default();
            work.add(&shader.pixel, pixels);
            work.add(&shader.light, pixels * seen.lights);
        }
        Ok(work)
    }

    fn display_work(&self) -> Result<Work, ShaderError> {
        let features = DisplayFeatures { tone_map: self.view.tone_map, encode_srgb: true };
        let module = display_module(&ShaderSources::default(), features)?.parse()?;
        Ok(fragment_work(&module).unwrap_or_default().pixel)
    }
}

/// Lookups, and multiply-adds.
fn counts(work: &Work) -> (f64, f64) {
    (Tap::ALL.map(|tap| work.taps(tap)).iter().sum(), work.ops(Op::MultiplyAdd))
}

impl Rates {
    /// Lookups and arithmetic, ms.
    fn ms_of(&self, work: &Work) -> (f64, f64) {
        let taps = Tap::ALL.map(|tap| work.taps(tap) * self.taps[tap as usize]);
        let ops = Op::ALL.map(|op| work.ops(op) * self.ops[op as usize]);
        (taps.iter().sum::<f64>() * 1e-6, ops.iter().sum::<f64>() * 1e-6)
    }
}

impl Floor {
    /// In sentences.
    pub(in crate::cli) fn text(&self, basis: Basis) -> String {
        let times = |ratio: Option<f64>| ratio.map_or_else(|| "-".into(), |ratio| format!("{ratio:.2}"));
        format!(
            "The floor is {:.1} ms of {}: {:.1} fill and resolve {} pixels, {:.1} are lookups, {:.1} arithmetic. \
             Surfaces cover {:.0} % of the pixels, each with {:.1} lights, {:.1} lookups and {:.0} multiply-adds. \
             The frame takes {} of the floor, and {} of its fill and lookups alone.\n",
            self.ms,
            basis.name(),
            self.fill_ms,
            self.pixels,
            self.taps_ms,
            self.arithmetic_ms,
            100.0 * self.covered,
            self.lights_a_covered_pixel,
            self.taps_a_covered_pixel,
            self.multiply_adds_a_covered_pixel,
            times(self.ratio),
            times(self.ratio_to_fill_and_taps),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cli::clock::Basis;
    use crate::scene::framing::default_view;
    use crate::scene::{Light, LightKind, Mesh, Node, shapes};
    use glam::{DVec3, UVec2};

    /// A lit sphere over a black background: nine tenths of the picture's side.
    fn sphere() -> Scene {
        let mut scene = Scene {
            nodes: vec![Node { mesh: Some(0), ..Default::default() }],
            roots: vec![0],
            meshes: vec![Mesh { name: None, primitives: vec![shapes::sphere(1.0, 64, 0)] }],
            materials: vec![Default::default()],
            ..Default::default()
        };
        let light = Light { name: None, kind: LightKind::Directional, color: DVec3::ONE, intensity: 1.0 };
        scene.add_light(light, DVec3::ZERO, DVec3::NEG_Y);
        scene
    }

    fn rates(of: &FloorOf<'_>, fill: f64, taps: f64, ops: f64) -> Rates {
        let fills = of.fills().into_iter().map(|one| (one, fill)).collect();
        Rates { basis: Basis::Wall, fills, taps: [taps; _], ops: [ops; _] }
    }

    #[test]
    fn a_floor_is_pixels_lookups_and_operations_by_their_rates() {
        let scene = sphere();
        let view = default_view(&scene, UVec2::splat(64));
        let features = SceneFeatures::of(&scene);
        let of = FloorOf { scene: &scene, view: &view, features, precision: Precision::Half, samples: 4 };
        let median = FrameTimes { wall_ms: 10.0, cpu_ms: None, gpu_ms: None };
        let floor = |fill, taps, ops| of.floor(&rates(&of, fill, taps, ops), &median).unwrap().unwrap();
        let fill = floor(1.0, 0.0, 0.0);
        // Two targets of 4096 pixels, a nanosecond each.
        assert!((fill.ms - 2.0 * 4096e-6).abs() < 1e-12 && fill.ms == fill.fill_ms, "{fill:?}");
        assert_eq!(fill.ratio, Some(10.0 / fill.ms));
        assert!((fill.covered - 0.25 * std::f64::consts::PI * 0.81).abs() < 0.01, "{fill:?}");
        let taps = floor(0.0, 1.0, 0.0);
        // The split-sum table for the view and for the light, and a texel for each pixel that is displayed.
        assert_eq!(taps.taps_a_covered_pixel, 2.0);
        assert!((taps.taps_ms - 4096e-6 * (2.0 * taps.covered + 1.0)).abs() < 1e-9, "{taps:?}");
        let all = floor(1.0, 1.0, 1.0);
        assert!((all.ms - all.fill_ms - all.taps_ms - all.arithmetic_ms).abs() < 1e-12 && all.arithmetic_ms > 0.0);
        assert_eq!(all.ratio_to_fill_and_taps, Some(10.0 / (all.fill_ms + all.taps_ms)));
        let text = all.text(Basis::Wall);
        assert!(text.contains("of wall time") && text.contains("cover 6"), "{text}");
    }

    #[test]
    fn what_was_not_measured_has_no_floor() {
        let scene = sphere();
        let view = default_view(&scene, UVec2::splat(8));
        let features = SceneFeatures::of(&scene);
        let of = FloorOf { scene: &scene, view: &view, features, precision: Precision::Half, samples: 4 };
        let other = FloorOf { samples: 1, ..of };
        let median = FrameTimes { wall_ms: 1.0, cpu_ms: None, gpu_ms: None };
        assert!(of.floor(&rates(&other, 1.0, 1.0, 1.0), &median).unwrap().is_none());
    }
}
