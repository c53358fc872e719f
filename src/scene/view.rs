//! How a scene is turned into a picture: camera, size, exposure, tone map, background.

use super::Camera;
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

/// A picture to be taken of a scene.
#[derive(Debug, Clone, PartialEq)]
pub struct View {
    pub camera: Camera,
    pub size_px: UVec2,
    /// Stops: display = tone_map(radiance * 2^EV).
    pub exposure_ev: f32,
    pub tone_map: ToneMap,
    pub background: Background,
    /// Give back the energy that single-scattering microfacet models lose (Kulla and Conty 2017).
    pub energy_compensation: bool,
}
