//! Directional albedo of the GGX lobe: the split-sum pair by quadrature, and a table of it for the renderer.

#![expect(non_snake_case, reason = "equations keep the symbols of their papers")]

use super::brdf::{D_GGX, V_SmithGGXCorrelated, alpha_from_perceptual_roughness};
use crate::math::quadrature::GaussLegendre;
use glam::DVec3;
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};
use std::sync::OnceLock;

/// The split-sum pair (Karis 2013, "Real Shading in Unreal Engine 4", equation 8): the lobe's albedo is
/// `F0 scale + F90 bias` with Schlick's Fresnel factor, and `E = scale + bias` with F = 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Dfg {
    pub scale: f64,
    pub bias: f64,
}

impl Dfg {
    /// E: the albedo with F = 1, in [0, 1].
    pub fn albedo(self) -> f64 {
        self.scale + self.bias
    }

    /// The albedo with Schlick's Fresnel factor.
    pub fn with_fresnel(self, f0: DVec3, f90: f64) -> DVec3 {
        f0 * self.scale + f90 * self.bias
    }

    fn lerp(self, other: Self, t: f64) -> Self {
        Self { scale: self.scale + (other.scale - self.scale) * t, bias: self.bias + (other.bias - self.bias) * t }
    }
}

/// Integrates the split-sum pair; holds the quadrature's nodes so that many calls share them.
#[derive(Debug)]
pub struct DfgIntegrator {
    polar: GaussLegendre,
    azimuth: GaussLegendre,
    average: GaussLegendre,
}

impl Default for DfgIntegrator {
    fn default() -> Self {
        Self::with_nodes(40, 20)
    }
}

/// Below this cosine the pair is at its limit to 1e-6, and G / NoV is not yet 0/0.
const SMALLEST_COSINE: f64 = 1e-7;

impl DfgIntegrator {
    fn with_nodes(polar: usize, azimuth: usize) -> Self {
        Self { polar: GaussLegendre::new(polar), azimuth: GaussLegendre::new(azimuth), average: GaussLegendre::new(48) }
    }

    /// Split-sum pair at a perceptual roughness in [0, 1] and a cosine in [0, 1], to 1e-6.
    ///
    /// The integral runs over the half vector: polar angle theta, and an azimuth that stops exactly where the reflected
    /// light sets below the horizon, which keeps the integrand smooth. tan theta = alpha tan psi flattens the peak of D
    /// at any alpha.
    pub fn dfg(&self, perceptual_roughness: f64, NoV: f64) -> Dfg {
        let [scale, bias] = self.integrate(perceptual_roughness, NoV, |VoH| {
            let fresnel = (1.0 - VoH).powi(5);
            [1.0 - fresnel, fresnel]
        });
        Dfg { scale, bias }
    }

    /// Albedo of the lobe with Lazanyi's term, F = VoH (1 - VoH)^6, in place of a Fresnel factor; to 1e-6.
    pub fn fresnel_tail(&self, perceptual_roughness: f64, NoV: f64) -> f64 {
        let [tail] = self.integrate(perceptual_roughness, NoV, |VoH| [VoH * (1.0 - VoH).powi(6)]);
        tail
    }

    /// int f(VoH) D V NoL dl for several f at once.
    fn integrate<const N: usize>(
        &self,
        perceptual_roughness: f64,
        NoV: f64,
        fresnel: impl Fn(f64) -> [f64; N],
    ) -> [f64; N] {
        let alpha = alpha_from_perceptual_roughness(perceptual_roughness);
        let NoV = NoV.clamp(SMALLEST_COSINE, 1.0);
        let theta_v = NoV.acos();
        let psi = |theta: f64| (theta.tan() / alpha).atan();
        // Up to `whole` every azimuth reflects upwards; at `end` none is left.
        let (whole, end) = (psi(FRAC_PI_4 - 0.5 * theta_v), psi((FRAC_PI_4 + 0.5 * theta_v).min(FRAC_PI_2)));
        let inner = self.polar.nodes_with_flat_ends(0.0, whole);
        let outer = self.polar.nodes_with_flat_ends(whole, end);
        let mut sum = [0.0; N];
        for (psi, weight) in inner.chain(outer) {
            let tan_psi = psi.tan();
            let theta = (alpha * tan_psi).atan();
            let dtheta_dpsi = alpha * (1.0 + tan_psi * tan_psi) / (1.0 + (alpha * tan_psi).powi(2));
            let ring = self.ring(alpha, NoV, theta, &fresnel);
            let weight = weight * theta.sin() * dtheta_dpsi;
            sum.iter_mut().zip(ring).for_each(|(sum, ring)| *sum += weight * ring);
        }
        sum
    }

