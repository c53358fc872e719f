//! Mip chains, filtered in linear light.
//!
//! A level is an area-weighted average of the one above, in float32: odd sizes lose nothing. Colours are averaged as
//! light and not as sRGB codes; where alpha is coverage they are weighted with it, so that what is invisible does not
//! bleed into what is not; normals are averaged as vectors and brought back to unit length.

use crate::math::color::{SrgbCodes, linear_from_srgb};
use crate::scene::{Image, Pixels};
use glam::{Vec3, Vec4};
use rayon::prelude::*;
use std::sync::Arc;

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

/// The image's own bytes where samplers read them as they are.
#[derive(Debug, Clone)]
pub enum Bytes {
    OfImage(Arc<[u8]>),
    Own(Vec<u8>),
}

impl std::ops::Deref for Bytes {
    type Target = [u8];

    fn deref(&self) -> &[u8] {
        match self {
            Self::OfImage(bytes) => bytes,
            Self::Own(bytes) => bytes,
        }
    }
}

/// Level 0 and, with `mipmapped`, all smaller ones, from the first that is not larger than `max_side` on.
///
/// 8-bit images give RGBA8 levels, encoded as they came; 16-bit ones linear RGBA16F. Normals are signed: in bytes, code 0
/// of the image is -128; else [-1, 1] in the same steps, from -257/254 on.
pub fn chain(image: &Image, role: Role, mipmapped: bool, max_side: u32) -> Vec<Level> {
    let fits = |width: u32, height: u32| width.max(height) <= max_side;
    let (mut width, mut height) = (image.width, image.height);
    let mut levels = Vec::new();
    if fits(width, height) {
        levels.push(Level { width, height, bytes: largest(image, role) });
    }
    let mut linear: Vec<Vec4> = Vec::new();
    while width.max(height) > 1 && (mipmapped || levels.is_empty()) {
        let (from, to) = ((width, height), ((width / 2).max(1), (height / 2).max(1)));
        linear = if linear.is_empty() { halved(image, role, to) } else { halve(|i| linear[i], from, to) };
        (width, height) = to;
        if fits(width, height) {
            levels.push(Level { width, height, bytes: Bytes::Own(encode(&linear, image, role)) });
        }
    }
    levels
}

/// The first level: the image itself where samplers read it as it is.
fn largest(image: &Image, role: Role) -> Bytes {
    match &image.pixels {
        Pixels::Rgba8(bytes) if role == Role::Normal => Bytes::Own(bytes.iter().map(signed).collect()),
        Pixels::Rgba8(bytes) => Bytes::OfImage(Arc::clone(bytes)),
        Pixels::Rgba16(words) => {
            let linear: Vec<Vec4> = words.par_chunks_exact(4).map(|texel| linear_from_words(texel, role)).collect();
            Bytes::Own(encode(&linear, image, role))
        }
    }
}

/// The level below the first. Texels are decoded as they are averaged: all at once they would take four times the
/// memory of the image.
fn halved(image: &Image, role: Role, to: (u32, u32)) -> Vec<Vec4> {
    let from = (image.width, image.height);
    match &image.pixels {
        Pixels::Rgba8(bytes) => {
            let plain: [f32; 256] = std::array::from_fn(|code| code as f32 / 255.0);
            let color: [f32; 256] = std::array::from_fn(|code| linear_from_srgb(code as f64 / 255.0) as f32);
            let rgb = if role.is_srgb() { &color } else { &plain };
            let decode = |i: usize| {
                let texel = &bytes[4 * i..4 * i + 4];
                let [r, g, b, a] = [texel[0], texel[1], texel[2], texel[3]].map(usize::from);
                weigh(Vec4::new(rgb[r], rgb[g], rgb[b], plain[a]), role)
            };
            halve(decode, from, to)
        }
        Pixels::Rgba16(words) => halve(|i| linear_from_words(&words[4 * i..4 * i + 4], role), from, to),
    }
}

/// RGBA in linear light; colours multiplied with alpha where it is coverage, normals in [-1, 1].
fn linear_from_words(texel: &[u16], role: Role) -> Vec4 {
    let value = |word: u16| f64::from(word) / 65535.0;
    let rgb = |word: u16| if role.is_srgb() { linear_from_srgb(value(word)) } else { value(word) } as f32;
    weigh(Vec4::new(rgb(texel[0]), rgb(texel[1]), rgb(texel[2]), value(texel[3]) as f32), role)
}

fn weigh(texel: Vec4, role: Role) -> Vec4 {
    match role {
        Role::Color | Role::Data => texel,
        Role::ColorWithCoverage => (texel.truncate() * texel.w).extend(texel.w),
        Role::Normal => (texel.truncate() * 2.0 - 1.0).extend(texel.w),
    }
}

/// A code in excess-128 as a two's complement: 0 becomes -128, which samplers read as -1 like -127.
fn signed(code: &u8) -> u8 {
    code ^ 0x80
}

/// Undoes [`weigh`] after averaging.
fn unweigh(texel: Vec4, role: Role) -> Vec4 {
    match role {
        Role::Color | Role::Data => texel,
        Role::ColorWithCoverage if texel.w > 0.0 => (texel.truncate() / texel.w).extend(texel.w),
        Role::ColorWithCoverage => Vec4::ZERO,
        Role::Normal => (texel.truncate().normalize_or(Vec3::Z) * 0.5 + 0.5).extend(texel.w),
    }
}

