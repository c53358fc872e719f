//! A scene of a host that is edited while it is shown: models come and go by handles, and nothing that stays is uploaded
//! again.

mod check;
mod environment;
mod hosted;
mod merge;
mod pick;
mod requirements;
mod scene;
mod slots;

pub use environment::EnvironmentDownload;
pub use pick::{Hit, Pick};
pub use requirements::{Degraded, Requirements};
pub use scene::LiveScene;

use crate::renderer::RenderError;

/// A model in a [`LiveScene`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct ModelId {
    scene: u64,
    index: u32,
    generation: u32,
}

/// Why a scene could not be changed or uploaded.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum EmbedError {
    #[error("the handle is of a model that was removed, or of another scene")]
    StaleHandle,
    #[error("the model has {count} {what}s, there is no {what} {index}")]
    NoSuch { what: &'static str, index: usize, count: usize },
    #[error("{what} is {value}, expected {expected}")]
    Number { what: &'static str, value: f64, expected: &'static str },
    #[error("the device cannot be rendered with: {0}")]
    Device(String),
    #[error("the model cannot be drawn: {0}")]
    Asset(String),
    #[error(transparent)]
    Render(#[from] RenderError),
}
