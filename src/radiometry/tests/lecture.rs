//! Examples of the lecture on physically based lighting.

use super::super::emission::exitance;
use super::super::*;
use std::f64::consts::PI;

#[test]
fn fifty_watts_on_two_square_meters() {
    let irradiance = RadiantFlux::from_watts(50.0).unwrap().incident_on(Area::from_square_meters(2.0).unwrap());
    assert_eq!(irradiance.as_watts_per_square_meter(), 25.0);
    assert_eq!(irradiance.to_string(), "25 W/m2");
}

#[test]
fn a_small_source_that_is_brightest_ahead() {
    // 10 cm x 10 cm, L = 6000 cos(theta) W/sr/m2: 2 pi 6000/3 W/m2 times 0.01 m2. The lecture rounds to 125 W.
    let radiance = |cosine: Cosine| Radiance::from_watts_per_square_meter_steradian(6000.0 * cosine.get()).unwrap();
    let side = Distance::from_meters(0.1).unwrap();
    let flux = exitance(radiance) * (side * side);
    assert!((flux.as_watts() - 40.0 * PI).abs() < 1e-12, "{flux}");
    assert!((flux.as_watts() - 125.66).abs() < 0.005);
}

#[test]
fn a_point_light_of_known_flux() {
    let (flux, albedo) = (LuminousFlux::from_lumens(1200.0).unwrap(), Albedo::new(0.5).unwrap());
    let (distance, cosine) = (Distance::from_meters(3.0).unwrap(), Cosine::new(0.6).unwrap());
    let illuminance = flux.isotropic_intensity().irradiance_at(distance, cosine);
    let expected_lux = 1200.0 * 0.6 / (4.0 * PI * 9.0);
    assert!((illuminance.as_lux() / expected_lux - 1.0).abs() < 1e-15);
    // The lecture's L = rho E has the BRDF's value for rho; with the albedo it is L = rho E / pi.
    let of_brdf = illuminance * Brdf::per_steradian(0.5 / PI).unwrap();
    let of_albedo = (illuminance * albedo).lambertian_radiance();
    assert!((of_brdf.as_nits() / of_albedo.as_nits() - 1.0).abs() < 1e-15);
    assert_eq!(of_brdf, illuminance * Brdf::lambertian(albedo));
}
