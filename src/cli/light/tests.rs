use super::*;
use crate::scene::LightKind;
use std::f64::consts::PI;

fn parsed(spec: &str) -> PlacedLight {
    parse(spec).unwrap_or_else(|problem| panic!("{spec}: {problem}"))
}

fn close(found: f64, expected: f64) {
    assert!((found / expected - 1.0).abs() < 1e-12, "{found} instead of {expected}");
}

#[test]
fn point_lights_by_flux_and_by_intensity() {
    let lamp = parsed("point:flux=1200lm,at=1,-2,3.5");
    close(lamp.light.intensity, 1200.0 / (4.0 * PI));
    assert_eq!(lamp.light.kind, LightKind::Point { range_m: None });
    assert_eq!((lamp.position_in_world, lamp.light.color), (DVec3::new(1.0, -2.0, 3.5), DVec3::ONE));
    assert_eq!(lamp.note, None);
    let lamp = parsed("point: at=0,0,0 , range=10, intensity = 1e2 cd");
    assert_eq!((lamp.light.intensity, lamp.light.kind), (100.0, LightKind::Point { range_m: Some(10.0) }));
}

#[test]
fn a_colour_tints_and_keeps_the_lumens() {
    let light = parsed("point:intensity=100cd,at=0,0,0,color=#ffaa88").light;
    close(crate::math::color::luminance(light.color * light.intensity), 100.0);
    close(light.color.y / light.color.x, linear_from_srgb(f64::from(0xaa) / 255.0));
}

#[test]
fn spot_lights_look_along_dir_or_at_a_point() {
    let spot = parsed("spot:intensity=7cd,at=1,2,3,to=1,0,3,inner=20,outer=30");
    assert_eq!(spot.direction_in_world, DVec3::NEG_Y);
    let (inner_cone_rad, outer_cone_rad) = (20.0_f64.to_radians(), 30.0_f64.to_radians());
    assert_eq!(spot.light.kind, LightKind::Spot { range_m: None, inner_cone_rad, outer_cone_rad });
    let wide = parsed("spot:flux=800lm,at=0,0,0,dir=0,-3,0,outer=90");
    assert_eq!(wide.direction_in_world, DVec3::NEG_Y);
    // 1 - 2/3 of the cosine's range from 0 to 1.
    close(wide.light.intensity, 800.0 / (2.0 * PI / 3.0));
}

#[test]
fn directional_lights_by_illuminance_and_by_radiance() {
    let lamp = parsed("directional:illuminance=50000lux,dir=0,-1,0");
    assert_eq!((lamp.light.kind, lamp.light.intensity), (LightKind::Directional, 50_000.0));
    let sun = parsed("directional:radiance=1.6e9nits,angular-diameter=0.53,dir=1,-1,0");
    close(sun.light.intensity, 1.6e9 * PI * 0.265_f64.to_radians().sin().powi(2));
    assert!((sun.light.intensity / 1.07e5 - 1.0).abs() < 0.01, "{} lux", sun.light.intensity);
    assert!(sun.direction_in_world.is_normalized());
}

#[test]
fn watts_count_as_light_of_555_nm_and_say_so() {
    let specs = [
        ("point:flux=2W,at=0,0,0", 1366.0 / (4.0 * PI), "2 W count as 1366 lm"),
        ("point:intensity=2W/sr,at=0,0,0", 1366.0, "2 W/sr count as 1366 cd"),
        ("directional:illuminance=2W/m2,dir=0,-1,0", 1366.0, "2 W/m2 count as 1366 lux"),
        ("directional:radiance=2W/m2/sr,angular-diameter=180,dir=0,-1,0", 1366.0 * PI, "2 W/m2/sr count as 1366 nits"),
    ];
    for (spec, intensity, words) in specs {
        let light = parsed(spec);
        close(light.light.intensity, intensity);
        let note = light.note.unwrap();
        assert!(note.contains(words) && note.contains("683 lm/W") && note.contains("555 nm"), "{note}");
    }
}

