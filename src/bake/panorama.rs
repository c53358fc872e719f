//! Equirectangular panoramas in float64: resampling and smooth lookup.

use crate::math::spaces::equirect_from_direction;
use crate::scene::EnvironmentImage;
use crate::threads::*;
use glam::{DVec2, DVec3};

/// Radiance in the rows and columns of [`crate::scene::EnvironmentImage`].
#[derive(Debug, Clone)]
pub(super) struct Panorama {
    pub(super) width: usize,
    pub(super) height: usize,
    pub(super) texels: Vec<DVec3>,
}

impl Panorama {
    /// `image` in another size: each axis is averaged where it shrinks, linear between texel centres where it grows.
    pub(super) fn resampled(image: &EnvironmentImage, width: usize, height: usize) -> Self {
        let columns = axis_taps(image.width as usize, width, Edge::Wrap);
        let rows = axis_taps(image.height as usize, height, Edge::Clamp);
        let resampled_row = |row: &[Tap]| -> Vec<DVec3> {
            let mut line = vec![DVec3::ZERO; image.width as usize];
            for tap in row {
                let source = &image.texels[tap.index * line.len()..][..line.len()];
                for (sum, texel) in line.iter_mut().zip(source) {
                    *sum += texel.as_dvec3() * tap.weight;
                }
            }
            columns.iter().map(|taps| taps.iter().map(|tap| line[tap.index] * tap.weight).sum()).collect()
        };
        Self { width, height, texels: rows.par_iter().flat_map_iter(|row| resampled_row(row)).collect() }
    }

    #[cfg(test)]
    pub(super) fn from_fn(width: usize, height: usize, radiance: impl Fn(DVec3) -> DVec3) -> Self {
        let mut panorama = Self { width, height, texels: Vec::new() };
        panorama.texels = (0..width * height).map(|i| radiance(panorama.direction(i % width, i / width))).collect();
        panorama
    }

    /// Unit vector toward the centre of a texel.
    #[cfg(test)]
    pub(super) fn direction(&self, column: usize, row: usize) -> DVec3 {
        let size = DVec2::new(self.width as f64, self.height as f64);
        crate::math::spaces::direction_from_equirect((DVec2::new(column as f64, row as f64) + 0.5) / size)
    }

    /// Radiance toward the unit vector `direction`, by the cubic of Catmull and Rom 1974 along both axes. Goes on over
    /// the poles; the width must be even for that.
    pub(super) fn radiance_cubic(&self, direction: DVec3) -> DVec3 {
        let position = equirect_from_direction(direction) * DVec2::new(self.width as f64, self.height as f64) - 0.5;
        let first = position.floor();
        let (fx, fy) = (catmull_rom(position.x - first.x), catmull_rom(position.y - first.y));
        let mut sum = DVec3::ZERO;
        for (j, wy) in fy.iter().enumerate() {
            let (row, turn) = self.row_over_the_poles(first.y as i64 - 1 + j as i64);
            for (i, wx) in fx.iter().enumerate() {
                let column = (first.x as i64 - 1 + i as i64 + turn).rem_euclid(self.width as i64) as usize;
                sum += self.texels[row * self.width + column] * (wx * wy);
            }
        }
        sum
    }

    /// The row that continues the panorama beyond its first or last one, and by how many columns it is turned.
    fn row_over_the_poles(&self, row: i64) -> (usize, i64) {
        let (height, half_turn) = (self.height as i64, self.width as i64 / 2);
        match row {
            row if row < 0 => ((-1 - row) as usize, half_turn),
            row if row >= height => ((2 * height - 1 - row) as usize, half_turn),
            row => (row as usize, 0),
        }
    }
}

impl From<Panorama> for EnvironmentImage {
    fn from(panorama: Panorama) -> Self {
        let texels = panorama.texels.iter().map(|texel| texel.as_vec3()).collect();
        Self { width: panorama.width as u32, height: panorama.height as u32, texels }
    }
}

/// A texel's share in a sum.
#[derive(Debug, Clone, Copy)]
struct Tap {
    index: usize,
    weight: f64,
}

#[derive(Debug, Clone, Copy)]
enum Edge {
    Wrap,
    Clamp,
}

/// For each of `to` texels along an axis, what it takes from the `from` texels; the weights sum to 1.
fn axis_taps(from: usize, to: usize, edge: Edge) -> Vec<Vec<Tap>> {
    let scale = from as f64 / to as f64;
    let index = |position: f64| match edge {
        Edge::Wrap => (position as i64).rem_euclid(from as i64) as usize,
        Edge::Clamp => position.clamp(0.0, (from - 1) as f64) as usize,
    };
    let averaged = |texel: usize| {
        let (start, end) = (texel as f64 * scale, (texel + 1) as f64 * scale);
        (start.floor() as usize..end.ceil() as usize)
            .map(|i| (i as f64, end.min((i + 1) as f64) - start.max(i as f64)))
            .map(|(position, overlap)| Tap { index: index(position), weight: overlap / scale })
            .collect()
    };
    let linear = |texel: usize| {
        let position = (texel as f64 + 0.5) * scale - 0.5;
        let (first, fraction) = (position.floor(), position - position.floor());
        vec![Tap { index: index(first), weight: 1.0 - fraction }, Tap { index: index(first + 1.0), weight: fraction }]
    };
    (0..to).map(|texel| if to < from { averaged(texel) } else { linear(texel) }).collect()
}

/// Weights of four equidistant samples at `t` in [0, 1] between the middle two.
fn catmull_rom(t: f64) -> [f64; 4] {
    let (t2, t3) = (t * t, t * t * t);
    [0.5 * (-t + 2.0 * t2 - t3), 0.5 * (2.0 - 5.0 * t2 + 3.0 * t3), 0.5 * (t + 4.0 * t2 - 3.0 * t3), 0.5 * (t3 - t2)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    #[test]
    fn resampling_keeps_the_average_of_each_row_and_its_place() {
        let texels = (0..12).map(|i| Vec3::new(1.0, i as f32, (i % 4) as f32)).collect();
        let image = EnvironmentImage { width: 6, height: 2, texels };
        for (width, height) in [(12, 4), (4, 2), (6, 2), (3, 1)] {
            let panorama = Panorama::resampled(&image, width, height);
            let mean = panorama.texels.iter().sum::<DVec3>() / (width * height) as f64;
            assert!((mean - DVec3::new(1.0, 5.5, 1.5)).abs().max_element() < 1e-6, "{width}: {mean}");
        }
        let grown = Panorama::resampled(&image, 12, 2);
        assert_eq!(grown.texels[3].y, 1.25, "the fourth of twelve texels lies a quarter past the second of six");
    }

    #[test]
    fn the_cubic_lookup_follows_a_smooth_panorama_over_the_poles() {
        let smooth = |d: DVec3| DVec3::new(d.x, d.y * d.z, 1.0);
        let panorama = Panorama::from_fn(128, 64, smooth);
        for i in 0..500 {
            let y = 1.0 - 2.0 * f64::from(i) / 499.0;
            let (sin, cos) = (f64::from(i) * 2.4).sin_cos();
            let d = DVec3::new(cos * (1.0 - y * y).sqrt(), y, sin * (1.0 - y * y).sqrt());
            // Measured 4.3e-5.
            assert!((panorama.radiance_cubic(d) - smooth(d)).abs().max_element() < 1e-4, "{d}");
        }
    }
}
