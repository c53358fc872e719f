//! Mip chains, filtered in linear light.
//!
//! A level is an area-weighted average of the one above, in float32: odd sizes lose nothing. Colours are averaged as
//! light and not as sRGB codes; where alpha is coverage they are weighted with it, so that what is invisible does not
//! bleed into what is not; normals are averaged as vectors and brought back to unit length.

mod average;
mod texels;

use crate::scene::{Image, Pixels};
use crate::threads::*;
use average::{Bands, halve};
use glam::Vec4;
use std::sync::Arc;
use texels::{Encoder, Linear, Linear8, Linear16, signed};

/// What the channels of a texture mean.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Role {
    /// RGB in sRGB, alpha ignored.
    Color,
    /// RGB in sRGB, alpha is coverage.
    ColorWithCoverage,
    /// Numbers.
    Data,
    /// A tangent-space normal around 0.5.
    Normal,
}

impl Role {
    pub fn is_srgb(self) -> bool {
        matches!(self, Self::Color | Self::ColorWithCoverage)
    }
}

/// One level: linear values, as 8-bit codes (sRGB for colours) or half floats.
#[derive(Debug, Clone)]
pub struct Level {
    pub width: u32,
    pub height: u32,
    pub bytes: Bytes,
}

/// The image's own bytes where samplers read them as they are, or almost.
#[derive(Debug, Clone)]
pub enum Bytes {
    OfImage(Arc<Vec<u8>>),
    /// Samplers read them signed.
    OfNormals(Arc<Vec<u8>>),
    Own(Vec<u8>),
}

impl Bytes {
    /// As samplers read them: a copy only where someone else holds the normals too.
    pub fn into_codes(self) -> Arc<Vec<u8>> {
        match self {
            Self::OfImage(bytes) => bytes,
            Self::OfNormals(mut bytes) => {
                Arc::make_mut(&mut bytes).par_chunks_mut(1 << 16).for_each(|codes| {
                    codes.iter_mut().for_each(|code| *code = signed(*code));
                });
                bytes
            }
            Self::Own(bytes) => Arc::new(bytes),
        }
    }
}

/// Level 0 and, with `mipmapped`, all smaller ones, from the first that is not larger than `max_side` on.
///
/// 8-bit images give RGBA8 levels, encoded as they came; 16-bit ones linear RGBA16F. Normals are signed: in bytes, code 0
/// of the image is -128; else [-1, 1] in the same steps, from -257/254 on. Of a host's texture there are none.
pub fn chain(image: &Image, role: Role, mipmapped: bool, max_side: u32) -> Vec<Level> {
    match &image.pixels {
        Pixels::Rgba8(bytes) => {
            let texels = Linear8::new(bytes, role);
            let largest = |_: &Encoder| match role {
                Role::Normal => Bytes::OfNormals(Arc::clone(bytes)),
                _ => Bytes::OfImage(Arc::clone(bytes)),
            };
            levels_of(image, &texels, (mipmapped, max_side), &Encoder::new(role, false), largest)
        }
        Pixels::Rgba16(words) => {
            let texels = Linear16::new(words, role);
            let count = image.width as usize * image.height as usize;
            let largest = |encoder: &Encoder| Bytes::Own(encoder.encode_all(&texels, count));
            levels_of(image, &texels, (mipmapped, max_side), &Encoder::new(role, true), largest)
        }
        Pixels::OfHost => Vec::new(),
    }
}

