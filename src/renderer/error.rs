//! What can go wrong with a frame, known before it is recorded.

use crate::gpu::DeviceLost;
use crate::gpu::pipeline::PassError;
use crate::gpu_scene::UploadError;
use crate::shader::ShaderError;

/// Why a frame could not be recorded.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum RenderError {
    #[error(transparent)]
    Upload(UploadError),
    /// Known before anything is recorded: by `Renderer::with_lost_flag`, or because wgpu refused a buffer.
    #[error(transparent)]
    DeviceLost(#[from] DeviceLost),
    #[error("a shader of this version is broken, please report it: {0}")]
    Shader(#[from] ShaderError),
    #[error("this frame cannot be shaded in a pass of its own; Renderer::path says which can")]
    NotDeferrable,
    #[error("{feature} needs a pass of its own: encode_radiance and encode_display have one")]
    NeedsOwnPass { feature: &'static str },
    #[error("the furnace shows what surfaces return of an environment's light; give the scene one, whichever it is")]
    NoFurnace,
    #[error("this device cannot draw {what}: it lacks {feature}")]
    Device { what: &'static str, feature: &'static str },
    #[error("no frame of this scene has been prepared")]
    NotPrepared,
    #[error("the pass cannot be drawn into: {0}")]
    Pass(String),
    #[error("the picture is {width} x {height} pixels; both must be between 1 and {allowed}")]
    Size { width: u32, height: u32, allowed: u32 },
}

impl From<UploadError> for RenderError {
    fn from(error: UploadError) -> Self {
        match error {
            UploadError::DeviceLost(lost) => Self::DeviceLost(lost),
            error => Self::Upload(error),
        }
    }
}

impl From<PassError> for RenderError {
    fn from(error: PassError) -> Self {
        match error {
            PassError::Shader(error) => Self::Shader(error),
            PassError::DeviceLost(lost) => Self::DeviceLost(lost),
        }
    }
}
