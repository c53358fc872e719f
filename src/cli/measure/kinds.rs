//! What is measured: fills of targets, lookups in textures, arithmetic.

use crate::gpu::formats::{self, Precision};

/// A target that every pixel of is written once.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::cli) struct Fill {
    pub(in crate::cli) target: Target,
    /// More than one are resolved.
    pub(in crate::cli) samples: u32,
    /// Whether a depth buffer is cleared and tested beside.
    pub(in crate::cli) depth: bool,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::cli) enum Target {
    /// Rgba8, what is displayed.
    Display,
    /// Half or single floats, four a pixel.
    Radiance(Precision),
}

impl Target {
    pub(super) fn format(self) -> wgpu::TextureFormat {
        match self {
            Self::Display => formats::CAPTURED_DISPLAY,
            Self::Radiance(precision) => precision.hdr_format(),
        }
    }
}

impl Fill {
    /// What a report on a device has.
    pub(in crate::cli) const ALL: [Self; 6] = {
        let half = Target::Radiance(Precision::Half);
        [
            Self { target: Target::Display, samples: 1, depth: false },
            Self { target: Target::Display, samples: 4, depth: false },
            Self { target: half, samples: 1, depth: false },
            Self { target: half, samples: 4, depth: false },
            Self { target: half, samples: 1, depth: true },
            Self { target: half, samples: 4, depth: true },
        ]
    };

    pub(super) fn name(self) -> String {
        let target = match self.target {
            Target::Display => "Rgba8",
            Target::Radiance(Precision::Half) => "Rgba16Float",
            Target::Radiance(Precision::Float) => "Rgba32Float",
        };
        let samples = if self.samples == 1 { ", 1 sample" } else { ", 4 samples and their resolve" };
        format!("{target}{samples}{}", if self.depth { ", depth" } else { "" })
    }
}

/// A lookup in a texture, by what it costs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::cli) enum Tap {
    /// Rgba8, one level.
    Bilinear,
    /// Rgba8 with sRGB transfer, two levels.
    Color,
    /// Rgba8, two levels.
    Data,
    /// Signed Rgba8, two levels.
    Normal,
    /// Rgba16Float, one level: environments.
    Half,
    /// Four channels of 16 bits, one level.
    Table,
    /// One texel of Rgba16Float.
    Load,
}

impl Tap {
    pub(in crate::cli) const ALL: [Self; 7] =
        [Self::Bilinear, Self::Color, Self::Data, Self::Normal, Self::Half, Self::Table, Self::Load];

    pub(in crate::cli) fn name(self) -> &'static str {
        match self {
            Self::Bilinear => "Rgba8, bilinear",
            Self::Color => "Rgba8 sRGB, trilinear",
            Self::Data => "Rgba8, trilinear",
            Self::Normal => "Rgba8 signed, trilinear",
            Self::Half => "Rgba16Float, bilinear",
            Self::Table => "16-bit table, bilinear",
            Self::Load => "Rgba16Float, one texel",
        }
    }

    pub(super) fn format(self, features: wgpu::Features) -> wgpu::TextureFormat {
        match self {
            Self::Bilinear | Self::Data => formats::DATA_TEXTURE,
            Self::Color => formats::COLOR_TEXTURE,
            Self::Normal => formats::NORMAL_TEXTURE,
            Self::Half | Self::Load => formats::ENVIRONMENT,
            Self::Table => formats::table(features, 4),
        }
    }
}

/// Arithmetic on one f32, by what it costs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::cli) enum Op {
    /// A multiplication and an addition. Either alone, a comparison or a choice counts as half of it.
    MultiplyAdd,
    Divide,
    Sqrt,
    InverseSqrt,
    Exp2,
    Log2,
    Pow,
    Sine,
    ArcCosine,
    ArcTangent,
}

impl Op {
    pub(in crate::cli) const ALL: [Self; 10] = [
        Self::MultiplyAdd,
        Self::Divide,
        Self::Sqrt,
        Self::InverseSqrt,
        Self::Exp2,
        Self::Log2,
        Self::Pow,
        Self::Sine,
        Self::ArcCosine,
        Self::ArcTangent,
    ];

    pub(in crate::cli) fn name(self) -> &'static str {
        match self {
            Self::MultiplyAdd => "multiply-add",
            Self::Divide => "division",
            Self::Sqrt => "sqrt",
            Self::InverseSqrt => "inverseSqrt",
            Self::Exp2 => "exp2",
            Self::Log2 => "log2",
            Self::Pow => "pow",
            Self::Sine => "sin",
            Self::ArcCosine => "acos",
            Self::ArcTangent => "atan2",
        }
    }
}
