//! Texels of an image as linear light that can be averaged, and averages as samplers read them.

use super::Role;
use crate::math::color::{SrgbCodes, linear_from_srgb};
use crate::threads::*;
use glam::{Vec3, Vec4};

/// Texels by their number, row by row. A trait and not a closure, so that they are inlined in the development profile too.
pub(super) trait Linear: Sync {
    fn texel(&self, i: usize) -> Vec4;
}

impl Linear for [Vec4] {
    #[inline(always)]
    fn texel(&self, i: usize) -> Vec4 {
        self[i]
    }
}

/// An image of 8 bits.
#[derive(Debug)]
pub(super) struct Linear8<'a> {
    bytes: &'a [u8],
    role: Role,
    /// By code.
    rgb: [f32; 256],
    plain: [f32; 256],
}

impl<'a> Linear8<'a> {
    pub(super) fn new(bytes: &'a [u8], role: Role) -> Self {
        let plain: [f32; 256] = std::array::from_fn(|code| code as f32 / 255.0);
        let color: [f32; 256] = std::array::from_fn(|code| linear_from_srgb(code as f64 / 255.0) as f32);
        Self { bytes, role, rgb: if role.is_srgb() { color } else { plain }, plain }
    }
}

impl Linear for Linear8<'_> {
    #[inline(always)]
    fn texel(&self, i: usize) -> Vec4 {
        let texel = &self.bytes[4 * i..4 * i + 4];
        let [r, g, b, a] = [texel[0], texel[1], texel[2], texel[3]].map(usize::from);
        weigh(Vec4::new(self.rgb[r], self.rgb[g], self.rgb[b], self.plain[a]), self.role)
    }
}

/// An image of 16 bits.
#[derive(Debug)]
pub(super) struct Linear16<'a> {
    words: &'a [u16],
    role: Role,
}

impl<'a> Linear16<'a> {
    pub(super) fn new(words: &'a [u16], role: Role) -> Self {
        Self { words, role }
    }
}

impl Linear for Linear16<'_> {
    fn texel(&self, i: usize) -> Vec4 {
        let texel = &self.words[4 * i..4 * i + 4];
        let value = |word: u16| f64::from(word) / 65535.0;
        let rgb = |word: u16| if self.role.is_srgb() { linear_from_srgb(value(word)) } else { value(word) } as f32;
        weigh(Vec4::new(rgb(texel[0]), rgb(texel[1]), rgb(texel[2]), value(texel[3]) as f32), self.role)
    }
}

/// Colours multiplied with alpha where it is coverage, normals in [-1, 1].
#[inline(always)]
fn weigh(texel: Vec4, role: Role) -> Vec4 {
    match role {
        Role::Color | Role::Data => texel,
        Role::ColorWithCoverage => (texel.truncate() * texel.w).extend(texel.w),
        Role::Normal => (texel.truncate() * 2.0 - 1.0).extend(texel.w),
    }
}

/// Undoes [`weigh`] after averaging.
#[inline(always)]
fn unweigh(texel: Vec4, role: Role) -> Vec4 {
    match role {
        Role::Color | Role::Data => texel,
        Role::ColorWithCoverage if texel.w > 0.0 => (texel.truncate() / texel.w).extend(texel.w),
        Role::ColorWithCoverage => Vec4::ZERO,
        Role::Normal => (texel.truncate().normalize_or(Vec3::Z) * 0.5 + 0.5).extend(texel.w),
    }
}

/// A code in excess-128 as a two's complement: 0 becomes -128, which samplers read as -1 like -127.
pub(super) fn signed(code: u8) -> u8 {
    code ^ 0x80
}

/// Makes bytes of averages.
#[derive(Debug)]
pub(super) struct Encoder {
    role: Role,
    /// Half floats instead of 8-bit codes.
    is_deep: bool,
    srgb: SrgbCodes,
}

impl Encoder {
    pub(super) fn new(role: Role, is_deep: bool) -> Self {
        Self { role, is_deep, srgb: SrgbCodes::new() }
    }

    pub(super) fn texel_bytes(&self) -> usize {
        if self.is_deep { 8 } else { 4 }
    }

    /// Fills `bytes` with the codes of as many texels, from number `start` on.
    pub(super) fn encode(&self, texels: &(impl Linear + ?Sized), start: usize, bytes: &mut [u8]) {
        let role = self.role;
        if self.is_deep {
            // As signed bytes are read, so that the shader need not tell them apart.
            let as_bytes = |texel: Vec4| if role == Role::Normal { (texel * 255.0 - 128.0) / 127.0 } else { texel };
            for (i, out) in bytes.chunks_exact_mut(8).enumerate() {
                let halves = as_bytes(unweigh(texels.texel(start + i), role)).to_array().map(half::f16::from_f32);
                out.copy_from_slice(bytemuck::bytes_of(&halves));
            }
            return;
        }
        let is_srgb = role.is_srgb();
        let (texels, code) =
            (|i: usize| unweigh(texels.texel(start + i), role), |value: f32| (value * 255.0 + 0.5) as u8);
        for (i, out) in bytes.as_chunks_mut::<4>().0.iter_mut().enumerate() {
            let [r, g, b, a] = texels(i).to_array();
            let rgb = if is_srgb { [r, g, b].map(|x| self.srgb.code(x)) } else { [r, g, b].map(code) };
            let texel = [rgb[0], rgb[1], rgb[2], code(a)];
            *out = if role == Role::Normal { texel.map(signed) } else { texel };
        }
    }

    /// The codes of the first `count` texels, on all cores.
    pub(super) fn encode_all(&self, texels: &(impl Linear + ?Sized), count: usize) -> Vec<u8> {
        const TEXELS: usize = 4096;
        let mut bytes = vec![0; count * self.texel_bytes()];
        bytes.par_chunks_mut(TEXELS * self.texel_bytes()).enumerate().for_each(|(chunk, out)| {
            self.encode(texels, chunk * TEXELS, out);
        });
        bytes
    }
}
