//! The viewer: what is seen and how, as plain data, and a window that shows it.
//!
//! [`ViewerState`] is all that a picture depends on. What a user does changes the state by plain functions; the window
//! and `specula render --state` make the same picture of it.

pub mod camera;
mod channel_picture;
#[cfg(feature = "view")]
mod desk;
mod edit;
#[cfg(feature = "view")]
mod folder;
#[cfg(feature = "view")]
mod gui;
#[cfg(feature = "view")]
pub mod input;
#[cfg(feature = "view")]
mod keys;
#[cfg(feature = "view")]
mod loading;
mod named;
#[cfg(feature = "view")]
mod panel;
#[cfg(feature = "view")]
mod recent;
#[cfg(feature = "view")]
mod recording;
#[cfg(feature = "view")]
mod saving;
#[cfg(feature = "view")]
mod shaders;
mod shown;
#[cfg(feature = "view")]
mod stage;
mod state;
#[cfg(feature = "view")]
mod surface;
#[cfg(feature = "view")]
mod timing;
#[cfg(feature = "view")]
mod translate;
#[cfg(feature = "view")]
mod truth;
#[cfg(feature = "view")]
mod viewer;
#[cfg(feature = "view")]
mod watch;
#[cfg(feature = "view")]
mod window;

pub use channel_picture::{in_units, picture};
pub use edit::{AlphaEdit, MaterialEdit};
#[cfg(feature = "view")]
pub use folder::is_state;
#[cfg(feature = "view")]
pub use shaders::read as shaders_in;
pub use shown::{Shown, environment_image, is_file, light_furnace, view_of};
pub use state::{BackgroundState, CameraState, EnvironmentState, Look, SCHEMA, StateError, ViewerState};
#[cfg(feature = "view")]
pub use window::{ViewError, ViewOptions, run};
