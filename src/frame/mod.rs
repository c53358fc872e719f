//! What will be drawn, decided on the CPU from scene and view alone: printable, testable, no GPU.

mod drawables;
mod path;
mod plan;

pub use drawables::{Drawable, Drawables, PlacedInstance};
pub use path::{RenderPath, are_small, is_deferrable, rectangle_around};
pub use plan::{Draw, FramePlan, PipelineKey, plan};
