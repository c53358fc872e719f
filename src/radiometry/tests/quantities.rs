//! Domains, conversions, and the operators between quantities.

use super::super::*;
use glam::DVec3;
use std::f64::consts::PI;

fn refused<T: std::fmt::Debug>(result: Result<T, RadiometryError>, parameter: &str, value: f64) {
    let error = result.unwrap_err();
    assert_eq!(error.parameter, parameter);
    assert!(error.value == value || (error.value.is_nan() && value.is_nan()), "{error}");
    assert!(error.to_string().starts_with(parameter), "{error}");
}

#[test]
fn numbers_that_no_light_has_are_refused_by_name() {
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, -1e-300] {
        refused(RadiantFlux::from_watts(bad), "radiant flux", bad);
        refused(LuminousFlux::from_lumens(bad), "luminous flux", bad);
        refused(Irradiance::from_watts_per_square_meter(bad), "irradiance", bad);
        refused(Illuminance::from_lux(bad), "illuminance", bad);
        refused(RadiantExitance::from_watts_per_square_meter(bad), "radiant exitance", bad);
        refused(LuminousExitance::from_lumens_per_square_meter(bad), "luminous exitance", bad);
        refused(RadiantIntensity::from_watts_per_steradian(bad), "radiant intensity", bad);
        refused(LuminousIntensity::from_candelas(bad), "luminous intensity", bad);
        refused(Radiance::from_watts_per_square_meter_steradian(bad), "radiance", bad);
        refused(Luminance::from_nits(bad), "luminance", bad);
        refused(Distance::from_meters(bad), "distance", bad);
        refused(Area::from_square_meters(bad), "area", bad);
        refused(SolidAngle::from_steradians(bad), "solid angle", bad);
        refused(ProjectedSolidAngle::from_steradians(bad), "projected solid angle", bad);
        refused(Etendue::from_square_meter_steradians(bad), "etendue", bad);
        refused(Cosine::new(bad), "cosine", bad);
        refused(Albedo::new(bad), "albedo", bad);
        refused(Brdf::per_steradian(bad), "BRDF", bad);
        refused(LuminousEfficacy::from_lumens_per_watt(bad), "luminous efficacy", bad);
        refused(solid_angle::cone(bad), "half angle", bad);
    }
    refused(Distance::from_meters(0.0), "distance", 0.0);
    refused(SolidAngle::from_steradians(12.567), "solid angle", 12.567);
    refused(ProjectedSolidAngle::from_steradians(3.15), "projected solid angle", 3.15);
    refused(Albedo::new(1.1), "albedo", 1.1);
    refused(LuminousEfficacy::from_lumens_per_watt(684.0), "luminous efficacy", 684.0);
    assert_eq!(
        Luminance::from_nits(-2.0).unwrap_err().to_string(),
        "luminance is -2, expected a finite number from 0 up, in nits"
    );
}

#[test]
fn vectors_without_a_direction_are_refused_by_name() {
    let at = DVec3::ZERO;
    refused(Receiver::new(at, DVec3::ZERO), "normal", 0.0);
    refused(Receiver::new(DVec3::NAN, DVec3::X), "position", f64::NAN);
    refused(Cosine::between(DVec3::INFINITY, DVec3::X), "first vector", f64::INFINITY);
    refused(Rectangle::new(at, DVec3::X, DVec3::ZERO), "edge v", 0.0);
    refused(Rectangle::new(at, DVec3::X, DVec3::X), "cosine between the edges", 1.0);
    refused(Rectangle::square(at, DVec3::Y, f64::NAN), "corner", f64::NAN);
    // Neither huge nor tiny vectors lose their direction.
    for scale in [1e-300, 1e300] {
        assert_eq!(Receiver::new(at, DVec3::Y * scale).unwrap().normal(), DVec3::Y);
    }
}

