//! The two systems of units, and the one bridge between them.

use super::error::RadiometryError;
use std::fmt::Debug;

mod sealed {
    pub trait Sealed {}
}

/// How power is weighted over the spectrum: [`Radiometric`] or [`Photometric`].
pub trait System: sealed::Sealed + Copy + Debug + PartialEq + PartialOrd {}

/// Every wavelength counts the same; power is in watts.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd)]
pub struct Radiometric;

/// Wavelengths count as the eye sees them by day (the CIE's V(lambda)); power is in lumens.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd)]
pub struct Photometric;

impl sealed::Sealed for Radiometric {}
impl sealed::Sealed for Photometric {}
impl System for Radiometric {}
impl System for Photometric {}

/// Lumens that a watt of some light is worth, lm/W. A property of its spectrum, which is why nobody can guess it.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd)]
pub struct LuminousEfficacy(f64);

impl LuminousEfficacy {
    /// 683 lm/W: monochromatic light of 540 THz, or 555 nm in air, where the eye is most sensitive. The SI defines the
    /// candela by it (BIPM, SI brochure, 9th edition 2019, section 2.3.1). No light has more.
    ///
    /// Where no spectrum is known Specula converts with this, and says so.
    pub const MONOCHROMATIC_555_NM: Self = Self(683.0);

    /// The efficacy of a light whose spectrum is known: above 0 and up to 683 lm/W. The sun at noon has about 93,
    /// a white LED's spectrum about 300.
    pub fn from_lumens_per_watt(value: f64) -> Result<Self, RadiometryError> {
        let in_domain = value > 0.0 && value <= Self::MONOCHROMATIC_555_NM.0;
        RadiometryError::check(in_domain, "luminous efficacy", value, "a number above 0 and up to 683 lm/W").map(Self)
    }

    pub fn as_lumens_per_watt(self) -> f64 {
        self.0
    }
}
