use super::*;
use crate::bake::test_support::sample_panorama;
use crate::math::spaces::{direction_from_equirect, orthonormal_basis};
use crate::progress::Silent;
use crate::threads::*;
use glam::{DVec2, Vec3};
use std::f64::consts::PI;

/// The filter is tested with the sun in the picture: it is the hardest part.
const WHOLE: BakeOptions = BakeOptions { max_side: LARGEST_SIDES[0], suns: false };

/// A sky with a gradient, a dark ground, a coloured window and a small sun of ten thousand times the sky's radiance.
fn synthetic(width: u32, height: u32) -> EnvironmentImage {
    let sun = DVec3::new(0.5, 0.6, -0.4).normalize();
    let window = DVec3::new(-0.7, 0.1, 0.3).normalize();
    let radiance = |d: DVec3| {
        let base =
            if d.y > 0.0 { DVec3::new(0.6, 0.8, 1.0).lerp(DVec3::splat(1.5), 1.0 - d.y) } else { DVec3::splat(0.1) };
        let lamp = if d.dot(window) > 0.97 { DVec3::new(20.0, 8.0, 4.0) } else { DVec3::ZERO };
        base + lamp + 1e4 * (-(1.0 - d.dot(sun)) / 2e-4).exp()
    };
    Panorama::from_fn(width as usize, height as usize, radiance).into()
}

/// A panorama of the shared samples, reduced to 256 x 128. `None` without them.
fn garden() -> Option<EnvironmentImage> {
    let full = sample_panorama("chinese_garden_1k.hdr")?;
    Some(Panorama::resampled(&full, 256, 128).into())
}

/// `count` directions spread evenly over the sphere.
fn on_sphere(count: u32) -> Vec<DVec3> {
    let direction = |i: u32| {
        let y = 1.0 - (2.0 * f64::from(i) + 1.0) / f64::from(count);
        let xz = golden_turn(i) * (1.0 - y * y).sqrt();
        DVec3::new(xz.x, y, xz.y)
    };
    (0..count).map(direction).collect()
}

/// `count` directions within 0.3 rad of the brightest texel, densest there.
fn near_the_brightest(image: &EnvironmentImage, count: u32) -> Vec<DVec3> {
    let green = |i: &usize| image.texels[*i].y;
    let brightest = (0..image.texels.len()).max_by(|a, b| green(a).total_cmp(&green(b))).unwrap() as u32;
    let peak = direction_from_equirect(texel_uv(brightest, image.width, image.height));
    let (b1, b2) = orthonormal_basis(peak);
    let direction = |i: u32| {
        let offset = golden_turn(i) * (0.3 * f64::from(i) / f64::from(count));
        (peak + b1 * offset.x + b2 * offset.y).normalize()
    };
    (0..count).map(direction).collect()
}

/// The unit vector after `i` turns by the golden angle.
fn golden_turn(i: u32) -> DVec2 {
    DVec2::from_angle(f64::from(i) * 2.399_963_229_728_653)
}

/// Texture coordinates of the centre of the `i`-th texel.
fn texel_uv(i: u32, width: u32, height: u32) -> DVec2 {
    (DVec2::new(f64::from(i % width), f64::from(i / width)) + 0.5) / DVec2::new(f64::from(width), f64::from(height))
}

/// Radiance and solid angle of `factor^2` pieces of each texel.
fn pieces(image: &EnvironmentImage, factor: u32) -> Vec<(DVec3, DVec3, f64)> {
    let (width, height) = (image.width * factor, image.height * factor);
    let solid_angle = |row: u32| {
        let edge = |row: u32| (f64::from(row) * PI / f64::from(height)).cos();
        2.0 * PI / f64::from(width) * (edge(row) - edge(row + 1))
    };
    (0..width * height)
        .into_par_iter()
        .map(|i| {
            let direction = direction_from_equirect(texel_uv(i, width, height));
            (direction, image.radiance(direction), solid_angle(i / width))
        })
        .collect()
}

/// The prefilter integral as a plain sum over the panorama, of D NoH / (4 VoH) NoL as Karis 2013 writes it.
fn brute_force(pieces: &[(DVec3, DVec3, f64)], n: DVec3, alpha: f64) -> DVec3 {
    let (mut sum, mut weights) = (DVec3::ZERO, 0.0);
    for (l, radiance, solid_angle) in pieces.iter().filter(|piece| piece.0.dot(n) > 0.0) {
        let h = (*l + n).normalize();
        let (n_h, v_h, n_l) = (n.dot(h), n.dot(h), n.dot(*l));
        let d = (alpha / (n_h * n_h * (alpha * alpha - 1.0) + 1.0)).powi(2) / PI;
        let weight = d * n_h / (4.0 * v_h) * n_l * solid_angle;
        sum += *radiance * weight;
        weights += weight;
    }
    sum / weights
}