/// The source texels that one destination texel covers along an axis, with their weights (which sum to 1).
fn coverage(source: u32, target: u32, index: u32) -> impl Iterator<Item = (usize, f32)> + Clone {
    let ratio = f64::from(source) / f64::from(target);
    let (start, end) = (f64::from(index) * ratio, (f64::from(index) + 1.0) * ratio);
    let texels = start as u32..(end.ceil() as u32).min(source);
    texels.filter_map(move |texel| {
        let overlap = end.min(f64::from(texel) + 1.0) - start.max(f64::from(texel));
        (overlap > 1e-9).then_some((texel as usize, (overlap / ratio) as f32))
    })
}

/// Averages the `texel`s of a level of `width` x `height` to one of `w` x `h`.
fn halve(texel: impl Fn(usize) -> Vec4 + Sync, (width, height): (u32, u32), (w, h): (u32, u32)) -> Vec<Vec4> {
    let mut out = vec![Vec4::ZERO; w as usize * h as usize];
    let is_even = width == 2 * w && height == 2 * h;
    out.par_chunks_exact_mut(w as usize).zip(0..h).for_each(|(row, y)| {
        if is_even {
            let (top, line) = (2 * y as usize * width as usize, width as usize);
            for (x, sum) in row.iter_mut().enumerate() {
                let corner = top + 2 * x;
                *sum = (texel(corner) + texel(corner + line) + texel(corner + 1) + texel(corner + line + 1)) * 0.25;
            }
            return;
        }
        let rows: Vec<(usize, f32)> = coverage(height, h, y).collect();
        for (x, sum) in row.iter_mut().enumerate() {
            for (column, weight_x) in coverage(width, w, x as u32) {
                for &(line, weight_y) in &rows {
                    *sum += texel(line * width as usize + column) * (weight_x * weight_y);
                }
            }
        }
    });
    out
}

/// Bytes of linear texels, as samplers read them.
fn encode(texels: &[Vec4], image: &Image, role: Role) -> Vec<u8> {
    match image.pixels {
        Pixels::Rgba8(_) => {
            let srgb = SrgbCodes::new();
            let code = |value: f32| (value * 255.0 + 0.5) as u8;
            let encode = |texel: Vec4| {
                let [r, g, b, a] = texel.to_array();
                let rgb = if role.is_srgb() { [r, g, b].map(|x| srgb.code(x)) } else { [r, g, b].map(code) };
                let texel = [rgb[0], rgb[1], rgb[2], code(a)];
                if role == Role::Normal { texel.map(|code| signed(&code)) } else { texel }
            };
            let codes: Vec<[u8; 4]> = texels.par_iter().map(|texel| encode(unweigh(*texel, role))).collect();
            bytemuck::cast_slice(&codes).to_vec()
        }
        Pixels::Rgba16(_) => {
            // As signed bytes are read, so that the shader need not tell them apart.
            let as_bytes = |texel: Vec4| if role == Role::Normal { (texel * 255.0 - 128.0) / 127.0 } else { texel };
            let encode = |texel: &Vec4| as_bytes(unweigh(*texel, role)).to_array().map(half::f16::from_f32);
            let halves: Vec<[half::f16; 4]> = texels.par_iter().map(encode).collect();
            bytemuck::cast_slice(&halves).to_vec()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn image(width: u32, height: u32, texel: impl Fn(u32, u32) -> [u8; 4]) -> Image {
        let bytes: Vec<u8> =
            (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).flat_map(|(x, y)| texel(x, y)).collect();
        Image { name: None, width, height, pixels: Pixels::Rgba8(bytes.into()) }
    }

    #[test]
    fn a_checkerboard_averages_as_light() {
        let board = image(4, 4, |x, y| if (x + y) % 2 == 0 { [255; 4] } else { [0, 0, 0, 255] });
        let levels = chain(&board, Role::Color, true, 4096);
        assert_eq!(levels.len(), 3);
        // Half the light of white is sRGB code 188, not 128.
        assert!(levels[1..].iter().all(|level| level.bytes.chunks(4).all(|texel| texel == [188, 188, 188, 255])));
        let data = chain(&board, Role::Data, true, 4096);
        assert_eq!(data[2].bytes[..], [128, 128, 128, 255]);
    }

    #[test]
    fn odd_sizes_keep_the_mean() {
        let ramp = image(5, 3, |x, y| [(x * 40 + y * 10) as u8, 0, 0, 255]);
        let mean = (0..3).flat_map(|y| (0..5).map(move |x| x * 40 + y * 10)).sum::<u32>() as f32 / 15.0;
        let levels = chain(&ramp, Role::Data, true, 4096);
        assert_eq!((levels[1].width, levels[1].height), (2, 1));
        let last = levels.last().unwrap();
        assert!((f32::from(last.bytes[0]) - mean).abs() <= 0.5, "{} instead of {mean}", last.bytes[0]);
    }

    #[test]
    fn what_is_invisible_does_not_bleed() {
        let leaf = image(2, 1, |x, _| if x == 0 { [0, 255, 0, 255] } else { [255, 0, 255, 0] });
        let level = &chain(&leaf, Role::ColorWithCoverage, true, 4096)[1];
        assert_eq!(level.bytes[..], [0, 255, 0, 128]);
    }

    #[test]
    fn normals_stay_unit_vectors() {
        let bumps = image(2, 2, |x, _| if x == 0 { [255, 128, 128, 255] } else { [128, 128, 255, 255] });
        let level = &chain(&bumps, Role::Normal, true, 4096)[1];
        let code = |i: usize| f32::from(level.bytes[i] ^ 0x80);
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
}
