//! Inputs shared by the tests.

use crate::scene::EnvironmentImage;
use glam::Vec3;

/// A panorama of the shared samples. `None`, and said so, without them; under CI=true they must be there.
pub(super) fn sample_panorama(file: &str) -> Option<EnvironmentImage> {
    let folder = std::env::var("SPECULA_SAMPLES").unwrap_or_else(|_| "../shared/samples".into());
    let path = std::path::Path::new(&folder).join("env").join(file);
    let Ok(image) = image::open(&path) else {
        assert!(std::env::var("CI").as_deref() != Ok("true"), "{} is missing", path.display());
        eprintln!("skipped: {} is missing", path.display());
        return None;
    };
    let image = image.into_rgb32f();
    let texels = image.pixels().map(|pixel| Vec3::from(pixel.0)).collect();
    Some(EnvironmentImage { width: image.width(), height: image.height(), texels })
}
