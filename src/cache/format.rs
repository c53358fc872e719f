//! A file of the cache: a header, then suns, tiles and texels as they lie in memory.

use super::key::Key;
use crate::scene::{EnvironmentMaps, MAX_SUNS, SpecularTile, Sun};
use bytemuck::{Pod, Zeroable};
use glam::{DVec3, Vec3};

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

/// The maps of a file that [`encode`] has made for this key, or `None` of any other.
pub(super) fn decode(key: &Key, file: &[u8]) -> Option<EnvironmentMaps> {
    let mut rest = file;
    let [header]: [Header; 1] = take(&mut rest, 1)?.try_into().ok()?;
    if header.magic != MAGIC || header.key != key.0 || header.checksum != checksum(file) {
        return None;
    }
    // From here on all is as it was written, if not by this program then by someone who can compute a checksum: what
    // would break a reader is looked at nevertheless.
    let suns = take::<StoredSun>(&mut rest, (header.suns as usize).min(MAX_SUNS))?;
    let tiles = take::<StoredTile>(&mut rest, header.tiles as usize)?;
    let texels = take::<Vec3>(&mut rest, (header.atlas_width as usize).checked_mul(header.atlas_height as usize)?)?;
    let fits = |tile: &StoredTile| {
        let ends = |origin: u32, side: u32| {
            origin >= 1 && origin.checked_add(tile.size).is_some_and(|end| end < side) && tile.size > 0
        };
        ends(tile.origin[0], header.atlas_width) && ends(tile.origin[1], header.atlas_height)
    };
    let is_whole = rest.is_empty() && !tiles.is_empty() && tiles.iter().all(fits);
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

fn checksum(file: &[u8]) -> [u8; 32] {
    let mut hasher = blake3::Hasher::new();
    hasher.update(&file[..CHECKSUM.start]).update(&[0; 32]).update(&file[CHECKSUM.end..]);
    hasher.finalize().into()
}

/// The next `count` values, wherever they lie; checked for length before anything is allocated.
fn take<T: Pod>(rest: &mut &[u8], count: usize) -> Option<Vec<T>> {
    let (bytes, after) = rest.split_at_checked(count.checked_mul(size_of::<T>())?)?;
    *rest = after;
    let mut values = vec![T::zeroed(); count];
    bytemuck::cast_slice_mut(&mut values).copy_from_slice(bytes);
    Some(values)
}
