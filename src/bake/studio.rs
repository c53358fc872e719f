//! Environments that need no file: a neutral photographic studio, and constants.

use crate::math::spaces::direction_from_equirect;
use crate::scene::EnvironmentImage;
use glam::{DVec2, DVec3, Vec3};

/// Size of the studio's panorama, texels.
const SIZE: (u32, u32) = (512, 256);

/// A lamp behind a diffuser: a rectangle with soft edges, on the sphere around the scene.
struct SoftBox {
    /// Toward the middle of the box, need not be unit length.
    center: DVec3,
    /// Half extents along its horizontal and its other axis, as tangents of the angles.
    half_size: DVec2,
    /// Width of the edge over which it fades, in the same measure.
    edge: f64,
    /// In the middle, cd/m2.
    radiance: f64,
}

/// The model faces +Z, and so the camera stands at +Z: a large key at the upper left front, a dimmer fill at the right,
/// two tall strips behind for the rims, and a light overhead.
const SOFT_BOXES: [SoftBox; 5] = [
    SoftBox { center: DVec3::new(-0.75, 0.80, 0.75), half_size: DVec2::new(0.36, 0.36), edge: 0.08, radiance: 10.5 },
    SoftBox { center: DVec3::new(1.00, 0.30, 0.55), half_size: DVec2::new(0.26, 0.50), edge: 0.10, radiance: 2.4 },
    SoftBox { center: DVec3::new(-0.95, 0.25, -0.60), half_size: DVec2::new(0.08, 0.60), edge: 0.05, radiance: 9.0 },
    SoftBox { center: DVec3::new(0.85, 0.25, -0.75), half_size: DVec2::new(0.08, 0.60), edge: 0.05, radiance: 10.0 },
    SoftBox { center: DVec3::new(0.05, 1.00, -0.22), half_size: DVec2::new(0.42, 0.16), edge: 0.10, radiance: 3.6 },
];

/// A neutral grey studio, white balanced (R = G = B), that exposes an 18 % grey sphere well at EV 0.
///
/// Irradiance / pi averages about 0.9 over all directions; the key reaches 10.5 cd/m2.
pub fn studio() -> EnvironmentImage {
    let (width, height) = SIZE;
    let texel = |i: u32| {
        let uv = DVec2::new(f64::from(i % width) + 0.5, f64::from(i / width) + 0.5);
        let direction = direction_from_equirect(uv / DVec2::new(f64::from(width), f64::from(height)));
        Vec3::splat(studio_radiance(direction) as f32)
    };
    EnvironmentImage { width, height, texels: (0..width * height).map(texel).collect() }
}

/// No light.
pub fn black() -> EnvironmentImage {
    EnvironmentImage::constant(Vec3::ZERO)
}

/// 1 cd/m2 from everywhere: the white furnace.
pub fn white() -> EnvironmentImage {
    EnvironmentImage::constant(Vec3::ONE)
}

fn studio_radiance(direction: DVec3) -> f64 {
    let lamps: f64 = SOFT_BOXES.iter().map(|soft_box| soft_box.radiance(direction)).sum();
    room_radiance(direction) + lamps
}

/// Grey walls that darken toward the floor and the back, a bright ceiling, and a floor that returns the light over it.
fn room_radiance(direction: DVec3) -> f64 {
    let wall = mix(0.15, 0.46, smoothstep(-0.35, 0.75, direction.y)) * mix(0.75, 1.0, 0.5 + 0.5 * direction.z);
    mix(wall, mix(0.14, 0.30, -direction.y), smoothstep(-0.05, -0.30, direction.y))
}

impl SoftBox {
    fn radiance(&self, direction: DVec3) -> f64 {
        let toward = self.center.normalize();
        let distance = direction.dot(toward);
        if distance <= 0.0 {
            return 0.0;
        }
        let right = DVec3::Y.cross(toward).normalize();
        let offset = DVec2::new(direction.dot(right), direction.dot(toward.cross(right))) / distance;
        let fade = |offset: f64, half: f64| smoothstep(half + 0.5 * self.edge, half - 0.5 * self.edge, offset.abs());
        // Diffusers are brightest in the middle.
        let falloff = 1.0 - 0.25 * (offset / self.half_size).length_squared().min(2.0);
        self.radiance * falloff * fade(offset.x, self.half_size.x) * fade(offset.y, self.half_size.y)
    }
}

fn mix(a: f64, b: f64, t: f64) -> f64 {
    a + (b - a) * t
}

/// Smooth step from 0 at `from` to 1 at `to`, whichever is larger.
fn smoothstep(from: f64, to: f64, x: f64) -> f64 {
    let t = ((x - from) / (to - from)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bake::environment::{BakeOptions, bake};
    use crate::progress::Silent;

    #[test]
    fn the_studio_is_neutral_and_its_light_is_in_range() {
        let image = studio();
        assert!(image.texels.iter().all(|t| t.is_finite() && t.x == t.y && t.y == t.z && t.x > 0.1));
        let peak = image.texels.iter().map(|texel| texel.x).fold(0.0, f32::max);
        assert!((8.0..=20.0).contains(&peak), "peak {peak}");

        let maps = bake(&image, &BakeOptions::default(), &Silent);
        let average = maps.irradiance_over_pi[0].x;
        assert!((0.8..=1.0).contains(&average), "mean irradiance / pi {average}");
        // The key side is brighter than the fill side by half a stop to one and a half; measured 1.7.
        let key = maps.irradiance_over_pi(DVec3::new(-0.7, 0.3, 0.65).normalize()).x;
        let fill = maps.irradiance_over_pi(DVec3::new(0.7, 0.3, 0.65).normalize()).x;
        assert!((1.4..=2.8).contains(&(key / fill)), "key {key}, fill {fill}");
    }
}
