//! Drawing directions toward the bright parts of an environment.

use crate::math::color::luminance;
use crate::math::spaces::{direction_from_equirect, equirect_from_direction};
use crate::scene::{Environment, EnvironmentImage};
use glam::{DQuat, DVec2, DVec3};
use std::f64::consts::{PI, TAU};

/// A density over directions, piecewise constant in solid angle, that follows what the environment has above its mean.
///
/// The mean is left to the other sampling techniques, which lowers the variance of their combination (Karlik et al. 2019,
/// "MIS Compensation"); an even environment leaves nothing, and is not sampled at all. The cells lie *between* the
/// panorama's texel centres, where its bilinear interpolation has no bend: in a cell radiance is at most four times its
/// average, beside a sun too.
#[derive(Debug)]
pub struct EnvironmentSampler {
    columns: usize,
    /// Edges of the rows in v, from 0 at +Y to 1 at -Y: half a texel at the poles, a texel elsewhere.
    row_edges: Vec<f64>,
    /// Probability that a row lies above, one entry a row and a closing 1.
    row_cdf: Vec<f64>,
    /// For each row the same over its columns.
    column_cdf: Vec<f64>,
    world_from_environment: DQuat,
}

impl EnvironmentSampler {
    /// `None` when the environment is as good as even, or black.
    pub fn new(environment: &Environment) -> Option<Self> {
        let image = &environment.image;
        let columns = image.width as usize;
        let height = image.height as usize;
        let row_edges: Vec<f64> =
            (0..=height + 1).map(|row| ((row as f64 - 0.5) / height as f64).clamp(0.0, 1.0)).collect();
        let excess = excess_over_mean(image, &row_edges);
        let mut row_cdf = vec![0.0];
        let mut column_cdf = Vec::with_capacity((height + 1) * (columns + 1));
        for (row, cells) in excess.chunks_exact(columns).enumerate() {
            let total = push_cdf(&mut column_cdf, cells);
            row_cdf.push(row_cdf[row] + total * row_solid_angle(&row_edges, row));
        }
        let total = row_cdf[height + 1];
        if total <= 0.0 {
            return None;
        }
        row_cdf.iter_mut().for_each(|value| *value /= total);
        let world_from_environment = DQuat::from_rotation_y(environment.rotation_rad);
        Some(Self { columns, row_edges, row_cdf, column_cdf, world_from_environment })
    }

    /// A unit direction in world space, for `u` in (0, 1)^2.
    pub fn sample(&self, u: DVec2) -> DVec3 {
        let (row, fy) = invert(&self.row_cdf, u.y);
        let (column, fx) = invert(self.columns_of(row), u.x);
        let (cos_top, cos_bottom) = (self.cos_edge(row), self.cos_edge(row + 1));
        // Even in cos(theta) is even in solid angle.
        let theta = (cos_top + (cos_bottom - cos_top) * fy).clamp(-1.0, 1.0).acos();
        let uv = DVec2::new(((column as f64 + 0.5 + fx) / self.columns as f64).fract(), theta / PI);
        self.world_from_environment * direction_from_equirect(uv)
    }

    /// Density of [`Self::sample`] at a unit direction, 1/sr.
    pub fn pdf(&self, direction_in_world: DVec3) -> f64 {
        let uv = equirect_from_direction(self.world_from_environment.inverse() * direction_in_world);
        let rows = self.row_cdf.len() - 1;
        let row = ((uv.y * (rows - 1) as f64 + 0.5) as usize).min(rows - 1);
        let column = (uv.x * self.columns as f64 - 0.5).rem_euclid(self.columns as f64) as usize;
        let column = column.min(self.columns - 1);
        let cdf = self.columns_of(row);
        let probability = (self.row_cdf[row + 1] - self.row_cdf[row]) * (cdf[column + 1] - cdf[column]);
        probability * self.columns as f64 / row_solid_angle(&self.row_edges, row)
    }

    fn columns_of(&self, row: usize) -> &[f64] {
        &self.column_cdf[row * (self.columns + 1)..(row + 1) * (self.columns + 1)]
    }

    fn cos_edge(&self, row: usize) -> f64 {
        (self.row_edges[row] * PI).cos()
    }
}

