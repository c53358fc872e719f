//! Ingredients from the debug views of a case.

use super::furnace::RETURNED;
use super::seen::Seen;
use super::sketch::{Sketch, content_hash};
use super::{Ingredients, MaterialIngredients, Quantity, TextureHash};
use crate::scene::{
    Channel, Component, Components, Input, LightInWorld, LightKind, LightSource, Pixels, RadianceImage, Scene, View,
};
use glam::{UVec2, Vec3};
use std::collections::BTreeMap;

/// Longest side of the views that are measured: enough for means, at a fraction of the picture's cost.
const SIDE_MAX: u32 = 256;

/// Faults of the radiance: red where it is NaN, green where it is infinite, blue where it is negative.
pub(super) const FAULTS: &str = "nan";

/// How much of a pixel the device has covered.
pub(super) const COVERAGE: &str = "coverage";

/// How the words for an environment among the lights begin.
pub(super) const SURROUNDINGS: &str = "environment";

/// How the names of its light begin, and of the light of all others.
pub(super) const FROM_SURROUNDINGS: &str = "ibl";
pub(super) const FROM_LIGHTS: &str = "direct";

/// The size of the views for a picture of a size, pixels.
pub(in crate::cli::test) fn size(picture_px: UVec2) -> UVec2 {
    no_larger(picture_px, SIDE_MAX)
}

/// The size, or a smaller one of the same shape, whose longest side is `side_max` at most.
pub(super) fn no_larger(picture_px: UVec2, side_max: u32) -> UVec2 {
    let longest = picture_px.max_element();
    if longest <= side_max {
        return picture_px;
    }
    let shrunk = picture_px.as_dvec2() * f64::from(side_max) / f64::from(longest);
    shrunk.round().as_uvec2().max(UVec2::ONE)
}

/// What is measured of a scene, by name: the inputs of shading, the light by where it comes from and which lobe has sent
/// it on, and the faults; of a furnace, what surfaces return. Light that the scene cannot have is left out.
pub(in crate::cli::test) fn channels(scene: &Scene, is_furnace: bool) -> Vec<(String, Channel)> {
    let mut channels: Vec<_> =
        Input::ALL.into_iter().map(|input| (input.name().to_owned(), Channel::Input(input))).collect();
    let has_lights = !scene.lights_in_world().is_empty();
    let has_disney = scene.materials.iter().any(|material| material.disney.is_some());
    let sources = [
        (FROM_LIGHTS, LightSource::Punctual, has_lights),
        (FROM_SURROUNDINGS, LightSource::Environment, scene.lit_environment().is_some()),
    ];
    for (prefix, source, _) in sources.into_iter().filter(|(.., is_there)| *is_there) {
        for component in Component::ALL {
            if has_disney || !matches!(component, Component::Sheen | Component::Clearcoat) {
                let name = format!("{prefix}-{}", component.name().replace(' ', "-"));
                channels.push((name, Channel::Radiance { source, components: Components::of(&[component]) }));
            }
        }
    }
    channels.push((FAULTS.into(), Channel::Nan));
    if is_furnace {
        channels.push((RETURNED.into(), Channel::Furnace));
    }
    channels
}

/// Ingredients on their way.
pub(in crate::cli::test) struct Gathering {
    ingredients: Ingredients,
    /// Of each pixel that is measured the place of its material in the ingredients.
    measured: Vec<Option<usize>>,
}

impl Gathering {
    /// Finds out which material each pixel of the view shows. `scale` is the width of the picture over that of the view;
    /// `surroundings` says what the environment is.
    pub(in crate::cli::test) fn new(scene: &Scene, view: &View, scale: f64, surroundings: &str) -> Self {
        let seen = Seen::of(scene, view);
        let Seen { nearest, measured, materials } = &seen;
        let width = view.size_px.x as usize;
        let mut hashes = BTreeMap::new();
        let materials = materials.iter().enumerate().map(|(place, &index)| {
            let pixels: Vec<usize> = (0..nearest.len()).filter(|&pixel| nearest[pixel] == Some(place)).collect();
            let count = pixels.len().max(1) as f64;
            let middle = |of: fn(usize, usize) -> usize| {
                pixels.iter().map(|&pixel| of(pixel, width) as f64 + 0.5).sum::<f64>() / count
            };
            MaterialIngredients {
                name: seen.name(scene, place),
                pixels: pixels.len() as u32,
                measured: measured.iter().filter(|&&other| other == Some(place)).count() as u32,
                center_px: [middle(|pixel, width| pixel % width), middle(|pixel, width| pixel / width)].map(six_digits),
                textures: textures(scene, index, &mut hashes),
                quantities: Vec::new(),
            }
        });
        let materials = materials.collect();
        let environment = scene.lit_environment().map(|environment| {
            let degrees = environment.rotation_rad.to_degrees();
            let (intensity, degrees) = (digits(environment.intensity), digits(degrees));
            format!("{SURROUNDINGS} {surroundings} of intensity {intensity}, turned by {degrees} degrees")
        });
        let lights = scene.lights_in_world().iter().map(light).chain(environment).collect();
        let ingredients = Ingredients { size_px: view.size_px.to_array(), scale, lights, materials, left_out: 0 };
        Self { ingredients, measured: seen.measured }
    }

