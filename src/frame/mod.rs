//! What will be drawn, decided on the CPU from scene and view alone: printable, testable, no GPU.

mod boxes;
mod clusters;
mod cull;
mod depth_order;
mod drawables;
mod identity;
mod occlusion;
mod path;
mod plan;
mod rectangle;
#[cfg(test)]
mod tests;

pub use boxes::Boxes;
pub use clusters::{Clusters, Reach, clusters};
pub use cull::{Culling, clip_from_origin};
pub use drawables::{Drawable, Drawables, PlacedInstance, Placements};
pub use identity::PrimitivePlace;
pub use occlusion::Occluders;
pub use path::{RenderPath, are_small, deferred, left_over};
pub use plan::{Culled, Draw, FramePlan, PipelineKey, PlanOptions, Planner, Raster, forward_features, plan};
pub use rectangle::Rectangle;
