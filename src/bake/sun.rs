//! Small bright sources taken out of a panorama, to be shaded as lights of their own.
//!
//! A sun holds half or more of the light of many skies within a few texels. Prefiltered maps look at it through a lobe
//! that is round, which is wrong by its whole contribution at grazing angles; the BRDF itself is exact for it.

use crate::math::color::luminance;
use crate::math::spaces::direction_from_equirect;
use crate::scene::{EnvironmentImage, MAX_SUNS, Sun};
use glam::{DVec2, DVec3};
use std::f64::consts::PI;

/// Radius of the cap around the brightest texel that is searched, rad.
const CAP_RAD: f64 = 4.0 * PI / 180.0;
/// The ring that tells the surroundings ends at so many radii of the cap.
const RING: f64 = 1.75;
/// Panoramas with fewer than three texels to the radius of the largest cap have no small sources.
const LARGEST_CAP_RAD: f64 = 10.0 * PI / 180.0;
/// A source stands above its surroundings by this factor...
const ABOVE_RING: f64 = 4.0;
/// ...and above the mean over the sphere by this one.
const ABOVE_MEAN: f64 = 20.0;
/// A source with a smaller share of all light stays in the panorama, where an error of its highlight goes unnoticed and
/// costs nothing.
const LEAST_SHARE: f64 = 0.01;
/// More of the ring than this as bright as the source, and it is a part of something larger: a window, a cloud.
const LARGEST_BRIGHT_RING: f64 = 0.05;
/// Bright places that are looked at, suns or not.
const CANDIDATES: usize = 16;

/// A panorama and what was taken out of it: together they hold the light of the panorama they came from.
#[derive(Debug, Clone)]
pub struct Extracted {
    pub residual: EnvironmentImage,
    /// In order of falling peak luminance, at most [`MAX_SUNS`].
    pub suns: Vec<Sun>,
}

/// Takes clusters of texels that outshine their surroundings out of `image`.
///
/// Around the brightest texel, those above both four times the median of a ring at 4 to 7 degrees and twenty times the
/// panorama's mean become the ring's median; what they lose is the sun, unless the ring is bright as well in part. The
/// next brightest follows until none stands out. The result is the same on every run.
pub fn extract(image: &EnvironmentImage) -> Extracted {
    let mut residual = image.clone();
    let mut suns = Vec::new();
    let grid = Grid::new(image);
    let cap = CAP_RAD.max(3.0 * grid.texel_rad);
    if cap > LARGEST_CAP_RAD {
        return Extracted { residual, suns };
    }
    let mut luminances: Vec<f64> = image.texels.iter().map(|texel| luminance(texel.as_dvec3())).collect();
    let mut seen = vec![false; residual.texels.len()];
    for _ in 0..CANDIDATES {
        match grid.take_brightest(&mut residual, &mut luminances, &mut seen, cap) {
            Found::Sun(sun) => suns.push(sun),
            Found::NoSun => {}
            Found::Nothing => break,
        }
        if suns.len() == MAX_SUNS {
            break;
        }
    }
    Extracted { residual, suns }
}

/// What the brightest texel is.
enum Found {
    Sun(Sun),
    /// A part of something that is not small, or too dim to matter.
    NoSun,
    /// Hardly brighter than the rest of the panorama, and so are all others.
    Nothing,
}

/// Directions and solid angles of a panorama's texels.
struct Grid {
    width: usize,
    height: usize,
    texel_rad: f64,
}

impl Grid {
    fn new(image: &EnvironmentImage) -> Self {
        Self { width: image.width as usize, height: image.height as usize, texel_rad: PI / f64::from(image.height) }
    }

    fn direction(&self, index: usize) -> DVec3 {
        let texel = DVec2::new((index % self.width) as f64, (index / self.width) as f64) + 0.5;
        direction_from_equirect(texel / DVec2::new(self.width as f64, self.height as f64))
    }

    /// Steradians of a texel in this row, exact.
    fn solid_angle(&self, row: usize) -> f64 {
        let edge = |row: usize| (row as f64 * self.texel_rad).cos();
        2.0 * PI / self.width as f64 * (edge(row) - edge(row + 1))
    }

