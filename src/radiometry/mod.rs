//! Quantities of light with the unit in the type, and the laws between them.
//!
//! Two systems measure light: radiometry in watts, photometry in lumens. Every quantity exists in both, as
//! [`Flux<Radiometric>`](Flux) and [`Flux<Photometric>`](Flux) with the names [`RadiantFlux`] and [`LuminousFlux`]; only
//! a [`LuminousEfficacy`] leads from one to the other. Operators exist where physics has them, so that a mix-up does not
//! compile. docs/radiometry.md has the table of quantities, units and formulas.
//!
//! ```
//! use specula::radiometry::{Albedo, Area, Brdf, Cosine, Distance, LuminousFlux, RadiantFlux};
//! # fn main() -> Result<(), specula::radiometry::RadiometryError> {
//! // 50 W that fall on 2 m2 are 25 W/m2.
//! let irradiance = RadiantFlux::from_watts(50.0)?.incident_on(Area::from_square_meters(2.0)?);
//! assert_eq!(irradiance.as_watts_per_square_meter(), 25.0);
//!
//! // A lamp of 1200 lm, 2 m above a white table: E = Phi cos / (4 pi r^2), L = rho E / pi.
//! let lamp = LuminousFlux::from_lumens(1200.0)?.isotropic_intensity();
//! let illuminance = lamp.irradiance_at(Distance::from_meters(2.0)?, Cosine::new(1.0)?);
//! let luminance = illuminance * Brdf::lambertian(Albedo::new(0.8)?);
//! assert!((illuminance.as_lux() - 23.87).abs() < 0.01);
//! assert!((luminance.as_nits() - 6.08).abs() < 0.01);
//! # Ok(())
//! # }
//! ```
//!
//! Watts and lumens do not add:
//! ```compile_fail,E0308
//! # use specula::radiometry::{LuminousFlux, RadiantFlux};
//! # fn main() -> Result<(), specula::radiometry::RadiometryError> {
//! let sum = RadiantFlux::from_watts(5.0)? + LuminousFlux::from_lumens(5.0)?;
//! # Ok(())
//! # }
//! ```
//! A solid angle is not a projected one, which would be wrong by up to a factor of two:
//! ```compile_fail,E0277
//! # use specula::radiometry::{Luminance, SolidAngle};
//! # fn main() -> Result<(), specula::radiometry::RadiometryError> {
//! let illuminance = Luminance::from_nits(5.0)? * SolidAngle::HEMISPHERE;
//! # Ok(())
//! # }
//! ```
//! An albedo is not the value of a BRDF; they differ by pi:
//! ```compile_fail,E0308
//! # use specula::radiometry::{Albedo, Illuminance, Luminance};
//! # fn main() -> Result<(), specula::radiometry::RadiometryError> {
//! let luminance: Luminance = Illuminance::from_lux(100.0)? * Albedo::new(0.5)?;
//! # Ok(())
//! # }
//! ```
//! Nor is there light that a number alone could describe:
//! ```compile_fail,E0308
//! # use specula::radiometry::LuminousIntensity;
//! let intensity: LuminousIntensity = 100.0;
//! ```

mod algebra;
pub mod emission;
mod error;
mod geometry;
pub mod irradiance;
mod quantity;
mod shapes;
pub mod solid_angle;
mod system;
#[cfg(test)]
mod tests;

pub use error::RadiometryError;
pub use geometry::{Albedo, Area, Brdf, Cosine, Distance, Etendue, ProjectedSolidAngle, SolidAngle};
pub use quantity::{
    Exitance, Flux, Illuminance, Intensity, Irradiance, Luminance, LuminousExitance, LuminousFlux, LuminousIntensity,
    Radiance, RadiantExitance, RadiantFlux, RadiantIntensity,
};
pub use shapes::{Receiver, Rectangle};
pub use system::{LuminousEfficacy, Photometric, Radiometric, System};