    /// Measures a channel, whose image is in the units that it is reported in.
    pub(in crate::cli::test) fn take(&mut self, name: &str, image: &RadianceImage) {
        // An edge holds a mean of what is covered, multiplied with its coverage.
        let value = |texel: glam::Vec4| if texel.w > 0.0 { texel.truncate() / texel.w } else { Vec3::ZERO };
        self.measure(name, image, value);
        if name == Input::Position.name() {
            self.measure(COVERAGE, image, |texel| Vec3::splat(texel.w));
        }
    }

    fn measure(&mut self, name: &str, image: &RadianceImage, value: impl Fn(glam::Vec4) -> Vec3) {
        let mut sketches = vec![Sketch::default(); self.ingredients.materials.len()];
        for (pixel, (texel, seen)) in image.texels.iter().zip(&self.measured).enumerate() {
            if let Some(material) = *seen {
                let value = value(*texel);
                sketches[material].add(pixel, if value.is_finite() { value } else { Vec3::ZERO });
            }
        }
        for (material, sketch) in self.ingredients.materials.iter_mut().zip(sketches) {
            let [mean, spread] = [sketch.mean(), sketch.spread()].map(|moment| moment.map(six_digits));
            let quantity = Quantity { name: name.to_owned(), mean, spread, sketch: sketch.sums() };
            // What is not listed is zero.
            if !quantity.is_nothing() {
                material.quantities.push(quantity);
            }
        }
    }

    pub(in crate::cli::test) fn finish(self) -> Ingredients {
        self.ingredients.bounded()
    }
}

/// The number with so many digits as matter.
fn six_digits(value: f64) -> f64 {
    format!("{value:.5e}").parse().unwrap_or(value)
}

/// The same as text.
fn digits(value: f64) -> String {
    let value = six_digits(value);
    let is_handy = value == 0.0 || (1e-4..1e6).contains(&value.abs());
    if is_handy { format!("{value}") } else { format!("{value:e}") }
}

/// The textures of a material; `known` has those of images that were asked for before.
fn textures(scene: &Scene, material: usize, known: &mut BTreeMap<usize, String>) -> Vec<TextureHash> {
    let mut hash = |image: usize| {
        let hash = known.entry(image).or_insert_with(|| match &scene.images[image].pixels {
            Pixels::Rgba8(texels) => content_hash(texels),
            Pixels::Rgba16(texels) => content_hash(bytemuck::cast_slice(texels)),
            Pixels::OfHost => content_hash(&[]),
        });
        hash.clone()
    };
    let used = scene.materials[material].textures();
    used.map(|(slot, texture)| TextureHash {
        slot: slot.name().into(),
        hash: hash(scene.textures[texture.texture].image),
    })
    .collect()
}

/// A light in words, with all that makes it what it is.
fn light(light: &LightInWorld) -> String {
    let LightInWorld { kind, intensity, position_in_world, direction_in_world } = light;
    let [intensity, position, direction] = [intensity, position_in_world, direction_in_world].map(|vector| {
        let [x, y, z] = vector.to_array().map(digits);
        if x == y && y == z { x } else { format!("({x}, {y}, {z})") }
    });
    let range = |range_m: &Option<f64>| range_m.map_or_else(String::new, |m| format!(", range {} m", digits(m)));
    match kind {
        LightKind::Point { range_m } => format!("point light of {intensity} cd at {position} m{}", range(range_m)),
        LightKind::Spot { range_m, inner_cone_rad, outer_cone_rad } => format!(
            "spot light of {intensity} cd at {position} m toward {direction}, cones of {:.6} and {:.6} degrees{}",
            inner_cone_rad.to_degrees(),
            outer_cone_rad.to_degrees(),
            range(range_m)
        ),
        LightKind::Directional => format!("directional light of {intensity} lux toward {direction}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn views_are_no_larger_than_they_need_be() {
        assert_eq!(size(UVec2::new(96, 64)), UVec2::new(96, 64));
        assert_eq!(size(UVec2::new(1024, 512)), UVec2::new(256, 128));
        assert_eq!(size(UVec2::new(16384, 1)), UVec2::new(256, 1));
    }
}