fn rms(values: impl Iterator<Item = DVec3>) -> f64 {
    values.map(DVec3::length_squared).sum::<f64>().sqrt()
}

#[test]
fn prefiltering_agrees_with_a_sum_over_the_panorama() {
    for (name, image) in [("synthetic", Some(synthetic(256, 128))), ("garden", garden())] {
        let Some(image) = image else { continue };
        let harmonics = analyse(&image);
        let directions = [on_sphere(40), near_the_brightest(&image, 40)].concat();
        for level in 1..LEVELS {
            let alpha = EnvironmentMaps::perceptual_roughness_at(level as f64).powi(2);
            let filtered = convolve(&harmonics, alpha);
            // The sum's own error falls with the square of piece / alpha.
            let pieces = pieces(&image, if level <= 3 { 6 } else { 4 });
            let (truths, errors): (Vec<_>, Vec<_>) = (directions.par_iter())
                .map(|&n| (brute_force(&pieces, n, alpha), n))
                .map(|(truth, n)| (truth, filtered.radiance_cubic(n) - truth))
                .unzip();
            let error = rms(errors.into_iter()) / rms(truths.into_iter());
            // Measured 2.0e-3 at level 1 (0.8e-3 of that is the sum's), 5.8e-4 at level 2, 2.5e-4 or less above.
            let bound = [2.5e-3, 2e-3, 1e-3, 5e-4, 1.5e-4][level.min(5) - 1];
            assert!(error < bound, "{name}, level {level}: {error:e}");
        }
    }
}

#[test]
fn tiles_are_large_enough_for_bilinear_lookup() {
    let image = synthetic(1024, 512);
    let maps = bake(&image, &WHOLE, &Silent);
    let harmonics = analyse(&image);
    let directions = [on_sphere(400), near_the_brightest(&image, 400)].concat();
    for level in 1..LEVELS {
        let perceptual_roughness = EnvironmentMaps::perceptual_roughness_at(level as f64);
        let filtered = convolve(&harmonics, perceptual_roughness.powi(2));
        let error =
            rms(directions.iter().map(|&n| maps.specular(n, perceptual_roughness) - filtered.radiance_cubic(n)))
                / rms(directions.iter().map(|&n| filtered.radiance_cubic(n)));
        // Around a sun, which only the maps of the split sum hold; measured 3.8e-2, 2.2e-2, 3.5e-2 at levels 1 to 3.
        assert!(error < [4.5e-2, 3e-2, 4.5e-2, 1.5e-2][level.min(4) - 1], "level {level}: {error:e}");
    }
}

#[test]
fn the_mirror_level_shows_the_panorama() {
    let smooth = |d: DVec3| DVec3::new(1.0 + d.x, 1.0 + d.y * d.z, 1.5 + d.y);
    let image = Panorama::from_fn(512, 256, smooth).into();
    let maps = bake(&image, &WHOLE, &Silent);
    for d in on_sphere(500) {
        let error = (maps.specular(d, 0.0) - smooth(d)).abs().max_element();
        // Measured 2.3e-3, where the chart has its folds.
        assert!(error < 4e-3, "{d}: {error:e}");
    }
}

#[test]
fn the_mirror_level_loses_no_light_of_a_large_panorama() {
    // Sparse bright texels, which a few lookups in each of the tile's 64 x 64 texels would step over or count twice.
    let (width, height) = (2048, 1024);
    let texels = (0..width * height).map(|i| if i % 1009 == 0 { Vec3::splat(1e3) } else { Vec3::ZERO }).collect();
    let image = EnvironmentImage { width, height, texels };
    let edge = |row: u32| (f64::from(row) * PI / f64::from(height)).cos();
    let solid_angle = |i: u32| 2.0 * PI / f64::from(width) * (edge(i / width) - edge(i / width + 1));
    let expected = 1e3 * (0..width * height).step_by(1009).map(solid_angle).sum::<f64>() / (4.0 * PI);

    let maps = bake(&image, &BakeOptions { max_side: 64, ..WHOLE }, &Silent);
    let directions = on_sphere(200_000);
    let seen = directions.iter().map(|&d| maps.specular(d, 0.0).x).sum::<f64>() / directions.len() as f64;
    // Measured 6e-4.
    assert!((seen / expected - 1.0).abs() < 2e-3, "mean radiance {seen}, should be {expected}");
}

#[test]
fn constant_light_stays_constant_everywhere() {
    let radiance = Vec3::new(0.1, 1.0, 3e4);
    for image in [
        EnvironmentImage::constant(radiance),
        EnvironmentImage { width: 100, height: 37, texels: vec![radiance; 3700] },
    ] {
        let maps = bake(&image, &WHOLE, &Silent);
        for d in on_sphere(200) {
            let off = |value: DVec3| (value / radiance.as_dvec3() - 1.0).abs().max_element();
            assert!(off(maps.irradiance_over_pi(d)) < 1e-12);
            for perceptual_roughness in [0.0, 0.03, 0.5, 0.7, 1.0] {
                // Texels are float32: half a unit in the last place is 6e-8.
                assert!(off(maps.specular(d, perceptual_roughness)) < 1e-7, "{d} {perceptual_roughness}");
            }
        }
    }
}

