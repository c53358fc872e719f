//! The five quantities of light, each in watts and in lumens.

use super::error::RadiometryError;
use super::system::{LuminousEfficacy, Photometric, Radiometric, System};
use std::fmt;
use std::iter::Sum;
use std::marker::PhantomData;
use std::ops::{Add, Div};

/// One quantity: a number of its unit in the system `S`, no larger than an f64.
macro_rules! quantity {
    (
        $(#[$doc:meta])* $name:ident,
        $radiant:literal, $from_radiant:ident, $as_radiant:ident, $radiant_unit:literal;
        $luminous:literal, $from_luminous:ident, $as_luminous:ident, $luminous_unit:literal
    ) => {
        $(#[$doc])*
        #[derive(Debug, Clone, Copy, PartialEq, PartialOrd)]
        #[repr(transparent)]
        pub struct $name<S: System = Radiometric> {
            value: f64,
            system: PhantomData<S>,
        }

        impl<S: System> $name<S> {
            /// No light at all.
            pub const ZERO: Self = Self::raw(0.0);

            /// The caller vouches for the domain, or leaves it to `checked`.
            pub(super) const fn raw(value: f64) -> Self {
                Self { value, system: PhantomData }
            }

            /// The number of units of the system.
            pub(super) const fn value(self) -> f64 {
                self.value
            }
        }

        quantity!(@system $name, Radiometric, $radiant, $from_radiant, $as_radiant, $radiant_unit);
        quantity!(@system $name, Photometric, $luminous, $from_luminous, $as_luminous, $luminous_unit);

        impl $name<Radiometric> {
            /// The same light as the eye weighs it.
            pub fn to_photometric(self, efficacy: LuminousEfficacy) -> $name<Photometric> {
                $name::raw(self.value * efficacy.as_lumens_per_watt())
            }
        }

        impl $name<Photometric> {
            /// The same light in watts.
            pub fn to_radiometric(self, efficacy: LuminousEfficacy) -> $name<Radiometric> {
                $name::raw(self.value / efficacy.as_lumens_per_watt())
            }
        }

        impl<S: System> Add for $name<S> {
            type Output = Self;

            fn add(self, other: Self) -> Self {
                Self::raw(self.value + other.value)
            }
        }

        impl<S: System> Sum for $name<S> {
            fn sum<I: Iterator<Item = Self>>(items: I) -> Self {
                items.fold(Self::ZERO, Add::add)
            }
        }

        /// How many times the other it is.
        impl<S: System> Div for $name<S> {
            type Output = f64;

            fn div(self, other: Self) -> f64 {
                self.value / other.value
            }
        }
    };
    (@system $name:ident, $system:ident, $label:literal, $from:ident, $as:ident, $unit:literal) => {
        impl $name<$system> {
            #[doc = concat!("The ", $label, " in ", $unit, ": finite, 0 or above.")]
            pub fn $from(value: f64) -> Result<Self, RadiometryError> {
                Self::raw(value).checked()
            }

            #[doc = concat!("The ", $label, " in ", $unit, ".")]
            pub const fn $as(self) -> f64 {
                self.value
            }

            /// The quantity itself, unless arithmetic has left its domain: huge products are infinite, as are divisions
            /// by an angle of zero.
            pub fn checked(self) -> Result<Self, RadiometryError> {
                let expected = concat!("a finite number from 0 up, in ", $unit);
                let in_domain = self.value.is_finite() && self.value >= 0.0;
                RadiometryError::check(in_domain, $label, self.value, expected).map(Self::raw)
            }
        }

        impl fmt::Display for $name<$system> {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                fmt::Display::fmt(&self.value, f)?;
                f.write_str(concat!(" ", $unit))
            }
        }
    };
}

quantity! {
    /// Power of light: all of what a source emits, or a surface receives, in W or lm.
    Flux,
    "radiant flux", from_watts, as_watts, "W";
    "luminous flux", from_lumens, as_lumens, "lm"
}

quantity! {
    /// Flux that arrives at a surface, per area: W/m2 or lux.
    Irradiance,
    "irradiance", from_watts_per_square_meter, as_watts_per_square_meter, "W/m2";
    "illuminance", from_lux, as_lux, "lux"
}

quantity! {
    /// Flux that leaves a surface into all of its hemisphere, per area: W/m2 or lm/m2.
    Exitance,
    "radiant exitance", from_watts_per_square_meter, as_watts_per_square_meter, "W/m2";
    "luminous exitance", from_lumens_per_square_meter, as_lumens_per_square_meter, "lm/m2"
}

quantity! {
    /// Flux that leaves a point in a direction, per solid angle: W/sr or cd.
    Intensity,
    "radiant intensity", from_watts_per_steradian, as_watts_per_steradian, "W/sr";
    "luminous intensity", from_candelas, as_candelas, "cd"
}

quantity! {
    /// Flux along a ray, per solid angle and projected area: W/m2/sr or cd/m2 (nits). Constant along the ray, in vacuum;
    /// what a camera records.
    Radiance,
    "radiance", from_watts_per_square_meter_steradian, as_watts_per_square_meter_steradian, "W/m2/sr";
    "luminance", from_nits, as_nits, "nits"
}

/// Flux in W.
pub type RadiantFlux = Flux<Radiometric>;
/// Flux in lm.
pub type LuminousFlux = Flux<Photometric>;
/// Irradiance in lux.
pub type Illuminance = Irradiance<Photometric>;
/// Exitance in W/m2.
pub type RadiantExitance = Exitance<Radiometric>;
/// Exitance in lm/m2.
pub type LuminousExitance = Exitance<Photometric>;
/// Intensity in W/sr.
pub type RadiantIntensity = Intensity<Radiometric>;
/// Intensity in cd.
pub type LuminousIntensity = Intensity<Photometric>;
/// Radiance in cd/m2.
pub type Luminance = Radiance<Photometric>;
