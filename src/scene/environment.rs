//! Light from infinitely far away: the panorama and what is made of it for shading.

use crate::math::spaces::{equirect_from_direction, octahedral_from_direction};
use glam::{DVec2, DVec3, Vec3};
use std::sync::Arc;

/// An equirectangular panorama of radiance, linear Rec.709, cd/m2. Finite and not negative.
///
/// Row 0 looks up (+Y), the centre toward +X, not mirrored: see [`crate::math::spaces::equirect_from_direction`].
#[derive(Debug, Clone)]
pub struct EnvironmentImage {
    pub width: u32,
    pub height: u32,
    /// `width * height` texels, row-major from the top left.
    pub texels: Vec<Vec3>,
}

impl EnvironmentImage {
    /// The same radiance from everywhere.
    pub fn constant(radiance: Vec3) -> Self {
        Self { width: 4, height: 2, texels: vec![radiance; 8] }
    }

    /// Radiance that arrives from `direction` (unit, in the panorama's own frame): bilinear between texel centres,
    /// wrapping around the horizon, clamped at the poles.
    pub fn radiance(&self, direction: DVec3) -> DVec3 {
        let uv = equirect_from_direction(direction);
        let x = uv.x * f64::from(self.width) - 0.5;
        let y = (uv.y * f64::from(self.height) - 0.5).clamp(0.0, f64::from(self.height - 1));
        let (x0, y0) = (x.floor(), y.floor());
        let (fx, fy) = (x - x0, y - y0);
        let column = |offset: i64| (x0 as i64 + offset).rem_euclid(i64::from(self.width)) as usize;
        let row = |offset: u32| (y0 as u32 + offset).min(self.height - 1) as usize;
        let texel = |column: usize, row: usize| self.texels[row * self.width as usize + column].as_dvec3();
        let top = texel(column(0), row(0)).lerp(texel(column(1), row(0)), fx);
        let bottom = texel(column(0), row(1)).lerp(texel(column(1), row(1)), fx);
        top.lerp(bottom, fy)
    }
}

/// A panorama as it stands around the scene.
#[derive(Debug, Clone)]
pub struct Environment {
    pub image: Arc<EnvironmentImage>,
    /// Turns the panorama about +Y: a positive angle moves what was seen toward +X toward -Z.
    pub rotation_rad: f64,
    /// Scale of all its radiance, 0 or above.
    pub intensity: f64,
}

impl Environment {
    pub fn new(image: EnvironmentImage) -> Self {
        Self { image: Arc::new(image), rotation_rad: 0.0, intensity: 1.0 }
    }

    /// Radiance that arrives from the unit direction `direction_in_world`, cd/m2.
    pub fn radiance(&self, direction_in_world: DVec3) -> DVec3 {
        self.image.radiance(self.environment_from_world(direction_in_world)) * self.intensity
    }

    /// Turns a direction in the panorama's own frame into the world.
    pub fn world_from_environment(&self, direction: DVec3) -> DVec3 {
        glam::DQuat::from_rotation_y(self.rotation_rad) * direction
    }

    /// Turns a world direction into the panorama's own frame.
    pub fn environment_from_world(&self, direction_in_world: DVec3) -> DVec3 {
        glam::DQuat::from_rotation_y(-self.rotation_rad) * direction_in_world
    }
}

/// Most suns that an environment has.
pub const MAX_SUNS: usize = 4;

/// A small bright source of a panorama, shaded as a light of its own.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sun {
    /// Unit vector toward it, in the panorama's own frame.
    pub direction: DVec3,
    /// Lux per channel on a surface that faces it.
    pub illuminance: DVec3,
    /// Of the disc that is as wide, rad.
    pub angular_radius_rad: f64,
}

/// Where one prefiltered level lies inside [`EnvironmentMaps::texels`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SpecularTile {
    /// Texel of the tile's interior, counted from the top left of the atlas; the one-texel border lies outside it.
    pub origin: [u32; 2],
    /// Interior side, texels.
    pub size: u32,
}

impl SpecularTile {
    /// Texels around a tile that repeat the octahedron's neighbours.
    pub const BORDER: u32 = 1;

    /// Where a level lies in an atlas whose mirror level and level 1 have these sides, both powers of two, the second at
    /// least 4. Below the mirror level stand pairs of levels side by side, each pair half as large as the one above,
    /// except for the last: so a shader finds a tile by arithmetic, where a list of them would be read lane by lane.
    pub fn of_level(level: usize, mirror_side: u32, finest_side: u32) -> Self {
        let Some(below) = level.checked_sub(1) else {
            return Self { origin: [Self::BORDER; 2], size: mirror_side };
        };
        let side = |pair: usize| (finest_side >> pair).max(finest_side / 4);
        let (pair, size) = (below / 2, side(below / 2));
        let rows_above: u32 = (0..pair).map(|pair| side(pair) + 2 * Self::BORDER).sum();
        let column = (below % 2) as u32 * (size + 2 * Self::BORDER);
        Self { origin: [column + Self::BORDER, mirror_side + rows_above + 3 * Self::BORDER], size }
    }
}

