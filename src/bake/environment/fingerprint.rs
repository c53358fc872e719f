//! Holds [`VERSION`] against what [`bake`] computes.
//!
//! The last bits of sines and square roots differ between CPUs and C libraries, so a hash of the maps would fail on other
//! machines. Sums with pseudo-random signs do not: they follow every texel, and rounding hardly.

use super::*;
use crate::progress::Silent;

/// Of this version of the bake: the fingerprints of [`cases`]. When the test below fails, and the change of the results is
/// meant, raise [`VERSION`] and put both here.
const RECORDED: (u32, [[f64; SUMS]; 3]) = (
    4,
    [
        [
            -2.753887879719855,
            0.238175446256964,
            185.13698632013998,
            1.3205515955183824,
            -0.7583753735985413,
            -4.283792394919488,
        ],
        [0.0, -0.09033787900165703, 185.13698632013998, 5.952854031820411, -5.626551832718822, -3.0766482594104057],
        [
            -2.6699712501208044,
            0.24020608449619338,
            191.29538919149599,
            0.7558142182369273,
            0.9156320893567499,
            -1.311844839977202,
        ],
    ],
);

const SUMS: usize = 6;

/// Of the root mean square. Rounding of a float32 texel is 6e-8.
const TOLERANCE: f64 = 1e-6;

/// A sky with a sun, taken out and left in, and one that is reduced before it is looked at.
fn cases() -> [EnvironmentMaps; 3] {
    let sun = DVec3::new(0.5, 0.6, -0.4).normalize();
    let radiance =
        |d: DVec3| DVec3::new(0.6 + 0.2 * d.x, 0.8, 1.0 - 0.3 * d.y * d.z) + 3e3 * (-(1.0 - d.dot(sun)) / 4e-4).exp();
    let image = |height| EnvironmentImage::from(Panorama::from_fn(2 * height, height, radiance));
    let bake = |image, max_side, suns| bake(&image, &BakeOptions { max_side, suns }, &Silent);
    [bake(image(64), 64, true), bake(image(64), 64, false), bake(image(96), 32, true)]
}

/// Sums of all that is in the maps, each number with a sign of its own, over the square root of their count.
fn fingerprint(maps: &EnvironmentMaps) -> [f64; SUMS] {
    let suns = maps.suns.iter().flat_map(|sun| {
        [sun.direction.to_array(), sun.illuminance.to_array(), [sun.angular_radius_rad, 0.0, 0.0]].concat()
    });
    let tiles = maps.tiles.iter().flat_map(|tile| [tile.origin[0], tile.origin[1], tile.size].map(f64::from));
    let smooth = maps.irradiance_over_pi.iter().flat_map(|coefficient| coefficient.to_array());
    // Few numbers beside the many texels: in sums of their own they are not lost.
    let few = [signed_sum(suns, 0), signed_sum(smooth, 1), signed_sum(tiles, 2)];
    let texels = || maps.texels.iter().flat_map(|texel| texel.as_dvec3().to_array());
    let many = [3, 4, 5].map(|stream| signed_sum(texels(), stream));
    [few[0], few[1], few[2], many[0], many[1], many[2]]
}

fn signed_sum(values: impl Iterator<Item = f64>, stream: u64) -> f64 {
    let (mut sum, mut count) = (0.0, 0.0);
    for (index, value) in values.enumerate() {
        // SplitMix64 (Steele, Lea and Flood 2014).
        let mut bits = (stream << 40 | index as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        sum += if (bits ^ (bits >> 31)) & 1 == 0 { value } else { -value };
        count += 1.0;
    }
    sum / f64::max(count, 1.0).sqrt()
}

fn agree(a: &[f64; SUMS], b: &[f64; SUMS]) -> bool {
    a.iter().zip(b).all(|(a, b)| (a - b).abs() <= TOLERANCE * (1.0 + a.abs()))
}

#[test]
fn results_change_only_with_the_version() {
    let fingerprints = cases().map(|maps| fingerprint(&maps));
    let (version, recorded) = RECORDED;
    let same = version == VERSION && fingerprints.iter().zip(&recorded).all(|(now, then)| agree(now, then));
    assert!(same, "the bake computes something else than version {version} did: {VERSION}, {fingerprints:?}");
}

#[test]
fn small_changes_are_noticed() {
    let [maps, ..] = cases();
    let before = fingerprint(&maps);
    type Change = fn(&mut EnvironmentMaps);
    let changes: [(&str, Change); 6] = [
        ("a level", |maps| {
            let tile = maps.tiles[8];
            for y in 0..tile.size {
                let start = ((tile.origin[1] + y) * maps.atlas_width + tile.origin[0]) as usize;
                maps.texels[start..][..tile.size as usize].iter_mut().for_each(|texel| *texel *= 1.0001);
            }
        }),
        ("a texel", |maps| maps.texels[5000].y += 0.01),
        ("a sun", |maps| maps.suns[0].direction.x += 1e-4),
        ("no sun", |maps| maps.suns.clear()),
        ("the irradiance", |maps| maps.irradiance_over_pi[8].z += 1e-4),
        ("a tile", |maps| maps.tiles[3].origin[0] += 1),
    ];
    for (name, change) in changes {
        let mut changed = maps.clone();
        change(&mut changed);
        assert!(!agree(&fingerprint(&changed), &before), "{name}");
    }
}
