//! Diffuse light of a panorama: irradiance as spherical harmonics of degree 2.

use crate::scene::EnvironmentImage;
use crate::threads::*;
use glam::DVec3;
use std::f64::consts::PI;

/// Irradiance / pi of the panorama, taken as constant within each texel, in the polynomial form that
/// [`crate::scene::EnvironmentMaps::irradiance_over_pi`] documents (Ramamoorthi and Hanrahan 2001, "An Efficient
/// Representation for Irradiance Environment Maps", equations 7 to 12).
///
/// The basis is integrated over each texel in closed form, so that constant light gives exactly one coefficient
/// whatever the size of the panorama.
pub(super) fn irradiance_over_pi(image: &EnvironmentImage) -> [DVec3; 9] {
    let (width, height) = (image.width as usize, image.height as usize);
    let columns: Vec<[f64; 5]> = (0..width).map(|i| column_integrals(i, width)).collect();
    let of_row = |row: usize| {
        let texels = &image.texels[row * width..][..width];
        let mut by_longitude = [DVec3::ZERO; 5];
        for (texel, column) in texels.iter().zip(&columns) {
            for (sum, integral) in by_longitude.iter_mut().zip(column) {
                *sum += texel.as_dvec3() * *integral;
            }
        }
        let [one, cos, sin, cos2, sin2] = by_longitude;
        let RowIntegrals { one: i, cos: c, sin: s, sin_cos: sc, sin_sin: ss } = row_integrals(row, height);
        // 1, y, z, x, xy, yz, 3 z^2 - 1, xz, x^2 - y^2, with sin^2 phi = (1 - cos 2 phi) / 2 and its like.
        [
            one * i,
            one * c,
            sin * s,
            cos * s,
            cos * sc,
            sin * sc,
            (one - cos2) * (1.5 * ss) - one * i,
            sin2 * (0.5 * ss),
            (one + cos2) * (0.5 * ss) - one * (i - ss),
        ]
    };
    let moments: Vec<[DVec3; 9]> = (0..height).into_par_iter().map(of_row).collect();
    let mut sums = [DVec3::ZERO; 9];
    for row in &moments {
        for (sum, moment) in sums.iter_mut().zip(row) {
            *sum += *moment;
        }
    }
    std::array::from_fn(|k| sums[k] * SCALE[k])
}

/// What the integrals of radiance times each polynomial are scaled with: the polynomial's squared norm (4 pi, 4 pi / 3,
/// 4 pi / 15, and 16 pi / 5 and 16 pi / 15 for the last two forms) divides, and the cosine lobe over pi multiplies: 1,
/// 2/3 and 1/4 by degree.
const SCALE: [f64; 9] = {
    let (degree0, degree1, degree2) = (1.0 / (4.0 * PI), 2.0 / (4.0 * PI), 3.75 / (4.0 * PI));
    [degree0, degree1, degree1, degree1, degree2, degree2, degree2 / 12.0, degree2, degree2 / 4.0]
};

/// Integrals over the longitudes of a column of 1, cos, sin, cos 2, sin 2.
fn column_integrals(column: usize, width: usize) -> [f64; 5] {
    let edge = |i: usize| (i as f64 / width as f64 - 0.5) * 2.0 * PI;
    let (a, b) = (edge(column), edge(column + 1));
    [
        b - a,
        b.sin() - a.sin(),
        a.cos() - b.cos(),
        0.5 * ((2.0 * b).sin() - (2.0 * a).sin()),
        0.5 * ((2.0 * a).cos() - (2.0 * b).cos()),
    ]
}

/// Integrals over the angles theta of a row, from +Y, with the measure sin theta dtheta.
struct RowIntegrals {
    one: f64,
    cos: f64,
    sin: f64,
    sin_cos: f64,
    sin_sin: f64,
}

fn row_integrals(row: usize, height: usize) -> RowIntegrals {
    let (a, b) = (row as f64 * PI / height as f64, (row + 1) as f64 * PI / height as f64);
    let one = a.cos() - b.cos();
    RowIntegrals {
        one,
        cos: 0.5 * (b.sin().powi(2) - a.sin().powi(2)),
        sin: 0.5 * (b - a) - 0.25 * ((2.0 * b).sin() - (2.0 * a).sin()),
        sin_cos: (b.sin().powi(3) - a.sin().powi(3)) / 3.0,
        sin_sin: one - (a.cos().powi(3) - b.cos().powi(3)) / 3.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::spaces::direction_from_equirect;
    use glam::{DVec2, Vec3};

    fn evaluate(c: &[DVec3; 9], n: DVec3) -> DVec3 {
        c[0] + c[1] * n.y
            + c[2] * n.z
            + c[3] * n.x
            + c[4] * (n.x * n.y)
            + c[5] * (n.y * n.z)
            + c[6] * (3.0 * n.z * n.z - 1.0)
            + c[7] * (n.x * n.z)
            + c[8] * (n.x * n.x - n.y * n.y)
    }

    #[test]
    fn constant_light_is_one_coefficient_even_in_a_tiny_panorama() {
        let coefficients = irradiance_over_pi(&EnvironmentImage::constant(Vec3::new(0.5, 1.0, 3.0)));
        assert!((coefficients[0] - DVec3::new(0.5, 1.0, 3.0)).abs().max_element() < 1e-15);
        assert!(coefficients[1..].iter().all(|c| c.abs().max_element() < 1e-15), "{coefficients:?}");
    }

    #[test]
    fn a_cosine_lobe_of_light_has_the_closed_form() {
        // L = max(0, d . axis) has the coefficients of the cosine lobe itself: E / pi = 1/4 + P_1 / 3 + 5/64 P_2.
        let (width, height) = (256, 128);
        for axis in [DVec3::Y, DVec3::X, DVec3::new(0.6, -0.48, 0.64)] {
            let texels = (0..width * height)
                .map(|i| {
                    let uv = (DVec2::new(f64::from(i % width), f64::from(i / width)) + 0.5)
                        / DVec2::new(f64::from(width), f64::from(height));
                    Vec3::splat(direction_from_equirect(uv).dot(axis).max(0.0) as f32)
                })
                .collect();
            let coefficients = irradiance_over_pi(&EnvironmentImage { width, height, texels });
            for n in [axis, DVec3::new(0.0, 0.8, 0.6), DVec3::new(-0.6, 0.0, 0.8), DVec3::NEG_Z] {
                let x = n.dot(axis);
                let expected = 0.25 + x / 3.0 + 5.0 / 64.0 * 0.5 * (3.0 * x * x - 1.0);
                let got = evaluate(&coefficients, n).x;
                // Texels are constant: measured 9e-5, falling with the square of their size.
                assert!((got - expected).abs() < 2e-4, "axis {axis}, normal {n}: {got}, expected {expected}");
            }
        }
    }
}
