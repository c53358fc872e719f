//! How a scene is turned into a picture: camera, size, exposure, tone map, background.

use super::{Camera, Channel, Components};
use glam::{UVec2, Vec3};

/// The curve from exposed scene radiance to display light. All but `None` apply the exposure first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum ToneMap {
    /// Khronos PBR Neutral: base colours come out as authored, highlights roll off (Khronos 2024).
    #[default]
    Neutral,
    /// ACES RRT + ODT, fitted by Hill, with the customary 1/0.6 exposure.
    Aces,
    /// AgX by Sobotka, default look.
    AgX,
    /// Reinhard et al. 2002, equation 3, per channel: x / (1 + x).
    Reinhard,
    /// Exposure and clamp.
    Linear,
    /// Clamp only: neither exposure nor curve, for data.
    None,
}

impl ToneMap {
    pub const ALL: [Self; 6] = [Self::Neutral, Self::Aces, Self::AgX, Self::Reinhard, Self::Linear, Self::None];

    /// The name in reports and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Neutral => "neutral",
            Self::Aces => "aces",
            Self::AgX => "agx",
            Self::Reinhard => "reinhard",
            Self::Linear => "linear",
            Self::None => "none",
        }
    }

    /// The curve of a name.
    pub fn by_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|tone_map| tone_map.name() == name)
    }
}

/// What is seen where the scene is not.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Background {
    /// Coverage goes to the alpha channel.
    Transparent,
    /// The environment, as a mirror would show it.
    #[default]
    Environment,
    /// A display-referred sRGB colour in [0, 1], not touched by exposure or tone map.
    Color(Vec3),
}

/// The geometry factor of the specular lobe: how microfacets hide each other. The Schlick forms know no direction, and take the mean alpha of an anisotropic distribution.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Default)]
pub enum Geometry {
    /// Exact under Smith's assumptions: facets that are high are neither masked nor shadowed.
    #[default]
    SmithCorrelated,
    /// Masking and shadowing as if independent: too dark where light and view are both grazing.
    SmithSeparable,
    /// Schlick's form with k = alpha / 2, which meets Smith's at alpha = 1.
    SchlickHalfAlpha,
    /// Schlick's form with k = (r + 1)^2 / 8 of the perceptual roughness r (Karis 2013, equation 4): made to look good
    /// under punctual lights, and so dark on smooth surfaces.
    SchlickKaris,
    /// Schlick's form with k = ((r + 1) / 2)^2, as the lecture prints it. That is Karis' remapped alpha, which he halves
    /// again to get k: the lecture's k is twice as large, and hides most of the light.
    SchlickLecture,
}

impl Geometry {
    pub const ALL: [Self; 5] =
        [Self::SmithCorrelated, Self::SmithSeparable, Self::SchlickHalfAlpha, Self::SchlickKaris, Self::SchlickLecture];

    /// The name in reports and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::SmithCorrelated => "smith-correlated",
            Self::SmithSeparable => "smith-separable",
            Self::SchlickHalfAlpha => "schlick-half-alpha",
            Self::SchlickKaris => "schlick-karis",
            Self::SchlickLecture => "schlick-lecture",
        }
    }

    /// The model of a name.
    pub fn by_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|geometry| geometry.name() == name)
    }
}

/// How light from the environment is reflected: time against error, see docs/ibl.md.
///
/// Suns that the maps have been parted from are shaded in every tier. `SplitSum` is meant for maps that hold all.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Default)]
pub enum Quality {
    /// One lookup in the mirror direction (Karis 2013): the baseline.
    SplitSum,
    /// Two fitted lookups a lobe; one for a lobe that is longer than wide.
    Draft,
    /// Three fitted lookups; three or five for a lobe that is longer than wide.
    #[default]
    Standard,
    /// Four fitted lookups; five for a lobe that is longer than wide.
    High,
}

impl Quality {
    pub const ALL: [Self; 4] = [Self::SplitSum, Self::Draft, Self::Standard, Self::High];

    /// The name in reports and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::SplitSum => "split-sum",
            Self::Draft => "draft",
            Self::Standard => "standard",
            Self::High => "high",
        }
    }

    /// The tier of a name.
    pub fn by_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|quality| quality.name() == name)
    }

    /// Whether suns are taken out of the panorama before it is prefiltered.
    pub fn parts_suns(self) -> bool {
        self != Self::SplitSum
    }
}

/// A part of the radiance that a surface sends to the eye; all of them add up to it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Term {
    /// What surfaces emit, and what unlit ones show.
    Emission,
    /// Of point, spot and directional lights, from below the surface.
    DirectDiffuse,
    /// Of the same, from its facets, however often they scatter the light.
    DirectSpecular,
    /// Of the environment, its suns included.
    EnvironmentDiffuse,
    EnvironmentSpecular,
}

impl Term {
    pub const ALL: [Self; 5] = [
        Self::Emission,
        Self::DirectDiffuse,
        Self::DirectSpecular,
        Self::EnvironmentDiffuse,
        Self::EnvironmentSpecular,
    ];

    /// The name in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Emission => "emission",
            Self::DirectDiffuse => "direct diffuse",
            Self::DirectSpecular => "direct specular",
            Self::EnvironmentDiffuse => "environment diffuse",
            Self::EnvironmentSpecular => "environment specular",
        }
    }

    /// Whether it is light of point, spot and directional lights.
    pub fn is_direct(self) -> bool {
        matches!(self, Self::DirectDiffuse | Self::DirectSpecular)
    }

    /// Whether it is light of the environment.
    pub fn is_of_environment(self) -> bool {
        matches!(self, Self::EnvironmentDiffuse | Self::EnvironmentSpecular)
    }

    /// What of a BRDF reflects it; nothing emits it.
    pub fn components(self) -> Option<Components> {
        match self {
            Self::Emission => None,
            Self::DirectDiffuse | Self::EnvironmentDiffuse => Some(Components::DIFFUSE),
            Self::DirectSpecular | Self::EnvironmentSpecular => Some(Components::SPECULAR),
        }
    }
}

/// A picture to be taken of a scene.
#[derive(Debug, Clone, PartialEq)]
pub struct View {
    pub camera: Camera,
    pub size_px: UVec2,
    /// Stops: display = tone_map(radiance * 2^EV).
    pub exposure_ev: f32,
    pub tone_map: ToneMap,
    pub background: Background,
    /// The environment as background is seen through the lobe that its maps are prefiltered with, of this perceptual
    /// roughness, in [0, 1]; 0 is sharp.
    pub background_blur: f32,
    /// Give back the energy that single-scattering microfacet models lose (Kulla and Conty 2017).
    pub energy_compensation: bool,
    /// For punctual lights; the tables that light from the environment is read through hold the default.
    pub geometry: Geometry,
    pub quality: Quality,
    /// Show only this part of the radiance of surfaces; the background stays. Of unshadowed light: where the reference
    /// renderer follows further bounces it shows everything.
    pub term: Option<Term>,
    /// What is drawn in place of the radiance; the reference renderer and the display transform do not heed it.
    pub channel: Option<Channel>,
}