#[test]
fn what_is_wrong_is_named() {
    let cases = [
        ("point", "point:..."),
        ("area:flux=1lm", "`area` is no kind of light"),
        ("point:", "expected name=value"),
        ("point:flux=-1lm,at=0,0,0", "flux: luminous flux is -1, expected"),
        ("point:flux=-1W,at=0,0,0", "flux: radiant flux is -1, expected"),
        ("point:flux=nanlm,at=0,0,0", "flux: luminous flux is NaN"),
        ("point:flux=1e999lm,at=0,0,0", "flux: luminous flux is inf"),
        ("point:flux=5,at=0,0,0", "flux: `5` has no unit, expected lm or W"),
        ("point:flux=5cd,at=0,0,0", "flux: `5cd` has the unit `cd`, expected lm or W"),
        ("point:flux=lm,at=0,0,0", "flux: `lm` does not begin with a number"),
        ("point:flux=1e40lm,at=0,0,0", "flux or intensity: strength of the light is"),
        ("point:at=0,0,0", "either flux or intensity"),
        ("point:flux=1lm,intensity=1cd,at=0,0,0", "either flux or intensity"),
        ("point:flux=1lm", "at=X,Y,Z is missing"),
        ("point:flux=1lm,at=0,0", "at: expected three numbers"),
        ("point:flux=1lm,at=0,0,inf", "at: `inf` is not a finite number"),
        ("point:flux=1lm,flux=2lm,at=0,0,0", "flux is given twice"),
        ("point:flux=1lm,at=0,0,0,dir=0,1,0", "`dir` is no parameter of a point light"),
        ("point:flux=1lm,at=0,0,0,range=0", "range: range is 0, expected"),
        ("point:flux=1lm,at=0,0,0,color=red", "color: `red` is no colour"),
        ("point:flux=1lm,at=0,0,0,color=#000000", "color: color is 0, expected"),
        ("spot:flux=1lm,at=0,0,0", "dir=X,Y,Z or to=X,Y,Z is missing"),
        ("spot:flux=1lm,at=0,0,0,dir=0,0,0", "dir: expected a vector"),
        ("spot:flux=1lm,at=1,2,3,to=1,2,3", "to: the light stands there itself"),
        ("spot:flux=1lm,at=1,2,3,to=0,0,0,dir=1,0,0", "dir and to: expected one of them"),
        ("spot:flux=1lm,at=0,0,0,dir=1,0,0,outer=91", "outer: 91 degrees"),
        ("spot:flux=1lm,at=0,0,0,dir=1,0,0,inner=46", "inner: 46 degrees"),
        ("spot:flux=1lm,at=0,0,0,dir=1,0,0,inner=NaN", "inner: `NaN` is not a finite number"),
        ("directional:dir=0,1,0", "either illuminance or radiance"),
        ("directional:illuminance=5lux", "dir=X,Y,Z is missing"),
        ("directional:illuminance=5W/m2/sr,dir=0,1,0", "illuminance: `5W/m2/sr` has the unit"),
        ("directional:radiance=5nits,dir=0,1,0", "angular-diameter is missing"),
        ("directional:radiance=5nits,angular-diameter=0,dir=0,1,0", "angular-diameter: 0 degrees"),
        ("directional:illuminance=5lux,angular-diameter=1,dir=0,1,0", "`angular-diameter` is no parameter"),
        ("directional:illuminance=5lux,dir=0,1,0,to=1,1,1", "`to` is no parameter"),
    ];
    for (spec, expected) in cases {
        let problem = parse(spec).unwrap_err();
        assert!(problem.contains(expected), "{spec}: {problem}");
        assert_eq!(problem.lines().count(), 1);
    }
    let args = LightArgs { specs: vec!["point:flux=1lm,at=0,0,0".into(), "spot:".into()] };
    assert!(args.parse().unwrap_err().to_string().starts_with("--light spot:: "));
}
