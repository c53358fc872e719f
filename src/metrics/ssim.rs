//! Structural similarity (Wang, Bovik, Sheikh and Simoncelli 2004, "Image quality assessment: from error visibility to
//! structural similarity").

use super::filter::{Plane, normalized, taps};
use super::pair::Pair;
use crate::math::color::LUMINANCE_REC709;
use crate::scene::Picture;

/// Standard deviation of the Gaussian window, pixels (section III.C).
const WINDOW_SIGMA_PX: f64 = 1.5;
/// The window is 11 x 11 pixels (section III.C).
const WINDOW_RADIUS_PX: usize = 5;
/// Stabilise the quotients of luminance and of contrast (section III.B), for values up to 1.
const K1: f64 = 0.01;
const K2: f64 = 0.03;

/// Mean SSIM of the luma (Rec.709 weights on the encoded values) of sRGB-encoded pictures, in [-1, 1].
///
/// Over the windows that lie within the picture and whose centre counts; `None` where there is none.
pub fn mean_ssim(pair: &Pair<'_>) -> Option<f64> {
    let [x, y] = [pair.actual(), pair.expected()].map(luma);
    let window = normalized(taps(WINDOW_RADIUS_PX, |d| (-d * d / (2.0 * WINDOW_SIGMA_PX * WINDOW_SIGMA_PX)).exp()));
    let mean = |a: &Plane| a.filtered(&window, &window).values;
    let mean_of_product = |a: &Plane, b: &Plane| {
        let values = a.values.iter().zip(&b.values).map(|(a, b)| a * b).collect();
        mean(&Plane { width: a.width, values })
    };
    let (mean_x, mean_y) = (mean(&x), mean(&y));
    let (xx, yy, xy) = (mean_of_product(&x, &x), mean_of_product(&y, &y), mean_of_product(&x, &y));

    let (width, height) = (x.width, x.height());
    let within = |at: usize, length: usize| at >= WINDOW_RADIUS_PX && at + WINDOW_RADIUS_PX < length;
    let (mut sum, mut count) = (0.0, 0_u64);
    for i in pair.selected().filter(|i| within(i % width, width) && within(i / width, height)) {
        let (mx, my) = (mean_x[i], mean_y[i]);
        sum += ssim(mx, my, xx[i] - mx * mx, yy[i] - my * my, xy[i] - mx * my);
        count += 1;
    }
    (count > 0).then(|| sum / count as f64)
}

/// Equation 13: means, variances and covariance of the two windows.
fn ssim(mean_x: f64, mean_y: f64, var_x: f64, var_y: f64, covariance: f64) -> f64 {
    let (c1, c2) = (K1 * K1, K2 * K2);
    (2.0 * mean_x * mean_y + c1) * (2.0 * covariance + c2)
        / ((mean_x * mean_x + mean_y * mean_y + c1) * (var_x + var_y + c2))
}

fn luma(picture: &Picture) -> Plane {
    let values = picture.texels.iter().map(|texel| LUMINANCE_REC709.dot(texel.truncate().as_dvec3())).collect();
    Plane { width: picture.width as usize, values }
}