#[test]
fn arithmetic_that_overflows_is_found() {
    let flux = LuminousFlux::from_lumens(1e300).unwrap();
    refused((flux / SolidAngle::from_steradians(0.0).unwrap()).checked(), "luminous intensity", f64::INFINITY);
    let near = Distance::from_meters(1e-200).unwrap();
    refused(
        flux.isotropic_intensity().irradiance_at(near, Cosine::new(1.0).unwrap()).checked(),
        "illuminance",
        f64::INFINITY,
    );
    // A distance whose square is no number is a distance all the same.
    let faint = LuminousIntensity::from_candelas(1e-200).unwrap();
    let illuminance = faint.irradiance_at(near, Cosine::new(1.0).unwrap());
    assert!((illuminance.as_lux() / 1e200 - 1.0).abs() < 1e-15);
}

#[test]
fn quantities_are_as_small_as_their_number() {
    assert_eq!(size_of::<RadiantFlux>(), size_of::<f64>());
    assert_eq!(size_of::<Luminance>(), size_of::<f64>());
    assert_eq!(size_of::<SolidAngle>(), size_of::<f64>());
}

#[test]
fn only_an_efficacy_leads_from_watts_to_lumens() {
    let green = RadiantFlux::from_watts(2.0).unwrap().to_photometric(LuminousEfficacy::MONOCHROMATIC_555_NM);
    assert_eq!(green.as_lumens(), 1366.0);
    let sun = LuminousEfficacy::from_lumens_per_watt(93.0).unwrap();
    let irradiance = Illuminance::from_lux(93_000.0).unwrap().to_radiometric(sun);
    assert_eq!(irradiance.as_watts_per_square_meter(), 1000.0);
    let [there, back] = [Radiance::from_watts_per_square_meter_steradian(7.0).unwrap(); 2];
    assert!((there.to_photometric(sun).to_radiometric(sun) / back - 1.0).abs() < 1e-15);
}

#[test]
fn lamberts_cosine_law() {
    let facing = Illuminance::from_lux(1000.0).unwrap();
    let tilt = |degrees: f64| {
        let normal = DVec3::new(degrees.to_radians().sin(), degrees.to_radians().cos(), 0.0);
        (facing * Cosine::between(normal, DVec3::Y * 3.0).unwrap()).as_lux()
    };
    for (degrees, lux) in [(0.0, 1000.0), (60.0, 500.0), (80.0, 173.648_177_666_930_35), (91.0, 0.0), (180.0, 0.0)] {
        assert!((tilt(degrees) - lux).abs() < 1e-10, "{degrees} degrees: {} lux", tilt(degrees));
    }
}

#[test]
fn a_lambertian_lamp_looks_the_same_by_every_way_around() {
    // A disc of 1 cm2 and 5000 nits, seen 2 m away under 40 degrees by a surface that faces it.
    let (radiance, area) = (Luminance::from_nits(5000.0).unwrap(), Area::from_square_meters(1e-4).unwrap());
    let cosine = Cosine::new(40.0_f64.to_radians().cos()).unwrap();
    let (distance, facing) = (Distance::from_meters(2.0).unwrap(), Cosine::new(1.0).unwrap());
    let by_intensity = radiance.intensity_of(area, cosine).irradiance_at(distance, facing);
    let solid_angle = SolidAngle::from_steradians(1e-4 * cosine.get() / 4.0).unwrap();
    let by_solid_angle = solid_angle * facing * radiance;
    assert!((by_intensity / by_solid_angle - 1.0).abs() < 1e-15);
    // All it emits, by its exitance and by uniform radiance into the projected hemisphere.
    let by_exitance = radiance.lambertian_exitance() * area;
    let by_etendue = radiance * (ProjectedSolidAngle::HEMISPHERE * area);
    assert!((by_exitance / by_etendue - 1.0).abs() < 1e-15);
    assert!((by_exitance.as_lumens() - 5000.0 * PI * 1e-4).abs() < 1e-15);
    assert_eq!(by_exitance.emitted_by(area).lambertian_radiance().as_nits().round(), 5000.0);
}

#[test]
fn lights_add_up() {
    let lamps = [100.0, 250.0].map(|lux| Illuminance::from_lux(lux).unwrap());
    let sum: Illuminance = lamps.into_iter().sum();
    assert_eq!(sum, lamps[0] + lamps[1]);
    assert_eq!(sum / lamps[0], 3.5);
    let angle = ProjectedSolidAngle::from_steradians(0.5).unwrap();
    assert_eq!((sum / angle * angle).as_lux(), 350.0);
}
