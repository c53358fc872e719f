//! From a panorama to what shading reads of it: prefiltered radiance and irradiance.

use super::harmonics::Harmonics;
use super::irradiance::irradiance_over_pi;
use super::lobe::legendre_coefficients;
use super::octahedral::{Atlas, texel_mean};
use super::panorama::Panorama;
use super::sun;
use crate::math::spaces::direction_from_octahedral;
use crate::progress::{Progress, Silent};
use crate::scene::{EnvironmentImage, EnvironmentMaps, SpecularTile};
use glam::DVec3;

const LEVELS: usize = EnvironmentMaps::LEVELS;

/// Largest interior sides of the tiles of level 0, which is as sharp as a panorama of 1024 x 512, and of level 1. From
/// there sides halve with every second level, down to a quarter. That is finer than the rough ones ask for: a large flat
/// surface magnifies them until the creases of bilinear lookup show.
const LARGEST_SIDES: [u32; 2] = [1024, 512];

/// Of level 1, in the smallest panorama.
const SMALLEST_FINEST_SIDE: u32 = 256;

/// No mirror tile has a smaller interior.
const SMALLEST_SIDE: u32 = 32;

/// Texels of the panorama that [`sketch`] sees.
const SKETCH_SIZE: (usize, usize) = (64, 32);

/// Of what [`bake`] computes: raise it with every change of its results beyond rounding, so that nobody reads what an
/// older version has stored. A test holds it against them.
pub const VERSION: u32 = 4;

/// Limits of [`bake`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct BakeOptions {
    /// Upper bound for the side of the mirror level, texels; at least 32, rounded down to a power of two.
    pub max_side: u32,
    /// Take suns out of the panorama ([`sun::extract`]), to be shaded as lights. Without, the maps are those of the plain
    /// split sum.
    pub suns: bool,
}

impl Default for BakeOptions {
    fn default() -> Self {
        Self { max_side: LARGEST_SIDES[0], suns: true }
    }
}

/// Prefilters `image` for shading.
///
/// Level k of the specular maps holds int L(l) D(h) NoL dl / int D(h) NoL dl with n = v = r and the perceptual
/// roughness of that level (Karis 2013); L is [`EnvironmentImage::radiance`], from level 1 on without the suns that were
/// taken out. The convolution is carried out per spherical harmonic, in float64, and the result is the same on every run. Radiance in cd/m2, as in the image.
pub fn bake(image: &EnvironmentImage, options: &BakeOptions, progress: &dyn Progress) -> EnvironmentMaps {
    progress.begin("Prefiltering the environment", LEVELS as u64 + 1);
    let [mirror_side, finest_side] = tile_sides(image.width, options);
    let tile = |level| SpecularTile::of_level(level, mirror_side, finest_side);
    let mut atlas = Atlas::new((0..LEVELS).map(tile).collect());
    fill_mirror_level(&mut atlas, image);
    progress.advance(1);

    let extracted = options.suns.then(|| sun::extract(image));
    let (image, suns) = extracted.as_ref().map_or((image, &[][..]), |found| (&found.residual, &found.suns));
    let harmonics = analyse(image);
    progress.advance(1);
    for level in 1..LEVELS {
        let filtered = convolve(&harmonics, EnvironmentMaps::perceptual_roughness_at(level as f64).powi(2));
        // The sum of harmonics may undershoot by rounding where all is black.
        let radiance = |direction| filtered.radiance_cubic(direction).max(DVec3::ZERO);
        atlas.fill(level, |uv| radiance(direction_from_octahedral(uv)));
        progress.advance(1);
    }
    EnvironmentMaps {
        suns: suns.to_vec(),
        irradiance_over_pi: irradiance_over_pi(image),
        tiles: atlas.tiles,
        atlas_width: atlas.width,
        atlas_height: atlas.height,
        texels: atlas.texels,
    }
}

/// The same of the panorama reduced to 64 x 32 texels: blurred, and sooner there.
pub fn sketch(image: &EnvironmentImage, options: &BakeOptions) -> EnvironmentMaps {
    let (width, height) = SKETCH_SIZE;
    bake(&Panorama::resampled(image, width, height).into(), options, &Silent)
}

/// Sides of the tiles of levels 0 and 1. A mirror tile of half the panorama's width has about its resolution: the
/// octahedron spends its square on the whole sphere, the panorama half its rows on the poles. But the tile's bilinear
/// lookup blurs once more what that of the panorama blurs; twice as many texels a side make little of it. Lobes over the
/// texels of a small panorama need finer tiles than the mirror image.
fn tile_sides(panorama_width: u32, options: &BakeOptions) -> [u32; 2] {
    let [largest_mirror, largest_finest] = LARGEST_SIDES;
    let limit = options.max_side.clamp(SMALLEST_SIDE, largest_mirror);
    let limit = 1 << limit.ilog2();
    let mirror = panorama_width.clamp(1, limit).next_power_of_two().clamp(SMALLEST_SIDE, limit);
    [mirror, (2 * mirror).clamp(SMALLEST_FINEST_SIDE, largest_finest)]
}

fn fill_mirror_level(atlas: &mut Atlas, image: &EnvironmentImage) {
    let size = atlas.tiles[0].size;
    // The widest texel of the octahedron spans 4.6 / size rad: as many samples as the panorama has texels to one of the
    // tile leave none out. Panoramas much larger than the tile are averaged first, which is cheaper.
    let reduced = (image.width > 4 * size).then(|| Panorama::resampled(image, 4 * size as usize, 2 * size as usize));
    let reduced = reduced.map(EnvironmentImage::from);
    let image = reduced.as_ref().unwrap_or(image);
    let samples = image.width.div_ceil(size).max(2);
    atlas.fill(0, |uv| texel_mean(uv, size, samples, |direction| image.radiance(direction)));
}

/// The panorama's harmonics, of as many degrees as its texels and the narrowest lobe call for.
///
/// Rows are interpolated to eight times their number up to 1024, so that the transform meets the bilinear radiance that
/// is looked up elsewhere, not a comb of texels. Degree 512 of the lobe of level 1 is scaled by 1e-7.
fn analyse(image: &EnvironmentImage) -> Harmonics {
    let rows = (8 * image.height as usize).next_power_of_two().clamp(256, 1024);
    Harmonics::analyse(&Panorama::resampled(image, 2 * rows, rows), rows / 2)
}

/// The panorama seen through the lobe of `alpha`.
fn convolve(harmonics: &Harmonics, alpha: f64) -> Panorama {
    // The coefficients of the lobe fall as e^(-2 alpha l) at first, later only as fast as the lobe's kink at the horizon
    // lets them.
    let degrees = ((8.0 / alpha) as usize).next_power_of_two().clamp(128, harmonics.degrees());
    harmonics.synthesise(&legendre_coefficients(alpha, degrees), 2 * degrees)
}

#[cfg(test)]
mod fingerprint;
#[cfg(test)]
mod tests;