/// [`chain`] of an image with these texels.
fn levels_of(
    image: &Image,
    texels: &impl Linear,
    (mipmapped, max_side): (bool, u32),
    encoder: &Encoder,
    largest: impl Fn(&Encoder) -> Bytes,
) -> Vec<Level> {
    let fits = |(width, height): (u32, u32)| width.max(height) <= max_side;
    let mut size = (image.width, image.height);
    let mut levels = Vec::new();
    if fits(size) {
        levels.push(Level { width: size.0, height: size.1, bytes: largest(encoder) });
    }
    let mut linear: Vec<Vec4> = Vec::new();
    if mipmapped {
        let bands = Bands::of(size);
        let made;
        (made, linear) = bands.average(texels, encoder, fits);
        levels.extend(made);
        size = bands.last();
    }
    while size.0.max(size.1) > 1 && (mipmapped || levels.is_empty()) {
        let to = ((size.0 / 2).max(1), (size.1 / 2).max(1));
        linear = if linear.is_empty() { halve(texels, size, to) } else { halve(linear.as_slice(), size, to) };
        size = to;
        if fits(size) {
            let bytes = Bytes::Own(encoder.encode_all(linear.as_slice(), linear.len()));
            levels.push(Level { width: size.0, height: size.1, bytes });
        }
    }
    levels
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    fn image(width: u32, height: u32, texel: impl Fn(u32, u32) -> [u8; 4]) -> Image {
        let bytes: Vec<u8> =
            (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).flat_map(|(x, y)| texel(x, y)).collect();
        Image { name: None, width, height, pixels: Pixels::Rgba8(bytes.into()) }
    }

    fn codes(level: &Level) -> Arc<Vec<u8>> {
        level.bytes.clone().into_codes()
    }

    #[test]
    fn a_checkerboard_averages_as_light() {
        let board = image(4, 4, |x, y| if (x + y) % 2 == 0 { [255; 4] } else { [0, 0, 0, 255] });
        let levels = chain(&board, Role::Color, true, 4096);
        assert_eq!(levels.len(), 3);
        // Half the light of white is sRGB code 188, not 128.
        assert!(
            codes(&levels[1]).chunks(4).chain(codes(&levels[2]).chunks(4)).all(|texel| texel == [188, 188, 188, 255])
        );
        let data = chain(&board, Role::Data, true, 4096);
        assert_eq!(codes(&data[2])[..], [128, 128, 128, 255]);
    }

    #[test]
    fn odd_sizes_keep_the_mean() {
        let ramp = image(5, 3, |x, y| [(x * 40 + y * 10) as u8, 0, 0, 255]);
        let mean = (0..3).flat_map(|y| (0..5).map(move |x| x * 40 + y * 10)).sum::<u32>() as f32 / 15.0;
        let levels = chain(&ramp, Role::Data, true, 4096);
        assert_eq!((levels[1].width, levels[1].height), (2, 1));
        let last = codes(levels.last().unwrap())[0];
        assert!((f32::from(last) - mean).abs() <= 0.5, "{last} instead of {mean}");
    }

    #[test]
    fn what_is_invisible_does_not_bleed() {
        let leaf = image(2, 1, |x, _| if x == 0 { [0, 255, 0, 255] } else { [255, 0, 255, 0] });
        let level = &chain(&leaf, Role::ColorWithCoverage, true, 4096)[1];
        assert_eq!(codes(level)[..], [0, 255, 0, 128]);
    }

    #[test]
    fn normals_stay_unit_vectors() {
        let bumps = image(2, 2, |x, _| if x == 0 { [255, 128, 128, 255] } else { [128, 128, 255, 255] });
        let level = &chain(&bumps, Role::Normal, true, 4096)[1];
        let level = codes(level);
        let code = |i: usize| f32::from(level[i] ^ 0x80);
        let n = Vec3::new(code(0), code(1), code(2)) / 127.5 - 1.0;
        assert!((n.length() - 1.0).abs() < 0.01, "{n}");
    }

    #[test]
    fn levels_above_the_limit_are_left_out() {
        let large = image(16, 8, |_, _| [7, 7, 7, 255]);
        let levels = chain(&large, Role::Data, true, 4);
        assert_eq!(
            levels.iter().map(|level| (level.width, level.height)).collect::<Vec<_>>(),
            [(4, 2), (2, 1), (1, 1)]
        );
        assert_eq!(chain(&large, Role::Data, false, 4).len(), 1);
        assert_eq!(chain(&large, Role::Data, false, 16).len(), 1);
    }

    #[test]
    fn bands_change_nothing() {
        let noise = |x: u32, y: u32| (x * 7919 + y * 104_729 + x * y).wrapping_mul(2_654_435_761).to_be_bytes();
        for role in [Role::Color, Role::ColorWithCoverage, Role::Data, Role::Normal] {
            // 96 can be halved five times, 2 x 192 once.
            for (width, height) in [(96, 160), (192, 2), (64, 64), (33, 66), (1, 8)] {
                let image = image(width, height, noise);
                let (Pixels::Rgba8(bytes), encoder) = (&image.pixels, Encoder::new(role, false)) else { panic!() };
                let texels = Linear8::new(bytes, role);
                let mut linear: Vec<Vec4> = (0..bytes.len() / 4).map(|i| texels.texel(i)).collect();
                let mut size = (width, height);
                for level in &chain(&image, role, true, 4096)[1..] {
                    let to = (level.width, level.height);
                    linear = halve(linear.as_slice(), size, to);
                    size = to;
                    let whole = encoder.encode_all(linear.as_slice(), linear.len());
                    assert_eq!(*codes(level), whole, "{role:?} {width} x {height}: {to:?}");
                }
                assert_eq!(size, (1, 1));
            }
        }
    }

    #[test]
    fn normals_are_signed_in_place() {
        let mut flat = image(2, 2, |_, _| [128, 128, 255, 0]);
        let [level] = &mut chain(&flat, Role::Normal, false, 4096)[..] else { panic!() };
        assert_eq!(codes(level)[..4], [0, 0, 127, 0x80]);
        let Pixels::Rgba8(bytes) = &flat.pixels else { panic!() };
        assert_eq!(bytes[..4], [128, 128, 255, 0], "a scene that keeps its image has it as it was");
        let place = bytes.as_ptr();
        flat.forget_texels();
        let bytes = std::mem::replace(&mut level.bytes, Bytes::Own(Vec::new()));
        assert_eq!(bytes.into_codes().as_ptr(), place);
    }
}
