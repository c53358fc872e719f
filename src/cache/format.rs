//! A file of the cache: a header, then suns, tiles and texels as they lie in memory.

use super::key::Key;
use crate::scene::{EnvironmentMaps, MAX_SUNS, SpecularTile, Sun};
use bytemuck::{Pod, Zeroable};
use glam::{DVec3, Vec3};
use std::io::Read;

/// First bytes of a file. A machine of the other byte order reads another number, and has other keys anyway.
const MAGIC: u64 = u64::from_le_bytes(*b"speculaE");

#[derive(Debug, Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct Header {
    magic: u64,
    /// Blake3 of the whole file with zeros in this place.
    checksum: [u8; 32],
    key: [u8; 32],
    suns: u32,
    tiles: u32,
    atlas_width: u32,
    atlas_height: u32,
    irradiance_over_pi: [DVec3; 9],
}

#[derive(Debug, Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct StoredSun {
    direction: DVec3,
    illuminance: DVec3,
    angular_radius_rad: f64,
}

#[derive(Debug, Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct StoredTile {
    origin: [u32; 2],
    size: u32,
}

const CHECKSUM: std::ops::Range<usize> = 8..40;

/// The file of `maps`.
pub(super) fn encode(key: &Key, maps: &EnvironmentMaps) -> Vec<u8> {
    // Named one by one, so that a field cannot be added and forgotten here.
    let EnvironmentMaps { suns, irradiance_over_pi, tiles, atlas_width, atlas_height, texels } = maps;
    let header = Header {
        magic: MAGIC,
        checksum: [0; 32],
        key: key.0,
        suns: suns.len() as u32,
        tiles: tiles.len() as u32,
        atlas_width: *atlas_width,
        atlas_height: *atlas_height,
        irradiance_over_pi: *irradiance_over_pi,
    };
    let suns: Vec<StoredSun> = suns.iter().map(stored_sun).collect();
    let tiles: Vec<StoredTile> = tiles.iter().map(stored_tile).collect();
    let parts: [&[u8]; 4] = [
        bytemuck::bytes_of(&header),
        bytemuck::cast_slice(&suns),
        bytemuck::cast_slice(&tiles),
        bytemuck::cast_slice(texels),
    ];
    let mut file = parts.concat();
    let checksum = blake3::hash(&file);
    file[CHECKSUM].copy_from_slice(checksum.as_bytes());
    file
}

fn stored_sun(sun: &Sun) -> StoredSun {
    let Sun { direction, illuminance, angular_radius_rad } = *sun;
    StoredSun { direction, illuminance, angular_radius_rad }
}

fn stored_tile(tile: &SpecularTile) -> StoredTile {
    let SpecularTile { origin, size } = *tile;
    StoredTile { origin, size }
}

/// The maps of a file of `length` bytes that [`encode`] has made for this key, or `None` of any other. The texels are read
/// to where they stay: once more, they would be most of what a small picture takes.
pub(super) fn decode(key: &Key, file: &mut impl Read, length: u64) -> Option<EnvironmentMaps> {
    let mut header = Header::zeroed();
    file.read_exact(bytemuck::bytes_of_mut(&mut header)).ok()?;
    if header.magic != MAGIC || header.key != key.0 || length_of(&header)? != length {
        return None;
    }
    let mut hasher = blake3::Hasher::new();
    hasher.update(bytemuck::bytes_of(&Header { checksum: [0; 32], ..header }));
    // What the header promises lies in the file: it has that length.
    let suns: Vec<StoredSun> = read(file, header.suns as usize, &mut hasher)?;
    let tiles: Vec<StoredTile> = read(file, header.tiles as usize, &mut hasher)?;
    let texels: Vec<Vec3> = read(file, texel_count(&header)?, &mut hasher)?;
    if header.checksum != *hasher.finalize().as_bytes() {
        return None;
    }
    // From here on all is as it was written, if not by this program then by someone who can compute a checksum: what
    // would break a reader is looked at nevertheless.
    let fits = |tile: &StoredTile| {
        let ends = |origin: u32, side: u32| {
            origin >= 1 && origin.checked_add(tile.size).is_some_and(|end| end < side) && tile.size > 0
        };
        ends(tile.origin[0], header.atlas_width) && ends(tile.origin[1], header.atlas_height)
    };
    let is_whole = suns.len() <= MAX_SUNS && !tiles.is_empty() && tiles.iter().all(fits);
    is_whole.then(|| EnvironmentMaps {
        suns: suns
            .into_iter()
            .map(|StoredSun { direction, illuminance, angular_radius_rad }| Sun {
                direction,
                illuminance,
                angular_radius_rad,
            })
            .collect(),
        irradiance_over_pi: header.irradiance_over_pi,
        tiles: tiles.into_iter().map(|StoredTile { origin, size }| SpecularTile { origin, size }).collect(),
        atlas_width: header.atlas_width,
        atlas_height: header.atlas_height,
        texels,
    })
}

fn texel_count(header: &Header) -> Option<usize> {
    (header.atlas_width as usize).checked_mul(header.atlas_height as usize)
}

/// The bytes of the whole file.
fn length_of(header: &Header) -> Option<u64> {
    let bytes = |count: usize, size: usize| (count as u64).checked_mul(size as u64);
    let suns = bytes(header.suns as usize, size_of::<StoredSun>())?;
    let tiles = bytes(header.tiles as usize, size_of::<StoredTile>())?;
    let texels = bytes(texel_count(header)?, size_of::<Vec3>())?;
    (size_of::<Header>() as u64).checked_add(suns)?.checked_add(tiles)?.checked_add(texels)
}

/// The next `count` values.
fn read<T: Pod>(file: &mut impl Read, count: usize, hasher: &mut blake3::Hasher) -> Option<Vec<T>> {
    let mut values: Vec<T> = bytemuck::zeroed_vec(count);
    file.read_exact(bytemuck::cast_slice_mut(&mut values)).ok()?;
    hasher.update(bytemuck::cast_slice(&values));
    Some(values)
}
