//! Drawing directions toward the bright parts of an environment.

use crate::math::color::luminance;
use crate::math::spaces::{direction_from_equirect, equirect_from_direction};
use crate::scene::Environment;
use glam::{DQuat, DVec2, DVec3};
use std::f64::consts::{PI, TAU};

/// A density over directions that follows what the environment has above its mean.
///
/// The mean is left to the other sampling techniques, which lowers the variance of their combination (Karlik et al. 2019,
/// "MIS Compensation"); an even environment leaves nothing, and is not sampled at all. The cells lie *between* the
/// panorama's texel centres, where its interpolation has no bend, and the density is as bilinear as the radiance: beside
/// a sun one texel wide a density that is constant in each cell would be wrong by up to a factor of four.
#[derive(Debug)]
pub struct EnvironmentSampler {
    columns: usize,
    /// Luminance of each texel as far as it exceeds the mean over the sphere.
    excess: Vec<f64>,
    /// Integral of the excess over the sphere.
    total: f64,
    /// Cosines of the edges between rows of cells, from 1 at +Y to -1 at -Y: half a texel at the poles, a texel elsewhere.
    row_cosines: Vec<f64>,
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
        let (columns, height) = (image.width as usize, image.height as usize);
        let edge = |row: usize| (((row as f64 - 0.5) / height as f64).clamp(0.0, 1.0) * PI).cos();
        let mut sampler = Self {
            columns,
            excess: image.texels.iter().map(|texel| luminance(texel.as_dvec3())).collect(),
            total: 0.0,
            row_cosines: (0..=height + 1).map(edge).collect(),
            row_cdf: Vec::new(),
            column_cdf: Vec::new(),
            world_from_environment: DQuat::from_rotation_y(environment.rotation_rad),
        };
        // A little more than the mean, so that rounding does not make a distribution of nothing.
        let mean = sampler.integral() / (2.0 * TAU) * (1.0 + 1e-6);
        sampler.excess.iter_mut().for_each(|value| *value = (*value - mean).max(0.0));
        sampler.total = sampler.integral();
        sampler.accumulate();
        (sampler.total > 0.0).then_some(sampler)
    }

    /// A unit direction in world space, for `u` in (0, 1)^2.
    pub fn sample(&self, u: DVec2) -> DVec3 {
        let (row, fy) = invert(&self.row_cdf, u.y);
        let (column, fx) = invert(self.columns_of(row), u.x);
        let [top_left, top_right, bottom_left, bottom_right] = self.corners(row, column);
        let y = sample_linear(top_left + top_right, bottom_left + bottom_right, fy);
        let x = sample_linear(lerp(top_left, bottom_left, y), lerp(top_right, bottom_right, y), fx);
        // Even in cos(theta) is even in solid angle.
        let cos_theta = lerp(self.row_cosines[row], self.row_cosines[row + 1], y);
        let uv = DVec2::new(((column as f64 + 0.5 + x) / self.columns as f64).fract(), cos_theta.acos() / PI);
        self.world_from_environment * direction_from_equirect(uv)
    }

    /// Density of [`Self::sample`] at a unit direction, 1/sr.
    pub fn pdf(&self, direction_in_world: DVec3) -> f64 {
        let direction = self.world_from_environment.inverse() * direction_in_world;
        let uv = equirect_from_direction(direction);
        let row = ((uv.y * (self.rows() - 1) as f64 + 0.5) as usize).min(self.rows() - 1);
        let position = (uv.x * self.columns as f64 - 0.5).rem_euclid(self.columns as f64);
        let column = (position as usize).min(self.columns - 1);
        let (above, below) = (self.row_cosines[row], self.row_cosines[row + 1]);
        let (x, y) = (position - column as f64, ((direction.y - above) / (below - above)).clamp(0.0, 1.0));
        let [top_left, top_right, bottom_left, bottom_right] = self.corners(row, column);
        lerp(lerp(top_left, top_right, x), lerp(bottom_left, bottom_right, x), y) / self.total
    }

    /// Rows of cells: one more than of texels.
    fn rows(&self) -> usize {
        self.row_cosines.len() - 1
    }

    /// The four texels around a cell: top left, top right, bottom left, bottom right.
    fn corners(&self, row: usize, column: usize) -> [f64; 4] {
        let (above, below) = (row.saturating_sub(1), row.min(self.rows() - 2));
        let right = (column + 1) % self.columns;
        let texel = |column: usize, row: usize| self.excess[row * self.columns + column];
        [texel(column, above), texel(right, above), texel(column, below), texel(right, below)]
    }

    /// Integral of the texels, bilinearly interpolated, over a row of cells.
    fn row_integral(&self, row: usize) -> f64 {
        let solid_angle = TAU * (self.row_cosines[row] - self.row_cosines[row + 1]) / self.columns as f64;
        (0..self.columns).map(|column| self.corners(row, column).iter().sum::<f64>() * 0.25 * solid_angle).sum()
    }

    fn integral(&self) -> f64 {
        (0..self.rows()).map(|row| self.row_integral(row)).sum()
    }

    /// Builds the cumulative distributions of rows and of the columns in each.
    fn accumulate(&mut self) {
        let rows: Vec<f64> = (0..self.rows()).map(|row| self.row_integral(row)).collect();
        self.row_cdf = cdf(rows.into_iter()).collect();
        self.column_cdf = (0..self.rows())
            .flat_map(|row| {
                let weights: Vec<f64> =
                    (0..self.columns).map(|column| self.corners(row, column).iter().sum()).collect();
                cdf(weights.into_iter())
            })
            .collect();
    }

    fn columns_of(&self, row: usize) -> &[f64] {
        &self.column_cdf[row * (self.columns + 1)..(row + 1) * (self.columns + 1)]
    }
}

fn lerp(a: f64, b: f64, t: f64) -> f64 {
    a + (b - a) * t
}

/// Sums of the weights up to each and, last, of all.
fn cdf(weights: impl Iterator<Item = f64>) -> impl Iterator<Item = f64> {
    let sums = weights.scan(0.0, |sum, weight| {
        *sum += weight;
        Some(*sum)
    });
    std::iter::once(0.0).chain(sums)
}

/// The interval of a cumulative distribution that holds the share `u` of it, and where in it that is, in [0, 1].
fn invert(cdf: &[f64], u: f64) -> (usize, f64) {
    let u = u * cdf[cdf.len() - 1];
    let index = cdf.partition_point(|&value| value <= u).clamp(1, cdf.len() - 1) - 1;
    let width = cdf[index + 1] - cdf[index];
    (index, if width > 0.0 { ((u - cdf[index]) / width).clamp(0.0, 1.0) } else { 0.5 })
}

/// A number in [0, 1] whose density goes linearly from `a` to `b`: the root of the quadratic cumulative distribution, in
/// the form that does not cancel.
fn sample_linear(a: f64, b: f64, u: f64) -> f64 {
    let denominator = a + lerp(a * a, b * b, u).sqrt();
    if denominator > 0.0 { (u * (a + b) / denominator).clamp(0.0, 1.0) } else { u }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reference::tests::chi_square_of_directions;
    use crate::scene::EnvironmentImage;
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
        let mut image = EnvironmentImage { width: 64, height: 32, texels: vec![Vec3::ZERO; 64 * 32] };
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
