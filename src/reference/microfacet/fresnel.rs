//! Fresnel reflectance: exact, and the approximations that renderers use.

#![expect(non_snake_case, reason = "equations keep the symbols of their papers")]

use super::metals::Metal;
use crate::math::parameter::ParameterError;
use crate::reference::brdf::F_Schlick;
use glam::DVec3;

/// Where c (1 - c)^6 is largest: 81.8 degrees, which F82 rounds to 82.
const COS_82: f64 = 1.0 / 7.0;

/// Schlick's curve with the term -a cos (1 - cos)^6 that metals dip by before they rise to 1 (Hoffman 2019, "Fresnel
/// Equations Considered Harmful", equation 7, after Lazanyi and Szirmay-Kalos 2005, who divide by ((n + 1)^2 + k^2)
/// instead). `a` as fitted to the metal ([`Metal::a`]); `VoH` in [0, 1].
pub fn F_Lazanyi(F0: DVec3, a: DVec3, VoH: f64) -> DVec3 {
    F_Schlick(F0, 1.0, VoH) - a * lazanyi_shape(VoH)
}

/// The same curve, given by its value `F82` at 82 degrees, cos = 1/7 (Hoffman 2019, equation 8; Kutz, Hasan and Edmondson
/// 2021, "Novel aspects of the Adobe Standard Material", whose tint is F82 divided by Schlick's curve there).
pub fn F_F82(F0: DVec3, F82: DVec3, VoH: f64) -> DVec3 {
    let a = (F_Schlick(F0, 1.0, COS_82) - F82) / lazanyi_shape(COS_82);
    F_Lazanyi(F0, a, VoH)
}

/// Fresnel's equations for unpolarised light at a clear interface (Born and Wolf 1999, section 1.5.2). `eta` is the
/// index of refraction behind the interface divided by that in front, above 0; 1 beyond total reflection.
pub fn F_dielectric(eta: f64, VoH: f64) -> f64 {
    let sin2_t = (1.0 - VoH * VoH) / (eta * eta);
    if sin2_t >= 1.0 {
        return 1.0;
    }
    let cos_t = (1.0 - sin2_t).sqrt();
    let s = (VoH - eta * cos_t) / (VoH + eta * cos_t);
    let p = (eta * VoH - cos_t) / (eta * VoH + cos_t);
    0.5 * (s * s + p * p)
}

/// Fresnel's equations for unpolarised light on a metal of the complex index `n + i k` in air, per channel
/// (Born and Wolf 1999, section 14.2). `n` above 0, `k` from 0 up, `VoH` in [0, 1].
pub fn F_conductor(n: DVec3, k: DVec3, VoH: f64) -> DVec3 {
    let channel = |i: usize| conductor(n[i], k[i], VoH);
    DVec3::new(channel(0), channel(1), channel(2))
}

/// One channel of [`F_conductor`]: u + i v is the square root of (n + i k)^2 - sin^2.
pub(super) fn conductor(n: f64, k: f64, VoH: f64) -> f64 {
    let (cos2, sin2) = (VoH * VoH, 1.0 - VoH * VoH);
    let real = n * n - k * k - sin2;
    let modulus = real.hypot(2.0 * n * k);
    let u = (0.5 * (modulus + real)).max(0.0).sqrt();
    let s = (modulus - 2.0 * u * VoH + cos2) / (modulus + 2.0 * u * VoH + cos2);
    // R_p / R_s; at grazing incidence both are 1.
    let p_over_s =
        (cos2 * modulus - 2.0 * u * VoH * sin2 + sin2 * sin2) / (cos2 * modulus + 2.0 * u * VoH * sin2 + sin2 * sin2);
    0.5 * s * (1.0 + p_over_s)
}

/// c (1 - c)^6.
pub(super) fn lazanyi_shape(VoH: f64) -> f64 {
    VoH * (1.0 - VoH).powi(6)
}

