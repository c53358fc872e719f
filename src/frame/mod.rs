//! What will be drawn, decided on the CPU from scene and view alone: printable, testable, no GPU.

mod clusters;
mod drawables;
mod plan;

pub use clusters::{Clusters, Reach, clusters};
pub use drawables::{Drawable, Drawables, PlacedInstance};
pub use plan::{Draw, FramePlan, PipelineKey, plan};
