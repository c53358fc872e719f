//! Octahedral tiles in one atlas, each with a border that makes bilinear filtering seamless.

use crate::math::spaces::direction_from_octahedral;
use crate::scene::SpecularTile;
use glam::{DVec2, DVec3, Vec3};
use rayon::prelude::*;

/// Texels around a tile that repeat the octahedron's neighbours.
const BORDER: u32 = 1;

/// Tiles of one atlas and its texels.
#[derive(Debug)]
pub(super) struct Atlas {
    pub(super) tiles: Vec<SpecularTile>,
    pub(super) width: u32,
    pub(super) height: u32,
    pub(super) texels: Vec<Vec3>,
}

impl Atlas {
    /// An empty atlas for tiles of the given interior sides, none larger than the one before: as wide as the first two,
    /// each tile as high up as it fits, and then as far left.
    pub(super) fn new(sizes: &[u32]) -> Self {
        let sides: Vec<u32> = sizes.iter().map(|size| size + 2 * BORDER).collect();
        let width = sides.iter().take(2).sum();
        let mut corners: Vec<[u32; 2]> = Vec::with_capacity(sides.len());
        for &side in &sides {
            let placed = || corners.iter().zip(&sides);
            let is_free = |[x, y]: [u32; 2]| {
                let is_apart = |(&[left, top], &other): (&[u32; 2], &u32)| {
                    x + side <= left || left + other <= x || y + side <= top || top + other <= y
                };
                x + side <= width && placed().all(is_apart)
            };
            let beside = placed().flat_map(|(&[x, y], &side)| [[x + side, y], [x, y + side]]);
            let places = beside.chain([[0, 0]]).filter(|place| is_free(*place));
            // Below the tile that reaches farthest down, at the left edge, there is always room.
            let corner = places.min_by_key(|[x, y]| (*y, *x)).unwrap_or_default();
            corners.push(corner);
        }
        let height = corners.iter().zip(&sides).map(|([_, y], side)| y + side).max().unwrap_or(0);
        let tile = |([x, y], &size): ([u32; 2], &u32)| SpecularTile { origin: [x + BORDER, y + BORDER], size };
        let tiles = corners.into_iter().zip(sizes).map(tile).collect();
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
        let mut atlas = Atlas::new(&[64, 64, 32, 16, 16, 16, 8]);
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
        let sizes = [1024, 512, 512, 256, 256, 128, 128, 128, 64];
        let atlas = Atlas::new(&sizes);
        let used: u32 = sizes.iter().map(|size| (size + 2) * (size + 2)).sum();
        assert_eq!((atlas.width, atlas.height), (1540, 1284));
        assert!(atlas.width * atlas.height * 8 < used * 9, "{used}");
    }

    #[test]
    fn the_border_holds_the_neighbours_on_the_sphere() {
        let size = 16;
        let mut atlas = Atlas::new(&[size]);
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