/// A curve of reflectance over the angle between light and half vector. The constructors check the parameters.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Fresnel {
    /// Reflects everything: shows what distribution and geometry do alone.
    One,
    #[non_exhaustive]
    Schlick { f0: DVec3, f90: f64 },
    #[non_exhaustive]
    Lazanyi { f0: DVec3, a: DVec3 },
    #[non_exhaustive]
    F82 { f0: DVec3, f82: DVec3 },
    #[non_exhaustive]
    Dielectric { eta: f64 },
    #[non_exhaustive]
    Conductor { n: DVec3, k: DVec3 },
}

impl Fresnel {
    /// # Errors
    /// When a reflectance is not in [0, 1].
    pub fn schlick(f0: DVec3, f90: f64) -> Result<Self, ParameterError> {
        Ok(Self::Schlick { f0: check_color("f0", f0)?, f90: ParameterError::check_unit("f90", f90)? })
    }

    /// # Errors
    /// When `f0` is not in [0, 1], or `a` takes the curve out of it.
    pub fn lazanyi(f0: DVec3, a: DVec3) -> Result<Self, ParameterError> {
        let curve = Self::Lazanyi { f0: check_color("f0", f0)?, a };
        curve.check_curve("a", a)
    }

    /// # Errors
    /// When a reflectance is not in [0, 1], or both together take the curve out of it.
    pub fn f82(f0: DVec3, f82: DVec3) -> Result<Self, ParameterError> {
        let curve = Self::F82 { f0: check_color("f0", f0)?, f82: check_color("f82", f82)? };
        curve.check_curve("f82", f82)
    }

    /// # Errors
    /// When `eta` is not in [0.1, 10].
    pub fn dielectric(eta: f64) -> Result<Self, ParameterError> {
        Ok(Self::Dielectric { eta: ParameterError::check("eta", eta, 0.1..=10.0, "from 0.1 to 10")? })
    }

    /// # Errors
    /// When `n` is not in [1e-3, 20] or `k` not in [0, 20].
    pub fn conductor(n: DVec3, k: DVec3) -> Result<Self, ParameterError> {
        for channel in 0..3 {
            ParameterError::check("n", n[channel], 1e-3..=20.0, "from 1e-3 to 20")?;
            ParameterError::check("k", k[channel], 0.0..=20.0, "from 0 to 20")?;
        }
        Ok(Self::Conductor { n, k })
    }

    /// Exact reflectance of a metal of the table.
    pub fn of_metal(metal: &Metal) -> Self {
        Self::Conductor { n: metal.n, k: metal.k }
    }

    /// Reflectance per channel at the cosine between light (or view) and half vector, in [0, 1].
    pub fn reflectance(&self, VoH: f64) -> DVec3 {
        match *self {
            Self::One => DVec3::ONE,
            Self::Schlick { f0, f90 } => F_Schlick(f0, f90, VoH),
            Self::Lazanyi { f0, a } => F_Lazanyi(f0, a, VoH),
            Self::F82 { f0, f82 } => F_F82(f0, f82, VoH),
            Self::Dielectric { eta } => DVec3::splat(F_dielectric(eta, VoH)),
            Self::Conductor { n, k } => F_conductor(n, k, VoH),
        }
    }

    /// The curve, where it stays in [0, 1].
    fn check_curve(self, parameter: &'static str, color: DVec3) -> Result<Self, ParameterError> {
        const EXPECTED: &str = "such that the reflectance stays from 0 to 1 at every angle";
        for i in 0..=256 {
            let F = self.reflectance(f64::from(i) / 256.0);
            for channel in 0..3 {
                // The rounding of a curve that touches 1 may pass it.
                ParameterError::check(parameter, F[channel], -1e-12..=1.0 + 1e-12, EXPECTED)
                    .map_err(|error| ParameterError { value: color[channel], ..error })?;
            }
        }
        Ok(self)
    }
}

