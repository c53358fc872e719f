//! What may be multiplied with what.
//!
//! Flux per area has no operator: it is an irradiance when the flux arrives and an exitance when it leaves, and `/` could
//! not tell. [`Flux::incident_on`] and [`Flux::emitted_by`] can.

use super::geometry::{Albedo, Area, Brdf, Cosine, Distance, Etendue, ProjectedSolidAngle, SolidAngle};
use super::quantity::{Exitance, Flux, Intensity, Irradiance, Radiance};
use super::system::System;
use std::f64::consts::{FRAC_1_PI, PI};
use std::ops::{Div, Mul};

/// `light * measure = product` in either order, and `product / measure = light` where that is the only reading.
macro_rules! product {
    ($(#[$doc:meta])* $light:ident * $measure:ident = $product:ident, $number:ident) => {
        $(#[$doc])*
        impl<S: System> Mul<$measure> for $light<S> {
            type Output = $product<S>;

            fn mul(self, measure: $measure) -> $product<S> {
                $product::raw(self.value() * measure.$number())
            }
        }

        $(#[$doc])*
        impl<S: System> Mul<$light<S>> for $measure {
            type Output = $product<S>;

            fn mul(self, light: $light<S>) -> $product<S> {
                light * self
            }
        }
    };
    ($(#[$doc:meta])* $light:ident * $measure:ident = $product:ident, $number:ident, invertible) => {
        product!($(#[$doc])* $light * $measure = $product, $number);

        $(#[$doc])*
        impl<S: System> Div<$measure> for $product<S> {
            type Output = $light<S>;

            fn div(self, measure: $measure) -> $light<S> {
                $light::raw(self.value() / measure.$number())
            }
        }
    };
}

product!(
    /// E = L Omega_p: what a source of uniform radiance sends to a surface.
    Radiance * ProjectedSolidAngle = Irradiance, as_steradians, invertible
);
product!(
    /// Phi = L G: what uniform radiance carries through two apertures.
    Radiance * Etendue = Flux, as_square_meter_steradians, invertible
);
product!(
    /// Phi = I Omega: what uniform intensity sends into a cone.
    Intensity * SolidAngle = Flux, as_steradians, invertible
);
product!(
    /// Phi = E A: what a surface receives.
    Irradiance * Area = Flux, as_square_meters
);
product!(
    /// Phi = M A: what a surface emits.
    Exitance * Area = Flux, as_square_meters
);
product!(
    /// E = E_perpendicular cos: Lambert's cosine law (Lambert 1760). A tilted surface spreads the same beam.
    Irradiance * Cosine = Irradiance, get
);
product!(
    /// L = f E: what a surface shows of light from one direction; a definition of the BRDF (Nicodemus 1977).
    Irradiance * Brdf = Radiance, as_per_steradian
);
product!(
    /// M = albedo E: all that a surface gives back.
    Irradiance * Albedo = Exitance, get
);

/// Omega_p = Omega cos, of a source so small that the cosine is the same all over it.
impl Mul<Cosine> for SolidAngle {
    type Output = ProjectedSolidAngle;

    fn mul(self, cosine: Cosine) -> ProjectedSolidAngle {
        // A hemisphere has no single cosine; what it can have at most is pi.
        ProjectedSolidAngle::raw((self.as_steradians() * cosine.get()).min(PI))
    }
}

/// G = A Omega_p, where the projected solid angle is the same, or averaged, over the area.
impl Mul<Area> for ProjectedSolidAngle {
    type Output = Etendue;

    fn mul(self, area: Area) -> Etendue {
        Etendue::raw(self.as_steradians() * area.as_square_meters())
    }
}

impl<S: System> Flux<S> {
    /// E = Phi / A.
    pub fn incident_on(self, area: Area) -> Irradiance<S> {
        Irradiance::raw(self.value() / area.as_square_meters())
    }

    /// M = Phi / A.
    pub fn emitted_by(self, area: Area) -> Exitance<S> {
        Exitance::raw(self.value() / area.as_square_meters())
    }

    /// I = Phi / 4 pi: of a source that shines the same in all directions.
    pub fn isotropic_intensity(self) -> Intensity<S> {
        self / SolidAngle::SPHERE
    }
}

impl<S: System> Intensity<S> {
    /// E = I cos / r^2: the inverse square law and Lambert's cosine law for a source that is a point.
    pub fn irradiance_at(self, distance: Distance, cosine: Cosine) -> Irradiance<S> {
        // Two divisions: the square of a distance of 1e-200 m is no number.
        Irradiance::raw(self.value() / distance.as_meters() / distance.as_meters() * cosine.get())
    }
}

impl<S: System> Radiance<S> {
    /// M = pi L: of a surface that is equally bright from everywhere.
    pub fn lambertian_exitance(self) -> Exitance<S> {
        Exitance::raw(self.value() * PI)
    }

    /// I = L A cos: of a small surface seen under an angle.
    pub fn intensity_of(self, area: Area, cosine: Cosine) -> Intensity<S> {
        Intensity::raw(self.value() * area.as_square_meters() * cosine.get())
    }
}

impl<S: System> Exitance<S> {
    /// L = M / pi: of a surface that is equally bright from everywhere.
    pub fn lambertian_radiance(self) -> Radiance<S> {
        Radiance::raw(self.value() * FRAC_1_PI)
    }
}