#[test]
fn lookups_do_not_jump_where_the_chart_is_cut() {
    let maps = bake(&synthetic(256, 128), &WHOLE, &Silent);
    // The edges of the chart are the lower halves of the great circles x = 0 and z = 0.
    for i in 0..=2000 {
        let (y, a) = (f64::from(i) * PI / 2000.0).sin_cos();
        for (on_edge, across) in [(DVec3::new(a, -y, 0.0), DVec3::Z), (DVec3::new(0.0, -y, a), DVec3::X)] {
            for level in 0..LEVELS {
                let r = EnvironmentMaps::perceptual_roughness_at(level as f64);
                let side = |step: f64| maps.specular((on_edge + across * step).normalize(), r);
                let jump = (side(1e-9) - side(-1e-9)).abs().max_element();
                assert!(jump < 1e-6 * side(0.0).max_element(), "level {level} at {on_edge}: {jump:e}");
            }
        }
    }
}

#[test]
fn tile_sides_follow_the_panorama_within_their_limits() {
    let sides = |width, max_side| tile_sides(width, &BakeOptions { max_side, ..WHOLE });
    assert_eq!(sides(1024, 1024), [1024, 512]);
    assert_eq!(sides(16384, 1024), [1024, 512]);
    assert_eq!(sides(4, 1024), [32, 256]);
    assert_eq!(sides(4096, 300), [256, 512]);
    assert_eq!(sides(0, 0), [32, 256]);
}

#[test]
fn mixtures_with_the_mirror_image_are_the_nearest_to_the_lobe() {
    // Power by degree of light like that which taps are fitted to, through the bilinear lookup of 512 rows.
    let power = |degree: usize| {
        (-(degree as f64 / 420.0).powi(4)).exp() * (2 * degree + 1) as f64 / (degree as f64 + 1.0).powi(2)
    };
    let lobe = |r: f64| legendre_coefficients(r * r, 600);
    let finest = EnvironmentMaps::FINEST_PERCEPTUAL_ROUGHNESS;
    let level_1 = lobe(finest);
    for r in [0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0].map(|x| x * finest) {
        let lost = |lobe: &[f64], degree: usize| 1.0 - lobe[degree] / lobe[0];
        let lobe = lobe(r);
        let product = |a: &[f64], b: &[f64]| (1..600).map(|l| power(l) * lost(a, l) * lost(b, l)).sum::<f64>();
        let nearest = product(&lobe, &level_1) / product(&level_1, &level_1);
        let share = EnvironmentMaps::level_of(r);
        assert!((share - nearest).abs() < 0.025, "{r}: {share}, nearest {nearest}");
    }
}

#[test]
fn maps_without_suns_and_the_suns_add_up_to_the_whole() {
    let image = synthetic(512, 256);
    let (whole, parted) = (bake(&image, &WHOLE, &Silent), bake(&image, &BakeOptions::default(), &Silent));
    assert_eq!((whole.suns.len(), parted.suns.len()), (0, 1));
    assert!(
        whole.specular(parted.suns[0].direction, 0.0).abs_diff_eq(parted.specular(parted.suns[0].direction, 0.0), 0.0)
    );
    // The mean irradiance / pi: a light of E lux adds E / 4 pi to it.
    let sum = parted.irradiance_over_pi[0] + parted.suns[0].illuminance / (4.0 * PI);
    assert!((sum / whole.irradiance_over_pi[0] - 1.0).abs().max_element() < 1e-6, "{sum}");
    for level in 1..LEVELS {
        let r = EnvironmentMaps::perceptual_roughness_at(level as f64);
        let at = |direction| (parted.specular(direction, r), whole.specular(direction, r));
        let (rest, all) = at(parted.suns[0].direction);
        assert!(rest.max_element() < 0.25 * all.max_element(), "level {level}: {rest} of {all}");
    }
}

#[test]
fn a_sketch_is_the_same_light_blurred() {
    let image = super::super::studio::studio();
    let [sketched, exact] = [sketch(&image, &BakeOptions::default()), bake(&image, &BakeOptions::default(), &Silent)];
    for direction in [DVec3::X, DVec3::NEG_Y, DVec3::new(-0.6, 0.64, 0.48)] {
        for (perceptual_roughness, limit) in [(0.5, 0.1), (1.0, 0.02)] {
            let [a, b] = [&sketched, &exact].map(|maps| maps.specular(direction, perceptual_roughness));
            assert!(
                (a - b).abs().max_element() < limit * b.max_element(),
                "{direction} {perceptual_roughness}: {a} {b}"
            );
        }
    }
}