fn check_color(parameter: &'static str, color: DVec3) -> Result<DVec3, ParameterError> {
    color.to_array().into_iter().try_for_each(|value| ParameterError::check_unit(parameter, value).map(|_| ()))?;
    Ok(color)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_exact_equations_agree_with_each_other_and_with_known_points() {
        for i in 0..=50 {
            let VoH = f64::from(i) / 50.0;
            let (clear, metal) = (F_dielectric(1.5, VoH), conductor(1.5, 0.0, VoH));
            assert!((clear - metal).abs() < 1e-14, "cos {VoH}: {clear} and {metal}");
        }
        assert!((F_dielectric(1.5, 1.0) - 0.04).abs() < 1e-15);
        assert_eq!(F_dielectric(1.5, 0.0), 1.0);
        // Brewster's angle, tan = n: only half of the light, the other polarisation, is reflected, by ((n^2-1)/(n^2+1))^2.
        let brewster = 1.0 / (1.0_f64 + 1.5 * 1.5).sqrt();
        assert!((F_dielectric(1.5, brewster) - 0.5 * (1.25_f64 / 3.25).powi(2)).abs() < 1e-14);
        // Behind the critical angle of glass to air, sin = 1/1.5, all.
        assert_eq!(F_dielectric(1.0 / 1.5, (1.0_f64 - 0.68 * 0.68).sqrt()), 1.0);
        let (n, k) = (2.9, 3.1);
        let f0 = ((n - 1.0_f64).powi(2) + k * k) / ((n + 1.0_f64).powi(2) + k * k);
        assert!((conductor(n, k, 1.0) - f0).abs() < 1e-14);
        assert!((conductor(n, k, 0.0) - 1.0).abs() < 1e-14);
    }

    #[test]
    fn schlick_is_off_by_0_036_for_glass() {
        let error = |i: i32| {
            let VoH = f64::from(i) / 1000.0;
            (F_Schlick(DVec3::splat(0.04), 1.0, VoH).x - F_dielectric(1.5, VoH)).abs()
        };
        let worst = (0..=1000).map(error).fold(0.0, f64::max);
        // Measured 0.0357.
        assert!((worst - 0.0357).abs() < 5e-5, "{worst}");
    }

    #[test]
    fn f82_goes_through_its_value() {
        let (f0, f82) = (DVec3::new(0.9, 0.5, 0.6), DVec3::new(0.84, 0.57, 0.61));
        assert!((F_F82(f0, f82, COS_82) - f82).length() < 1e-15);
        assert!((F_F82(f0, f82, 1.0) - f0).length() < 1e-15);
        assert!((F_F82(f0, f82, 0.0) - DVec3::ONE).length() < 1e-15);
    }

    #[test]
    fn curves_that_leave_the_possible_are_refused() {
        let (grey, parameter) =
            (DVec3::splat(0.5), |result: Result<Fresnel, ParameterError>| result.unwrap_err().parameter);
        assert!(Fresnel::lazanyi(grey, DVec3::splat(3.0)).is_ok());
        assert_eq!(parameter(Fresnel::lazanyi(grey, DVec3::new(0.0, 30.0, 0.0))), "a");
        assert_eq!(parameter(Fresnel::lazanyi(grey, DVec3::NAN)), "a");
        assert_eq!(parameter(Fresnel::lazanyi(DVec3::splat(1.1), DVec3::ZERO)), "f0");
        assert_eq!(parameter(Fresnel::f82(grey, DVec3::splat(-0.1))), "f82");
        // Reachable at 82 degrees alone: the curve dips below 0 beside it.
        assert_eq!(parameter(Fresnel::f82(DVec3::ZERO, DVec3::ZERO)), "f82");
        assert_eq!(parameter(Fresnel::schlick(grey, 1.5)), "f90");
        assert_eq!(parameter(Fresnel::dielectric(0.0)), "eta");
        assert_eq!(parameter(Fresnel::conductor(DVec3::ZERO, grey)), "n");
        assert_eq!(parameter(Fresnel::conductor(grey, -grey)), "k");
    }
}