    /// What the brightest texel that is not `seen` belongs to. Its surroundings are seen then, and a sun is gone from
    /// `image` and its `luminances`.
    fn take_brightest(
        &self,
        image: &mut EnvironmentImage,
        luminances: &mut [f64],
        seen: &mut [bool],
        cap: f64,
    ) -> Found {
        let rows = luminances.chunks_exact(self.width).enumerate();
        let total: f64 = rows.map(|(row, luminances)| self.solid_angle(row) * luminances.iter().sum::<f64>()).sum();
        let bright = ABOVE_MEAN * total / (4.0 * PI);
        let candidates = (0..luminances.len()).filter(|&i| !seen[i] && luminances[i] > bright);
        let by_luminance = |&a: &usize, &b: &usize| luminances[a].total_cmp(&luminances[b]).then(b.cmp(&a));
        let Some(brightest) = candidates.max_by(by_luminance) else { return Found::Nothing };

        let (inside, ring) = self.neighbourhood(self.direction(brightest), cap);
        for &index in &inside {
            seen[index] = true;
        }
        let Some(around) = median_of_channels(&ring.iter().map(|&i| image.texels[i].as_dvec3())) else {
            return Found::NoSun;
        };
        let threshold = bright.max(ABOVE_RING * luminance(around));
        let bright_ring = ring.iter().filter(|&&i| luminances[i] > threshold).count();
        let cluster: Vec<usize> = inside.into_iter().filter(|&i| luminances[i] > threshold).collect();
        let excess = |index: usize| {
            let above = (image.texels[index].as_dvec3() - around).max(DVec3::ZERO);
            above * self.solid_angle(index / self.width)
        };
        let matters = |sun: &Sun| luminance(sun.illuminance) >= LEAST_SHARE * total;
        let alone = bright_ring as f64 <= LARGEST_BRIGHT_RING * ring.len() as f64;
        match self.sun(&cluster, excess).filter(|sun| alone && matters(sun)) {
            Some(sun) => {
                for &index in &cluster {
                    image.texels[index] = image.texels[index].min(around.as_vec3());
                    luminances[index] = luminance(image.texels[index].as_dvec3());
                }
                Found::Sun(sun)
            }
            None => Found::NoSun,
        }
    }

    /// Texels within the cap around `center`, and those of the ring around it.
    fn neighbourhood(&self, center: DVec3, cap: f64) -> (Vec<usize>, Vec<usize>) {
        let (cos_cap, cos_ring) = (cap.cos(), (RING * cap).cos());
        let (mut inside, mut ring) = (Vec::new(), Vec::new());
        // Rows further away than the ring is wide have none of it; one more on each side for rounding.
        let middle = center.y.clamp(-1.0, 1.0).acos() / self.texel_rad;
        let reach = RING * cap / self.texel_rad + 1.0;
        let rows = (middle - reach).max(0.0) as usize..((middle + reach).ceil() as usize).min(self.height);
        for index in rows.start * self.width..rows.end * self.width {
            let cosine = self.direction(index).dot(center);
            if cosine >= cos_cap {
                inside.push(index);
            } else if cosine >= cos_ring {
                ring.push(index);
            }
        }
        (inside, ring)
    }

    /// The source that shines like the texels of `cluster`, of which each adds its `excess` lux.
    fn sun(&self, cluster: &[usize], excess: impl Fn(usize) -> DVec3) -> Option<Sun> {
        let illuminance: DVec3 = cluster.iter().map(|&i| excess(i)).sum();
        let flux = luminance(illuminance);
        let moment: DVec3 = cluster.iter().map(|&i| self.direction(i) * luminance(excess(i))).sum();
        let direction = moment.try_normalize()?;
        let spread = cluster.iter().map(|&i| {
            let texel = self.direction(i);
            // Bilinear lookup spreads each texel like a tent: a variance of a sixth of its square along each axis.
            let sin2 = 1.0 - texel.y * texel.y;
            let step2 = (2.0 * PI / self.width as f64).powi(2) * sin2 + self.texel_rad * self.texel_rad;
            luminance(excess(i)) * (2.0 * (1.0 - texel.dot(direction)) + step2 / 6.0)
        });
        // The mean squared distance from the middle of a disc is half its squared radius.
        let angular_radius_rad = (2.0 * spread.sum::<f64>() / flux).sqrt();
        Some(Sun { direction, illuminance, angular_radius_rad })
    }
}

