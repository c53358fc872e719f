//! Octahedral tiles in one atlas, each with a border that makes bilinear filtering seamless.

use crate::math::spaces::direction_from_octahedral;
use crate::scene::SpecularTile;
use crate::threads::*;
use glam::{DVec2, DVec3, Vec3};

const BORDER: u32 = SpecularTile::BORDER;

/// Tiles of one atlas and its texels.
#[derive(Debug)]
pub(super) struct Atlas {
    pub(super) tiles: Vec<SpecularTile>,
    pub(super) width: u32,
    pub(super) height: u32,
    pub(super) texels: Vec<Vec3>,
}

impl Atlas {
    /// An empty atlas for `tiles`.
    pub(super) fn new(tiles: Vec<SpecularTile>) -> Self {
        let end = |axis: usize| tiles.iter().map(|tile| tile.origin[axis] + tile.size + BORDER).max().unwrap_or(0);
        let (width, height) = (end(0), end(1));
        Self { tiles, width, height, texels: vec![Vec3::ZERO; (width * height) as usize] }
    }

    /// Fills a tile, border included; `radiance` is asked for the texture coordinates of the tile's texel centres.
    pub(super) fn fill(&mut self, level: usize, radiance: impl Fn(DVec2) -> DVec3 + Sync) {
        let tile = self.tiles[level];
        let size = tile.size;
        let interior: Vec<Vec3> = (0..size * size)
            .into_par_iter()
            .map(|i| radiance(texel_center(i % size, i / size, size)).as_vec3())
            .collect();
        let (left, top) = (tile.origin[0] - BORDER, tile.origin[1] - BORDER);
        for y in 0..size + 2 * BORDER {
            for x in 0..size + 2 * BORDER {
                let source = wrapped(i64::from(x) - i64::from(BORDER), i64::from(y) - i64::from(BORDER), size);
                self.texels[((top + y) * self.width + left + x) as usize] = interior[source];
            }
        }
    }
}

/// Texture coordinates in [0, 1] of a texel's centre.
fn texel_center(x: u32, y: u32, size: u32) -> DVec2 {
    (DVec2::new(f64::from(x), f64::from(y)) + 0.5) / f64::from(size)
}

/// Index of the interior texel that stands at (x, y), which may lie one step outside: the chart continues past an edge
/// with itself, turned by half a turn about the middle of that edge.
fn wrapped(x: i64, y: i64, size: u32) -> usize {
    let last = i64::from(size) - 1;
    let (x, y) = if x < 0 || x > last { (x.clamp(0, last), last - y) } else { (x, y) };
    let (x, y) = if y < 0 || y > last { (last - x, y.clamp(0, last)) } else { (x, y) };
    (y * (last + 1) + x) as usize
}

/// The mean of `radiance` over the texel of a tile with `size` texels a side that has its centre at `uv`, from
/// `samples` times `samples` directions.
pub(super) fn texel_mean(uv: DVec2, size: u32, samples: u32, radiance: impl Fn(DVec3) -> DVec3) -> DVec3 {
    let offset = |x: u32, y: u32| (texel_center(x, y, samples) - 0.5) / f64::from(size);
    let directions = (0..samples * samples).map(|i| uv + offset(i % samples, i / samples));
    let sum: DVec3 = directions.map(|uv| radiance(direction_from_octahedral(uv))).sum();
    sum / f64::from(samples * samples)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiles_and_their_borders_do_not_overlap() {
        for (mirror, finest) in [(64, 32), (32, 64), (64, 64)] {
            tiles_do_not_overlap((0..9).map(|level| SpecularTile::of_level(level, mirror, finest)).collect());
        }
    }

    fn tiles_do_not_overlap(tiles: Vec<SpecularTile>) {
        let mut atlas = Atlas::new(tiles);
        for level in 0..atlas.tiles.len() {
            atlas.fill(level, |_| DVec3::splat(level as f64 + 1.0));
        }
        for (level, tile) in atlas.tiles.iter().enumerate() {
            let of_level = atlas.texels.iter().filter(|texel| texel.x == level as f32 + 1.0).count();
            assert_eq!(of_level, (tile.size as usize + 2).pow(2), "level {level}");
        }
    }

    #[test]
    fn tiles_of_a_large_panorama_leave_little_room() {
        let tiles: Vec<_> = (0..9).map(|level| SpecularTile::of_level(level, 1024, 512)).collect();
        let used: u32 = tiles.iter().map(|tile| (tile.size + 2).pow(2)).sum();
        let atlas = Atlas::new(tiles);
        assert!(atlas.width * atlas.height * 5 < used * 6, "{} x {}, {used}", atlas.width, atlas.height);
    }

    #[test]
    fn the_border_holds_the_neighbours_on_the_sphere() {
        let size = 16;
        let mut atlas = Atlas::new(vec![SpecularTile { origin: [1, 1], size }]);
        atlas.fill(0, direction_from_octahedral);
        let at = |x: u32, y: u32| atlas.texels[(y * atlas.width + x) as usize];
        for i in 1..=size {
            for (border, inside) in
                [((0, i), (1, i)), ((size + 1, i), (size, i)), ((i, 0), (i, 1)), ((i, size + 1), (i, size))]
            {
                // Twice the half texel to the edge; a texel at the edge's end is 2 / size wide.
                let step = (at(border.0, border.1) - at(inside.0, inside.1)).length();
                assert!(step < 1.5 * 2.0 / size as f32, "{border:?}: {step}");
            }
        }
        assert_eq!(at(0, 0), at(size, size), "all four corners look down");
    }
}