    /// The integrand at one polar angle of the half vector, integrated over azimuth (both halves).
    fn ring<const N: usize>(&self, alpha: f64, NoV: f64, theta: f64, fresnel: impl Fn(f64) -> [f64; N]) -> [f64; N] {
        let (sin, NoH) = theta.sin_cos();
        let sin_v = (1.0 - NoV * NoV).sqrt();
        // n.l = 2 (v.h) (n.h) - n.v > 0, solved for the azimuth: cos phi > -cot(2 theta) cot(theta_v).
        let horizon = -NoV * (NoH * NoH - sin * sin) / (sin_v * 2.0 * sin * NoH);
        let last = if sin_v > 0.0 { horizon.clamp(-1.0, 1.0).acos() } else { PI };
        let D = D_GGX(alpha, NoH);
        let mut ring = [0.0; N];
        for (phi, weight) in self.azimuth.nodes_on(0.0, last) {
            let VoH = NoV * NoH + sin_v * sin * phi.cos();
            let NoL = 2.0 * VoH * NoH - NoV;
            if NoL <= 0.0 {
                continue;
            }
            // dl = 4 (v.h) dh.
            let f = 2.0 * weight * D * V_SmithGGXCorrelated(alpha, NoV, NoL.min(1.0)) * NoL * 4.0 * VoH;
            ring.iter_mut().zip(fresnel(VoH)).for_each(|(ring, fresnel)| *ring += f * fresnel);
        }
        ring
    }

    /// Cosine-weighted averages of the pair, 2 int_0^1 (..) mu dmu, to 1e-6.
    pub fn dfg_average(&self, perceptual_roughness: f64) -> Dfg {
        let mut sum = Dfg { scale: 0.0, bias: 0.0 };
        // mu = x^2: the albedo has its features at small mu.
        for (x, weight) in self.average.nodes_on(0.0, 1.0) {
            let dfg = self.dfg(perceptual_roughness, x * x);
            sum.scale += 4.0 * weight * x.powi(3) * dfg.scale;
            sum.bias += 4.0 * weight * x.powi(3) * dfg.bias;
        }
        sum
    }
}

/// [`DfgIntegrator::dfg`] for a single point.
pub fn dfg(perceptual_roughness: f64, NoV: f64) -> Dfg {
    DfgIntegrator::default().dfg(perceptual_roughness, NoV)
}

/// [`DfgIntegrator::dfg_average`] for a single perceptual roughness.
pub fn dfg_average(perceptual_roughness: f64) -> Dfg {
    DfgIntegrator::default().dfg_average(perceptual_roughness)
}

/// Values of the pair at one perceptual roughness, over the square root of the cosine, and their average.
#[derive(Debug)]
struct Row {
    texels: Vec<Dfg>,
    average: Dfg,
}

/// The split-sum pair as a float64 table, read bilinearly: x = sqrt(NoV), y = perceptual roughness, end points on texel
/// centres. A row is integrated when it is first read, so a scene pays for the roughnesses it has.
#[derive(Debug)]
pub struct DirectionalAlbedo {
    integrator: DfgIntegrator,
    rows: Vec<OnceLock<Row>>,
}

impl Default for DirectionalAlbedo {
    fn default() -> Self {
        Self { integrator: DfgIntegrator::default(), rows: (0..Self::SIZE).map(|_| OnceLock::new()).collect() }
    }
}

impl DirectionalAlbedo {
    /// Rows and columns. Twice the resolution of the baked table, so that the reference does not share its error.
    pub const SIZE: usize = 256;

    /// The pair at a perceptual roughness and a cosine, both clamped to [0, 1].
    pub fn dfg(&self, perceptual_roughness: f64, NoV: f64) -> Dfg {
        let (column, fx) = texel(NoV.clamp(0.0, 1.0).sqrt());
        self.between_rows(perceptual_roughness, |row| row.texels[column].lerp(row.texels[column + 1], fx))
    }

    /// The cosine-weighted averages of the pair.
    pub fn average(&self, perceptual_roughness: f64) -> Dfg {
        self.between_rows(perceptual_roughness, |row| row.average)
    }

    fn between_rows(&self, perceptual_roughness: f64, read: impl Fn(&Row) -> Dfg) -> Dfg {
        let (row, fy) = texel(perceptual_roughness.clamp(0.0, 1.0));
        read(self.row(row)).lerp(read(self.row(row + 1)), fy)
    }

