use super::*;
use crate::progress::Silent;
use crate::scene::SpecularTile;
use glam::{DVec3, Vec3};
use std::fs;
use std::path::Path;
use std::time::{Duration, SystemTime};

const SMALL: BakeOptions = BakeOptions { max_side: 32, suns: true };

/// A grey sky with a sun of its own radiance.
fn image(radiance: f32) -> EnvironmentImage {
    let (width, height) = (128, 64);
    let mut texels = vec![Vec3::splat(0.3); width as usize * height as usize];
    texels[20 * width as usize + 40] = Vec3::splat(radiance);
    EnvironmentImage { width, height, texels }
}

/// Maps that cost nothing.
fn maps(value: f32) -> EnvironmentMaps {
    EnvironmentMaps {
        suns: Vec::new(),
        irradiance_over_pi: [DVec3::ONE; 9],
        tiles: vec![SpecularTile { origin: [1, 1], size: 6 }],
        atlas_width: 8,
        atlas_height: 8,
        texels: vec![Vec3::splat(value); 64],
    }
}

/// Every bit of them.
fn bits(maps: &EnvironmentMaps) -> Vec<u8> {
    format::encode(&Key([0; 32]), maps)
}

fn decoded(key: &Key, mut file: &[u8]) -> Option<EnvironmentMaps> {
    let length = file.len() as u64;
    format::decode(key, &mut file, length)
}

fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<_> =
        fs::read_dir(folder).unwrap().map(|file| file.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

fn only_file(folder: &Path) -> PathBuf {
    let names = names(folder);
    assert_eq!(names.len(), 1, "{names:?}");
    folder.join(&names[0])
}

fn set_age(path: &Path, seconds: u64) {
    let time = SystemTime::now() - Duration::from_secs(seconds);
    fs::File::options().append(true).open(path).unwrap().set_modified(time).unwrap();
}

#[test]
fn what_was_stored_comes_back_bit_by_bit() {
    let folder = tempfile::tempdir().unwrap();
    let cache = EnvironmentCache::in_folder(folder.path().join("made/on/demand"), DEFAULT_LIMIT_BYTES);
    let sun = image(1e5);
    let (plain, (cold, first), (warm, second)) = (
        environment::bake(&sun, &SMALL, &Silent),
        cache.bake(&sun, &SMALL, &Silent),
        cache.bake(&sun, &SMALL, &Silent),
    );
    assert_eq!((first, second), (Outcome::Stored, Outcome::Hit));
    assert!(plain.suns.len() == 1 && bits(&plain) == bits(&cold) && bits(&plain) == bits(&warm));
    let (_, other) = cache.bake(&image(2e5), &SMALL, &Silent);
    let (_, without) = cache.bake(&sun, &BakeOptions { suns: false, ..SMALL }, &Silent);
    assert_eq!((other, without), (Outcome::Stored, Outcome::Stored));
}

#[test]
fn a_file_that_is_not_as_it_was_written_is_replaced() {
    let folder = tempfile::tempdir().unwrap();
    let cache = EnvironmentCache::in_folder(folder.path(), DEFAULT_LIMIT_BYTES);
    let key = Key([7; 32]);
    let stored = maps(1.0);
    cache.store.save(&key, &stored).unwrap();
    let path = only_file(folder.path());
    let whole = fs::read(&path).unwrap();
    let is_missed = |name: &str, bytes: &[u8]| {
        fs::write(&path, bytes).unwrap();
        assert!(cache.store.load(&key).is_none(), "{name} is believed");
    };
    // Every byte of the header and of the tile, some of the texels, each in another bit.
    for place in (0..340).chain((340..whole.len()).step_by(37)).chain([whole.len() - 1]) {
        let mut flipped = whole.clone();
        flipped[place] ^= 1 << (place % 8);
        is_missed(&format!("bit {} of byte {place}", place % 8), &flipped);
    }
    for length in [0, 1, 8, 40, 303, 304, 316, whole.len() / 2, whole.len() - 1] {
        is_missed(&format!("a file of {length} bytes"), &whole[..length]);
    }
    is_missed("a longer file", &[&whole[..], &[0]].concat());
    is_missed("zeros, as a loss of power leaves them", &vec![0; whole.len()]);
    is_missed("another entry's file", &format::encode(&Key([8; 32]), &stored));

    let (baked, outcome) = {
        let key = Key::of(&image(1.0), &SMALL);
        fs::write(folder.path().join(key.hex() + ".maps"), &whole[..100]).unwrap();
        cache.bake(&image(1.0), &SMALL, &Silent)
    };
    assert_eq!(outcome, Outcome::Stored);
    let (again, outcome) = cache.bake(&image(1.0), &SMALL, &Silent);
    assert!(outcome == Outcome::Hit && bits(&again) == bits(&baked));
}

#[test]
fn maps_that_no_bake_makes_are_refused_even_with_the_right_checksum() {
    let key = Key([1; 32]);
    assert!(decoded(&key, &format::encode(&key, &maps(1.0))).is_some());
    let tile = |origin, size| EnvironmentMaps { tiles: vec![SpecularTile { origin, size }], ..maps(1.0) };
    let sun = crate::scene::Sun { direction: DVec3::Y, illuminance: DVec3::ONE, angular_radius_rad: 0.01 };
    let wrong = [
        ("no tiles", EnvironmentMaps { tiles: Vec::new(), ..maps(1.0) }),
        ("no room for a border on the left", tile([0, 1], 6)),
        ("no room for a border below", tile([1, 1], 7)),
        ("a tile far outside", tile([u32::MAX, 1], 6)),
        ("an empty tile", tile([1, 1], 0)),
        ("too many suns", EnvironmentMaps { suns: vec![sun; 5], ..maps(1.0) }),
        ("fewer texels than the atlas has", EnvironmentMaps { texels: vec![Vec3::ONE; 63], ..maps(1.0) }),
        ("an atlas beyond all memory", EnvironmentMaps { atlas_width: u32::MAX, atlas_height: u32::MAX, ..maps(1.0) }),
    ];
    for (name, maps) in wrong {
        assert!(decoded(&key, &format::encode(&key, &maps)).is_none(), "{name}");
    }
}

#[test]
fn the_files_used_longest_ago_go_first_and_others_stay() {
    let folder = tempfile::tempdir().unwrap();
    let size = bits(&maps(0.0)).len() as u64;
    let cache = EnvironmentCache::in_folder(folder.path(), 3 * size);
    let keys: Vec<Key> = (0..6).map(|i| Key([i; 32])).collect();
    let path = |i: usize| folder.path().join(keys[i].hex() + ".maps");
    let foreign = ["notes.maps", "picture.png", ".unfinished-young.maps"];
    for name in foreign {
        fs::write(folder.path().join(name), vec![0; 1 << 16]).unwrap();
    }
    let abandoned = folder.path().join(".unfinished-old.maps");
    fs::write(&abandoned, b"half").unwrap();
    set_age(&abandoned, 7200);
    for (i, age) in [(0, 30), (1, 20), (2, 10)] {
        cache.store.save(&keys[i], &maps(i as f32)).unwrap();
        set_age(&path(i), age);
    }
    // Two and a bit are more than the limit with the next; reading makes the oldest the youngest.
    assert!(cache.store.load(&keys[0]).is_some());
    cache.store.save(&keys[3], &maps(3.0)).unwrap();
    assert!(!abandoned.exists() && !path(1).exists(), "{:?}", names(folder.path()));
    assert!(path(0).exists() && path(2).exists() && path(3).exists(), "{:?}", names(folder.path()));
    assert!(foreign.iter().all(|name| folder.path().join(name).exists()));

    let tight = EnvironmentCache::in_folder(folder.path(), size);
    tight.store.save(&keys[4], &maps(4.0)).unwrap();
    assert!(path(4).exists() && names(folder.path()).len() == 1 + foreign.len(), "{:?}", names(folder.path()));
    let too_small = EnvironmentCache::in_folder(folder.path(), size - 1);
    assert!(too_small.store.save(&keys[5], &maps(5.0)).is_err());
    assert!(path(4).exists() && !path(5).exists(), "what does not fit drives nothing out");
}

#[test]
fn threads_share_a_folder() {
    let folder = tempfile::tempdir().unwrap();
    // Room for two of four, so that files vanish while others look for them.
    let limit = 2 * bits(&environment::bake(&image(1.0), &SMALL, &Silent)).len() as u64;
    let plain: Vec<Vec<u8>> = (0..4).map(|i| bits(&environment::bake(&image(i as f32), &SMALL, &Silent))).collect();
    std::thread::scope(|scope| {
        for thread in 0..4 {
            let cache = EnvironmentCache::in_folder(folder.path(), limit);
            let plain = &plain;
            scope.spawn(move || {
                for round in 0..6 {
                    let i = (thread + round) % 4;
                    let (maps, outcome) = cache.bake(&image(i as f32), &SMALL, &Silent);
                    assert!(bits(&maps) == plain[i], "thread {thread}, round {round}");
                    assert!(!matches!(outcome, Outcome::Unavailable(_)), "{outcome:?}");
                }
            });
        }
    });
    let left = names(folder.path());
    assert!((1..=2).contains(&left.len()) && left.iter().all(|name| name.len() == 64 + 5), "{left:?}");
}

#[test]
fn without_a_usable_folder_everything_is_baked() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("file");
    fs::write(&file, b"mine").unwrap();
    let key = Key::of(&image(1.0), &SMALL);
    // What has the entry's name is a folder that holds something: neither read nor replaced.
    let occupied = folder.path().join("occupied");
    fs::create_dir_all(occupied.join(key.hex() + ".maps").join("inside")).unwrap();
    for place in [file.clone(), file.join("below"), occupied.clone()] {
        let cache = EnvironmentCache::in_folder(&place, DEFAULT_LIMIT_BYTES);
        for _ in 0..2 {
            let (maps, outcome) = cache.bake(&image(1.0), &SMALL, &Silent);
            assert!(matches!(outcome, Outcome::Unavailable(_)), "{outcome:?}");
            assert!(bits(&maps) == bits(&environment::bake(&image(1.0), &SMALL, &Silent)));
        }
    }
    assert_eq!(fs::read(&file).unwrap(), b"mine");
    assert_eq!(names(&occupied).len(), 1, "an unfinished file was left");
}

#[cfg(unix)]
#[test]
fn a_folder_that_may_only_be_read_is_read() {
    use std::os::unix::fs::PermissionsExt;
    let folder = tempfile::tempdir().unwrap();
    let cache = EnvironmentCache::in_folder(folder.path(), DEFAULT_LIMIT_BYTES);
    cache.bake(&image(1.0), &SMALL, &Silent);
    let allow = |mode| fs::set_permissions(folder.path(), fs::Permissions::from_mode(mode)).unwrap();
    allow(0o555);
    let (_, known) = cache.bake(&image(1.0), &SMALL, &Silent);
    let (_, unknown) = cache.bake(&image(2.0), &SMALL, &Silent);
    // Root may write everywhere.
    let may_write = fs::write(folder.path().join("probe"), b"").is_ok();
    allow(0o755);
    assert_eq!(known, Outcome::Hit);
    assert!(may_write == (unknown == Outcome::Stored), "{unknown:?}");
}
