//! What a frame is drawn into.

use glam::UVec2;

/// Where the radiance of a frame goes. All views have the size of the `View`.
#[derive(Debug, Clone, Copy)]
pub struct RadianceTarget<'a> {
    pub format: wgpu::TextureFormat,
    pub samples: u32,
    pub surfaces: SurfaceTarget<'a>,
    /// In `formats::DEPTH`, with the same number of samples.
    pub depth: &'a wgpu::TextureView,
    /// The only pixel that is drawn, from the top left; inside of the picture. `None` draws all.
    pub pixel: Option<UVec2>,
}

/// What surfaces are drawn into on the path of a frame (`Renderer::path`).
#[derive(Debug, Clone, Copy)]
pub enum SurfaceTarget<'a> {
    Forward {
        /// Multisampled when `samples > 1`.
        color: &'a wgpu::TextureView,
        /// Given exactly when `samples > 1`.
        resolve: Option<&'a wgpu::TextureView>,
    },
    Deferred {
        /// In `formats::VISIBILITY`, with as many samples as the depth, to be read by shaders.
        visibility: &'a wgpu::TextureView,
        /// In `formats::DEPTH`, one sample a pixel.
        covered: &'a wgpu::TextureView,
        /// In the format of the radiance, with as many samples as the depth, to be read by shaders. Given exactly where the
        /// path is [`RenderPath::Mixed`](crate::frame::RenderPath::Mixed).
        over: Option<&'a wgpu::TextureView>,
        /// One sample a pixel.
        color: &'a wgpu::TextureView,
    },
}

impl<'a> SurfaceTarget<'a> {
    /// What holds the radiance in the end.
    pub fn radiance(&self) -> &'a wgpu::TextureView {
        match *self {
            Self::Forward { color, resolve } => resolve.unwrap_or(color),
            Self::Deferred { color, .. } => color,
        }
    }

    /// All textures; the first tells the paths apart.
    pub(super) fn views(&self) -> [Option<&'a wgpu::TextureView>; 4] {
        match *self {
            Self::Forward { color, resolve } => [None, Some(color), resolve, None],
            Self::Deferred { visibility, covered, over, color } => [Some(visibility), Some(covered), Some(color), over],
        }
    }
}