    fn row(&self, index: usize) -> &Row {
        self.rows[index].get_or_init(|| {
            let last = (Self::SIZE - 1) as f64;
            let perceptual_roughness = index as f64 / last;
            let texel = |column: usize| self.integrator.dfg(perceptual_roughness, (column as f64 / last).powi(2));
            Row {
                texels: (0..Self::SIZE).map(texel).collect(),
                average: self.integrator.dfg_average(perceptual_roughness),
            }
        })
    }
}

/// The texel below a coordinate in [0, 1], never the last one, and the fraction toward the next.
fn texel(coordinate: f64) -> (usize, f64) {
    let position = coordinate * (DirectionalAlbedo::SIZE - 1) as f64;
    let index = (position as usize).min(DirectionalAlbedo::SIZE - 2);
    (index, position - index as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    const ROUGHNESSES: [f64; 10] = [0.0, 0.035, 0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 0.9, 1.0];
    const COSINES: [f64; 14] = [0.0, 1e-5, 1e-4, 1e-3, 0.003, 0.01, 0.03, 0.1, 0.3, 0.6, 0.9, 0.99, 0.999, 1.0];

    #[test]
    fn the_quadrature_has_converged() {
        let fine = DfgIntegrator::with_nodes(150, 90);
        let integrator = DfgIntegrator::default();
        let mut worst: f64 = 0.0;
        for r in ROUGHNESSES {
            for NoV in COSINES {
                let (a, b) = (integrator.dfg(r, NoV), fine.dfg(r, NoV));
                worst = worst.max((a.scale - b.scale).abs()).max((a.bias - b.bias).abs());
            }
        }
        // Measured 3.3e-7: 40 x 20 against 150 x 90 nodes.
        assert!(worst < 1e-6, "{worst:e}");
    }

    #[test]
    fn albedos_match_closed_forms_and_an_independent_integrator() {
        // At alpha = 1 and normal incidence D and G2 are elementary: E = 1 - ln 2.
        assert!((dfg(1.0, 1.0).albedo() - (1.0 - 2.0_f64.ln())).abs() < 1e-6);
        // The figures of an independent prototype, to the four digits printed.
        let anchors = [
            (1.0, 0.01, 0.9538),
            (1.0, 0.5, 0.4507),
            (0.5, 0.5, 0.8573),
            (0.5, 0.1, 0.8916),
            (0.3, 0.05, 0.9074),
            (0.1, 0.01, 0.8920),
            (0.05, 0.01, 0.9645),
        ];
        for (r, NoV, expected) in anchors {
            let E = dfg(r, NoV).albedo();
            assert!((E - expected).abs() < 1e-4, "r {r}, NoV {NoV}: {E} instead of {expected}");
        }
        for (r, expected) in [(0.05, 0.99996), (0.3, 0.97651), (0.5, 0.88232), (0.8, 0.60421), (1.0, 0.40914)] {
            let E_avg = dfg_average(r).albedo();
            assert!((E_avg - expected).abs() < 1e-5, "r {r}: {E_avg} instead of {expected}");
        }
    }

    #[test]
    fn nothing_reflects_more_than_it_receives_and_grazing_light_is_all_reflected() {
        let integrator = DfgIntegrator::default();
        for r in ROUGHNESSES {
            for NoV in COSINES {
                let dfg = integrator.dfg(r, NoV);
                assert!(dfg.scale >= 0.0 && dfg.bias >= 0.0 && dfg.albedo() <= 1.0 + 1e-6, "r {r}, NoV {NoV}: {dfg:?}");
            }
            let grazing = integrator.dfg(r, 0.0).albedo();
            assert!((grazing - 1.0).abs() < 1e-4, "r {r}: {grazing}");
        }
    }

    #[test]
    fn the_table_follows_the_quadrature() {
        let (integrator, table) = (DfgIntegrator::default(), DirectionalAlbedo::default());
        let (mut worst, mut square_sum, mut count): (f64, f64, f64) = (0.0, 0.0, 0.0);
        for r in [0.047, 0.11, 0.333, 0.62, 0.951] {
            for i in 0..40 {
                let NoV = (0.01 + 0.0245 * f64::from(i)).powi(2);
                let error = table.dfg(r, NoV).albedo() - integrator.dfg(r, NoV).albedo();
                worst = worst.max(error.abs());
                square_sum += error * error;
                count += 1.0;
            }
            let error = table.average(r).albedo() - integrator.dfg_average(r).albedo();
            assert!(error.abs() < 1e-4, "average at {r}: {error:e}");
        }
        let rms = (square_sum / count).sqrt();
        // Measured RMS 2.9e-5, worst 3.3e-4; margin 2.
        assert!(rms < 6e-5 && worst < 7e-4, "RMS {rms:e}, worst {worst:e}");
    }
}
