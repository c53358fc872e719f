//! Conventions shared by every layer: directions, projections, colour. No scene, no GPU.

pub mod color;
pub mod parameter;
pub mod spaces;
