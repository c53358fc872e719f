//! The passes of a frame. Each is one function that records into what it is given; none knows another.

mod background;
mod deferred;
mod display;
mod forward;
mod present;

pub use background::{BackgroundPass, BackgroundPipeline, BackgroundSource, BackgroundTarget};
pub use deferred::{DeferredGroups, DeferredPass, DeferredPipelines, DeferredTarget, OverTarget};
pub use display::{DisplayPass, DisplayPipelines};
pub use forward::{ForwardPipelines, ForwardTarget, draw};
pub use present::{PresentPass, Presented};