/// The median of each channel, or `None` of nothing.
fn median_of_channels(colors: &(impl Iterator<Item = DVec3> + Clone)) -> Option<DVec3> {
    let median = |channel: usize| {
        let mut values: Vec<f64> = colors.clone().map(|color| color[channel]).collect();
        values.sort_by(f64::total_cmp);
        values.get(values.len() / 2).copied()
    };
    Some(DVec3::new(median(0)?, median(1)?, median(2)?))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bake::panorama::Panorama;
    use crate::bake::test_support::sample_panorama;

    /// A grey sky with discs, each of a direction, an angular radius and a radiance.
    fn sky(height: usize, discs: &[(DVec3, f64, DVec3)]) -> EnvironmentImage {
        let radiance = |direction: DVec3| {
            let lit = discs.iter().filter(|(center, radius, _)| direction.dot(*center) > radius.cos());
            DVec3::splat(0.3) + lit.map(|(_, _, radiance)| *radiance).sum::<DVec3>()
        };
        Panorama::from_fn(2 * height, height, radiance).into()
    }

    fn flux(image: &EnvironmentImage) -> DVec3 {
        let grid = Grid::new(image);
        (0..image.texels.len()).map(|i| image.texels[i].as_dvec3() * grid.solid_angle(i / grid.width)).sum()
    }

    #[test]
    fn two_suns_are_found_with_their_place_light_and_size() {
        let discs = [
            (DVec3::new(0.3, 0.7, -0.5).normalize(), 0.02, DVec3::new(3000.0, 2500.0, 2000.0)),
            (DVec3::new(-0.8, -0.2, 0.4).normalize(), 0.035, DVec3::new(200.0, 300.0, 500.0)),
        ];
        let image = sky(1024, &discs);
        let extracted = extract(&image);
        assert_eq!(extracted.suns.len(), 2);
        for (sun, (direction, radius, radiance)) in extracted.suns.iter().zip(discs) {
            // Texels of 3 mrad; the relative errors are of the discs' edges on them. Measured 2e-4 rad, 1.2 %, 0.9 %.
            assert!(sun.direction.distance(direction) < 5e-4, "{sun:?}");
            let expected = radiance * (PI * radius.sin().powi(2));
            assert!((sun.illuminance / expected - 1.0).abs().max_element() < 0.025, "{sun:?}, {expected}");
            assert!((sun.angular_radius_rad / radius - 1.0).abs() < 0.05, "{sun:?}, {radius}");
        }
        let lost = flux(&image) - flux(&extracted.residual);
        let taken: DVec3 = extracted.suns.iter().map(|sun| sun.illuminance).sum();
        assert!((lost / taken - 1.0).abs().max_element() < 1e-5, "lost {lost}, taken {taken}");
        assert!(extracted.residual.texels.iter().all(|texel| texel.max_element() < 0.31), "something is left");
    }

    #[test]
    fn skies_without_a_small_source_stay_as_they_are() {
        let window = (DVec3::X, 0.3, DVec3::splat(30.0));
        let spark = (DVec3::Y, 0.004, DVec3::splat(40.0));
        for (name, image) in [
            ("even", sky(128, &[])),
            ("a window", sky(128, &[window])),
            ("a spark that lights nothing", sky(1024, &[spark])),
            ("coarse", sky(8, &[(DVec3::X, 0.3, DVec3::splat(1e4))])),
            ("black", EnvironmentImage::constant(glam::Vec3::ZERO)),
            ("studio", crate::bake::studio::studio()),
        ] {
            let extracted = extract(&image);
            assert!(extracted.suns.is_empty(), "{name}: {:?}", extracted.suns);
            assert_eq!(extracted.residual.texels, image.texels, "{name}");
        }
    }

    #[test]
    fn the_sample_panoramas_have_the_suns_that_are_in_them() {
        // Measured once by another program (texels above four times the ring's median): 70 % and 51 % of all light.
        for (file, share) in [("chinese_garden_1k.hdr", 0.70), ("spiaggia_di_mondello_1k.hdr", 0.51)] {
            let Some(image) = sample_panorama(file) else { return };
            let extracted = extract(&image);
            let found = luminance(extracted.suns[0].illuminance) / luminance(flux(&image));
            assert!(extracted.suns.len() == 1 && (found - share).abs() < 0.01, "{file}: {found}");
            assert!((0.003..0.02).contains(&extracted.suns[0].angular_radius_rad), "{:?}", extracted.suns[0]);
        }
    }
}
