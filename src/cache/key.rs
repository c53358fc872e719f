//! What a file in the cache is found by.

use crate::bake::environment::{BakeOptions, VERSION};
use crate::scene::EnvironmentImage;

/// Hash of everything that baked maps depend on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Key(pub(super) [u8; 32]);

impl Key {
    pub(super) fn of(image: &EnvironmentImage, options: &BakeOptions) -> Self {
        // Named one by one, so that an option cannot be added and forgotten here.
        let BakeOptions { max_side, suns } = *options;
        let EnvironmentImage { width, height, texels } = image;
        let mut hasher = blake3::Hasher::new_derive_key("specula prefiltered environment");
        for number in [VERSION, max_side, u32::from(suns), *width, *height] {
            hasher.update(&number.to_le_bytes());
        }
        hasher.update(bytemuck::cast_slice(texels));
        Self(hasher.finalize().into())
    }

    pub(super) fn hex(&self) -> String {
        blake3::Hash::from_bytes(self.0).to_hex().to_string()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    #[test]
    fn every_input_counts() {
        let image = |width, height, seed: f32| {
            let texels = (0..width * height).map(|i| Vec3::splat(seed + i as f32)).collect();
            EnvironmentImage { width, height, texels }
        };
        let options = BakeOptions::default();
        let base = image(8, 4, 1.0);
        let mut changed = base.clone();
        changed.texels[31].z = f32::from_bits(changed.texels[31].z.to_bits() ^ 1);
        let others = [
            Key::of(&changed, &options),
            Key::of(&image(4, 8, 1.0), &options),
            Key::of(&base, &BakeOptions { max_side: 64, ..options }),
            Key::of(&base, &BakeOptions { suns: false, ..options }),
        ];
        assert_eq!(Key::of(&base, &options), Key::of(&base.clone(), &options));
        for (index, other) in others.iter().enumerate() {
            assert_ne!(Key::of(&base, &options), *other, "{index}");
            assert!(!others[..index].contains(other), "{index}");
        }
        assert_eq!(Key::of(&base, &options).hex().len(), 64);
    }
}
