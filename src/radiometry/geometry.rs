//! The quantities without light in them: lengths, angles, reflectances.

use super::error::RadiometryError;
use glam::DVec3;
use std::f64::consts::{FRAC_1_PI, PI};
use std::fmt;
use std::ops::Mul;

macro_rules! scalar {
    ($(#[$doc:meta])* $name:ident, $label:literal, $from:ident, $as:ident, $unit:literal, $valid:expr, $expected:literal) => {
        $(#[$doc])*
        #[derive(Debug, Clone, Copy, PartialEq, PartialOrd)]
        #[repr(transparent)]
        pub struct $name(f64);

        impl $name {
            #[doc = concat!("The ", $label, ": ", $expected, ".")]
            pub fn $from(value: f64) -> Result<Self, RadiometryError> {
                let in_domain: fn(f64) -> bool = $valid;
                RadiometryError::check(value.is_finite() && in_domain(value), $label, value, $expected).map(Self)
            }

            #[doc = concat!("The ", $label, " as a number", $unit, ".")]
            pub const fn $as(self) -> f64 {
                self.0
            }

            /// The caller vouches for the domain.
            #[allow(dead_code, reason = "not every one of them is the result of a formula")]
            pub(crate) const fn raw(value: f64) -> Self {
                Self(value)
            }
        }

        impl fmt::Display for $name {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                fmt::Display::fmt(&self.0, f)?;
                f.write_str($unit)
            }
        }
    };
}

scalar! {
    /// A distance in metres.
    Distance, "distance", from_meters, as_meters, " m", |x| x > 0.0, "a finite number above 0, in m"
}

scalar! {
    /// An area in m2.
    Area, "area", from_square_meters, as_square_meters, " m2", |x| x > 0.0, "a finite number above 0, in m2"
}

scalar! {
    /// What part of the unit sphere something covers, in sr.
    SolidAngle, "solid angle", from_steradians, as_steradians, " sr",
    |x| (0.0..=4.0 * PI).contains(&x), "a number from 0 to 4 pi, in sr"
}

scalar! {
    /// A solid angle in which every direction is weighted with its cosine to a surface's normal, in sr: the integral of
    /// cos over the directions. All of the hemisphere has pi.
    ProjectedSolidAngle, "projected solid angle", from_steradians, as_steradians, " sr",
    |x| (0.0..=PI).contains(&x), "a number from 0 to pi, in sr"
}

scalar! {
    /// How much room a beam has, m2 sr: area times projected solid angle. Lenses and free space leave it as it is.
    Etendue, "etendue", from_square_meter_steradians, as_square_meter_steradians, " m2 sr",
    |x| x >= 0.0, "a finite number from 0 up, in m2 sr"
}

scalar! {
    /// Cosine of the angle between a direction and a surface's normal; 0 for all that is below the horizon.
    Cosine, "cosine", new, get, "", |x| (0.0..=1.0).contains(&x), "a number from 0 to 1"
}

scalar! {
    /// The fraction of the light that a surface gives back, in all directions together.
    Albedo, "albedo", new, get, "", |x| (0.0..=1.0).contains(&x), "a number from 0 to 1"
}

scalar! {
    /// The value of a BRDF for one pair of directions, 1/sr: radiance out over irradiance in. Without an upper bound.
    Brdf, "BRDF", per_steradian, as_per_steradian, " /sr", |x| x >= 0.0, "a finite number from 0 up, in 1/sr"
}

impl SolidAngle {
    /// All directions, 4 pi.
    pub const SPHERE: Self = Self(4.0 * PI);
    /// All directions on one side of a plane, 2 pi.
    pub const HEMISPHERE: Self = Self(2.0 * PI);
}

impl ProjectedSolidAngle {
    /// All directions above a surface, pi.
    pub const HEMISPHERE: Self = Self(PI);
}

impl Cosine {
    /// Between two vectors of any length above 0; 0 when they are more than a right angle apart.
    pub fn between(a: DVec3, b: DVec3) -> Result<Self, RadiometryError> {
        let [a, b] = [("first vector", a), ("second vector", b)].map(|(name, vector)| unit(name, vector));
        Ok(Self(a?.dot(b?).clamp(0.0, 1.0)))
    }
}

impl Brdf {
    /// Lambert's surface, equally bright from everywhere: albedo / pi (Lambert 1760).
    ///
    /// This is where pi belongs. L = rho E with rho a BRDF's value and L = rho E / pi with rho an albedo say the same.
    pub fn lambertian(albedo: Albedo) -> Self {
        Self(albedo.0 * FRAC_1_PI)
    }
}

impl Mul for Distance {
    type Output = Area;

    fn mul(self, other: Self) -> Area {
        Area(self.0 * other.0)
    }
}

/// `vector` at unit length; an error that names it when it has none.
pub(super) fn unit(parameter: &'static str, vector: DVec3) -> Result<DVec3, RadiometryError> {
    let expected = "a vector with a finite length above 0";
    let error = RadiometryError { parameter, value: vector.length(), expected };
    // Scaled first: the squares of huge and of tiny coordinates leave the range of f64.
    let largest = vector.abs().max_element();
    if !(vector.is_finite() && largest > 0.0) {
        return Err(error);
    }
    (vector / largest).try_normalize().ok_or(error)
}
