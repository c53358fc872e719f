//! The spherical harmonic transform of a panorama, in float64.
//!
//! A GGX lobe seen along its axis is rotationally symmetric, so prefiltering is a convolution on the sphere, and there
//! it is a product per degree (Funk and Hecke). Two transforms replace a sum over all texels for each direction.
//!
//! The harmonics here are `P_lm(cos theta) e^(i m phi)` with `P_lm` normalised to `int_-1^1 P_lm^2 dx = 1`, theta from
//! +Y and phi = 2 pi u. The panorama is real, so that only orders m >= 0 are stored.

use super::panorama::Panorama;
use crate::threads::*;
use glam::DVec3;
use rustfft::FftPlanner;
use rustfft::num_complex::Complex;
use std::f64::consts::PI;
use std::ops::AddAssign;

/// One complex number a colour channel.
#[derive(Debug, Clone, Copy, Default)]
struct Phasor {
    re: DVec3,
    im: DVec3,
}

impl Phasor {
    fn scaled(self, factor: f64) -> Self {
        Self { re: self.re * factor, im: self.im * factor }
    }

    fn channel(&self, index: usize) -> Complex<f64> {
        Complex::new(self.re[index], self.im[index])
    }

    fn set_channel(&mut self, index: usize, value: Complex<f64>) {
        (self.re[index], self.im[index]) = (value.re, value.im);
    }

    fn plus(self, other: Self) -> Self {
        Self { re: self.re + other.re, im: self.im + other.im }
    }
}

impl AddAssign for Phasor {
    fn add_assign(&mut self, other: Self) {
        *self = self.plus(other);
    }
}

/// The coefficients of a panorama for degrees below [`Harmonics::degrees`].
#[derive(Debug, Clone)]
pub(super) struct Harmonics {
    degrees: usize,
    /// `by_order[m][l - m]`.
    by_order: Vec<Vec<Phasor>>,
}

impl Harmonics {
    /// Transforms `panorama`, whose height must be even and at least `degrees`, and whose width at least twice that.
    ///
    /// With a height of twice `degrees` the transform is exact for panoramas limited to those degrees.
    pub(super) fn analyse(panorama: &Panorama, degrees: usize) -> Self {
        let weights = fejer_weights(panorama.height);
        let pairs = row_pairs(panorama.height);
        let spectra = row_spectra(panorama, degrees);
        let of_order = |order: usize| {
            // P_lm is even in cos theta when l + m is even, else odd: one Legendre value serves two rows.
            let folded: Vec<[Phasor; 2]> = (pairs.iter())
                .map(|pair| {
                    let north = spectra[pair.north][order].scaled(weights[pair.north]);
                    let south = spectra[pair.south][order].scaled(weights[pair.south]);
                    [north.plus(south), north.plus(south.scaled(-1.0))]
                })
                .collect();
            let mut legendre = Legendre::new(order, &pairs);
            (0..degrees - order)
                .map(|step| {
                    let parity = step % 2;
                    let mut sum = Phasor::default();
                    for (row, p) in folded.iter().zip(&legendre.values) {
                        sum += row[parity].scaled(*p);
                    }
                    legendre.advance();
                    sum
                })
                .collect()
        };
        Self { degrees, by_order: (0..degrees).into_par_iter().map(of_order).collect() }
    }

    pub(super) fn degrees(&self) -> usize {
        self.degrees
    }

    /// The panorama, `height` rows of twice as many texels, convolved with the rotationally symmetric kernel whose
    /// Legendre coefficients are `kernel`; degrees beyond `kernel.len()` are dropped.
    ///
    /// `height` must be even and above the number of degrees that remain.
    pub(super) fn synthesise(&self, kernel: &[f64], height: usize) -> Panorama {
        let degrees = self.degrees.min(kernel.len());
        let pairs = row_pairs(height);
        let of_order = |order: usize| {
            let mut folded = vec![[Phasor::default(); 2]; pairs.len()];
            let mut legendre = Legendre::new(order, &pairs);
            for (step, (harmonic, factor)) in self.by_order[order].iter().zip(&kernel[order..degrees]).enumerate() {
                let (parity, coefficient) = (step % 2, harmonic.scaled(*factor));
                for (row, p) in folded.iter_mut().zip(&legendre.values) {
                    row[parity] += coefficient.scaled(*p);
                }
                legendre.advance();
            }
            folded
        };
        let by_order: Vec<_> = (0..degrees).into_par_iter().map(of_order).collect();
        let spectrum_of_row = |row: usize| {
            let (pair, sign) = if row < height / 2 { (height / 2 - 1 - row, 1.0) } else { (row - height / 2, -1.0) };
            by_order.iter().map(|folded| folded[pair][0].plus(folded[pair][1].scaled(sign))).collect::<Vec<_>>()
        };
        panorama_from_spectra(2 * height, height, spectrum_of_row)
    }
}

