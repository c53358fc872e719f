//! Decoded pictures and how they are sampled.

use std::sync::Arc;

/// RGBA pixels, row-major from the top left, four channels each.
#[derive(Debug, Clone)]
pub enum Pixels {
    Rgba8(Arc<Vec<u8>>),
    Rgba16(Arc<Vec<u16>>),
    /// None here: the texture is a host's, on its device. The reference renderer sees white.
    OfHost,
}

/// A decoded picture. The values are as stored in the file: whether they are sRGB depends on the slot that uses them.
#[derive(Debug, Clone)]
pub struct Image {
    pub name: Option<String>,
    pub width: u32,
    pub height: u32,
    pub pixels: Pixels,
}

impl Image {
    /// Whether the other has as many texels a row and a column, of the same kind, and both have them here.
    pub fn has_layout_of(&self, other: &Self) -> bool {
        let is_here = !matches!(self.pixels, Pixels::OfHost);
        let same_kind = is_here && std::mem::discriminant(&self.pixels) == std::mem::discriminant(&other.pixels);
        (self.width, self.height, same_kind) == (other.width, other.height, true)
    }

    /// Lets go of the texels, for whoever has made a texture of them. The size and the kind of texels stay.
    pub fn forget_texels(&mut self) {
        self.pixels = match self.pixels {
            Pixels::Rgba8(_) => Pixels::Rgba8(Arc::default()),
            Pixels::Rgba16(_) => Pixels::Rgba16(Arc::default()),
            Pixels::OfHost => Pixels::OfHost,
        };
    }
}

/// What lies outside [0, 1] of a texture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Wrap {
    #[default]
    Repeat,
    MirroredRepeat,
    ClampToEdge,
}

/// Filtering and wrapping of a texture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Sampler {
    pub wrap_u: Wrap,
    pub wrap_v: Wrap,
    /// Bilinear (true) or nearest texel when magnified.
    pub mag_linear: bool,
    /// Bilinear (true) or nearest texel when minified.
    pub min_linear: bool,
    /// How mip levels are combined: `None` uses only level 0, `Some(false)` the nearest level, `Some(true)` blends two.
    pub mip_linear: Option<bool>,
}

impl Default for Sampler {
    fn default() -> Self {
        Self { wrap_u: Wrap::Repeat, wrap_v: Wrap::Repeat, mag_linear: true, min_linear: true, mip_linear: Some(true) }
    }
}

/// An image with a sampler.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Texture {
    /// Index into [`super::Scene::images`].
    pub image: usize,
    pub sampler: Sampler,
}

/// A rendered picture: scene radiance, before exposure and tone map.
#[derive(Debug, Clone, PartialEq)]
pub struct RadianceImage {
    pub width: u32,
    pub height: u32,
    /// `width * height` texels from the top left: linear Rec.709 radiance in cd/m2, multiplied with the coverage in w.
    pub texels: Vec<glam::Vec4>,
}

/// What the numbers of a [`Picture`] are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Encoding {
    /// Display-referred: sRGB-encoded, in [0, 1].
    Srgb,
    /// Linear Rec.709 radiance in cd/m2, of any size.
    Linear,
}

/// A picture as its file has it, for comparison with another.
#[derive(Debug, Clone, PartialEq)]
pub struct Picture {
    pub width: u32,
    pub height: u32,
    pub encoding: Encoding,
    /// `width * height` texels from the top left: the colour multiplied with the coverage, which is in w.
    pub texels: Vec<glam::Vec4>,
}