/// Luminance of each cell, the average of its corners, as far as it exceeds the mean over the sphere.
fn excess_over_mean(image: &EnvironmentImage, row_edges: &[f64]) -> Vec<f64> {
    let (width, height) = (image.width as usize, image.height as usize);
    let texel = |column: usize, row: usize| luminance(image.texels[row * width + column % width].as_dvec3());
    let mut cells = Vec::with_capacity(width * (height + 1));
    let mut mean = 0.0;
    for row in 0..=height {
        let (above, below) = (row.saturating_sub(1), row.min(height - 1));
        let weight = row_solid_angle(row_edges, row) / (2.0 * TAU * width as f64);
        for column in 0..width {
            let corners =
                texel(column, above) + texel(column + 1, above) + texel(column, below) + texel(column + 1, below);
            cells.push(0.25 * corners);
            mean += 0.25 * corners * weight;
        }
    }
    // A little more than the mean, so that rounding does not make a distribution of nothing.
    cells.iter_mut().for_each(|cell| *cell = (*cell - mean * (1.0 + 1e-6)).max(0.0));
    cells
}

/// Solid angle of all cells of a row, sr.
fn row_solid_angle(row_edges: &[f64], row: usize) -> f64 {
    TAU * ((row_edges[row] * PI).cos() - (row_edges[row + 1] * PI).cos())
}

/// Appends the cumulative distribution of `weights`, one entry more than they are, and returns their sum.
fn push_cdf(cdf: &mut Vec<f64>, weights: &[f64]) -> f64 {
    let total: f64 = weights.iter().sum();
    let scale = if total > 0.0 { 1.0 / total } else { 0.0 };
    let mut sum = 0.0;
    cdf.push(0.0);
    for weight in weights {
        sum += weight;
        cdf.push(sum * scale);
    }
    total
}

/// The interval of a cumulative distribution that holds `u`, never an empty one, and where in it `u` lies, in [0, 1).
fn invert(cdf: &[f64], u: f64) -> (usize, f64) {
    let u = u * cdf[cdf.len() - 1];
    let index = cdf.partition_point(|&value| value <= u).clamp(1, cdf.len() - 1) - 1;
    let width = cdf[index + 1] - cdf[index];
    (index, if width > 0.0 { ((u - cdf[index]) / width).clamp(0.0, 1.0 - f64::EPSILON) } else { 0.5 })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reference::tests::chi_square_of_directions;
    use glam::Vec3;

    /// Bright spots at a pole, at the seam and elsewhere, on a dim ground.
    fn spotted() -> Environment {
        let mut image = EnvironmentImage { width: 16, height: 8, texels: vec![Vec3::splat(0.1); 128] };
        for (column, row, value) in [(3, 0, 8.0), (15, 4, 20.0), (0, 4, 5.0), (7, 6, 30.0), (9, 7, 9.0)] {
            image.texels[row * 16 + column] = Vec3::splat(value);
        }
        Environment { rotation_rad: 0.7, ..Environment::new(image) }
    }

    #[test]
    fn samples_follow_their_density() {
        let sampler = EnvironmentSampler::new(&spotted()).unwrap();
        let chi = chi_square_of_directions(|u| sampler.sample(u), |d| sampler.pdf(d));
        assert!(chi.is_plausible(), "{chi:?}");
    }

    #[test]
    fn the_density_points_at_the_bright_texel() {
        let mut image = EnvironmentImage::constant(Vec3::ZERO);
        image = EnvironmentImage { width: 64, height: 32, texels: vec![Vec3::splat(image.texels[0].x); 64 * 32] };
        image.texels[10 * 64 + 40] = Vec3::ONE;
        let environment = Environment { rotation_rad: 1.2, ..Environment::new(image) };
        let sampler = EnvironmentSampler::new(&environment).unwrap();
        for (x, y) in [(0.1, 0.2), (0.5, 0.5), (0.9, 0.7)] {
            let direction = sampler.sample(DVec2::new(x, y));
            assert!(environment.radiance(direction).x > 0.0, "{direction} is dark");
            assert!(sampler.pdf(direction) > 0.0);
        }
    }

    #[test]
    fn an_even_environment_is_left_to_the_surface() {
        assert!(EnvironmentSampler::new(&Environment::new(EnvironmentImage::constant(Vec3::splat(0.3)))).is_none());
        assert!(EnvironmentSampler::new(&Environment::new(EnvironmentImage::constant(Vec3::ZERO))).is_none());
    }
}