/// Weights of Fejer's first rule: `int_-1^1 f(x) dx = sum_j w_j f(cos theta_j)`, theta_j = (j + 1/2) pi / n, exact for
/// polynomials of degree below n (Fejer 1933). The nodes are the rows of a panorama.
pub(super) fn fejer_weights(n: usize) -> Vec<f64> {
    let weight = |j: usize| {
        let theta = (j as f64 + 0.5) * PI / n as f64;
        let series: f64 = (1..=n / 2).map(|k| (2.0 * k as f64 * theta).cos() / (4.0 * (k * k) as f64 - 1.0)).sum();
        2.0 / n as f64 * (1.0 - 2.0 * series)
    };
    (0..n).into_par_iter().map(weight).collect()
}

/// Two rows at opposite latitudes.
#[derive(Debug, Clone, Copy)]
struct RowPair {
    north: usize,
    south: usize,
    /// Of the northern row's angle from +Y.
    cos: f64,
    sin: f64,
}

/// All rows in pairs, from the equator to the poles.
fn row_pairs(height: usize) -> Vec<RowPair> {
    let half = height / 2;
    (0..half)
        .map(|i| {
            let north = half - 1 - i;
            let (sin, cos) = ((north as f64 + 0.5) * PI / height as f64).sin_cos();
            RowPair { north, south: half + i, cos, sin }
        })
        .collect()
}

/// `P_lm` of one order in a number of rows, degree after degree.
#[derive(Debug)]
struct Legendre {
    order: f64,
    degree: f64,
    cosines: Vec<f64>,
    /// `P_lm` of the current degree. Rows where it is negligible at all degrees in use are cut off at the end.
    values: Vec<f64>,
    previous: Vec<f64>,
    previous_scale: f64,
}

impl Legendre {
    /// Toward the poles `P_mm` falls like sin^m. Where `P_lm` matters for some l <= n, that is where n sin theta > m,
    /// it is above e^(-n/e), 1e-82 for n = 512: what lies below this is left out, long before it becomes subnormal.
    const NEGLIGIBLE: f64 = 1e-150;

    /// Starts at degree = order.
    fn new(order: usize, pairs: &[RowPair]) -> Self {
        let scale = (1..=order).fold(0.5, |product, k| product * (1.0 + 0.5 / k as f64)).sqrt();
        let values: Vec<f64> = (pairs.iter())
            .map(|pair| scale * pair.sin.powi(order as i32))
            .take_while(|value| *value > Self::NEGLIGIBLE)
            .collect();
        let cosines = pairs[..values.len()].iter().map(|pair| pair.cos).collect();
        let previous = vec![0.0; values.len()];
        Self { order: order as f64, degree: order as f64, cosines, values, previous, previous_scale: 0.0 }
    }

    /// One degree up: P_l = a_l (x P_(l-1) - P_(l-2) / a_(l-1)) with a_l = sqrt((4 l^2 - 1) / (l^2 - m^2)).
    fn advance(&mut self) {
        self.degree += 1.0;
        let (l2, m2) = (self.degree * self.degree, self.order * self.order);
        let scale = ((4.0 * l2 - 1.0) / (l2 - m2)).sqrt();
        for ((value, previous), x) in self.values.iter_mut().zip(&mut self.previous).zip(&self.cosines) {
            let next = scale * (x * *value - self.previous_scale * *previous);
            *previous = *value;
            *value = next;
        }
        self.previous_scale = scale.recip();
    }
}

/// Angle from the left edge of the panorama to the centre of its first column.
fn first_column_angle(width: usize) -> f64 {
    PI / width as f64
}

