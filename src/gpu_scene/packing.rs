//! Two images in one: glTF leaves R of metallic-roughness textures unused, and occlusion is in R.

use crate::scene::{Image, Pixels};
use crate::threads::*;
use std::sync::Arc;

/// `image` with R of `other`, which has its layout. Channels are averaged and filtered each by itself, so that no value
/// that is looked up changes.
pub(super) fn with_red_of(image: &Image, other: &Image) -> Image {
    let pixels = match (&image.pixels, &other.pixels) {
        (Pixels::Rgba8(texels), Pixels::Rgba8(red)) => Pixels::Rgba8(packed(texels, red)),
        (Pixels::Rgba16(texels), Pixels::Rgba16(red)) => Pixels::Rgba16(packed(texels, red)),
        (kept, _) => kept.clone(),
    };
    Image { name: image.name.clone(), pixels, ..*image }
}

fn packed<T: Copy + Send + Sync>(texels: &[T], red: &[T]) -> Arc<Vec<T>> {
    let mut packed = texels.to_vec();
    packed.par_chunks_mut(4).zip(red.par_chunks(4)).for_each(|(texel, red)| texel[0] = red[0]);
    Arc::new(packed)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu_scene::mips::{Role, chain};

    #[test]
    fn no_level_of_any_channel_changes() {
        let image = |seed: u32| Image {
            name: None,
            width: 7,
            height: 4,
            pixels: Pixels::Rgba8(Arc::new(
                (0..7 * 4 * 4).map(|i: u32| (i.wrapping_mul(seed) >> 7) as u8).collect::<Vec<u8>>(),
            )),
        };
        let (data, occlusion) = (image(2_654_435_761), image(2_246_822_519));
        let levels = |image: &Image| -> Vec<_> {
            chain(image, Role::Data, true, 4096).into_iter().map(|level| level.bytes.into_codes()).collect()
        };
        let packed = levels(&with_red_of(&data, &occlusion));
        assert_eq!(packed.len(), 3);
        for ((packed, data), occlusion) in packed.iter().zip(levels(&data)).zip(levels(&occlusion)) {
            assert_ne!(data[..], occlusion[..]);
            for ((packed, data), occlusion) in packed.chunks(4).zip(data.chunks(4)).zip(occlusion.chunks(4)) {
                assert_eq!(packed, [occlusion[0], data[1], data[2], data[3]]);
            }
        }
    }
}