/// What shading reads of an environment, baked from its image, in the panorama's own frame.
///
/// Specular: one octahedral tile a level, all in one atlas, so that a level may have any size
/// and one bilinear tap reads one level. A border of one texel around each tile repeats the octahedron's neighbours.
#[derive(Debug, Clone)]
pub struct EnvironmentMaps {
    /// Sources that the maps do not hold, at most [`MAX_SUNS`]: the irradiance and the levels from the second on are of
    /// the rest. The mirror level is of the whole panorama. Between the two, the share of the second level is the share
    /// of the suns that is shaded.
    pub suns: Vec<Sun>,
    /// Irradiance / pi as spherical harmonics of degree 2, coefficients premultiplied with the basis constants and the
    /// cosine lobe (Ramamoorthi and Hanrahan 2001): evaluated as
    /// c0 + c1 y + c2 z + c3 x + c4 xy + c5 yz + c6 (3 z^2 - 1) + c7 xz + c8 (x^2 - y^2).
    pub irradiance_over_pi: [DVec3; 9],
    /// [`EnvironmentMaps::LEVELS`] of them, as [`SpecularTile::of_level`] lays them out. Level 0 is the mirror image, the others are for [`EnvironmentMaps::perceptual_roughness_at`].
    pub tiles: Vec<SpecularTile>,
    pub atlas_width: u32,
    pub atlas_height: u32,
    /// `atlas_width * atlas_height` texels of radiance, row-major.
    pub texels: Vec<Vec3>,
}

impl EnvironmentMaps {
    /// Levels of the specular maps.
    pub const LEVELS: usize = 9;
    /// Perceptual roughness of level 1, where alpha is 1 / 128.
    pub const FINEST_PERCEPTUAL_ROUGHNESS: f64 = 0.088_388_347_648_318_45;

    /// The perceptual roughness of a level. Alpha doubles from level 1 on, up to 1 at level 8, so that a mixture of two
    /// neighbours has the same shape wherever it stands. Below level 1 there is the mirror image, of perceptual
    /// roughness 0.
    pub fn perceptual_roughness_at(level: f64) -> f64 {
        if level < 1.0 { 0.0 } else { (0.5 * level - 4.0).exp2() }
    }

    /// The level, in [0, 8], of a perceptual roughness in [0, 1]. Below 1 it is the share of level 1 in a mixture with
    /// the mirror image that is nearest to the lobe: in least squares, under light whose power falls with the degree as
    /// (1 + l)^-2, as far as a panorama of 1024 x 512 holds it. The polynomial is within 0.025 of that share.
    pub fn level_of(perceptual_roughness: f64) -> f64 {
        let x = perceptual_roughness / Self::FINEST_PERCEPTUAL_ROUGHNESS;
        if x < 1.0 { x * x * x * (6.0 + x * (3.0 * x - 8.0)) } else { 8.0 + 2.0 * perceptual_roughness.log2() }
    }

    /// Irradiance / pi, cd/m2, on a surface with the unit normal `n`; slightly negative at worst, opposite to a sun.
    pub fn irradiance_over_pi(&self, n: DVec3) -> DVec3 {
        let [c0, c1, c2, c3, c4, c5, c6, c7, c8] = self.irradiance_over_pi;
        c0 + c1 * n.y
            + c2 * n.z
            + c3 * n.x
            + c4 * (n.x * n.y)
            + c5 * (n.y * n.z)
            + c6 * (3.0 * n.z * n.z - 1.0)
            + c7 * (n.x * n.z)
            + c8 * (n.x * n.x - n.y * n.y)
    }

    /// Prefiltered radiance, cd/m2, toward the unit vector `direction`; linear between texels and between levels.
    pub fn specular(&self, direction: DVec3, perceptual_roughness: f64) -> DVec3 {
        let level = Self::level_of(perceptual_roughness.clamp(0.0, 1.0));
        let below = (level as usize).min(Self::LEVELS - 2);
        let uv = octahedral_from_direction(direction);
        self.tile_bilinear(below, uv).lerp(self.tile_bilinear(below + 1, uv), level - below as f64)
    }

    /// Bilinear lookup in one tile; `uv` in [0, 1] spans its interior.
    fn tile_bilinear(&self, level: usize, uv: DVec2) -> DVec3 {
        let tile = self.tiles[level];
        let position = DVec2::from(tile.origin.map(f64::from)) + uv * f64::from(tile.size) - 0.5;
        let first = position.floor();
        let fraction = position - first;
        let start = first.y as usize * self.atlas_width as usize + first.x as usize;
        let texel = |offset: usize| self.texels[start + offset].as_dvec3();
        let below = self.atlas_width as usize;
        let top = texel(0).lerp(texel(1), fraction.x);
        let bottom = texel(below).lerp(texel(below + 1), fraction.x);
        top.lerp(bottom, fraction.y)
    }
}