/// Fourier coefficients `1/W sum_i f_i e^(-i m phi_i)` of each row, for orders below `orders`.
fn row_spectra(panorama: &Panorama, orders: usize) -> Vec<Vec<Phasor>> {
    let width = panorama.width;
    let fft = FftPlanner::new().plan_fft_forward(width);
    let shift = first_column_angle(width);
    let of_row = |row: &[DVec3]| {
        let mut spectrum = vec![Phasor::default(); orders];
        let mut buffer = vec![Complex::default(); width];
        for channel in 0..3 {
            for (value, texel) in buffer.iter_mut().zip(row) {
                *value = Complex::new(texel[channel] / width as f64, 0.0);
            }
            fft.process(&mut buffer);
            for (order, phasor) in spectrum.iter_mut().enumerate() {
                phasor.set_channel(channel, buffer[order] * Complex::cis(-(order as f64) * shift));
            }
        }
        spectrum
    };
    panorama.texels.par_chunks(width).map(of_row).collect()
}

/// Sums the Fourier series of each row.
fn panorama_from_spectra(
    width: usize,
    height: usize,
    spectrum_of_row: impl Fn(usize) -> Vec<Phasor> + Sync,
) -> Panorama {
    let fft = FftPlanner::new().plan_fft_inverse(width);
    let shift = first_column_angle(width);
    let mut texels = vec![DVec3::ZERO; width * height];
    texels.par_chunks_mut(width).enumerate().for_each(|(row, texels)| {
        let spectrum = spectrum_of_row(row);
        let mut buffer = vec![Complex::default(); width];
        for channel in 0..3 {
            buffer.fill(Complex::default());
            for (order, phasor) in spectrum.iter().enumerate() {
                // The order -m of a real panorama is the conjugate of m: twice the real part stands for both.
                let both = if order == 0 { 1.0 } else { 2.0 };
                buffer[order] = phasor.channel(channel) * Complex::cis(order as f64 * shift) * both;
            }
            fft.process(&mut buffer);
            for (texel, value) in texels.iter_mut().zip(&buffer) {
                texel[channel] = value.re;
            }
        }
    });
    Panorama { width, height, texels }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fejers_rule_integrates_polynomials_below_its_order() {
        let weights = fejer_weights(16);
        let integral = |power: i32| -> f64 {
            (weights.iter().enumerate()).map(|(j, w)| w * ((j as f64 + 0.5) * PI / 16.0).cos().powi(power)).sum()
        };
        for power in 0..16 {
            let exact = if power % 2 == 0 { 2.0 / f64::from(power + 1) } else { 0.0 };
            assert!((integral(power) - exact).abs() < 1e-14, "x^{power}");
        }
    }

    #[test]
    fn a_panorama_limited_to_the_degrees_comes_back() {
        // 1 + x y z^2: degree 4, with odd and even orders.
        let panorama = Panorama::from_fn(32, 16, |d| DVec3::new(1.0, d.x * d.y * d.z * d.z, d.z + d.x * d.x));
        let back = Harmonics::analyse(&panorama, 8).synthesise(&[1.0; 8], 32);
        for row in 0..back.height {
            for column in 0..back.width {
                let d = back.direction(column, row);
                let expected = DVec3::new(1.0, d.x * d.y * d.z * d.z, d.z + d.x * d.x);
                let got = back.texels[row * back.width + column];
                assert!((got - expected).abs().max_element() < 1e-13, "{d}: {got}, expected {expected}");
            }
        }
    }

    #[test]
    fn a_kernel_scales_each_degree() {
        // z is of degree 1, x y of degree 2.
        let panorama = Panorama::from_fn(16, 8, |d| DVec3::new(d.z, d.x * d.y, d.z + d.x * d.y));
        let filtered = Harmonics::analyse(&panorama, 4).synthesise(&[1.0, 0.5, 0.25, 0.0], 8);
        let d = filtered.direction(5, 2);
        let expected = DVec3::new(0.5 * d.z, 0.25 * d.x * d.y, 0.5 * d.z + 0.25 * d.x * d.y);
        assert!((filtered.texels[2 * 16 + 5] - expected).abs().max_element() < 1e-14);
    }
}
