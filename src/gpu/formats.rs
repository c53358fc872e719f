//! Texture formats by role. No other file names a format.

use glam::Vec4;
use half::f16;
use wgpu::TextureFormat;

/// Depth, reversed: 1 at the near plane, 0 at infinity.
pub const DEPTH: TextureFormat = TextureFormat::Depth32Float;
/// What the visibility pass leaves: four whole numbers a sample (wider ones cannot be multisampled).
pub const VISIBILITY: TextureFormat = TextureFormat::Rgba16Uint;
/// Attributes of vertices that a fragment shader fetches.
pub const PULLED_VERTICES: TextureFormat = TextureFormat::Rgba32Float;
/// Numbers of the vertices of a triangle that a fragment shader fetches.
pub const PULLED_TRIANGLES: TextureFormat = TextureFormat::Rgba32Uint;
/// Display values of a captured frame; the shader applies the sRGB transfer, so that all adapters round alike.
pub const CAPTURED_DISPLAY: TextureFormat = TextureFormat::Rgba8Unorm;
/// Prefiltered environments and panoramas.
pub const ENVIRONMENT: TextureFormat = TextureFormat::Rgba16Float;
/// 8-bit textures that hold sRGB colour.
pub const COLOR_TEXTURE: TextureFormat = TextureFormat::Rgba8UnormSrgb;
/// 8-bit textures that hold numbers.
pub const DATA_TEXTURE: TextureFormat = TextureFormat::Rgba8Unorm;
/// 8-bit normal maps, moved by half the range: llvmpipe filters unsigned bytes in steps of 1/255, too coarse for a mirror,
/// and signed ones in float32. `gpu_scene::mips` makes them, `surface/normal_map.wgsl` undoes it.
pub const NORMAL_TEXTURE: TextureFormat = TextureFormat::Rgba8Snorm;
/// Textures that came with 16 bits a channel, made linear.
pub const DEEP_TEXTURE: TextureFormat = TextureFormat::Rgba16Float;

/// Precision of the target that scene radiance is accumulated in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Precision {
    /// 11 bits of significand, up to 65504 cd/m2.
    #[default]
    Half,
    /// 24 bits of significand. Needs an adapter that can blend and multisample it.
    Float,
}

impl Precision {
    pub fn hdr_format(self) -> TextureFormat {
        match self {
            Self::Half => TextureFormat::Rgba16Float,
            Self::Float => TextureFormat::Rgba32Float,
        }
    }

    /// The texels of a texture in [`Self::hdr_format`], read back without padding.
    pub fn texels(self, bytes: &[u8]) -> Vec<Vec4> {
        match self {
            Self::Float => bytes.chunks_exact(16).map(bytemuck::pod_read_unaligned).collect(),
            Self::Half => {
                let halves = bytes.chunks_exact(8).map(bytemuck::pod_read_unaligned::<[f16; 4]>);
                halves.map(|texel| Vec4::from_array(texel.map(f16::to_f32))).collect()
            }
        }
    }
}

/// Tables of numbers in [0, 1] with one or four channels: 16-bit normalised where the device has it, else half floats
/// (the split-sum table then has an error of 1e-4 instead of 4e-5).
pub fn table(features: wgpu::Features, channels: usize) -> TextureFormat {
    match (features.contains(wgpu::Features::TEXTURE_FORMAT_16BIT_NORM), channels) {
        (true, 1) => TextureFormat::R16Unorm,
        (true, _) => TextureFormat::Rgba16Unorm,
        (false, 1) => TextureFormat::R16Float,
        (false, _) => TextureFormat::Rgba16Float,
    }
}

/// Whether the channels of a 16-bit format are half floats and not fractions of 65535.
pub fn is_half_float(format: TextureFormat) -> bool {
    matches!(format, TextureFormat::R16Float | TextureFormat::Rgba16Float)
}

/// The format in which a window is drawn that can be shown in `possible` ones: one that takes display values as they are.
pub fn presented(possible: &[TextureFormat]) -> Option<TextureFormat> {
    let plain = [TextureFormat::Bgra8Unorm, TextureFormat::Rgba8Unorm];
    plain.into_iter().find(|format| possible.contains(format))
}

/// Whether a target of this format applies the sRGB transfer by itself.
pub fn encodes_srgb(format: TextureFormat) -> bool {
    format.is_srgb()
}
